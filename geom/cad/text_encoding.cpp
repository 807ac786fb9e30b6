#include "geom/cad/text_encoding.h"

#include <iconv.h>

#include <cstddef>
#include <optional>

namespace sterna::cad {
namespace {

unsigned byte_value(char c) { return static_cast<unsigned char>(c); }

/// Tests for pairs of GB 2312 only: with all of GBK any accented letter and its successor would count as a character.
bool is_gb2312(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (byte_value(bytes[i]) < 0x80u) continue;
    if (i + 1 >= bytes.size()) return false;
    const unsigned lead = byte_value(bytes[i]), trail = byte_value(bytes[i + 1]);
    const bool is_sign = lead >= 0xa1u && lead <= 0xa9u, is_character = lead >= 0xb0u && lead <= 0xf7u;
    if ((!is_sign && !is_character) || trail < 0xa1u || trail > 0xfeu) return false;
    ++i;
  }
  return true;
}

std::optional<std::string> from_gbk(std::string_view bytes) {
  const iconv_t converter = iconv_open("UTF-8", "GBK");
  if (converter == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  std::string input(bytes), output(3 * bytes.size() + 1, '\0');
  char *from = input.data(), *to = output.data();
  std::size_t n_from = input.size(), n_to = output.size();
  const std::size_t result = iconv(converter, &from, &n_from, &to, &n_to);
  iconv_close(converter);
  if (result == static_cast<std::size_t>(-1)) return std::nullopt;
  output.resize(output.size() - n_to);
  return output;
}

std::string from_latin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const unsigned letter = byte_value(c);
    if (letter < 0x80u) {
      text += c;
    } else {
      text += static_cast<char>(0xc0u | (letter >> 6u));
      text += static_cast<char>(0x80u | (letter & 0x3fu));
    }
  }
  return text;
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const unsigned first = byte_value(bytes[i]);
    const std::size_t n = first < 0x80u                      ? 1
                          : first >= 0xc2u && first <= 0xdfu ? 2
                          : first >= 0xe0u && first <= 0xefu ? 3
                          : first >= 0xf0u && first <= 0xf4u ? 4
                                                             : 0;
    if (n == 0 || i + n > bytes.size()) return false;
    for (std::size_t k = 1; k < n; ++k)
      if ((byte_value(bytes[i + k]) & 0xc0u) != 0x80u) return false;
    if (n == 3 && ((first == 0xe0u && byte_value(bytes[i + 1]) < 0xa0u) || (first == 0xedu && byte_value(bytes[i + 1]) > 0x9fu))) return false;
    if (n == 4 && ((first == 0xf0u && byte_value(bytes[i + 1]) < 0x90u) || (first == 0xf4u && byte_value(bytes[i + 1]) > 0x8fu))) return false;
    i += n;
  }
  return true;
}

std::string utf8_of_bytes(std::string_view bytes) {
  if (is_utf8(bytes)) return std::string(bytes);
  if (is_gb2312(bytes))
    if (std::optional<std::string> text = from_gbk(bytes)) return *text;
  return from_latin1(bytes);
}

}  // namespace sterna::cad
