// Keys by content, independent of how the content was made: equal keys mean equal results. Not for security. Keys of values are in values/value_keys.h.
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

/// Collects the data of a key.
class KeyMaker final : public ByteSink {
 public:
  /// \p what names the type of object: objects of different types have different keys.
  explicit KeyMaker(std::string_view what);

  void put(const void* bytes, std::size_t n) override;
  /// Adds any value supported by archive.h.
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
  /// Adds stage, name and value (17 digits) of each option, in the order of the table.
  KeyMaker& add(const OptionTable& options);
  /// Adds only the options of these stages.
  KeyMaker& add(const OptionTable& options, std::initializer_list<std::string_view> stages);
  ContentKey key() const;

 private:
  ContentHash hash_;
};

/// Returns the key of options alone.
ContentKey key_of(const OptionTable& options);

}  // namespace sterna::scripting
