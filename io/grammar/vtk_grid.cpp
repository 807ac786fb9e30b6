#include "io/grammar/vtk_grid.h"

#include <algorithm>
#include <span>

#include "geom/base/error.h"
#include "io/grammar/vtk_cells.h"
#include "io/input/file_buffer.h"
#include "io/input/left_out.h"
#include "io/input/text_limits.h"
#include "io/mesh/orientation.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_polygon.h"
#include "io/names/patch_names.h"

namespace sterna::io {
namespace {

// Further cell types of VTK.
constexpr std::int64_t k_vtk_empty = 0, k_vtk_strip = 6, k_vtk_polygon = 7, k_vtk_pixel = 8, k_vtk_voxel = 11, k_vtk_curved_edge = 21;

std::optional<PatchKind> kind_named(std::string_view name) {
  for (const PatchKind kind :
       {PatchKind::wall, PatchKind::slip, PatchKind::symmetry, PatchKind::inflow, PatchKind::outflow, PatchKind::farfield, PatchKind::interface})
    if (to_string(kind) == name) return kind;
  return std::nullopt;
}

bool bounds_nothing(std::int64_t type) { return (type >= k_vtk_empty && type < k_vtk_triangle) || type == k_vtk_curved_edge; }

/// Returns the number of corners of a second-order face, which are its first nodes; 0 for other types.
std::size_t corners_of_curved_face(std::int64_t type) {
  switch (type) {
    case 22:            // quadratic triangle
    case 34: return 3;  // biquadratic
    case 23:            // quadratic quad
    case 28:            // biquadratic
    case 30: return 4;  // quadratic in one direction
    default: return 0;
  }
}

[[noreturn]] void fail(const VtkGrid& grid, const VtkPiece& piece, const std::string& problem) { throw_malformed(grid.source, piece.where, problem); }

/// Calls f(number, type, nodes, marker) for the cells of a piece; nodes are checked.
template <class F>
void for_each_vtk_cell(const VtkGrid& grid, const VtkPiece& piece, const RunContext& context, const F& f) {
  std::size_t n_cells = 0;
  for (const VtkCells& cells : piece.cells) n_cells += cells.size();
  if (piece.markers && piece.markers->size() != n_cells)
    fail(grid, piece, "found " + std::to_string(piece.markers->size()) + " values of \"" + piece.marker_name + "\" for " + std::to_string(n_cells) + " cells");
  std::vector<std::uint64_t> nodes;
  std::size_t cell = 0;
  for (const VtkCells& cells : piece.cells) {
    if (cells.types && cells.types->size() != cells.size())
      fail(grid, piece, "found " + std::to_string(cells.types->size()) + " types for " + std::to_string(cells.size()) + " offsets");
    std::uint64_t begin = 0;
    for (std::size_t i = 0; i < cells.size(); ++i, ++cell) {
      if (cell % k_stop_interval == 0) context.check_stop();
      const std::uint64_t end = cells.ends->id(i);
      if (end < begin || end > cells.connectivity->size())
        fail(grid, piece,
             "cell " + std::to_string(cell) + " has the offset " + std::to_string(static_cast<std::int64_t>(end)) + ", expected " + std::to_string(begin) +
                 " to " + std::to_string(cells.connectivity->size()));
      nodes.clear();
      for (std::uint64_t k = begin; k < end; ++k) {
        const std::uint64_t node = cells.connectivity->id(k);
        if (node >= piece.points.size())
          fail(grid, piece,
               "cell " + std::to_string(cell) + " has the node " + std::to_string(static_cast<std::int64_t>(node)) + ", there are " +
                   std::to_string(piece.points.size()));
        nodes.push_back(node);
      }
      f(cell, cells.types ? static_cast<std::int64_t>(cells.types->id(i)) : cells.type, std::span<const std::uint64_t>(nodes),
        piece.markers ? piece.markers->id(cell) : 0);
      begin = end;
    }
  }
}

std::string marker_name(const VtkGrid& grid, std::uint64_t marker) {
  const auto found = grid.patches.find(marker);
  return found == grid.patches.end() ? numbered_patch(static_cast<std::int64_t>(marker)) : found->second.name;
}

// ---- surfaces

class FaceCollector {
 public:
  FaceCollector(const VtkGrid& grid, const RunContext& context) : grid_(grid), context_(context), builder_(grid.source) {}

