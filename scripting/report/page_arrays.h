// The arrays of a report page: one blob of little-endian values that the page unpacks, and their places in its JSON (docs/report.md).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace sterna::scripting {

/// Where an array is: {"type", "at", "n"} in the JSON.
struct ArrayPlace {
  std::string_view type;
  std::size_t at = 0;  ///< byte in the blob
  std::size_t n = 0;   ///< values
};

class PageArrays {
 public:
  /// The place of the values just added.
  ArrayPlace add(std::span<const float> values);
  ArrayPlace add(std::span<const std::uint32_t> values);
  ArrayPlace add(std::span<const std::uint16_t> values);
  ArrayPlace add(std::span<const std::uint8_t> values);
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  ArrayPlace add_values(std::string_view type, std::span<const T> values);
  std::string bytes_;
};

/// Ten bits of the mantissa, three digits: enough to colour, and half the bytes once packed.
float shortened(double value);

/// The whole page: the template with JSON and arrays filled in.
/// \throws Error(unsupported_format) in a build without the page
std::string page_text(const std::string& json, const PageArrays& arrays);

}  // namespace sterna::scripting
