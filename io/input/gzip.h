// Bytes packed by zlib, for what is embedded in other files.
#pragma once

#include <string>
#include <string_view>

namespace sterna::io {

/// A gzip stream without name and time: the same bytes each time.
/// \throws Error(internal) when zlib has no memory
std::string gzip(std::string_view bytes);
/// RFC 4648, with padding, on one line.
std::string base64(std::string_view bytes);

}  // namespace sterna::io
