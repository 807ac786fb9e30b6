// The arrays of a report page: one blob of little-endian values that the page unpacks, and their places in its JSON (docs/report.md).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace sterna::scripting {

class PageArrays {
 public:
  /// {"type", "at", "n"} of the values just added.
  nlohmann::ordered_json add(std::span<const float> values);
  nlohmann::ordered_json add(std::span<const std::uint32_t> values);
  nlohmann::ordered_json add(std::span<const std::uint16_t> values);
  nlohmann::ordered_json add(std::span<const std::uint8_t> values);
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  nlohmann::ordered_json add_values(std::string_view type, std::span<const T> values);
  std::string bytes_;
};

/// Ten bits of the mantissa, three digits: enough to colour, and half the bytes once packed.
float shortened(double value);

/// The whole page: the template with JSON and arrays filled in. \throws Error(unsupported_format) in a build without the page
std::string page_text(const nlohmann::ordered_json& json, const PageArrays& arrays);

}  // namespace sterna::scripting
