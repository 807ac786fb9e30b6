// SU2: blocks of lines after "KEY= n", in any order (docs/method/formats.md, "SU2 variants"). Markers are the patches. A file without markers and volume
// elements is a surface mesh whose own triangles and quads are read. Trailing values on a line are ignored.
#include "io/surface/surface_su2.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/grammar/su2_keyword.h"
#include "io/grammar/vtk_cells.h"
#include "io/input/file_buffer.h"
#include "io/input/line_blocks.h"
#include "io/mesh/surface_boundary.h"
#include "io/mesh/surface_builder.h"
#include "io/volume/volume_su2.h"

namespace sterna::io {
namespace {

struct SurfaceZone : Su2Zone {
  bool is_empty() const { return !points && !elements && markers.empty() && !n_markers && n_partition_markers == 0; }
};

class Su2SurfaceReader {
 public:
  Su2SurfaceReader(const FileBuffer& buffer, const RunContext& context)
      : source_(buffer.source), cursor_(buffer.text(), source_), builder_(source_), context_(context) {}

  SurfaceSoup read() {
    while (cursor_.find_content()) take_line();
    finish_zone();
    check_zone_count();
    bool has_names = false;
    for (const SurfaceZone& zone : zones_) {
      read_points(zone);
      for (const Su2Marker& marker : zone.markers) read_marker(marker);
      read_elements(zone);
      has_names = has_names || !zone.markers.empty();
    }
    report_left_out();
    SurfaceSoup soup = builder_.finish(context_, true);
    soup.has_names = has_names;
    soup.n_cells = n_cells_;
    return soup;
  }

 private:
  // ---- first pass: positions of the blocks

  void take_line() {
    const std::string_view line = cursor_.rest_of_line();
    const Su2Keyword keyword = split_su2_keyword(line);
    if (keyword.key.empty()) {
      if (!is_in_unknown_section_)
        cursor_.fail("found " + quoted_excerpt(line) + ", expected a keyword such as NPOIN= or MARKER_TAG=" +
                     (last_block_.empty() ? std::string() : "; " + last_block_ + " announces fewer lines than there are"));
      return cursor_.next_line();
    }
    is_in_unknown_section_ = false;
    if (keyword.key == "NPOIN") return take_block(zone_.points, keyword);
    if (keyword.key == "NELEM") return take_block(zone_.elements, keyword);
    if (keyword.key == "MARKER_TAG") return take_marker(keyword);
    if (keyword.key == "NDIME") check_dimension(keyword);
    else if (keyword.key == "NMARK") zone_.n_markers = su2_count(keyword, cursor_);
    else if (keyword.key == "NZONE") n_zones_ = su2_count(keyword, cursor_);
    else if (keyword.key == "IZONE") begin_zone();
    else is_in_unknown_section_ = true;  // free-form deformation boxes, periodic transformations, ...
    cursor_.next_line();
  }

  void check_dimension(const Su2Keyword& keyword) {
    if (keyword.value == "2") throw_unsupported(source_, "line " + std::to_string(cursor_.line()) + ": NDIME= 2 is a plane mesh, which has no surface");
    if (keyword.value != "3") cursor_.fail("found " + quoted_excerpt(keyword.value) + ", expected 3 after NDIME=");
  }

  /// Begins a zone. IZONE= precedes each zone, including the first.
  void begin_zone() {
    if (!zones_.empty() || !zone_.is_empty()) finish_zone();
    last_block_.clear();
  }

  void check_zone_count() const {
    if (n_zones_ && *n_zones_ != zones_.size())
      cursor_.fail("found " + std::to_string(zones_.size()) + " zones to the end of the file, expected " + std::to_string(*n_zones_) + " (NZONE=)",
                   zones_.size() < *n_zones_ ? "the file may have been cut short: copy or write it again" : "");
  }

  LineBlock take_lines(const Su2Keyword& keyword) {
    const std::uint64_t n = su2_count(keyword, cursor_);
    last_block_ = std::string(keyword.key) + "= in line " + std::to_string(cursor_.line());
    return cursor_.take_block(n, std::string(keyword.key) + "=");
  }

  void take_block(std::optional<LineBlock>& block, const Su2Keyword& keyword) {
    if (block) cursor_.fail("a second " + std::string(keyword.key) + "=; the first is in line " + std::to_string(block->line));
    block = take_lines(keyword);
  }

  void take_marker(const Su2Keyword& tag) {
    const std::string name = su2_marker_name(tag.value);
    cursor_.next_line();
    const Su2Keyword count = expect_keyword("MARKER_ELEMS", name);
    if (name == k_su2_partition_marker) {
      const std::uint64_t n = su2_count(count, cursor_);
      cursor_.next_line();
      expect_keyword("SEND_TO", name);
      cursor_.take_block(n, "MARKER_ELEMS=");
      ++zone_.n_partition_markers;
      return;
    }
    zone_.markers.push_back({.name = name, .faces = take_lines(count)});
  }

  Su2Keyword expect_keyword(std::string_view key, const std::string& marker) {
    const bool has_line = cursor_.find_content();
    const Su2Keyword keyword = has_line ? split_su2_keyword(cursor_.rest_of_line()) : Su2Keyword{};
    if (keyword.key != key)
      cursor_.fail("found " + (has_line ? quoted_excerpt(cursor_.rest_of_line()) : std::string("the end of the file")) + ", expected " + std::string(key) +
                   "= of marker \"" + marker + "\"");
    return keyword;
  }

