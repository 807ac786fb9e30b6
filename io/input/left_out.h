// What a reader leaves out of what it returns, counted by kind and reported once.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"

namespace sterna::io {

class LeftOut {
 public:
  /// \param what a plural: "lines", "free-form surfaces (surf)"
  void add(std::string_view what, std::uint64_t n = 1) {
    if (n > 0) counts_[std::string(what)] += n;
  }
  bool empty() const { return counts_.empty(); }
  /// "3 curves, 12 lines"
  std::string text() const {
    std::string text;
    for (const auto& [what, n] : counts_) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + what;
    return text;
  }
  /// "FILE: left out: 3 curves, 12 lines", if anything was: a warning, or a note for what bounds nothing.
  void warn(const std::string& source, const RunContext& context) const {
    if (!empty()) context.warn(source + ": left out: " + text());
  }
  void tell(const std::string& source, const RunContext& context) const {
    if (!empty()) context.info(source + ": left out: " + text());
  }

 private:
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace sterna::io
