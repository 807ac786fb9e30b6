// The file has four parts: nodes (or "0 ..." and a file .node beside it), facets, holes, and regions. The last two do not describe the surface.
#include "io/surface/surface_tetgen.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/input/file_buffer.h"
#include "io/input/left_out.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_polygon.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_min_tetgen_node_bytes = 8;  // "1 0 0 0" and a line end
constexpr std::size_t k_min_facet_bytes = 2;
constexpr TextScanner::Rules k_rules{.comment = '#', .line_bound = true};

/// Moves to the next line with content; every record begins on a new line.
void find_record(TextScanner& scanner, std::string_view expected) {
  if (scanner.at_end())
    scanner.fail("found the end of the file, expected " + std::string(expected), "the file may have been cut short: copy or write it again");
}

class PlcParser {
 public:
  PlcParser(const std::filesystem::path& path, const RunContext& context)
      : path_(path), context_(context), buffer_(load_file(path, context)), scanner_(buffer_, k_rules), builder_(buffer_.source) {}

  SurfaceSoup parse() {
    std::filesystem::path unpacked = path_;
    if (equal_ignoring_case(unpacked.extension().string(), ".gz")) unpacked.replace_extension();
    if (!take_nodes(scanner_)) {
      const std::filesystem::path nodes = std::filesystem::path(unpacked).replace_extension(".node");
      const FileBuffer node_buffer = load_file(nodes, context_);
      TextScanner node_scanner(node_buffer, k_rules);
      if (!take_nodes(node_scanner)) node_scanner.fail("found no nodes, expected those of " + buffer_.source);
    }
    take_facets(equal_ignoring_case(unpacked.extension().string(), ".poly"));
    if (n_constraints_ > 0) context_.info(buffer_.source + ": points and segments within facets left out: " + std::to_string(n_constraints_));
    report_holes_and_regions();
    SurfaceSoup soup = builder_.finish(context_);
    soup.has_names = has_markers_;
    return soup;
  }

 private:
  /// Reads the nodes. \returns false if the count is 0
  bool take_nodes(TextScanner& scanner) {
    find_record(scanner, "the number of nodes");
    const std::size_t n = scanner.count("the number of nodes", k_min_tetgen_node_bytes);
    if (!scanner.at_line_end()) {
      const std::int64_t dimension = scanner.integer("the dimension");
      if (dimension == 2) throw_unsupported(scanner.source(), "a plane file (dimension 2), as Triangle writes it");
      if (dimension != 3) scanner.fail_expected("3, the dimension");
    }
    scanner.next_line();
    if (n == 0) return false;
    builder_.reserve_points(n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      find_record(scanner, "a node");
      const std::int64_t number = scanner.integer("the number of a node");
      if (i == 0) {
        if (number != 0 && number != 1) scanner.fail_expected("0 or 1 as the number of the first node");
        base_ = number;
      }
      if (number != base_ + static_cast<std::int64_t>(i))
        scanner.fail_expected(std::to_string(base_ + static_cast<std::int64_t>(i)) + ", the number of the next node");
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner.coordinate("a coordinate of a node");
      builder_.add_point(p);
      scanner.next_line();  // attributes, marker
    }
    return true;
  }

  void take_facets(bool is_poly) {
    find_record(scanner_, "the number of facets");
    const std::size_t n = scanner_.count("the number of facets", k_min_facet_bytes);
    has_markers_ = !scanner_.at_line_end() && scanner_.integer("1 when facets have markers, else 0") != 0;
    scanner_.next_line();
    builder_.reserve_polygons(n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      find_record(scanner_, "a facet");
      is_poly ? take_poly_facet() : take_smesh_facet();
    }
  }

  /// Reports the lists of holes and of regions that may follow the facets.
  void report_holes_and_regions() {
    LeftOut left_out;
    for (const char* what : {"points in holes", "points in regions"}) {
      if (scanner_.at_end()) break;
      const std::size_t n = scanner_.count("the number of holes or regions", 1);
      left_out.add(what, n);
      for (std::size_t i = 0; i < n + 1 && !scanner_.at_end(); ++i) scanner_.next_line();
    }
    left_out.warn(buffer_.source, context_);
  }

  void take_marker() {
    if (!has_markers_) return;
    const std::int64_t marker = scanner_.at_line_end() ? 0 : scanner_.integer("the marker of a facet");
    if (last_marker_ != marker) builder_.set_patch(numbered_patch(marker));
    last_marker_ = marker;
  }

