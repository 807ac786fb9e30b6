// SU2 reader, docs/method/formats.md, "SU2 variants". Steps: index_zones finds the blocks; read_points; count_cells counts the cells of each chunk, which gives
// the chunk its position in the arrays; read_cells; orient_mesh repairs windings. The text is never copied; chunks of lines are parsed in parallel.
#include <array>
#include <optional>
#include <utility>

#include "geom/base/parallel.h"
#include "io/grammar/su2_keyword.h"
#include "io/grammar/vtk_cells.h"
#include "io/input/line_blocks.h"
#include "io/mesh/orientation.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_su2.h"

namespace sterna::io {
namespace {

struct Zone : Su2Zone {
  bool has_dimension = false;
  bool is_empty() const { return !points && !elements && markers.empty() && !has_dimension; }
};

/// First pass over the file. It interprets keywords and skips blocks.
class ZoneIndexer {
 public:
  explicit ZoneIndexer(const FileBuffer& buffer) : source_(buffer.source), cursor_(buffer.text(), source_) {}

  std::vector<Zone> zones() {
    while (cursor_.find_content()) take_line();
    finish_zone();
    return std::move(zones_);
  }

 private:
  void take_line() {
    const std::string_view line = cursor_.rest_of_line();
    const Su2Keyword keyword = split_su2_keyword(line);
    if (keyword.key.empty()) {
      if (!is_in_unknown_section_)
        cursor_.fail("found " + quoted_excerpt(line) + ", expected a keyword such as NPOIN= or MARKER_TAG=" +
                     (last_block_.empty() ? std::string() : "; " + last_block_ + " announces fewer lines than there are"));
      cursor_.next_line();
      return;
    }
    is_in_unknown_section_ = false;
    if (keyword.key == "NDIME") take_dimension(keyword);
    else if (keyword.key == "NPOIN") take_block(zone_.points, keyword);
    else if (keyword.key == "NELEM") take_block(zone_.elements, keyword);
    else if (keyword.key == "NMARK") take_marker_count(keyword);
    else if (keyword.key == "MARKER_TAG") take_marker(keyword);
    else if (keyword.key == "IZONE") finish_zone();
    else is_in_unknown_section_ = keyword.key != "NZONE";  // free-form deformation boxes, periodic transformations, ...
    if (keyword.key == "IZONE" || keyword.key == "NZONE" || is_in_unknown_section_) cursor_.next_line();
  }

  void take_dimension(const Su2Keyword& keyword) {
    if (keyword.value == "2")
      throw_unsupported(source_, "line " + std::to_string(cursor_.line()) + ": NDIME= 2 is a plane mesh, only NDIME= 3 is read as a volume mesh");
    if (keyword.value != "3") cursor_.fail("found " + quoted_excerpt(keyword.value) + ", expected 3 after NDIME=");
    zone_.has_dimension = true;
    cursor_.next_line();
  }

  void take_block(std::optional<LineBlock>& block, const Su2Keyword& keyword) {
    if (block) cursor_.fail("a second " + std::string(keyword.key) + "=; the first is in line " + std::to_string(block->line));
    const std::uint64_t n = su2_count(keyword, cursor_);
    last_block_ = std::string(keyword.key) + "= in line " + std::to_string(cursor_.line());
    block = cursor_.take_block(n, std::string(keyword.key) + "=");
  }

  void take_marker_count(const Su2Keyword& keyword) {
    zone_.n_markers = su2_count(keyword, cursor_);
    cursor_.next_line();
  }

