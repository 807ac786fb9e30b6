// Medit readers. Sections come in any order, and elements may precede the vertices, so node numbers are checked at the end.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "geom/base/error.h"
#include "io/input/byte_reader.h"
#include "io/input/left_out.h"
#include "io/input/text_scanner.h"
#include "io/mesh/orientation.h"
#include "io/mesh/surface_boundary.h"
#include "io/mesh/surface_builder.h"
#include "io/names/names_file.h"
#include "io/volume/medit.h"

namespace sterna::io {
namespace {

constexpr std::int32_t k_cookie = 1;
constexpr std::int32_t k_swapped_cookie = 0x01000000;
/// Codes of higher-order triangles, quads, tetrahedra and hexahedra, which must not be lost without an error.
constexpr std::array<std::int32_t, 4> k_curved_codes = {24, 27, 30, 33};

/// An element as its node numbers in the file, less 1.
template <std::size_t N>
struct Row {
  std::array<NodeId, N> nodes;
  std::int64_t reference = 0;
};

/// Start of the rows of a section: row `first_row`, counted over all sections of its kind, is at byte `offset`.
struct SectionStart {
  std::size_t first_row = 0, offset = 0;
};

/// The elements of one kind, possibly from several sections.
template <std::size_t N>
struct Table {
  std::vector<Row<N>> rows;
  std::vector<SectionStart> starts;
};

/// Contents of a file in any of its forms.
class MeditReader {
 public:
  MeditReader(const FileBuffer& buffer, bool with_cells, const RunContext& context)
      : buffer_(buffer), scanner_(buffer, {.comment = '#'}), with_cells_(with_cells), context_(context) {}

  void read() {
    const std::string_view text = buffer_.text();
    const bool is_binary = text.size() >= 8 && (text.substr(0, 4) == std::string_view("\1\0\0\0", 4) || text.substr(0, 4) == std::string_view("\0\0\0\1", 4));
    is_binary ? read_binary() : read_text();
    if (!has_vertices_)
      throw_malformed(buffer_.source, is_binary ? "byte " + std::to_string(text.size()) : "line " + std::to_string(scanner_.line()), "found no Vertices");
    left_out_.report(buffer_.source, context_);
    if (regions_.size() > 1)
      context_.warn(buffer_.source + ": the cells have " + std::to_string(regions_.size()) +
                    " references (regions), which are left out: the cells become one region");
    check_nodes(triangles_, "triangle");
    check_nodes(quads_, "quadrilateral");
    check_nodes(tetrahedra_, "tetrahedron");
    check_nodes(prisms_, "prism");
    check_nodes(pyramids_, "pyramid");
    check_nodes(hexahedra_, "hexahedron");
  }

  std::uint64_t n_cells() const { return n_cells_; }  ///< in the file; \pre read()

  HybridMesh mesh(const std::map<std::int64_t, Patch>& names) {
    HybridMesh mesh;
    mesh.points.raw() = std::move(points_);
    std::map<std::int64_t, PatchId> patches;
    const auto patch_of = [&](std::int64_t reference) {
      const auto [entry, is_new] = patches.try_emplace(reference);
      if (is_new) {
        const auto named = names.find(reference);
        entry->second = mesh.patches.push_back(named != names.end() ? named->second : Patch{numbered_patch(reference), PatchKind::wall});
      }
      return entry->second;
    };
    for (const auto& row : triangles_.rows) mesh.boundary_triangles.push_back({row.nodes, patch_of(row.reference)});
    for (const auto& row : quads_.rows) mesh.boundary_quads.push_back({row.nodes, patch_of(row.reference)});
    const auto take = [](const auto& table, auto& cells) {
      cells.reserve(table.rows.size());
      for (const auto& row : table.rows) cells.push_back(row.nodes);
    };
    take(tetrahedra_, mesh.tetrahedra);
    take(prisms_, mesh.prisms);
    take(pyramids_, mesh.pyramids);
    take(hexahedra_, mesh.hexahedra);
    return mesh;
  }

 private:
  // ---- the two forms

  void read_text() {
    scanner_.keyword("MeshVersionFormatted");
    const std::int64_t version = scanner_.integer("a version from 1 to 4");
    if (version < 1 || version > 4) scanner_.fail_expected("a version from 1 to 4");
    bool has_ended = false;
    while (!has_ended && !scanner_.at_end()) {
      context_.check_stop();
      const std::string keyword(scanner_.token("a keyword such as Vertices"));
      if (keyword.empty() || !is_letter(keyword[0])) scanner_.fail_expected("a keyword such as Vertices");
      if (keyword == "End") has_ended = true;
      else if (keyword == "Dimension") require_three(scanner_.integer("3 dimensions"));
      else if (keyword.ends_with("P2") || keyword.ends_with("Q2") || keyword.ends_with("P3") || keyword.ends_with("Q3")) throw_curved(keyword);
      else if (!read_section([&](const MeditSection& section) { return section.keyword == keyword; })) skip_text(keyword);
    }
    if (!has_ended) scanner_.fail("found the end of the file, expected End or a section", "the file may have been cut short: copy or write it again");
  }

