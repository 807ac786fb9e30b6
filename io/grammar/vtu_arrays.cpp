#include "io/grammar/vtu_arrays.h"

#include <lz4.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>

#include "geom/base/parallel.h"

namespace sterna::io {
namespace {

using Type = VtuValues::Type;

constexpr std::array<std::pair<std::string_view, Type>, 10> k_types = {{{"Int8", Type::int8},
                                                                        {"Int16", Type::int16},
                                                                        {"Int32", Type::int32},
                                                                        {"Int64", Type::int64},
                                                                        {"UInt8", Type::uint8},
                                                                        {"UInt16", Type::uint16},
                                                                        {"UInt32", Type::uint32},
                                                                        {"UInt64", Type::uint64},
                                                                        {"Float32", Type::float32},
                                                                        {"Float64", Type::float64}}};

/// Deflate expands a byte to at most 1032 bytes, LZ4 to 255. A block that claims more is damaged, and no memory is reserved for it.
constexpr std::uint64_t k_max_zlib_expansion = 1032;
constexpr std::uint64_t k_array_expansion_floor = 4096;

std::optional<std::uint64_t> to_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

constexpr std::array<std::int8_t, 256> make_base64_table() {
  std::array<std::int8_t, 256> table{};
  for (auto& value : table) value = -1;
  constexpr std::string_view k_alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < k_alphabet.size(); ++i) table[static_cast<unsigned char>(k_alphabet[i])] = static_cast<std::int8_t>(i);
  return table;
}
constexpr std::array<std::int8_t, 256> k_base64 = make_base64_table();

/// Decodes groups of four characters. Padded groups may occur in between, because VTK encodes header and data separately. Returns nullopt if the text is not
/// base64.
std::optional<std::string> from_base64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::array<std::uint32_t, 4> group{};
  std::size_t n = 0, n_padding = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const int value = c == '=' ? 0 : k_base64[static_cast<unsigned char>(c)];
    if (value < 0 || (c != '=' && n_padding > 0)) return std::nullopt;
    n_padding += c == '=' ? 1 : 0;
    group[n++] = static_cast<std::uint32_t>(value);
    if (n < 4) continue;
    if (n_padding > 2) return std::nullopt;
    const std::uint32_t bits = group[0] << 18 | group[1] << 12 | group[2] << 6 | group[3];
    for (std::size_t k = 0; k < 3 - n_padding; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k) & 0xff);
    n = n_padding = 0;
  }
  if (n != 0) return std::nullopt;
  return bytes;
}

template <class T>
bool append_ascii(std::string_view text, std::vector<char>& bytes) {
  const auto is_space = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    at = std::find_if_not(at, end, is_space);
    if (at == end) return true;
    T value{};
    const auto [next, failure] = std::from_chars(at, end, value);
    if (failure != std::errc{} || (next != end && !is_space(*next))) return false;
    at = next;
    const std::size_t location = bytes.size();
    bytes.resize(location + sizeof(T));
    std::memcpy(bytes.data() + location, &value, sizeof(T));
  }
}

/// Unpacks a block of exactly n bytes.
bool unpack(std::string_view packed, bool is_lz4, char* to, std::size_t n) {
  constexpr std::size_t k_most = std::numeric_limits<int>::max();  // limit of LZ4
  if (is_lz4)
    return packed.size() <= k_most && n <= k_most &&
           LZ4_decompress_safe(packed.data(), to, static_cast<int>(packed.size()), static_cast<int>(n)) == static_cast<int>(n);
  uLongf n_found = static_cast<uLongf>(n);
  return uncompress(reinterpret_cast<Bytef*>(to), &n_found, reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size())) == Z_OK &&
         n_found == n;
}

/// A compressed block and the destination of its bytes.
struct Block {
  std::string_view packed;
  std::size_t location = 0;
  std::size_t size = 0;
};

}  // namespace

std::size_t VtuValues::size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8: return 1;
    case Type::int16:
    case Type::uint16: return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32: return 4;
    case Type::int64:
    case Type::uint64:
    case Type::float64: return 8;
  }
  return 1;
}

VtuDecoder::VtuDecoder(Borrowed<const FileBuffer> buffer, const std::vector<XmlTag>& tags, const RunContext& context) : buffer_(buffer), context_(context) {
  for (const XmlTag& tag : tags) {
    if (tag.name == "VTKFile") {
      const std::string_view compressor = tag.attribute("compressor");
      if (compressor == "vtkZLibDataCompressor") packing_ = Packing::zlib;
      else if (compressor == "vtkLZ4DataCompressor") packing_ = Packing::lz4;
      else if (!compressor.empty())
        throw_unsupported(buffer->source, "the arrays are compressed with " + std::string(compressor), "write the file with LZ4, zlib or without compression");
      if (tag.attribute("byte_order", "LittleEndian") != "LittleEndian")
        throw_unsupported(buffer->source, "the byte order is " + std::string(tag.attribute("byte_order")), "write the file as LittleEndian");
      word_size_ = tag.attribute("header_type", "UInt32") == "UInt64" ? 8 : 4;
    } else if (tag.name == "DataArray" && tag.attribute("format") == "appended") {
      if (const auto offset = to_number(tag.attribute("offset"))) offsets_.push_back(*offset);
    } else if (tag.name == "AppendedData") {
      appended_is_base64_ = tag.attribute("encoding") == "base64";
      const std::size_t mark = tag.text.find('_');
      if (mark == std::string_view::npos) fail(tag, "found no \"_\" before the appended data");
      appended_ = tag.text.substr(mark + 1);
      if (appended_is_base64_) appended_ = appended_.substr(0, appended_.find('<'));
    }
  }
  std::sort(offsets_.begin(), offsets_.end());
}

