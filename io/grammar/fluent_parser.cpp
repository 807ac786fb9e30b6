// Sections are nested brackets: (index (header) (body)). Indices are decimal; all other integers are hexadecimal, except in sections 0, 2, 39 and 45. Strings
// may contain brackets.
#include "io/grammar/fluent_parser.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "io/input/byte_reader.h"
#include "io/mesh/surface_builder.h"
#include "io/names/patch_names.h"

namespace sterna::io {
namespace {

enum Section : std::int64_t {
  k_comment = 0,
  k_dimensions = 2,
  k_nodes = 10,
  k_cells = 12,
  k_faces = 13,
  k_old_zone = 39,
  k_zone = 45,
  k_cell_tree = 58,
  k_face_tree = 59,
  k_interface_parents = 61
};
enum FaceZone : std::int64_t { k_interior = 2, k_wall = 3 };
constexpr std::int64_t k_single_binary = 2000;  // added to the index of a section with a binary body of single precision; 3000 for double precision
constexpr std::int64_t k_double_binary = 3000;
constexpr std::int64_t k_most_face_nodes = 64;  // nodes of a polygon; more indicates a damaged file

class FluentParser {
 public:
  FluentParser(const FileBuffer& buffer, const RunContext& context) : buffer_(buffer), text_(buffer.text()), context_(context) {}

  FluentContent parse() {
    content_.faces.first.push_back(0);
    for (skip_space(); position_ < text_.size(); skip_space()) {
      context_.check_stop();
      read_section();
    }
    finish();
    return std::move(content_);
  }

 private:
  struct Zone {
    std::int64_t type = 0;
    std::size_t first_face = 0, n_faces = 0;
    std::int64_t id = 0;
  };

  // ---- characters and numbers