  SurfaceSoup collect() {
    bool has_markers = false;
    for (const VtkPiece& piece : grid_.pieces) {
      piece_ = &piece;
      first_point_ = static_cast<std::uint32_t>(builder_.n_points());
      for (const Point& p : piece.points) builder_.add_point(p);
      has_markers = has_markers || piece.markers;
      for_each_vtk_cell(grid_, piece, context_, [&](std::size_t cell, std::int64_t type, std::span<const std::uint64_t> nodes, std::uint64_t marker) {
        if (bounds_nothing(type)) {
          ++n_dropped_;
        } else if (is_face(type)) {
          if (piece.markers && marker != last_marker_) {
            builder_.set_patch(marker_name(grid_, marker));
            last_marker_ = marker;
          }
          add_face(cell, type, nodes);
        } else {
          ++n_volumes_;
        }
      });
    }
    if (n_dropped_ > 0) context_.info(grid_.source + ": vertices and lines left out: " + std::to_string(n_dropped_));
    curved_.warn(grid_.source, context_);
    SurfaceSoup soup = builder_.finish(context_, n_volumes_ > 0);
    soup.has_names = has_markers;
    soup.single_precision = grid_.single_precision;
    soup.n_cells = n_volumes_;
    return soup;
  }

 private:
  static bool is_face(std::int64_t type) { return (type >= k_vtk_triangle && type <= k_vtk_quad) || corners_of_curved_face(type) > 0; }

  void add_face(std::size_t cell, std::int64_t type, std::span<const std::uint64_t> nodes) {
    if (type == k_vtk_strip) return add_strip(cell, nodes);
    std::size_t n = nodes.size();
    const std::size_t n_curved = corners_of_curved_face(type);
    const std::size_t n_expected = type == k_vtk_triangle ? 3 : type == k_vtk_quad || type == k_vtk_pixel ? 4 : 0;
    if (n_curved > 0) n = std::min(n, n_curved);
    if (n_curved > 0) curved_.add("second-order faces by their mid-side nodes, which become flat");
    if ((n_expected > 0 && n != n_expected) || (n_curved > 0 && nodes.size() <= n_curved) || n < 3 || n > k_max_polygon_corners)
      fail(grid_, *piece_, "cell " + std::to_string(cell) + " of VTK type " + std::to_string(type) + " has " + std::to_string(nodes.size()) + " nodes");
    corners_.clear();
    for (const std::uint64_t node : nodes.first(n)) corners_.push_back(first_point_ + static_cast<std::uint32_t>(node));
    if (type == k_vtk_pixel) std::swap(corners_[2], corners_[3]);
    builder_.add_polygon(corners_);
  }

  /// Adds a strip; every second triangle is reversed.
  void add_strip(std::size_t cell, std::span<const std::uint64_t> nodes) {
    if (nodes.size() < 3)
      fail(grid_, *piece_, "the triangle strip " + std::to_string(cell) + " has " + std::to_string(nodes.size()) + " nodes, expected 3 or more");
    const auto corner = [&](std::size_t i) { return first_point_ + static_cast<std::uint32_t>(nodes[i]); };
    for (std::size_t i = 0; i + 2 < nodes.size(); ++i) builder_.add_triangle(corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2));
  }

  const VtkGrid& grid_;
  const RunContext& context_;
  SurfaceBuilder builder_;
  const VtkPiece* piece_ = nullptr;
  std::uint32_t first_point_ = 0;
  std::optional<std::uint64_t> last_marker_;
  std::size_t n_dropped_ = 0, n_volumes_ = 0;
  LeftOut curved_;
  std::vector<std::uint32_t> corners_;
};

// ---- volume meshes

class CellCollector {
 public:
  CellCollector(const VtkGrid& grid, const RunContext& context) : grid_(grid), context_(context) {
    for (const auto& [marker, patch] : grid.patches) patch_of_marker_[marker] = mesh_.patches.push_back(patch);
  }

  HybridMesh collect() {
    for (const VtkPiece& piece : grid_.pieces) {
      piece_ = &piece;
      first_node_ = mesh_.points.size();
      if (first_node_ + piece.points.size() >= NodeId::k_invalid) throw_id_overflow(first_node_ + piece.points.size());
      for (std::size_t i = 0; i < piece.points.size(); ++i)
        if (!is_finite(piece.points[i])) fail(grid_, piece, "the coordinates of point " + std::to_string(i) + " are not finite");
      mesh_.points.raw().insert(mesh_.points.raw().end(), piece.points.begin(), piece.points.end());
      for_each_vtk_cell(grid_, piece, context_, [&](std::size_t cell, std::int64_t type, std::span<const std::uint64_t> nodes, std::uint64_t marker) {
        nodes_ = nodes;
        add(cell, type, marker);
      });
    }
    if (n_dropped_ > 0) context_.info(grid_.source + ": vertices and lines left out: " + std::to_string(n_dropped_));
    context_.progress(0.8);
    orient_mesh(mesh_, context_);
    return std::move(mesh_);
  }

