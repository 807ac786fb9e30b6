// A file has three lines, then keywords in any order. Each keyword announces numbers, as text or as big-endian bytes after the keyword's line. The text scanner
// controls the parsing; a byte reader is used inside a binary block. Attributes other than patch numbers are skipped by their size.
#include "io/grammar/vtk_legacy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <optional>

#include "io/input/byte_reader.h"
#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"

namespace sterna::io {
namespace {

using Type = VtuValues::Type;

struct TypeName {
  std::string_view name;
  Type type;
};
/// vtkIdType is written as int; long has the size of 64-bit systems.
constexpr std::array<TypeName, 19> k_legacy_types = {{{"char", Type::int8},
                                                      {"signed_char", Type::int8},
                                                      {"unsigned_char", Type::uint8},
                                                      {"short", Type::int16},
                                                      {"unsigned_short", Type::uint16},
                                                      {"int", Type::int32},
                                                      {"unsigned_int", Type::uint32},
                                                      {"long", Type::int64},
                                                      {"unsigned_long", Type::uint64},
                                                      {"vtkidtype", Type::int32},
                                                      {"vtktypeint8", Type::int8},
                                                      {"vtktypeuint8", Type::uint8},
                                                      {"vtktypeint16", Type::int16},
                                                      {"vtktypeint32", Type::int32},
                                                      {"vtktypeuint32", Type::uint32},
                                                      {"vtktypeint64", Type::int64},
                                                      {"vtktypeuint64", Type::uint64},
                                                      {"float", Type::float32},
                                                      {"double", Type::float64}}};

constexpr std::string_view k_legacy_magic = "# vtk DataFile Version";
constexpr std::size_t k_min_text_bytes = 2;  // a digit and a blank

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// Decodes "%20" and similar escapes in names.
std::string unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = [&](std::size_t at) { return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at])); };
    if (text[i] == '%' && digit(i + 1) && digit(i + 2)) {
      out += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

template <class T>
void append_value(std::vector<char>& bytes, T value) {
  const std::size_t location = bytes.size();
  bytes.resize(location + sizeof(T));
  std::memcpy(bytes.data() + location, &value, sizeof(T));
}

/// Splits a block of cells, each with its number of nodes first: "3 0 1 2 4 2 3 5 6".
VtkCells split_counted(const VtuValues& values, std::size_t n_cells, const auto& fail) {
  std::vector<char> nodes, ends;
  std::uint64_t n_nodes = 0;
  std::size_t at = 0;
  for (std::size_t cell = 0; cell < n_cells; ++cell) {
    const std::uint64_t n = at < values.size() ? values.id(at) : 0;
    if (at >= values.size() || n > values.size() - at - 1)
      fail("the nodes of cell " + std::to_string(cell) + " of " + std::to_string(n_cells) + " reach beyond the announced " + std::to_string(values.size()) +
           " numbers");
    for (std::size_t k = 1; k <= n; ++k) append_value(nodes, static_cast<std::int64_t>(values.id(at + k)));
    n_nodes += n;
    append_value(ends, static_cast<std::int64_t>(n_nodes));
    at += n + 1;
  }
  if (at != values.size())
    fail("found " + std::to_string(values.size() - at) + " numbers after the nodes of the last of " + std::to_string(n_cells) + " cells");
  return {.connectivity = VtuValues(Type::int64, std::move(nodes)), .ends = VtuValues(Type::int64, std::move(ends)), .types = {}};
}

class LegacyParser {
 public:
  LegacyParser(const FileBuffer& buffer, const RunContext& context) : buffer_(buffer), scanner_(buffer), context_(context) { grid_.source = buffer.source; }

  VtkGrid parse() {
    parse_head();
    while (!scanner_.at_end()) {
      section_offset_ = scanner_.offset();
      take_section(lower_case(scanner_.token("a keyword such as POINTS")));
    }
    if (!has_points_ && !is_empty()) scanner_.fail("found the end of the file, expected POINTS", "the file may have been cut short: copy or write it again");
    finish();
    return std::move(grid_);
  }

 private:
  // ---- structure

  void parse_head() {
    const std::string_view first = scanner_.rest_of_line();
    if (!equal_ignoring_case(first.substr(0, k_legacy_magic.size()), k_legacy_magic))
      throw_malformed(buffer_.source, "line 1",
                      "found " + quoted_excerpt(first) + ", expected \"" + std::string(k_legacy_magic) + " 3.0\" or another version up to 5.1");
    scanner_.rest_of_line();  // title
    const std::string encoding = lower_case(scanner_.token("ASCII or BINARY"));
    if (encoding != "ascii" && encoding != "binary") scanner_.fail_expected("ASCII or BINARY");
    is_binary_ = encoding == "binary";
    scanner_.keyword("DATASET");
    const std::string kind = lower_case(scanner_.token("the kind of data set"));
    if (kind != "unstructured_grid" && kind != "polydata")
      throw_unsupported(buffer_.source, "a data set " + quoted_excerpt(kind), "UNSTRUCTURED_GRID and POLYDATA are read");
    grid_.is_surface = kind == "polydata";
  }

  void take_section(const std::string& word) {
    if (word == "points") return take_points();
    if (word == "cells" && !grid_.is_surface) return take_cells(0);
    if (word == "cell_types" && !grid_.is_surface) return take_types();
    if (grid_.is_surface)
      for (std::size_t i = 0; i < k_surface_sections.size(); ++i)
        if (word == k_surface_sections[i].name) return take_cells(i);
    if (word == "metadata") return skip_metadata();
    if (word == "field") return take_field();
    if (word == "cell_data" || word == "point_data") {
      is_cell_data_ = word == "cell_data";
      is_in_attributes_ = true;
      n_tuples_ = count("the number of tuples");
      return;
    }
    if (!is_in_attributes_) scanner_.fail_expected("a keyword such as POINTS, CELLS or CELL_DATA");
    take_attribute(word);
  }

  bool is_empty() const {
    for (const auto& cells : cells_)
      if (cells && cells->size() > 0) return false;
    return true;
  }

  void finish() {
    VtkPiece piece{.where = "byte 0"};
    piece.points = std::move(points_);
    if (!grid_.is_surface && cells_[0]) {
      if (!types_) scanner_.fail("found the end of the file, expected CELL_TYPES", "the file may have been cut short: copy or write it again");
      cells_[0]->types = std::move(types_);
    }
    for (std::optional<VtkCells>& cells : cells_)
      if (cells) piece.cells.push_back(std::move(*cells));
    piece.markers = std::move(markers_);
    piece.marker_name = marker_rank_ < k_vtk_marker_names.size() ? std::string(k_vtk_marker_names[marker_rank_]) : std::string();
    grid_.pieces.push_back(std::move(piece));
  }

  // ---- geometry

  void take_points() {
    if (has_points_) fail("a second block POINTS");
    has_points_ = true;
    const std::size_t n = count("the number of points");
    const Type type = parse_type();
    const VtuValues values = read_values(type, n, 3, "coordinates", true);
    grid_.single_precision = type == Type::float32 && is_binary_;
    points_.resize(n);
    for (std::size_t i = 0; i < n; ++i) points_[i] = {values.real(3 * i), values.real(3 * i + 1), values.real(3 * i + 2)};
  }

  void take_cells(std::size_t section) {
    if (cells_[section]) fail("a second block of this kind");
    const std::size_t n = count("the number of cells");
    const std::size_t size = count("the number of values");
    cells_[section] = is_next("OFFSETS")
                          ? take_offset_cells(n, size)
                          : split_counted(read_values(Type::int32, size, 1, "nodes of cells"), n, [&](const std::string& problem) { fail(problem); });
    cells_[section]->type = grid_.is_surface ? k_surface_sections[section].type : 0;
  }

  /// Reads cells of version 5.1: first the offsets of the nodes of each cell and the end of the last cell, then the nodes.
  VtkCells take_offset_cells(std::size_t n_offsets, std::size_t n_nodes) {
    scanner_.skip_token("OFFSETS");
    const VtuValues offsets = read_values(parse_integer_type(), n_offsets, 1, "offsets");
    scanner_.keyword("CONNECTIVITY");
    VtuValues nodes = read_values(parse_integer_type(), n_nodes, 1, "nodes of cells");
    if (n_offsets > 0 && offsets.id(0) != 0) fail("found the first offset " + std::to_string(static_cast<std::int64_t>(offsets.id(0))) + ", expected 0");
    std::vector<char> ends;
    for (std::size_t i = 1; i < n_offsets; ++i) append_value(ends, static_cast<std::int64_t>(offsets.id(i)));
    return {.connectivity = std::move(nodes), .ends = VtuValues(Type::int64, std::move(ends)), .types = {}};
  }

  void take_types() {
    if (types_) fail("a second block CELL_TYPES");
    types_ = read_values(Type::int32, count("the number of cells"), 1, "cell types");
  }

  // ---- attributes

  void take_attribute(const std::string& word) {
    if (word == "lookup_table") {
      scanner_.skip_token("the name of a table");
      const std::size_t n = count("the number of colours");
      return skip_colours(n, 4);
    }
    const std::string name = unescaped(scanner_.token("the name of an attribute"));
    if (word == "color_scalars") return skip_colours(n_tuples_, count("the number of colour components"));
    std::size_t n_components = 1;
    if (word == "texture_coordinates") n_components = count("the number of texture coordinates");
    const std::optional<Type> type = parse_any_type();
    if (word == "scalars") {
      scanner_.set_line_bound(true);
      if (!scanner_.at_line_end()) n_components = count("the number of components");
      scanner_.set_line_bound(false);
      if (is_next("LOOKUP_TABLE")) {
        scanner_.skip_token("LOOKUP_TABLE");
        scanner_.skip_token("the name of a table");
      }
    } else if (word == "vectors" || word == "normals") {
      n_components = 3;
    } else if (word == "tensors") {
      n_components = 9;
    } else if (word == "tensors6") {
      n_components = 6;
    } else if (word != "texture_coordinates" && word != "global_ids" && word != "pedigree_ids" && word != "edge_flags") {
      scanner_.fail("found the attribute " + quoted_excerpt(word) + ", expected one of VTK's such as SCALARS or FIELD");
    }
    take_array(name, type, n_tuples_, n_components);
  }

  void take_field() {
    scanner_.skip_token("the name of a field");
    const std::size_t n_arrays = count("the number of arrays");
    for (std::size_t i = 0; i < n_arrays; ++i) {
      if (is_next("METADATA")) {  // metadata of the previous array
        scanner_.skip_token("METADATA");
        skip_metadata();
      }
      const std::string name = unescaped(scanner_.token("the name of an array"));
      const std::size_t n_components = count("the number of components");
      const std::size_t n_tuples = count("the number of tuples");
      take_array(name, parse_any_type(), n_tuples, n_components);
    }
  }

  /// Stores the preferred array of patch numbers and the patch names; skips other arrays. \param type empty for strings
  void take_array(const std::string& name, std::optional<Type> type, std::size_t n_tuples, std::size_t n_components) {
    if (n_components > 0 && n_tuples > buffer_.bytes.size() / n_components)
      fail("an array of " + std::to_string(n_tuples) + " times " + std::to_string(n_components) + " values is larger than the file");
    if (!type) return skip_strings(n_tuples * n_components);
    const bool is_integer = *type != Type::float32 && *type != Type::float64;
    const auto rank = static_cast<std::size_t>(std::find(k_vtk_marker_names.begin(), k_vtk_marker_names.end(), name) - k_vtk_marker_names.begin());
    if (is_in_attributes_ && is_cell_data_ && is_integer && n_components == 1 && rank < marker_rank_) {
      markers_ = read_values(*type, n_tuples, 1, "patch numbers");
      marker_rank_ = rank;
    } else if (!is_in_attributes_ && is_integer && n_components * n_tuples == 1 && name.starts_with(k_vtk_patch_prefix)) {
      grid_.add_patch(name, read_values(*type, 1, 1, "the number of a patch").id(0));
    } else {
      skip_values(*type, n_tuples * n_components);
    }
  }

  /// Skips to the next empty line.
  void skip_metadata() {
    scanner_.next_line();
    while (scanner_.remaining() > 0 && !scanner_.rest_of_line().empty()) {
    }
  }

  // ---- values

  /// Returns true if that word follows. The position is unchanged, because the next data may be bytes.
  bool is_next(std::string_view word) {
    const std::size_t location = scanner_.offset();
    const bool is_there = equal_ignoring_case(scanner_.peek(), word);
    scanner_.seek(location);
    return is_there;
  }

  std::size_t count(std::string_view expected) { return scanner_.count(expected, 0); }

  std::optional<Type> parse_any_type() {
    const std::string word = lower_case(scanner_.token("the type of values"));
    if (word == "string" || word == "utf8_string" || word == "variant" || word == "bit") {
      if (word == "bit" || word == "variant") throw_unsupported(buffer_.source, "an array of type " + word, "write the file without it");
      return std::nullopt;
    }
    for (const TypeName& known : k_legacy_types)
      if (known.name == word) return known.type;
    scanner_.fail_expected("a type such as float, double, int or vtktypeint64");
  }
  Type parse_type() {
    const std::optional<Type> type = parse_any_type();
    if (!type) scanner_.fail_expected("a type of numbers");
    return *type;
  }
  Type parse_integer_type() {
    const Type type = parse_type();
    if (type == Type::float32 || type == Type::float64) scanner_.fail_expected("a type of integers");
    return type;
  }

  ByteReader bytes_behind_line() {
    scanner_.next_line();
    return ByteReader(buffer_, std::endian::big, scanner_.offset());
  }

  VtuValues read_values(Type type, std::size_t n_items, std::size_t per_item, std::string_view what, bool is_real = false) {
    const std::size_t size = VtuValues::size_of(type);
    if (!is_binary_) {
      require(n_items, k_min_text_bytes * per_item, what);
      std::vector<char> bytes;
      bytes.reserve(n_items * per_item * sizeof(std::int64_t));
      for (std::size_t i = 0; i < n_items * per_item; ++i) {
        if (i % k_stop_interval == 0) context_.check_stop();
        is_real ? append_value(bytes, scanner_.coordinate(what)) : append_value(bytes, scanner_.integer(what));
      }
      return {is_real ? Type::float64 : Type::int64, std::move(bytes)};
    }
    ByteReader reader = bytes_behind_line();
    reader.require(n_items, per_item * size, what);
    const std::size_t n_bytes = n_items * per_item * size;
    const char* const begin = buffer_.bytes.data() + reader.offset();
    std::vector<char> bytes(begin, begin + n_bytes);
    if (std::endian::native == std::endian::little && size > 1)
      for (std::size_t i = 0; i < n_bytes; i += size)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i), bytes.begin() + static_cast<std::ptrdiff_t>(i + size));
    scanner_.seek(reader.offset() + n_bytes);
    return {type, std::move(bytes)};
  }

  void skip_values(Type type, std::size_t n) {
    if (is_binary_) {
      ByteReader reader = bytes_behind_line();
      reader.require(n, VtuValues::size_of(type), "values of an array");
      scanner_.seek(reader.offset() + n * VtuValues::size_of(type));
    } else {
      for (std::size_t i = 0; i < n; ++i) scanner_.skip_token("a value of an array");
    }
  }

  /// Skips colours: bytes in binary files, reals in text.
  void skip_colours(std::size_t n, std::size_t n_components) {
    if (n_components > 0 && n > buffer_.bytes.size() / n_components)
      fail("colours of " + std::to_string(n) + " times " + std::to_string(n_components) + " values are larger than the file");
    skip_values(Type::uint8, n * n_components);
  }

  /// Skips strings. In text there is one per line. In binary files the first two bits give the width of the length field: 3 means one byte, 2 two, 1 four, 0
  /// eight bytes.
  void skip_strings(std::size_t n) {
    if (!is_binary_) {
      scanner_.next_line();
      for (std::size_t i = 0; i < n && scanner_.remaining() > 0; ++i) scanner_.next_line();
      return;
    }
    ByteReader reader = bytes_behind_line();
    for (std::size_t i = 0; i < n; ++i) {
      constexpr std::array<std::size_t, 4> k_more_bytes = {7, 3, 1, 0};
      const std::uint8_t first = reader.read<std::uint8_t>("the length of a string");
      std::uint64_t length = first & 0x3fu;
      for (std::size_t k = 0; k < k_more_bytes[first >> 6]; ++k) length = length << 8 | reader.read<std::uint8_t>("the length of a string");
      reader.require(length, 1, "characters of a string");
      reader.skip(length);
    }
    scanner_.seek(reader.offset());
  }

  void require(std::size_t n, std::size_t min_bytes, std::string_view what) {
    if (n > (scanner_.remaining() + 1) / min_bytes)
      fail("found " + std::to_string(scanner_.remaining()) + " bytes to the end of the file, expected " + std::to_string(n) + " " + std::string(what),
           "the file may have been cut short: copy or write it again");
  }

  [[noreturn]] void fail(const std::string& problem, std::string_view hint = {}) const {
    throw_malformed(buffer_.source, "block at line " + std::to_string(scanner_.line_at(section_offset_)), problem, hint);
  }

  struct SurfaceSection {
    std::string_view name;
    int type;
  };
  /// Surface sections in the order in which CELL_DATA counts them. The order in the file may differ.
  static constexpr std::array<SurfaceSection, 4> k_surface_sections = {{{"vertices", 2}, {"lines", 4}, {"polygons", 7}, {"triangle_strips", 6}}};

  const FileBuffer& buffer_;
  TextScanner scanner_;
  const RunContext& context_;
  VtkGrid grid_;
  bool is_binary_ = false;
  bool has_points_ = false;
  std::size_t section_offset_ = 0;
  std::vector<Point> points_;
  std::array<std::optional<VtkCells>, 4> cells_;  ///< an unstructured grid uses the first entry only
  std::optional<VtuValues> types_;
  bool is_in_attributes_ = false;
  bool is_cell_data_ = false;
  std::size_t n_tuples_ = 0;
  std::optional<VtuValues> markers_;
  std::size_t marker_rank_ = k_vtk_marker_names.size();
};

}  // namespace

VtkGrid read_vtk_grid(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return LegacyParser(buffer, context).parse();
}

}  // namespace sterna::io