  void take_marker(const Su2Keyword& tag) {
    Su2Marker marker;
    marker.name = su2_marker_name(tag.value);
    cursor_.next_line();
    const Su2Keyword count = expect_keyword("MARKER_ELEMS", marker.name);
    const std::uint64_t n = su2_count(count, cursor_);
    last_block_ = "MARKER_ELEMS= in line " + std::to_string(cursor_.line());
    if (marker.name == k_su2_partition_marker) {
      cursor_.next_line();
      expect_keyword("SEND_TO", marker.name);
      cursor_.take_block(n, "MARKER_ELEMS=");
      ++zone_.n_partition_markers;
      return;
    }
    marker.faces = cursor_.take_block(n, "MARKER_ELEMS=");
    zone_.markers.push_back(std::move(marker));
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
    is_in_unknown_section_ = false;
    last_block_.clear();
    const bool is_first_header = zone_.is_empty() && cursor_.find_content();
    if (is_first_header) return;  // this is the first IZONE=, which begins no new zone
    const auto missing = [&](const char* what) { cursor_.fail(std::string("the mesh ends here without ") + what); };
    if (!zone_.has_dimension) missing("NDIME=");
    if (!zone_.points) missing("NPOIN=");
    if (!zone_.elements) missing("NELEM=");
    const std::uint64_t n_found = zone_.markers.size() + zone_.n_partition_markers;
    if (zone_.n_markers.value_or(0) != n_found)
      cursor_.fail("found " + std::to_string(n_found) + " markers, expected " + std::to_string(zone_.n_markers.value_or(0)) + " (NMARK=)");
    zones_.push_back(std::move(zone_));
    zone_ = {};
  }

