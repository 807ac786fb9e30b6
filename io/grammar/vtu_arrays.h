// Values of the DataArrays of a VTU file, in any encoding (docs/method/formats.md, "VTU and VTP").
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "io/input/file_buffer.h"
#include "io/input/xml_tags.h"

namespace sterna::io {

/// Decoded values of one array.
class VtuValues {
 public:
  enum class Type : std::uint8_t { int8, int16, int32, int64, uint8, uint16, uint32, uint64, float32, float64 };
  VtuValues(Type type, std::vector<char> bytes) : type_(type), bytes_(std::move(bytes)) {}
  static std::size_t size_of(Type type);

  std::size_t size() const { return bytes_.size() / size_of(type_); }
  bool is_integer() const { return type_ != Type::float32 && type_ != Type::float64; }
  double real(std::size_t i) const {
    return visit<double>(i, [](auto value) { return static_cast<double>(value); });
  }
  /// Returns an id or count; negative values become huge numbers, which range checks reject.
  /// \pre is_integer()
  std::uint64_t id(std::size_t i) const {
    return visit<std::uint64_t>(i, [](auto value) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(value)); });
  }

 private:
  template <class T, class R, class F>
  R apply(std::size_t i, const F& f) const {
    T value;
    std::memcpy(&value, bytes_.data() + i * sizeof(T), sizeof(T));
    return f(value);
  }
  template <class R, class F>
  R visit(std::size_t i, const F& f) const {
    switch (type_) {
      case Type::int8: return apply<std::int8_t, R>(i, f);
      case Type::int16: return apply<std::int16_t, R>(i, f);
      case Type::int32: return apply<std::int32_t, R>(i, f);
      case Type::int64: return apply<std::int64_t, R>(i, f);
      case Type::uint8: return apply<std::uint8_t, R>(i, f);
      case Type::uint16: return apply<std::uint16_t, R>(i, f);
      case Type::uint32: return apply<std::uint32_t, R>(i, f);
      case Type::uint64: return apply<std::uint64_t, R>(i, f);
      case Type::float32: return apply<float, R>(i, f);
      case Type::float64: break;
    }
    return apply<double, R>(i, f);
  }

  Type type_;
  std::vector<char> bytes_;
};

/// Decodes the arrays of one file.
/// \throws Error file_malformed, unsupported_format.
class VtuDecoder {
 public:
  /// \param tags all tags of the file; the last is AppendedData if there is such a section.
  VtuDecoder(Borrowed<const FileBuffer> buffer, const std::vector<XmlTag>& tags, const RunContext& context);
  VtuValues decode(const XmlTag& data_array) const;

 private:
  enum class Packing { none, zlib, lz4 };
  std::vector<char> decode_blocks(std::string_view encoded, const XmlTag& tag) const;
  std::string_view appended_part(const XmlTag& tag) const;
  std::uint64_t header_word(std::string_view bytes, std::uint64_t i, const XmlTag& tag) const;
  [[noreturn]] void fail(const XmlTag& tag, const std::string& problem) const;

  const FileBuffer& buffer_;
  RunContext context_;
  Packing packing_ = Packing::none;
  std::size_t word_size_ = 4;
  std::string_view appended_;  ///< appended data after the '_'
  bool appended_is_base64_ = false;
  std::vector<std::uint64_t> offsets_;  ///< offsets of all appended arrays, ascending
};

}  // namespace sterna::io
