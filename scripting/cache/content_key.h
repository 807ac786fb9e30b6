// Keys of what things hold, never of how they came about: equal keys, equal results. Not for security. Those of values are in values/value_keys.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "geom/base/hash.h"
#include "geom/base/schema.h"
#include "scripting/cache/archive.h"
#include "scripting/cache/provenance.h"

namespace sterna::scripting {

/// Collects what a key is made of.
class KeyMaker final : public ByteSink {
 public:
  /// \p what names the kind of thing: things of different kinds have different keys.
  explicit KeyMaker(std::string_view what);

  void put(const void* bytes, std::size_t n) override;
  /// Anything of archive.h.
  template <class T>
  KeyMaker& add(const T& value) {
    write_value(*this, value);
    return *this;
  }
  KeyMaker& add(const ContentKey& key) {
    put(key.bytes.data(), key.bytes.size());
    return *this;
  }
  KeyMaker& add(std::string_view text);
  KeyMaker& add(const char* text) { return add(std::string_view(text)); }
  /// Stage, name and value (17 digits) of each option; in the table's order.
  KeyMaker& add(const OptionTable& options);
  /// Only those of these stages.
  KeyMaker& add(const OptionTable& options, std::initializer_list<std::string_view> stages);
  ContentKey key() const;

 private:
  ContentHash hash_;
};

/// Of options alone.
ContentKey key_of(const OptionTable& options);

}  // namespace sterna::scripting