  void finish_zone() {
    if (!zone_.points) cursor_.fail("the mesh ends here without NPOIN=");
    const std::uint64_t n_found = zone_.markers.size() + zone_.n_partition_markers;
    const std::uint64_t n_expected = zone_.n_markers.value_or(n_found);
    if (n_expected != n_found)
      cursor_.fail("found " + std::to_string(n_found) + " markers to the end of the mesh, expected " + std::to_string(n_expected) + " (NMARK=)",
                   n_found < n_expected ? "the file may have been cut short: copy or write it again" : "");
    if (zone_.markers.empty() && !zone_.elements) cursor_.fail("the mesh ends here without NELEM= and without markers");
    n_partition_markers_ += zone_.n_partition_markers;
    zones_.push_back(std::move(zone_));
    zone_ = {};
  }

  void report_left_out() const {
    if (zones_.size() > 1) context_.info("zones joined into one surface: " + std::to_string(zones_.size()));
    if (n_partition_markers_ > 0) context_.info("markers SEND_RECEIVE (boundaries of a partition) left out: " + std::to_string(n_partition_markers_));
    if (n_lines_ > 0) context_.warn(source_ + ": " + std::to_string(n_lines_) + " lines (type 3) in markers, which are not faces, are left out");
  }

  // ---- second pass: the numbers

  /// Calls f(cursor, number) at the beginning of every line of a block.
  template <class F>
  void for_each_line(const LineBlock& block, const F& f) {
    for (const LineChunk& chunk : block.chunks) {
      context_.check_stop();
      LineCursor cursor(chunk, source_);
      for (std::uint64_t i = 0; i < chunk.n_items; ++i) {
        cursor.find_content();
        f(cursor, chunk.first_item + i);
        cursor.next_line();
      }
    }
  }

  void read_points(const SurfaceZone& zone) {
    first_point_ = builder_.n_points();
    n_points_ = zone.points->n_items;
    builder_.reserve_points(first_point_ + n_points_);
    for_each_line(*zone.points, [&](LineCursor& cursor, std::uint64_t i) {
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = cursor.coordinate("a coordinate of node ", i);
      builder_.add_point(p);
    });
  }

  void read_face(LineCursor& cursor, std::uint64_t type, std::uint64_t item) {
    std::array<std::uint32_t, 4> corners{};
    const std::span<std::uint32_t> used = std::span(corners).first(type == k_vtk_triangle ? 3 : 4);
    for (std::uint32_t& corner : used) corner = static_cast<std::uint32_t>(first_point_) + cursor.index(n_points_, "a node of face ", item);
    builder_.add_polygon(used);
  }

  void read_marker(const Su2Marker& marker) {
    builder_.set_patch(marker.name);
    for_each_line(marker.faces, [&](LineCursor& cursor, std::uint64_t i) {
      const std::uint64_t type = cursor.integer("the type of face ", i);
      if (type == k_vtk_line) {  // an edge of an open surface, written by programs that treat a surface as a plane mesh
        ++n_lines_;
        return;
      }
      if (type != k_vtk_triangle && type != k_vtk_quad)
        cursor.fail("found element type " + std::to_string(type) + " in marker \"" + marker.name + "\", expected 5 (triangle), 9 (quadrilateral) or 3 (line)");
      read_face(cursor, type, i);
      has_marked_faces_ = true;
    });
  }

  /// Reads the elements. If markers have no faces, the surface consists of the faces among the elements; otherwise these faces are left out. The caller handles
  /// cells without faces.
  void read_elements(const SurfaceZone& zone) {
    const bool are_elements_the_surface = !std::exchange(has_marked_faces_, false);
    if (!zone.elements) return;
    std::uint64_t n_faces = 0, n_cells = 0;
    if (are_elements_the_surface) builder_.set_patch({});
    for_each_line(*zone.elements, [&](LineCursor& cursor, std::uint64_t i) {
      const std::uint64_t type = cursor.integer("the type of element ", i);
      const bool is_face = type == k_vtk_triangle || type == k_vtk_quad;
      if (!is_face && !kind_of_vtk_type(static_cast<std::int64_t>(type)))
        cursor.fail("found element type " + std::to_string(type) +
                    ", expected 5 (triangle), 9 (quadrilateral), 10 (tetrahedron), 12 (hexahedron), 13 (prism) or 14 (pyramid)");
      ++(is_face ? n_faces : n_cells);
      if (is_face && are_elements_the_surface) read_face(cursor, type, i);
    });
    if (are_elements_the_surface && n_cells > 0 && (n_faces > 0 || zones_.size() > 1))
      throw_malformed(source_, "line " + std::to_string(zone.elements->line),
                      "found a volume mesh without faces in markers, expected its boundary faces behind NMARK=");
    n_cells_ += n_cells;
    if (!are_elements_the_surface && n_faces > 0)
      context_.warn(source_ + ": " + std::to_string(n_faces) + " faces among the elements belong to no marker and are left out");
  }

  std::string source_;
  LineCursor cursor_;
  SurfaceBuilder builder_;
  const RunContext& context_;
  std::optional<std::uint64_t> n_zones_;  ///< announced in the file
  std::vector<SurfaceZone> zones_;
  SurfaceZone zone_;             ///< currently indexed
  std::size_t first_point_ = 0;  ///< first point of the current zone
  std::uint64_t n_points_ = 0;
  bool has_marked_faces_ = false;  ///< in the current zone
  std::uint64_t n_lines_ = 0, n_partition_markers_ = 0, n_cells_ = 0;
  std::string last_block_;
  bool is_in_unknown_section_ = false;
};

}  // namespace

SurfaceSoup read_su2(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return Su2SurfaceReader(buffer, context).read();
}

void write_su2(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_su2(as_boundary(mesh, Winding::kept), path, context);
}

}  // namespace sterna::io
