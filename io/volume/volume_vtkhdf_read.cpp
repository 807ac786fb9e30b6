// VTKHDF reader. It reads the datasets of the group, then the points and cells of each partition.
#include <array>
#include <map>
#include <optional>

#include "geom/base/parallel.h"
#include "io/container/container_file.h"
#include "io/grammar/vtk_cells.h"
#include "io/input/file_buffer.h"
#include "io/mesh/orientation.h"
#include "io/mesh/surface_builder.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_vtkhdf.h"

namespace sterna::io {
namespace {

/// Cell arrays that identify boundaries, in order of preference.
constexpr std::array<std::string_view, 5> k_marker_names = {"marker", "boundary", "CellEntityIds", "gmsh:physical", "ids"};
constexpr std::string_view k_patch_prefix = "patch:";

std::optional<PatchKind> boundary_kind_named(std::string_view name) {
  for (const PatchKind kind :
       {PatchKind::wall, PatchKind::slip, PatchKind::symmetry, PatchKind::inflow, PatchKind::outflow, PatchKind::farfield, PatchKind::interface})
    if (to_string(kind) == name) return kind;
  return std::nullopt;
}

class VtkHdfReader {
 public:
  VtkHdfReader(const ContainerImage& file, bool takes_any_point, const RunContext& context)
      : file_(file), takes_any_point_(takes_any_point), context_(context), group_(file_.child(file_.root(), "VTKHDF")) {}

  HybridMesh read() {
    const NumberArray* const type = group_.attribute("Type");
    if (!type) throw_malformed(file_.source(), "/VTKHDF", "found no attribute \"Type\"");
    if (type->text() != "UnstructuredGrid") throw_unsupported(file_.source(), "the file holds " + quoted_excerpt(type->text()) + ", not an UnstructuredGrid");
    const std::vector<std::uint64_t> n_points = counts("NumberOfPoints"), n_cells = counts("NumberOfCells"), n_ids = counts("NumberOfConnectivityIds");
    if (n_cells.size() != n_points.size() || n_ids.size() != n_points.size())
      throw_malformed(file_.source(), "/VTKHDF", "the arrays NumberOfPoints, NumberOfCells and NumberOfConnectivityIds have different numbers of partitions");
    read_points(sum(n_points, "/VTKHDF/NumberOfPoints"));
    const std::uint64_t n_all_cells = sum(n_cells, "/VTKHDF/NumberOfCells");
    connectivity_ = integers("Connectivity", sum(n_ids, "/VTKHDF/NumberOfConnectivityIds"));
    offsets_ = integers("Offsets", n_all_cells + n_cells.size());
    types_ = integers("Types", n_all_cells);
    read_names();
    read_markers(n_all_cells);
    for (std::size_t part = 0; part < n_cells.size(); ++part) read_cells(n_points[part], n_cells[part], n_ids[part]);
    if (n_left_out_ > 0) context_.info("vertices and lines left out: " + std::to_string(n_left_out_));
    return std::move(mesh_);
  }

 private:
  NumberArray array(std::string_view name) const { return file_.data(file_.child(group_, name)); }
  NumberArray integers(std::string_view name, std::uint64_t n) {
    NumberArray values = array(name);
    values.require_integers(n, "as many as the partitions have");
    return values;
  }

  /// Reads one number per partition.
  std::vector<std::uint64_t> counts(std::string_view name) {
    const NumberArray values = array(name);
    values.require_integers(values.count(), "a number for each partition");
    std::vector<std::uint64_t> result;
    for (std::uint64_t i = 0; i < values.count(); ++i) {
      if (values.integer(i) < 0) values.fail("found " + std::to_string(values.integer(i)));
      result.push_back(static_cast<std::uint64_t>(values.integer(i)));
    }
    return result;
  }
  std::uint64_t sum(const std::vector<std::uint64_t>& values, const char* where) const {
    std::uint64_t total = 0;
    for (const std::uint64_t value : values)
      if (__builtin_add_overflow(total, value, &total)) throw_malformed(file_.source(), where, "the sum does not fit 64 bits");
    if (total > std::uint64_t{1} << 60) throw_malformed(file_.source(), where, "found " + std::to_string(total) + " in total");
    return total;
  }

  void read_points(std::uint64_t n) {
    const NumberArray values = array("Points");
    values.require_reals(3 * n, "coordinates of the points");
    if (n >= NodeId::k_invalid) throw_id_overflow(n);
    mesh_.points.resize(n);
    parallel_for(context_, n, [&](std::size_t i) {
      const Point p = {values.real(3 * i), values.real(3 * i + 1), values.real(3 * i + 2)};
      if (!is_finite(p) && !takes_any_point_) values.fail("the coordinates of point " + std::to_string(i) + " are not finite");
      mesh_.points.raw()[i] = p;
    });
  }

  /// Reads the patches named in the field data, in its order.
  void read_names() {
    if (!group_.find("FieldData")) return;
    for (const ContainerNode& field : file_.child(group_, "FieldData").children) {
      if (!field.name.starts_with(k_patch_prefix)) continue;
      const std::string_view rest = std::string_view(field.name).substr(k_patch_prefix.size());
      const std::size_t colon = rest.find(':');
      const auto kind = boundary_kind_named(rest.substr(0, colon));
      if (colon == std::string_view::npos || !kind) continue;
      const NumberArray number = file_.data(field);
      number.require_integers(1, "the marker of a patch");
      const NumberArray* const whole = field.attribute("name");
      const std::string name = whole ? whole->text() : std::string(rest.substr(colon + 1));
      patches_.emplace(number.integer(0), mesh_.patches.push_back({.name = name, .kind = *kind}));
    }
  }