  static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
  void skip_space() {
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
  }
  bool next_is(char c) {
    skip_space();
    return position_ < text_.size() && text_[position_] == c;
  }
  void expect(char c, const char* expected) {
    if (!next_is(c)) fail(std::string("found ") + found() + ", expected " + expected);
    ++position_;
  }
  std::string found() const {
    if (position_ >= text_.size()) return "the end of the file";
    std::size_t end = position_;
    while (end < text_.size() && end < position_ + 20 && !is_space(text_[end])) ++end;
    return quoted_excerpt(text_.substr(position_, end - position_));
  }
  std::int64_t integer(const char* expected, int base = 16) {
    skip_space();
    std::int64_t value = 0;
    const auto [end, failure] = std::from_chars(text_.data() + position_, text_.data() + text_.size(), value, base);
    if (failure != std::errc{}) fail("found " + found() + ", expected " + expected);
    position_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  double real(const char* expected) {
    skip_space();
    double value = 0.0;
    const char* const begin = text_.data() + position_;
    const auto [end, failure] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (failure == std::errc::result_out_of_range)
      value = std::strtod(std::string(begin, std::min<std::size_t>(64, static_cast<std::size_t>(end - begin))).c_str(), nullptr);  // an underflow becomes zero
    else if (failure != std::errc{}) fail("found " + found() + ", expected " + expected);
    if (!std::isfinite(value)) fail("found " + found() + ", expected " + std::string(expected) + " (a finite number)");
    position_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  [[noreturn]] void fail(const std::string& problem) const {
    if (bytes_) bytes_->fail(problem);
    const std::string_view before = text_.substr(0, position_);
    throw_malformed(buffer_.source, "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')), problem);
  }

  /// Moves past the bracket that closes the innermost open bracket. Brackets in strings are ignored.
  void skip_to_close() {
    int depth = 1;
    bool in_string = false;
    for (; position_ < text_.size() && depth > 0; ++position_) {
      const char c = text_[position_];
      if (c == '"') in_string = !in_string;
      if (in_string) continue;
      if (c == '(') ++depth;
      if (c == ')') --depth;
    }
    if (depth > 0) fail("found the end of the file, expected \")\"");
  }

  // ---- sections

  void read_section() {
    expect('(', "\"(\" of a section");
    const std::int64_t index = integer("the number of a section", 10);
    const bool is_double = index > k_double_binary && index < k_double_binary + 1000;
    const bool is_binary = is_double || (index > k_single_binary && index < k_single_binary + 1000);
    switch (is_double ? index - k_double_binary : is_binary ? index - k_single_binary : index) {
      case k_dimensions: read_dimensions(); break;
      case k_nodes: read_nodes(index, is_binary, is_double); return;
      case k_cells: read_cells(index, is_binary); return;
      case k_faces: read_faces(index, is_binary); return;
      case k_old_zone:
      case k_zone: read_zone_name(); break;
      case k_cell_tree:
      case k_face_tree:
      case k_interface_parents:
        throw_unsupported(buffer_.source, "the mesh has hanging nodes (section " + std::to_string(index) + ")", "save a conformal mesh");
      default:
        if (is_binary) throw_unsupported(buffer_.source, "a binary section " + std::to_string(index));
    }
    skip_to_close();
  }

  void read_dimensions() {
    const std::int64_t n = integer("the number of dimensions", 10);
    if (n != 3) throw_unsupported(buffer_.source, "the mesh has " + std::to_string(n) + " dimensions", "meshes of 3 dimensions are read");
  }

  struct Header {
    std::int64_t zone = 0, first = 0, last = 0, type = 0, element = 0;
    std::uint64_t count() const { return static_cast<std::uint64_t>(last - first + 1); }
  };
  Header read_header(const char* what) {
    Header header;
    expect('(', "\"(\" of a header");
    header.zone = integer("the number of a zone");
    header.first = integer("a first index");
    header.last = integer("a last index");
    if (!next_is(')')) header.type = integer("a type");
    if (!next_is(')')) header.element = integer("a type of elements");
    expect(')', "\")\" behind a header");
    constexpr std::int64_t k_most = NodeId::k_invalid;
    if (header.first < 0 || header.last < header.first - 1 || header.last >= k_most)
      fail("found " + std::string(what) + " " + std::to_string(header.first) + " to " + std::to_string(header.last) + ", expected ascending numbers below " +
           std::to_string(k_most));
    return header;
  }

  /// Enters the body of n items of at least the given numbers of bytes each. A binary body begins directly after its bracket.
  void begin_body(bool is_binary, std::uint64_t n, std::size_t min_text, std::size_t min_binary) {
    expect('(', "\"(\" of a body");
    const std::size_t min_bytes = is_binary ? min_binary : min_text;
    if (n > (text_.size() - position_) / min_bytes)
      fail("found " + std::to_string(n) + " items announced, more than the " + std::to_string(text_.size() - position_) + " bytes left in the file can hold");
    if (is_binary) bytes_.emplace(buffer_, std::endian::little, position_);
  }
  void end_body(std::int64_t index) {
    if (bytes_) position_ = bytes_->offset();
    const bool is_binary = bytes_.has_value();
    bytes_.reset();
    expect(')', "\")\" behind a body");
    if (!is_binary) {
      skip_to_close();
      return;
    }
    const std::string trailer = "End of Binary Section";
    skip_space();
    if (text_.substr(position_, trailer.size()) != trailer) fail("found " + found() + ", expected \"" + trailer + "\"");
    position_ += trailer.size();
    const std::int64_t ended = integer("the number of the section", 10);
    if (ended != index) fail("found the end of section " + std::to_string(ended) + ", expected that of section " + std::to_string(index));
    expect(')', "\")\" behind a section");
  }

  /// Reads a number of the body.
  std::int64_t body_integer(const char* expected) { return bytes_ ? bytes_->read<std::int32_t>(expected) : integer(expected); }

  void read_nodes(std::int64_t index, bool is_binary, bool is_double) {
    const Header header = read_header("nodes");
    if (header.zone == 0) return skip_to_close();
    if (header.first != static_cast<std::int64_t>(content_.points.size()) + 1)
      fail("found nodes from " + std::to_string(header.first) + " on, expected " + std::to_string(content_.points.size() + 1));
    begin_body(is_binary, header.count(), 6, is_double ? 24 : 12);
    content_.points.reserve(content_.points.size() + header.count());
    for (std::uint64_t i = 0; i < header.count(); ++i) {
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!bytes_) p[axis] = real("a coordinate");
        else p[axis] = is_double ? bytes_->read<double>("a coordinate") : static_cast<double>(bytes_->read<float>("a coordinate"));
      }
      if (!is_finite(p)) fail("the coordinates of node " + std::to_string(content_.points.size() + 1) + " are not finite");
      content_.points.push_back(p);
    }
    end_body(index);
  }

  /// Reads the number of cells only; their kinds follow from the faces.
  void read_cells(std::int64_t index, bool is_binary) {
    const Header header = read_header("cells");
    if (header.zone > 0) ++content_.n_cell_zones;
    n_cells_ = std::max(n_cells_, static_cast<std::uint64_t>(header.last));
    if (!is_binary || !next_is('(')) return skip_to_close();
    begin_body(true, header.count(), 1, 4);
    bytes_->skip(header.count() * 4);
    end_body(index);
  }

  void read_faces(std::int64_t index, bool is_binary) {
    const Header header = read_header("faces");
    if (header.zone == 0) return skip_to_close();
    FaceBasedMesh& faces = content_.faces;
    if (header.first != static_cast<std::int64_t>(faces.n_faces()) + 1)
      fail("found faces from " + std::to_string(header.first) + " on, expected " + std::to_string(faces.n_faces() + 1));
    if (header.element == 2) throw_unsupported(buffer_.source, "faces of two nodes", "meshes of 3 dimensions are read");
    begin_body(is_binary, header.count(), 10, 20);
    zones_.push_back({.type = header.type, .first_face = faces.n_faces(), .n_faces = header.count(), .id = header.zone});
    for (std::uint64_t i = 0; i < header.count(); ++i) {
      const bool has_size = header.element == 0 || header.element == 5;
      const std::int64_t n = has_size ? body_integer("the number of nodes of a face") : header.element;
      if (n < 3 || n > k_most_face_nodes) fail("found " + std::to_string(n) + " as the number of nodes of a face, expected 3 or 4");
      const std::size_t begin = faces.nodes.size();
      for (std::int64_t k = 0; k < n; ++k) {
        const std::int64_t node = body_integer("a node of a face");
        if (node < 1 || node >= static_cast<std::int64_t>(NodeId::k_invalid)) fail("found node " + std::to_string(node) + " of a face, expected 1 or more");
        faces.nodes.push_back(static_cast<std::uint32_t>(node - 1));
      }
      std::int64_t inner = body_integer("a cell of a face"), outer = body_integer("a cell of a face");
      if (inner == 0) std::swap(inner, outer);  // the normal points out of the other cell
      else std::reverse(faces.nodes.begin() + static_cast<std::ptrdiff_t>(begin), faces.nodes.end());
      if (inner < 1 || outer < 0 || inner >= static_cast<std::int64_t>(NodeId::k_invalid) || outer >= static_cast<std::int64_t>(NodeId::k_invalid))
        fail("found the cells " + std::to_string(inner) + " and " + std::to_string(outer) + " of a face, expected one or two above 0");
      faces.owner.push_back(static_cast<std::uint32_t>(inner - 1));
      faces.neighbour.push_back(outer == 0 ? k_none : static_cast<std::uint32_t>(outer - 1));
      faces.first.push_back(faces.nodes.size());
      if (outer == 0 && header.type == k_interior) fail("found an interior face with one cell");
    }
    end_body(index);
  }

  /// Reads (45 (zone type name)(...)), decimal.
  void read_zone_name() {
    expect('(', "\"(\" of a zone");
    const std::int64_t zone = integer("the number of a zone", 10);
    const auto word = [&] {
      skip_space();
      const std::size_t begin = position_;
      while (position_ < text_.size() && !is_space(text_[position_]) && text_[position_] != ')' && text_[position_] != '(') ++position_;
      return std::string(text_.substr(begin, position_ - begin));
    };
    word();  // the type is repeated as a word
    std::string name = word();
    if (!name.empty()) names_[zone] = std::move(name);
    skip_to_close();
  }

  void finish() {
    FaceBasedMesh& faces = content_.faces;
    if (content_.points.empty() || faces.n_faces() == 0)
      fail(std::string("found the end of the file, expected a section of ") + (content_.points.empty() ? "nodes" : "faces"));
    for (const std::uint32_t node : faces.nodes)
      if (node >= content_.points.size()) fail("a face has the node " + std::to_string(node + 1ull) + ", there are " + std::to_string(content_.points.size()));
    if (n_cells_ > faces.n_faces()) fail("found " + std::to_string(n_cells_) + " cells, too many for " + std::to_string(faces.n_faces()) + " faces");
    faces.n_cells = n_cells_;
    for (std::size_t f = 0; f < faces.n_faces(); ++f)
      if (faces.owner[f] >= n_cells_ || (faces.neighbour[f] != k_none && faces.neighbour[f] >= n_cells_))
        fail("face " + std::to_string(f + 1) + " has the cells " + std::to_string(faces.owner[f] + 1ull) + " and " + std::to_string(faces.neighbour[f] + 1ull) +
             ", there are " + std::to_string(n_cells_));
    faces.patch.resize(faces.n_faces());
    for (const Zone& zone : zones_) add_patch(zone);
  }

  void add_patch(const Zone& zone) {
    if (zone.type == k_interior || zone.n_faces == 0) return;
    FaceBasedMesh& faces = content_.faces;
    const auto named = names_.find(zone.id);
    const std::string name = named == names_.end() ? numbered_patch(zone.id) : named->second;
    const PatchId patch = find_or_add_patch(content_.patches, name);
    content_.patches[patch].kind = kind_of_fluent_zone(zone.type, name);
    for (std::size_t f = zone.first_face; f < zone.first_face + zone.n_faces; ++f) {
      if (faces.neighbour[f] == k_none) faces.patch[f] = patch;
      else ++content_.n_inner_walls;
    }
  }

  const FileBuffer& buffer_;
  std::string_view text_;
  const RunContext& context_;
  std::size_t position_ = 0;
  std::optional<ByteReader> bytes_;  ///< inside a binary body
  FluentContent content_;
  std::uint64_t n_cells_ = 0;
  std::vector<Zone> zones_;
  std::map<std::int64_t, std::string> names_;
};

}  // namespace

PatchKind kind_of_fluent_zone(std::int64_t type, std::string_view name) {
  switch (type) {
    case 3: return name.starts_with("slip") ? PatchKind::slip : PatchKind::wall;
    case 4:
    case 10:
    case 20: return PatchKind::inflow;
    case 5:
    case 36: return PatchKind::outflow;
    case 7:
    case 37: return PatchKind::symmetry;
    case 9: return PatchKind::farfield;
    default: return PatchKind::interface;
  }
}

FluentContent parse_fluent(const FileBuffer& buffer, const RunContext& context) { return FluentParser(buffer, context).parse(); }

}  // namespace sterna::io
