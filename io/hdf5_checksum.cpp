#include "io/hdf5_checksum.h"

#include <algorithm>
#include <bit>

namespace sterna::io {
namespace {

std::uint32_t word_at(std::string_view bytes, std::size_t i) {
  std::uint32_t word = 0;
  for (std::size_t k = 0; k < 4 && i + k < bytes.size(); ++k) word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) << (8 * k);
  return word;
}

/// x -= y, then mixed with y turned by n bits.
void mix(std::uint32_t& x, std::uint32_t& y, std::uint32_t z, int n) {
  x -= y;
  x ^= std::rotl(y, n);
  y += z;
}

void finish(std::uint32_t& x, std::uint32_t y, int n) {
  x ^= y;
  x -= std::rotl(y, n);
}

}  // namespace

std::uint32_t hdf5_checksum(std::string_view bytes) {
  std::uint32_t a = 0xdeadbeefu + static_cast<std::uint32_t>(bytes.size());
  std::uint32_t b = a, c = a;
  if (bytes.empty()) return c;
  std::size_t i = 0;
  for (; bytes.size() - i > 12; i += 12) {
    a += word_at(bytes, i);
    b += word_at(bytes, i + 4);
    c += word_at(bytes, i + 8);
    mix(a, c, b, 4);
    mix(b, a, c, 6);
    mix(c, b, a, 8);
    mix(a, c, b, 16);
    mix(b, a, c, 19);
    mix(c, b, a, 4);
  }
  a += word_at(bytes, i);
  b += word_at(bytes, i + 4);
  c += word_at(bytes, i + 8);
  finish(c, b, 14);
  finish(a, c, 11);
  finish(b, a, 25);
  finish(c, b, 16);
  finish(a, c, 4);
  finish(b, a, 14);
  finish(c, b, 24);
  return c;
}

}  // namespace sterna::io
