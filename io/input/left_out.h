// Counts of items that a reader leaves out, by kind, reported once.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"

namespace sterna::io {

class LeftOut {
 public:
  /// Counts n items. \param what a plural: "lines", "free-form surfaces (surf)"
  void add(std::string_view what, std::uint64_t n = 1) {
    if (n > 0) counts_[std::string(what)] += n;
  }
  bool empty() const { return counts_.empty(); }
  /// Returns "3 curves, 12 lines".
  std::string text() const {
    std::string text;
    for (const auto& [what, n] : counts_) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + what;
    return text;
  }
  /// Reports "FILE: left out: 3 curves, 12 lines" if any item was left out: as a warning, or as a note for items that bound nothing.
  void warn(const std::string& source, const RunContext& context) const {
    if (!empty()) context.warn(source + ": left out: " + text());
  }
  void report(const std::string& source, const RunContext& context) const {
    if (!empty()) context.info(source + ": left out: " + text());
  }

 private:
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace sterna::io
