// Decoding of text from files that do not declare their encoding.
#pragma once

#include <string>
#include <string_view>

namespace sterna::cad {

bool is_utf8(std::string_view bytes);

/// Returns the text as UTF-8. Valid UTF-8 (including all ASCII) is unchanged. Otherwise the text is decoded as GBK if every byte above 127 belongs to a pair
/// that is a Chinese character or symbol of GB 2312; in names of European languages accented letters are single bytes. All other text is decoded as Latin-1.
std::string utf8_of_bytes(std::string_view bytes);

}  // namespace sterna::cad
