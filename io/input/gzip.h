// Compression with zlib, for data embedded in other files.
#pragma once

#include <string>
#include <string_view>

namespace sterna::io {

/// Returns a gzip stream without name and time, so that the output is reproducible.
/// \throws Error(internal) if zlib has no memory
std::string gzip(std::string_view bytes);
/// Returns base64 (RFC 4648) with padding, on one line.
std::string base64(std::string_view bytes);

}  // namespace sterna::io
