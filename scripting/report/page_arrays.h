// The arrays of a report page. They are one blob of little-endian values that the page unpacks; their offsets are in its JSON (docs/report.md).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace sterna::scripting {

/// Location of an array in the blob: {"type", "at", "n"} in the JSON.
struct ArrayLocation {
  std::string_view type;
  std::size_t at = 0;  ///< byte offset in the blob
  std::size_t n = 0;   ///< number of values
};

class PageArrays {
 public:
  /// Appends the values and returns their location.
  ArrayLocation add(std::span<const float> values);
  ArrayLocation add(std::span<const std::uint32_t> values);
  ArrayLocation add(std::span<const std::uint16_t> values);
  ArrayLocation add(std::span<const std::uint8_t> values);
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  ArrayLocation add_values(std::string_view type, std::span<const T> values);
  std::string bytes_;
};

/// Rounds to ten bits of the mantissa, which are three digits. This is sufficient for colours, and halves the bytes after compression.
float shortened(double value);

/// Returns the whole page: the template with JSON and arrays filled in.
/// \throws Error(unsupported_format) in a build without the page
std::string page_text(const std::string& json, const PageArrays& arrays);

}  // namespace sterna::scripting