  void read_binary() {
    bytes_.emplace(buffer_);
    const auto cookie = bytes_->read<std::int32_t>("the number 1");
    if (cookie == k_swapped_cookie) bytes_.emplace(buffer_, std::endian::big, sizeof(std::int32_t));
    else if (cookie != k_cookie) bytes_->fail("found " + std::to_string(cookie) + " before this byte, expected 1");
    version_ = bytes_->read<std::int32_t>("the version");
    if (version_ < 1 || version_ > 4) bytes_->fail("found version " + std::to_string(version_) + ", expected 1 to 4");
    for (;;) {
      context_.check_stop();
      const auto code = bytes_->read<std::int32_t>("the code of a section");
      const std::uint64_t next =
          version_ >= 3 ? bytes_->read<std::uint64_t>("the offset of the next section") : bytes_->read<std::uint32_t>("the offset of the next section");
      if (code == k_medit_end) return;
      if (next != 0 && (next < bytes_->offset() || next > buffer_.bytes.size()))
        bytes_->fail("found " + std::to_string(next) + " as the offset of the next section, expected " + std::to_string(bytes_->offset()) + " to " +
                         std::to_string(buffer_.bytes.size()),
                     "the file may have been cut short: copy or write it again");
      if (code == k_medit_dimension) require_three(bytes_->read<std::int32_t>("3 dimensions"));
      else if (std::find(k_curved_codes.begin(), k_curved_codes.end(), code) != k_curved_codes.end()) throw_curved("code " + std::to_string(code));
      else if (!read_section([&](const MeditSection& section) { return section.code == code; })) left_out_.add("sections of code " + std::to_string(code));
      if (next == 0) return;
      if (bytes_->offset() > next) bytes_->fail("a section ends here, expected at byte " + std::to_string(next));
      bytes_->skip(next - bytes_->offset());
    }
  }

  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

  /// Skips numbers to the next keyword.
  void skip_text(const std::string& keyword) {
    left_out_.add("sections \"" + keyword + "\"");
    for (std::string_view word = scanner_.peek(); !word.empty() && !is_letter(word[0]); word = scanner_.peek()) scanner_.skip_token("a number");
  }

  /// Reads a section. \returns true if the section is known
  template <class Is>
  bool read_section(const Is& is) {
    if (is(k_medit_vertices)) read_vertices();
    else if (is(k_medit_triangles)) read_rows(triangles_, true);
    else if (is(k_medit_quads)) read_rows(quads_, true);
    else if (is(k_medit_tetrahedra)) n_cells_ += read_rows(tetrahedra_, with_cells_, true);
    else if (is(k_medit_prisms)) n_cells_ += read_rows(prisms_, with_cells_);
    else if (is(k_medit_pyramids)) n_cells_ += read_rows(pyramids_, with_cells_);
    else if (is(k_medit_hexahedra)) n_cells_ += read_rows(hexahedra_, with_cells_);
    else return false;
    return true;
  }

  // ---- numbers of either form

  std::size_t integer_bytes() const { return version_ >= 4 ? 8 : 4; }
  std::size_t real_bytes() const { return version_ == 1 ? 4 : 8; }
  std::int64_t integer(std::string_view expected) {
    if (!bytes_) return scanner_.integer(expected);
    return version_ >= 4 ? bytes_->read<std::int64_t>(expected) : bytes_->read<std::int32_t>(expected);
  }
  double real(std::string_view expected) {
    if (!bytes_) return scanner_.real(expected);
    const double value = version_ == 1 ? static_cast<double>(bytes_->read<float>(expected)) : bytes_->read<double>(expected);
    if (!std::isfinite(value)) fail("found a number that is not finite, expected " + std::string(expected));
    return value;
  }
  /// Reads a coordinate. For surfaces it may be nan or infinite: such triangles are left out later.
  double coordinate(std::string_view expected) {
    if (with_cells_) return real(expected);
    if (!bytes_) return scanner_.coordinate(expected);
    return version_ == 1 ? static_cast<double>(bytes_->read<float>(expected)) : bytes_->read<double>(expected);
  }
  /// Reads a number of rows with the given numbers of reals and integers.
  std::size_t count(std::size_t n_reals, std::size_t n_integers) {
    if (!bytes_) return scanner_.count("the number of entries", 2 * (n_reals + n_integers));
    const std::int64_t n = integer("the number of entries");
    if (n < 0) fail("found " + std::to_string(n) + " as the number of entries");
    bytes_->require(static_cast<std::uint64_t>(n), n_reals * real_bytes() + n_integers * integer_bytes(), "entries of a section");
    return static_cast<std::size_t>(n);
  }
  [[noreturn]] void fail(const std::string& problem) const {
    if (bytes_) bytes_->fail(problem);
    scanner_.fail(problem);
  }
  void require_three(std::int64_t dimension) const {
    if (dimension != 3) throw_unsupported(buffer_.source, "the mesh has " + std::to_string(dimension) + " dimensions", "meshes of 3 dimensions are read");
  }
  [[noreturn]] void throw_curved(const std::string& what) const {
    throw_unsupported(buffer_.source, "elements of higher order (" + what + ")", "save linear elements");
  }