VtuValues VtuDecoder::decode(const XmlTag& tag) const {
  const auto found = std::find_if(k_types.begin(), k_types.end(), [&](const auto& entry) { return entry.first == tag.attribute("type"); });
  if (found == k_types.end())
    throw_unsupported(buffer_.source, "array " + quoted_excerpt(tag.attribute("Name")) + " has the type " + quoted_excerpt(tag.attribute("type")));
  const Type type = found->second;
  const std::string_view format = tag.attribute("format", "ascii");
  if (format == "ascii") {
    std::vector<char> bytes;
    const bool is_real = type == Type::float32 || type == Type::float64;
    if (!(is_real ? append_ascii<double>(tag.text, bytes) : append_ascii<std::int64_t>(tag.text, bytes)))
      fail(tag, "found text that is not a number of its type");
    return {is_real ? Type::float64 : Type::int64, std::move(bytes)};
  }
  std::string decoded;
  std::string_view encoded;
  if (format == "appended") encoded = appended_part(tag);
  else if (format == "binary") encoded = tag.text;
  else throw_unsupported(buffer_.source, "an array has the format " + quoted_excerpt(format));
  if (format == "binary" || appended_is_base64_) {
    auto bytes = from_base64(encoded);
    if (!bytes) fail(tag, "found text that is not base64");
    decoded = std::move(*bytes);
    encoded = decoded;
  }
  std::vector<char> bytes = decode_blocks(encoded, tag);
  if (bytes.size() % VtuValues::size_of(type) != 0) fail(tag, "its " + std::to_string(bytes.size()) + " bytes are not a whole number of values");
  return {type, std::move(bytes)};
}

std::string_view VtuDecoder::appended_part(const XmlTag& tag) const {
  const auto offset = to_number(tag.attribute("offset"));
  if (!offset || *offset > appended_.size())
    fail(tag, "the offset " + quoted_excerpt(tag.attribute("offset")) + " is not in the " + std::to_string(appended_.size()) + " bytes of appended data");
  const auto next = std::upper_bound(offsets_.begin(), offsets_.end(), *offset);
  const std::uint64_t end = next == offsets_.end() ? appended_.size() : std::min<std::uint64_t>(*next, appended_.size());
  return appended_.substr(*offset, end - *offset);
}

std::uint64_t VtuDecoder::header_word(std::string_view bytes, std::uint64_t i, const XmlTag& tag) const {
  if (i >= bytes.size() / word_size_) fail(tag, "found " + std::to_string(bytes.size()) + " bytes, too few for its header");
  std::uint64_t value = 0;  // little endian: a shorter word fills the low bytes
  std::memcpy(&value, bytes.data() + i * word_size_, word_size_);
  return value;
}

std::vector<char> VtuDecoder::decode_blocks(std::string_view encoded, const XmlTag& tag) const {
  if (packing_ == Packing::none) {
    const std::uint64_t n = header_word(encoded, 0, tag);
    if (n > encoded.size() - word_size_) fail(tag, "found " + std::to_string(encoded.size() - word_size_) + " bytes, expected " + std::to_string(n));
    return {encoded.begin() + static_cast<std::ptrdiff_t>(word_size_), encoded.begin() + static_cast<std::ptrdiff_t>(word_size_ + n)};
  }
  const std::uint64_t n_blocks = header_word(encoded, 0, tag);
  if (n_blocks == 0) return {};
  const std::uint64_t block_size = header_word(encoded, 1, tag);
  const std::uint64_t last_size = header_word(encoded, 2, tag) == 0 ? block_size : header_word(encoded, 2, tag);
  if (n_blocks > encoded.size() / word_size_)
    fail(tag, "found " + std::to_string(encoded.size()) + " bytes, too few for " + std::to_string(n_blocks) + " blocks");
  std::vector<Block> blocks;
  std::uint64_t at = (3 + n_blocks) * word_size_;
  std::size_t location = 0;
  for (std::uint64_t i = 0; i < n_blocks; ++i) {
    const std::uint64_t packed = header_word(encoded, 3 + i, tag);
    const std::uint64_t size = i + 1 == n_blocks ? last_size : block_size;
    if (at > encoded.size() || packed > encoded.size() - at) fail(tag, "block " + std::to_string(i) + " reaches beyond the end of the data");
    if (size > k_array_expansion_floor + k_max_zlib_expansion * packed)
      fail(tag, "block " + std::to_string(i) + " claims to unpack to " + std::to_string(size) + " bytes");
    blocks.push_back({.packed = encoded.substr(at, packed), .location = location, .size = size});
    at += packed;
    location += size;
  }
  std::vector<char> bytes(location);
  parallel_for(
      context_, blocks.size(),
      [&](std::size_t i) {
        const Block& block = blocks[i];
        if (!unpack(block.packed, packing_ == Packing::lz4, bytes.data() + block.location, block.size)) fail(tag, "block " + std::to_string(i) + " is damaged");
      },
      1);
  return bytes;
}

void VtuDecoder::fail(const XmlTag& tag, const std::string& problem) const {
  throw_malformed(buffer_.source, "byte " + std::to_string(tag.offset), tag.name + " " + quoted_excerpt(tag.attribute("Name")) + ": " + problem);
}

}  // namespace sterna::io