  /// Reads corners, possibly over several lines.
  void take_corners() {
    const std::size_t n = scanner_.count("the number of corners", 1);
    if (n > k_max_polygon_corners)
      scanner_.fail("found a polygon of " + std::to_string(n) + " corners, expected at most " + std::to_string(k_max_polygon_corners));
    corners_.clear();
    scanner_.set_line_bound(false);
    for (std::size_t k = 0; k < n; ++k) corners_.push_back(scanner_.index("a corner of a facet", base_, builder_.n_points()));
    scanner_.set_line_bound(true);
  }

  void take_smesh_facet() {
    take_corners();
    take_marker();
    scanner_.next_line();
    if (corners_.size() < 3) ++n_constraints_;
    else builder_.add_polygon(corners_);
  }

  void take_poly_facet() {
    const std::size_t n_polygons = scanner_.count("the number of polygons of a facet", k_min_facet_bytes);
    const std::size_t n_holes = scanner_.at_line_end() ? 0 : scanner_.count("the number of holes of a facet", k_min_tetgen_node_bytes);
    if (n_holes > 0)
      throw_unsupported(buffer_.source, "line " + std::to_string(scanner_.line()) + ": a facet with holes", "split the facet, or write triangles");
    take_marker();
    scanner_.next_line();
    bool has_polygon = false;
    for (std::size_t i = 0; i < n_polygons; ++i) {
      find_record(scanner_, "a polygon of a facet");
      take_corners();
      scanner_.next_line();
      if (corners_.size() < 3) {
        ++n_constraints_;
        continue;
      }
      if (has_polygon)
        throw_unsupported(buffer_.source, "line " + std::to_string(scanner_.line()) + ": a facet of several polygons", "split the facet, or write triangles");
      builder_.add_polygon(corners_);
      has_polygon = true;
    }
  }

  std::filesystem::path path_;
  const RunContext& context_;
  FileBuffer buffer_;
  TextScanner scanner_;
  SurfaceBuilder builder_;
  std::int64_t base_ = 0;
  bool has_markers_ = false;
  std::optional<std::int64_t> last_marker_;
  std::size_t n_constraints_ = 0;
  std::vector<std::uint32_t> corners_;
};

// ---- writing

OutputSection node_lines(const TriMesh& mesh) {
  return items_section(mesh.n_vertices(), k_max_integer_text + k_max_point_text + 2, [&mesh](std::uint64_t i, char* at) {
    at = put_integer_text(at, static_cast<std::int64_t>(i + 1));
    *at++ = ' ';
    at = put_point_text(at, mesh.points.raw()[i]);
    *at++ = '\n';
    return at;
  });
}

void write(const TriMesh& mesh, const std::filesystem::path& path, bool is_poly, const RunContext& context) {
  require_count(std::max(mesh.n_vertices(), mesh.n_triangles()), std::numeric_limits<std::int32_t>::max(), "nodes or facets", "TetGen", path.string());
  report_numbered_patches(mesh, "TetGen", context);
  const OutputSection facets = items_section(mesh.n_triangles(), 16 + 4 * k_max_id_text, [&mesh, is_poly](std::uint64_t i, char* at) {
    if (is_poly) {
      at = put_integer_text(put_text(at, "1 0 "), patch_number(mesh, TriangleId(i)));
      *at++ = '\n';
    }
    at = put_corners_text(put_text(at, "3 "), mesh.triangles.raw()[i], 1);
    if (!is_poly) {
      *at++ = ' ';
      at = put_integer_text(at, patch_number(mesh, TriangleId(i)));
    }
    *at++ = '\n';
    return at;
  });
  write_file(path,
             {fixed_section("# nodes\n" + std::to_string(mesh.n_vertices()) + " 3 0 0\n"), node_lines(mesh),
              fixed_section("# facets with markers\n" + std::to_string(mesh.n_triangles()) + " 1\n"), facets, fixed_section("# holes\n0\n# regions\n0\n")},
             context);
}

}  // namespace

SurfaceSoup read_tetgen(const std::filesystem::path& path, const RunContext& context) { return PlcParser(path, context).parse(); }
void write_smesh(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write(mesh, path, false, context); }
void write_poly(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write(mesh, path, true, context); }

}  // namespace sterna::io