  void read_markers(std::uint64_t n_cells) {
    if (!group_.find("CellData")) return;
    const ContainerNode& cell_data = file_.child(group_, "CellData");
    for (const std::string_view name : k_marker_names) {
      if (!cell_data.find(name)) continue;
      NumberArray values = file_.data(file_.child(cell_data, name));
      if (!is_integer(values.kind)) continue;
      values.require_integers(n_cells, "a number for each cell");
      markers_ = std::move(values);
      return;
    }
  }

  void read_cells(std::uint64_t n_points, std::uint64_t n_cells, std::uint64_t n_ids) {
    for (std::uint64_t i = 0; i < n_cells; ++i) {
      const std::int64_t begin = offsets_.integer(first_offset_ + i), end = offsets_.integer(first_offset_ + i + 1);
      if (begin < 0 || end < begin || end > static_cast<std::int64_t>(n_ids) || (i == 0 && begin != 0))
        offsets_.fail("cell " + std::to_string(i) + " has the ids " + std::to_string(begin) + " to " + std::to_string(end) + " of " + std::to_string(n_ids));
      nodes_.clear();
      if (end - begin > 8) throw_unsupported(file_.source(), "cell " + std::to_string(i) + " has " + std::to_string(end - begin) + " nodes", k_hint);
      for (std::int64_t k = begin; k < end; ++k) {
        const std::int64_t node = connectivity_.integer(first_id_ + static_cast<std::uint64_t>(k));
        if (node < 0 || node >= static_cast<std::int64_t>(n_points))
          connectivity_.fail("cell " + std::to_string(i) + " has the node " + std::to_string(node) + ", there are " + std::to_string(n_points));
        nodes_.push_back(NodeId(first_point_ + static_cast<std::uint64_t>(node)));
      }
      add_cell(first_cell_ + i);
    }
    first_point_ += n_points;
    first_cell_ += n_cells;
    first_id_ += n_ids;
    first_offset_ += n_cells + 1;
  }

  template <std::size_t N>
  std::array<NodeId, N> taken(std::uint64_t cell, const std::array<std::uint8_t, 8>& order) const {
    if (nodes_.size() != N)
      connectivity_.fail("cell " + std::to_string(cell) + " has " + std::to_string(nodes_.size()) + " nodes, expected " + std::to_string(N));
    std::array<NodeId, N> result;
    for (std::size_t k = 0; k < N; ++k) result[order[k]] = nodes_[k];
    return result;
  }

  void add_cell(std::uint64_t cell) {
    constexpr std::array<std::uint8_t, 8> k_same = {0, 1, 2, 3, 4, 5, 6, 7};
    const std::int64_t type = types_.integer(cell);
    if (const auto kind = kind_of_vtk_type(type)) {
      switch (*kind) {
        case CellKind::tetrahedron: mesh_.tetrahedra.push_back(taken<4>(cell, k_same)); break;
        case CellKind::pyramid: mesh_.pyramids.push_back(taken<5>(cell, k_same)); break;
        case CellKind::prism: mesh_.prisms.push_back(taken<6>(cell, vtk_order(CellKind::prism))); break;
        case CellKind::hexahedron: mesh_.hexahedra.push_back(taken<8>(cell, k_same)); break;
      }
    } else if (type == k_vtk_triangle) {
      mesh_.boundary_triangles.push_back({taken<3>(cell, k_same), patch_of(cell)});
    } else if (type == k_vtk_quad) {
      mesh_.boundary_quads.push_back({taken<4>(cell, k_same), patch_of(cell)});
    } else if (type >= k_vtk_vertex && type < k_vtk_triangle) {
      ++n_left_out_;  // vertices and lines bound nothing
    } else {
      throw_unsupported(file_.source(), "cell " + std::to_string(cell) + " is of VTK type " + std::to_string(type), k_hint);
    }
  }

  PatchId patch_of(std::uint64_t cell) {
    const std::int64_t marker = markers_ ? markers_->integer(cell) : 0;
    const auto [entry, is_new] = patches_.try_emplace(marker);
    if (is_new) entry->second = mesh_.patches.push_back({.name = numbered_patch(marker), .kind = kind_of_name(numbered_patch(marker))});
    return entry->second;
  }

  static constexpr std::string_view k_hint = "tetrahedra, pyramids, wedges, hexahedra, triangles and quads are read";

  const ContainerImage& file_;
  bool takes_any_point_;
  const RunContext& context_;
  const ContainerNode& group_;
  NumberArray connectivity_, offsets_, types_;
  std::optional<NumberArray> markers_;
  std::map<std::int64_t, PatchId> patches_;
  std::vector<NodeId> nodes_;
  std::uint64_t first_point_ = 0, first_cell_ = 0, first_id_ = 0, first_offset_ = 0;  ///< offsets of the current partition
  std::int64_t n_left_out_ = 0;
  HybridMesh mesh_;
};

HybridMesh read_vtkhdf(const std::filesystem::path& path, bool takes_any_point, const RunContext& context) {
  const ContainerImage file = read_container(path, ContainerFormat::hdf5, {"PointData"}, context);
  HybridMesh mesh = VtkHdfReader(file, takes_any_point, context).read();
  context.progress(0.7);
  orient_mesh(mesh, context);
  return mesh;
}

}  // namespace

HybridMesh read_volume_vtkhdf(const std::filesystem::path& path, const RunContext& context) { return read_vtkhdf(path, false, context); }
HybridMesh read_boundary_vtkhdf(const std::filesystem::path& path, const RunContext& context) { return read_vtkhdf(path, true, context); }

}  // namespace sterna::io
