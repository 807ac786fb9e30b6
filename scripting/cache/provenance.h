// Keys by content, and their attachment to values.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>

namespace sterna::scripting {

/// A key: 128 bits of XXH3.
struct ContentKey {
  std::array<std::uint8_t, 16> bytes{};
  std::string hex() const;  ///< 32 digits
  friend auto operator<=>(const ContentKey&, const ContentKey&) = default;
};

/// A key that copies of the holder do not inherit, because a copy may be changed. Moving keeps the key.
class Provenance {
 public:
  Provenance() = default;
  Provenance(const Provenance&) noexcept {}
  Provenance(Provenance&& other) noexcept = default;
  Provenance& operator=(const Provenance&) noexcept {
    key_.reset();
    return *this;
  }
  Provenance& operator=(Provenance&& other) noexcept = default;
  Provenance& operator=(const ContentKey& key) {
    key_ = key;
    return *this;
  }
  /// Returns nothing if the inputs of the value are unknown; results made from such a value cannot be cached.
  const std::optional<ContentKey>& key() const { return key_; }

 private:
  std::optional<ContentKey> key_;
};

}  // namespace sterna::scripting
