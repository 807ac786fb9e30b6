// Blocks of 16 values of `size` bytes are transposed in registers. The position of a byte in a block is the bit string "vvvv bb" (value, byte of the value).
// A perfect shuffle, which interleaves the two halves of the block, rotates these bits left by one. 4 shuffles give "bb vvvv", the planes; log2(size) shuffles
// give the inverse.
#include "io/container/byte_planes.h"

#include <array>
#include <cstring>

namespace sterna::io {
namespace {

constexpr std::size_t k_block = 16;  // number of values
using Register = char __attribute__((vector_size(k_block)));

/// Shuffles a block of `Size` registers.
template <std::size_t Size>
void shuffle(std::array<Register, Size>& block) {
  std::array<Register, Size> result;
  for (std::size_t i = 0; i < Size / 2; ++i) {
    result[2 * i] = __builtin_shufflevector(block[i], block[i + Size / 2], 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    result[2 * i + 1] = __builtin_shufflevector(block[i], block[i + Size / 2], 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
  }
  block = result;
}

template <std::size_t Size>
void gather_blocks(const char* values, std::size_t n, char* planes) {
  for (std::size_t i = 0; i + k_block <= n; i += k_block) {
    std::array<Register, Size> block;
    std::memcpy(block.data(), values + i * Size, sizeof block);
    for (int turn = 0; turn < 4; ++turn) shuffle(block);
    for (std::size_t k = 0; k < Size; ++k) std::memcpy(planes + k * n + i, &block[k], k_block);
  }
}

template <std::size_t Size>
void scatter_blocks(const char* planes, std::size_t n, char* values) {
  for (std::size_t i = 0; i + k_block <= n; i += k_block) {
    std::array<Register, Size> block;
    for (std::size_t k = 0; k < Size; ++k) std::memcpy(&block[k], planes + k * n + i, k_block);
    for (std::size_t size = Size; size > 1; size /= 2) shuffle(block);
    std::memcpy(values + i * Size, block.data(), sizeof block);
  }
}

/// Returns the number of values processed in whole blocks.
std::size_t n_in_blocks(std::size_t n, std::size_t size) { return size == 4 || size == 8 ? n - n % k_block : 0; }

}  // namespace

void gather_planes(const char* values, std::size_t n, std::size_t size, char* planes) {
  if (size == 8) gather_blocks<8>(values, n, planes);
  if (size == 4) gather_blocks<4>(values, n, planes);
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t i = n_in_blocks(n, size); i < n; ++i) planes[k * n + i] = values[i * size + k];
}

void scatter_planes(const char* planes, std::size_t n, std::size_t size, char* values) {
  if (size == 8) scatter_blocks<8>(planes, n, values);
  if (size == 4) scatter_blocks<4>(planes, n, values);
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t i = n_in_blocks(n, size); i < n; ++i) values[i * size + k] = planes[k * n + i];
}

}  // namespace sterna::io
