#include "io/input/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "geom/base/error.h"

namespace sterna::io {

std::string gzip(std::string_view bytes) {
  constexpr int k_gzip_window = 15 + 16, k_memory = 8;
  constexpr std::size_t k_piece = std::size_t{1} << 20;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, k_gzip_window, k_memory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error({.code = ErrorCode::internal, .attempted = "packing bytes", .problem = "zlib could not be started"});
  std::string packed;
  std::string piece(k_piece, '\0');
  do {
    const std::string_view next = bytes.substr(0, k_piece);
    bytes.remove_prefix(next.size());
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(next.data()));
    stream.avail_in = static_cast<uInt>(next.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream.avail_out = static_cast<uInt>(piece.size());
      deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
      packed.append(piece.data(), piece.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (!bytes.empty());
  deflateEnd(&stream);
  return packed;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view k_letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? k_letters[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

}  // namespace sterna::io