  std::string_view source_;
  LineCursor cursor_;
  std::vector<Zone> zones_;
  Zone zone_;
  std::string last_block_;
  bool is_in_unknown_section_ = false;
};

/// A chunk of element or marker lines; elements have no patch.
struct CellChunk {
  LineChunk lines;
  PatchId patch;
};

/// Slots: cells by CellKind, then triangles and quads.
enum : std::size_t { k_triangle_slot = 4, k_quad_slot = 5 };
using SlotCounts = std::array<std::uint64_t, 6>;

/// Reads the type at the beginning of a line; \returns its slot.
std::size_t read_slot(LineCursor& cursor, bool is_boundary, std::uint64_t item) {
  const std::uint64_t type = cursor.integer("the type of element ", item);
  if (is_boundary) {
    if (type == k_vtk_triangle) return k_triangle_slot;
    if (type == k_vtk_quad) return k_quad_slot;
    cursor.fail("found element type " + std::to_string(type) + " in a marker, expected 5 (triangle) or 9 (quadrilateral)");
  }
  if (const auto kind = kind_of_vtk_type(static_cast<std::int64_t>(type))) return static_cast<std::size_t>(*kind);
  cursor.fail("found element type " + std::to_string(type) + ", expected a volume element: 10 (tetrahedron), 12 (hexahedron), 13 (prism) or 14 (pyramid)");
}

void read_points(const LineBlock& block, std::string_view source, HybridMesh& mesh, std::size_t first_node, const RunContext& context) {
  if (first_node + block.n_items >= NodeId::k_invalid) throw_id_overflow(first_node + block.n_items);
  mesh.points.resize(first_node + block.n_items);
  parallel_for(
      context, block.chunks.size(),
      [&](std::size_t c) {
        const LineChunk& chunk = block.chunks[c];
        LineCursor cursor(chunk, source);
        for (std::uint64_t i = chunk.first_item; i < chunk.first_item + chunk.n_items; ++i) {
          cursor.find_content();
          Point& p = mesh.points.raw()[first_node + i];
          for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = cursor.real("a coordinate of node ", i);
          cursor.next_line();  // indices may follow
        }
      },
      1);
}

SlotCounts count_slots(const CellChunk& chunk, std::string_view source) {
  SlotCounts counts{};
  LineCursor cursor(chunk.lines, source);
  for (std::uint64_t i = 0; i < chunk.lines.n_items; ++i) {
    cursor.find_content();
    ++counts[read_slot(cursor, chunk.patch.is_valid(), chunk.lines.first_item + i)];
    cursor.next_line();
  }
  return counts;
}

template <std::size_t N>
void read_nodes(LineCursor& cursor, std::array<NodeId, N>& nodes, const std::array<std::uint8_t, 8>& order, std::size_t first_node, std::uint64_t n_nodes,
                std::uint64_t item) {
  for (std::size_t k = 0; k < N; ++k) nodes[order[k]] = NodeId(static_cast<std::uint32_t>(first_node) + cursor.index(n_nodes, "a node of element ", item));
}

/// \param place position of the chunk's first item in each slot
void read_chunk(const CellChunk& chunk, std::string_view source, std::size_t first_node, std::uint64_t n_nodes, SlotCounts position, HybridMesh& mesh) {
  constexpr std::array<std::uint8_t, 8> k_same = {0, 1, 2, 3, 4, 5, 6, 7};
  LineCursor cursor(chunk.lines, source);
  for (std::uint64_t i = 0; i < chunk.lines.n_items; ++i) {
    const std::uint64_t item = chunk.lines.first_item + i;
    cursor.find_content();
    const std::size_t slot = read_slot(cursor, chunk.patch.is_valid(), item);
    const std::uint64_t at = position[slot]++;
    const auto read = [&](auto& nodes, const std::array<std::uint8_t, 8>& order) { read_nodes(cursor, nodes, order, first_node, n_nodes, item); };
    switch (slot) {
      case static_cast<std::size_t>(CellKind::tetrahedron): read(mesh.tetrahedra[at], k_same); break;
      case static_cast<std::size_t>(CellKind::pyramid): read(mesh.pyramids[at], k_same); break;
      case static_cast<std::size_t>(CellKind::prism): read(mesh.prisms[at], vtk_order(CellKind::prism)); break;
      case static_cast<std::size_t>(CellKind::hexahedron): read(mesh.hexahedra[at], k_same); break;
      case k_triangle_slot:
        read(mesh.boundary_triangles[at].nodes, k_same);
        mesh.boundary_triangles[at].patch = chunk.patch;
        break;
      default: read(mesh.boundary_quads[at].nodes, k_same); mesh.boundary_quads[at].patch = chunk.patch;
    }
    cursor.next_line();
  }
}

void read_cells(const std::vector<CellChunk>& chunks, std::string_view source, std::size_t first_node, std::uint64_t n_nodes, HybridMesh& mesh,
                const RunContext& context) {
  std::vector<SlotCounts> locations(chunks.size());
  parallel_for(
      context, chunks.size(), [&](std::size_t c) { locations[c] = count_slots(chunks[c], source); }, 1);
  SlotCounts next = {mesh.tetrahedra.size(), mesh.pyramids.size(),           mesh.prisms.size(),
                     mesh.hexahedra.size(),  mesh.boundary_triangles.size(), mesh.boundary_quads.size()};
  for (SlotCounts& position : locations)
    for (std::size_t s = 0; s < position.size(); ++s) position[s] = std::exchange(next[s], next[s] + position[s]);
  mesh.tetrahedra.resize(next[0]);
  mesh.pyramids.resize(next[1]);
  mesh.prisms.resize(next[2]);
  mesh.hexahedra.resize(next[3]);
  mesh.boundary_triangles.resize(next[4]);
  mesh.boundary_quads.resize(next[5]);
  parallel_for(
      context, chunks.size(), [&](std::size_t c) { read_chunk(chunks[c], source, first_node, n_nodes, locations[c], mesh); }, 1);
}

void read_zone(const Zone& zone, std::string_view source, HybridMesh& mesh, const RunContext& context) {
  const std::size_t first_node = mesh.points.size();
  read_points(*zone.points, source, mesh, first_node, context);
  std::vector<CellChunk> chunks;
  for (const LineChunk& lines : zone.elements->chunks) chunks.push_back({lines, PatchId{}});
  for (const Su2Marker& marker : zone.markers) {
    const PatchId patch = find_or_add_patch(mesh.patches, marker.name);
    for (const LineChunk& lines : marker.faces.chunks) chunks.push_back({lines, patch});
  }
  read_cells(chunks, source, first_node, zone.points->n_items, mesh, context);
  if (zone.n_partition_markers > 0) context.info("markers SEND_RECEIVE (boundaries of a partition) left out: " + std::to_string(zone.n_partition_markers));
}

}  // namespace

HybridMesh read_volume_su2(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const std::vector<Zone> zones = ZoneIndexer(buffer).zones();
  context.progress(0.3);
  HybridMesh mesh;
  for (const Zone& zone : zones) read_zone(zone, buffer.source, mesh, context);
  if (zones.size() > 1) context.info("zones joined into one mesh: " + std::to_string(zones.size()));
  context.progress(0.8);
  orient_mesh(mesh, context);
  return mesh;
}

}  // namespace sterna::io
