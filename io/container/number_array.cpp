#include "io/container/number_array.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "io/input/file_buffer.h"

namespace sterna::io {
namespace {

template <class T>
T number_at(const NumberArray& array, std::uint64_t i) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), array.bytes.data() + i * sizeof(T), sizeof(T));
  if (array.order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

std::string_view name_of(NumberKind kind) {
  constexpr std::array<std::string_view, 11> k_names = {"8-bit integers",
                                                        "8-bit unsigned integers",
                                                        "16-bit integers",
                                                        "16-bit unsigned integers",
                                                        "32-bit integers",
                                                        "32-bit unsigned integers",
                                                        "64-bit integers",
                                                        "64-bit unsigned integers",
                                                        "32-bit reals",
                                                        "64-bit reals",
                                                        "text"};
  return k_names[static_cast<std::size_t>(kind)];
}

}  // namespace

std::uint64_t count_of(const std::vector<std::uint64_t>& extents, const std::string& source, const std::string& where) {
  std::uint64_t n = 1;
  for (const std::uint64_t extent : extents)
    if (__builtin_mul_overflow(n, extent, &n)) throw_malformed(source, where, "the number of values does not fit 64 bits");
  return n;
}

std::int64_t NumberArray::integer(std::uint64_t i) const {
  switch (kind) {
    case NumberKind::i1: return number_at<std::int8_t>(*this, i);
    case NumberKind::u1: return number_at<std::uint8_t>(*this, i);
    case NumberKind::i2: return number_at<std::int16_t>(*this, i);
    case NumberKind::u2: return number_at<std::uint16_t>(*this, i);
    case NumberKind::i4: return number_at<std::int32_t>(*this, i);
    case NumberKind::u4: return number_at<std::uint32_t>(*this, i);
    case NumberKind::i8: return number_at<std::int64_t>(*this, i);
    case NumberKind::u8: return static_cast<std::int64_t>(number_at<std::uint64_t>(*this, i));
    default: fail("found " + std::string(name_of(kind)) + ", expected integers");
  }
}

double NumberArray::real(std::uint64_t i) const {
  if (kind == NumberKind::f8) return number_at<double>(*this, i);
  if (kind == NumberKind::f4) return number_at<float>(*this, i);
  return static_cast<double>(integer(i));
}

std::string NumberArray::text() const {
  std::string_view text = bytes.substr(0, bytes.find('\0'));
  while (text.ends_with(' ')) text.remove_suffix(1);
  return std::string(text);
}

void NumberArray::require_integers(std::uint64_t n, std::string_view what) const {
  if (!is_integer(kind)) fail("found " + std::string(name_of(kind)) + ", expected integers: " + std::string(what));
  if (count() != n) fail("found " + std::to_string(count()) + " numbers, expected " + std::to_string(n) + ": " + std::string(what));
}

void NumberArray::require_reals(std::uint64_t n, std::string_view what) const {
  if (!is_real(kind)) fail("found " + std::string(name_of(kind)) + ", expected reals: " + std::string(what));
  if (count() != n) fail("found " + std::to_string(count()) + " numbers, expected " + std::to_string(n) + ": " + std::string(what));
}

void NumberArray::fail(std::string_view problem) const { throw_malformed(source, where, problem); }

}  // namespace sterna::io
