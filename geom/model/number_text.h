// Numbers in messages: six significant digits, however small.
#pragma once

#include <charconv>
#include <string>

namespace sterna {

inline std::string number_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr;
  return std::string(text, end);
}

}  // namespace sterna
