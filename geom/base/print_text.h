// printf-style formatting of numbers in messages.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace sterna {

/// Returns the formatted text, at most 500 characters.
[[gnu::format(printf, 1, 2)]] inline std::string print_text(const char* format, ...) {
  char text[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace sterna
