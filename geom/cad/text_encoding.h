// Text of files that do not name their encoding.
#pragma once

#include <string>
#include <string_view>

namespace sterna::cad {

bool is_utf8(std::string_view bytes);

/// The text as UTF-8. Valid UTF-8 (so all ASCII) stays. Else GBK, where every byte above 127 belongs to a pair that is a Chinese character or sign of GB 2312;
/// in names of European languages accented letters stand alone. All else is taken as Latin-1.
std::string utf8_of_bytes(std::string_view bytes);

}  // namespace sterna::cad