 private:
  template <std::size_t N>
  std::array<NodeId, N> taken(std::size_t cell, const std::array<std::uint8_t, 8>& order) const {
    if (nodes_.size() != N)
      fail(grid_, *piece_, "cell " + std::to_string(cell) + " has " + std::to_string(nodes_.size()) + " nodes, expected " + std::to_string(N));
    std::array<NodeId, N> result;
    for (std::size_t k = 0; k < N; ++k) result[order[k]] = NodeId(std::uint64_t{first_node_ + nodes_[k]});
    return result;
  }

  void add(std::size_t cell, std::int64_t type, std::uint64_t marker) {
    constexpr std::array<std::uint8_t, 8> k_same = {0, 1, 2, 3, 4, 5, 6, 7};
    constexpr std::array<std::uint8_t, 8> k_voxel = {0, 1, 3, 2, 4, 5, 7, 6};
    if (const auto kind = kind_of_vtk_type(type)) {
      switch (*kind) {
        case CellKind::tetrahedron: mesh_.tetrahedra.push_back(taken<4>(cell, k_same)); break;
        case CellKind::pyramid: mesh_.pyramids.push_back(taken<5>(cell, k_same)); break;
        case CellKind::prism: mesh_.prisms.push_back(taken<6>(cell, vtk_order(CellKind::prism))); break;
        case CellKind::hexahedron: mesh_.hexahedra.push_back(taken<8>(cell, k_same)); break;
      }
    } else if (type == k_vtk_voxel) {
      mesh_.hexahedra.push_back(taken<8>(cell, k_voxel));
    } else if (type == k_vtk_triangle) {
      mesh_.boundary_triangles.push_back({taken<3>(cell, k_same), patch_of(marker)});
    } else if (type == k_vtk_quad || type == k_vtk_pixel) {
      mesh_.boundary_quads.push_back({taken<4>(cell, type == k_vtk_pixel ? k_voxel : k_same), patch_of(marker)});
    } else if (bounds_nothing(type)) {
      ++n_dropped_;
    } else {
      throw_unsupported(grid_.source, "cell " + std::to_string(cell) + " is of VTK type " + std::to_string(type),
                        "tetrahedra, pyramids, wedges, hexahedra, triangles and quads are read");
    }
  }

  PatchId patch_of(std::uint64_t marker) {
    const auto [entry, is_new] = patch_of_marker_.try_emplace(marker);
    if (is_new) entry->second = find_or_add_patch(mesh_.patches, numbered_patch(static_cast<std::int64_t>(marker)));
    return entry->second;
  }

  const VtkGrid& grid_;
  const RunContext& context_;
  HybridMesh mesh_;
  std::map<std::uint64_t, PatchId> patch_of_marker_;
  const VtkPiece* piece_ = nullptr;
  std::size_t first_node_ = 0;
  std::span<const std::uint64_t> nodes_;
  std::size_t n_dropped_ = 0;
};

}  // namespace

std::string vtk_patch_key(const Patch& patch) { return std::string(k_vtk_patch_prefix) + std::string(to_string(patch.kind)) + ":" + patch.name; }

void VtkGrid::add_patch(std::string_view field_name, std::uint64_t marker) {
  if (!field_name.starts_with(k_vtk_patch_prefix)) return;
  const std::string_view rest = field_name.substr(k_vtk_patch_prefix.size());
  const std::size_t colon = rest.find(':');
  const auto kind = kind_named(rest.substr(0, colon));
  if (colon == std::string_view::npos || !kind) return;
  patches[marker] = {.name = std::string(rest.substr(colon + 1)), .kind = *kind};
}

SurfaceSoup surface_of(const VtkGrid& grid, const RunContext& context) { return FaceCollector(grid, context).collect(); }
HybridMesh volume_of(const VtkGrid& grid, const RunContext& context) {
  if (grid.is_surface) throw_unsupported(grid.source, "the file holds \"PolyData\", a surface, not a volume mesh");
  return CellCollector(grid, context).collect();
}

}  // namespace sterna::io
