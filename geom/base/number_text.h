// Numbers as text: with a given number of significant digits, however small, for messages; or exact.
#pragma once

#include <charconv>
#include <string>

namespace sterna {

inline constexpr int k_message_digits = 6;

/// \pre 1 <= digits <= 17
inline std::string number_text(double value, int digits = k_message_digits) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr;
  return std::string(text, end);
}

/// Returns the shortest text that reads back as the same value.
inline std::string exact_text(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

inline std::string in_metres(double value, int digits = k_message_digits) { return number_text(value, digits) + " m"; }

}  // namespace sterna