  void read_vertices() {
    const std::size_t n = count(3, 1);
    if (points_.size() + n >= NodeId::k_invalid) throw_id_overflow(points_.size() + n);
    points_.reserve(points_.size() + n);
    for (std::size_t i = 0; i < n; ++i) {
      Point p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = coordinate("a coordinate");
      integer("the reference of a vertex");
      points_.push_back(p);
    }
    has_vertices_ = true;
  }

  /// Reads the elements. \returns their number
  template <std::size_t N>
  std::size_t read_rows(Table<N>& table, bool is_needed, bool is_cells = false) {
    const std::size_t n = count(0, N + 1);
    if (is_needed) {
      table.rows.reserve(table.rows.size() + n);
      table.starts.push_back({table.rows.size(), bytes_ ? bytes_->offset() : scanner_.offset()});
    }
    for (std::size_t i = 0; i < n; ++i) {
      Row<N> row;
      for (NodeId& node : row.nodes) {
        const std::int64_t number = integer("a vertex of an element");
        if (number < 1 || number >= static_cast<std::int64_t>(NodeId::k_invalid))
          fail("found " + std::to_string(number) + " as a vertex of an element, expected 1 or more");
        node = NodeId(static_cast<std::uint32_t>(number - 1));
      }
      row.reference = integer("the reference of an element");
      if constexpr (N > 4) regions_.insert(row.reference);
      else if (is_cells) regions_.insert(row.reference);
      if (is_needed) table.rows.push_back(row);
    }
    return n;
  }

  template <std::size_t N>
  void check_nodes(const Table<N>& table, const char* what) {
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      for (const NodeId node : table.rows[i].nodes)
        if (node.index() >= points_.size())
          throw_malformed(buffer_.source, location_of(table, i),
                          std::string(what) + " " + std::to_string(i + 1) + " has the vertex " + std::to_string(node.value() + 1ull) + ", there are " +
                              std::to_string(points_.size()));
  }

  /// Returns the location of a row: "line 12" or "byte 80".
  template <std::size_t N>
  std::string location_of(const Table<N>& table, std::size_t i) {
    const auto after =
        std::upper_bound(table.starts.begin(), table.starts.end(), i, [](std::size_t row, const SectionStart& start) { return row < start.first_row; });
    const SectionStart& start = *(after - 1);
    const std::size_t n_before = i - start.first_row;
    if (bytes_) return "byte " + std::to_string(start.offset + n_before * (N + 1) * integer_bytes());
    scanner_.seek(start.offset);
    for (std::size_t k = 0; k < n_before * (N + 1); ++k) scanner_.skip_token("a number");
    scanner_.peek();
    return "line " + std::to_string(scanner_.line());
  }

  const FileBuffer& buffer_;
  TextScanner scanner_;
  std::optional<ByteReader> bytes_;  ///< only for binary files
  std::int32_t version_ = 2;
  bool with_cells_;
  std::uint64_t n_cells_ = 0;  ///< in the file
  const RunContext& context_;
  bool has_vertices_ = false;
  LeftOut left_out_;
  std::set<std::int64_t> regions_;  ///< references of cells
  std::vector<Point> points_;
  Table<3> triangles_;
  Table<4> quads_, tetrahedra_;
  Table<6> prisms_;
  Table<5> pyramids_;
  Table<8> hexahedra_;
};

}  // namespace

HybridMesh read_volume_medit(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  MeditReader reader(buffer, true, context);
  reader.read();
  context.progress(0.6);
  HybridMesh mesh = reader.mesh(read_names(path, context));
  orient_mesh(mesh, context);
  return mesh;
}

SurfaceSoup read_surface_medit(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  MeditReader reader(buffer, false, context);
  reader.read();
  const std::map<std::int64_t, Patch> names = read_names(path, context);
  SurfaceSoup soup = boundary_soup(FileBoundary{reader.mesh(names), reader.n_cells()}, buffer.source, context);
  soup.has_names = !names.empty() || soup.patch_names.size() > 1;
  return soup;
}

}  // namespace sterna::io
