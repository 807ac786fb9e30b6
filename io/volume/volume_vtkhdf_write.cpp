// VTKHDF writer. It writes the datasets of one group, each as sections by kind of cell.
#include <algorithm>
#include <array>

#include "io/container/hdf5_output.h"
#include "io/grammar/vtk_cells.h"
#include "io/output/cell_sections.h"
#include "io/volume/volume_vtkhdf.h"

namespace sterna::io {
namespace {

/// Cells of one kind, or the boundary faces of one size, in file order.
struct HdfRun {
  int type = 0;
  std::uint64_t n_nodes = 0;  ///< nodes per cell
  std::uint64_t n_cells = 0;
  /// Calls f(nodes in VTK order, layer, marker) for cells [begin, end).
  std::function<void(std::uint64_t begin, std::uint64_t end, const std::function<void(std::span<const NodeId>, int, std::int32_t)>& f)> for_each;
};

std::vector<HdfRun> runs_of(const HybridMesh& mesh, const CellSections& cells) {
  std::vector<HdfRun> runs;
  for (const CellKind kind : k_kinds_in_file)
    runs.push_back({.type = vtk_type(kind),
                    .n_nodes = static_cast<std::uint64_t>(n_nodes(kind)),
                    .n_cells = cells.count(kind),
                    .for_each = [&cells, kind](std::uint64_t begin, std::uint64_t end, const auto& f) {
                      const auto order = vtk_order(kind);
                      std::array<NodeId, 8> turned;
                      cells.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int layer) {
                        for (std::size_t i = 0; i < nodes.size(); ++i) turned[i] = nodes[order[i]];
                        f(std::span<const NodeId>(turned.data(), nodes.size()), layer, 0);
                      });
                    }});
  const auto add_faces = [&](int type, const auto& faces, std::uint64_t size) {
    runs.push_back({.type = type, .n_nodes = size, .n_cells = faces.size(), .for_each = [&faces](std::uint64_t begin, std::uint64_t end, const auto& f) {
                      for (std::uint64_t i = begin; i < end; ++i)
                        f(std::span<const NodeId>(faces[i].nodes), 0, static_cast<std::int32_t>(faces[i].patch.value()) + 1);
                    }});
  };
  add_faces(k_vtk_triangle, mesh.boundary_triangles, 3);
  add_faces(k_vtk_quad, mesh.boundary_quads, 4);
  std::erase_if(runs, [](const HdfRun& run) { return run.n_cells == 0; });
  return runs;
}

Hdf5OutputNode dataset(std::string name, OutputArray array) { return {.name = std::move(name), .is_dataset = true, .array = std::move(array)}; }
Hdf5OutputNode number(std::string name, std::uint64_t value) {
  return dataset(std::move(name), output_numbers<std::int64_t>(NumberKind::i8, {1}, {static_cast<std::int64_t>(value)}));
}

OutputArray hdf_points_array(const HybridMesh& mesh) {
  const std::uint64_t n = mesh.points.size();
  return {.kind = NumberKind::f8, .extents = {n, 3}, .content = {{.n_items = n, .format = [&mesh](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                                                                    char* at = out.reserve((end - begin) * 24);
                                                                    for (std::uint64_t i = begin; i < end; ++i) {
                                                                      const Point& p = mesh.points.raw()[i];
                                                                      if (!is_finite(p)) throw_node_not_finite(i);
                                                                      for (std::size_t axis = 0; axis < 3; ++axis)
                                                                        at = put_bytes(at, p[axis], std::endian::little);
                                                                    }
                                                                    out.end_at(at);
                                                                  }}}};
}

/// Adds an array with one value of type T per cell, value(nodes, layer, marker); or all nodes if `has_nodes`.
template <class T, class Put>
OutputArray per_cell(NumberKind kind, std::uint64_t n_values, const std::vector<HdfRun>& runs, bool has_nodes, const Put& put) {
  OutputArray array{.kind = kind, .extents = {n_values}, .content = {}};
  for (const HdfRun& run : runs)
    array.content.push_back({.n_items = run.n_cells, .format = [&run, has_nodes, put](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                               char* at = out.reserve((end - begin) * sizeof(T) * (has_nodes ? run.n_nodes : 1));
                               run.for_each(begin, end,
                                            [&](std::span<const NodeId> nodes, int layer, std::int32_t marker) { at = put(at, nodes, layer, marker); });
                               out.end_at(at);
                             }});
  return array;
}

OutputArray types_array(std::uint64_t n_cells, const std::vector<HdfRun>& runs) {
  OutputArray array{.kind = NumberKind::u1, .extents = {n_cells}, .content = {}};
  for (const HdfRun& run : runs)
    array.content.push_back({.n_items = run.n_cells, .format = [type = run.type](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                               out.end_at(std::fill_n(out.reserve(end - begin), end - begin, static_cast<char>(type)));
                             }});
  return array;
}

OutputArray offsets_array(std::uint64_t n_cells, const std::vector<HdfRun>& runs) {
  OutputArray array = output_numbers<std::int64_t>(NumberKind::i8, {n_cells + 1}, {0});
  std::uint64_t before = 0;
  for (const HdfRun& run : runs) {
    array.content.push_back({.n_items = run.n_cells, .format = [before, n = run.n_nodes](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                               char* at = out.reserve((end - begin) * 8);
                               for (std::uint64_t i = begin; i < end; ++i)
                                 at = put_bytes(at, static_cast<std::int64_t>(before + (i + 1) * n), std::endian::little);
                               out.end_at(at);
                             }});
    before += run.n_cells * run.n_nodes;
  }
  return array;
}

Hdf5OutputNode patch_numbers(const HybridMesh& mesh, const RunContext& context) {
  Hdf5OutputNode group{.name = "FieldData"};
  for (const PatchId patch : mesh.patches.ids()) {
    const Patch& data = mesh.patches[patch];
    std::string name = "patch:" + std::string(to_string(data.kind)) + ":" + data.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '/' || c == '\0'; }, '_');
    const std::string stem = name;
    const auto is_taken = [&] {
      return std::any_of(group.children.begin(), group.children.end(), [&](const Hdf5OutputNode& other) { return other.name == name; });
    };
    for (int i = 2; is_taken(); ++i) name = stem + "_" + std::to_string(i);
    Hdf5OutputNode node = dataset(name, output_numbers<std::int32_t>(NumberKind::i4, {1}, {static_cast<std::int32_t>(patch.value()) + 1}));
    if (!name.ends_with(":" + data.name)) {
      context.warn("patch \"" + data.name + "\" is named \"" + name + "\" in the VTKHDF file");
      node.attributes.push_back(text_attribute("name", data.name, data.name.size() + 1));
    }
    group.children.push_back(std::move(node));
  }
  return group;
}

}  // namespace

void write_volume_vtkhdf(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const FacesByPatch checked(mesh);  // rejects faces without patch
  const CellSections cells(mesh);
  const std::vector<HdfRun> runs = runs_of(mesh, cells);
  std::uint64_t n_cells = 0, n_values = 0;
  for (const HdfRun& run : runs) {
    n_cells += run.n_cells;
    n_values += run.n_cells * run.n_nodes;
  }
  Hdf5OutputNode grid{.name = "VTKHDF"};
  grid.attributes.push_back({.name = "Version", .kind = NumberKind::i8, .extents = {2}, .bytes = std::string("\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 16)});
  grid.attributes.push_back(text_attribute("Type", "UnstructuredGrid", 16));
  grid.children.push_back(number("NumberOfPoints", mesh.points.size()));
  grid.children.push_back(number("NumberOfCells", n_cells));
  grid.children.push_back(number("NumberOfConnectivityIds", n_values));
  grid.children.push_back(dataset("Points", hdf_points_array(mesh)));
  grid.children.push_back(
      dataset("Connectivity", per_cell<std::int64_t>(NumberKind::i8, n_values, runs, true, [](char* at, std::span<const NodeId> nodes, int, std::int32_t) {
                for (const NodeId node : nodes) at = put_bytes(at, static_cast<std::int64_t>(node.value()), std::endian::little);
                return at;
              })));
  grid.children.push_back(dataset("Offsets", offsets_array(n_cells, runs)));
  grid.children.push_back(dataset("Types", types_array(n_cells, runs)));
  Hdf5OutputNode cell_data{.name = "CellData"};
  cell_data.children.push_back(
      dataset("marker", per_cell<std::int32_t>(NumberKind::i4, n_cells, runs, false, [](char* at, std::span<const NodeId>, int, std::int32_t marker) {
                return put_bytes(at, marker, std::endian::little);
              })));
  cell_data.children.push_back(
      dataset("layer", per_cell<std::int32_t>(NumberKind::i4, n_cells, runs, false, [](char* at, std::span<const NodeId>, int layer, std::int32_t) {
                return put_bytes(at, static_cast<std::int32_t>(layer), std::endian::little);
              })));
  grid.children.push_back(std::move(cell_data));
  if (!mesh.patches.empty()) grid.children.push_back(patch_numbers(mesh, context));
  Hdf5OutputNode root;
  root.children.push_back(std::move(grid));
  write_hdf5(root, path, context);
}

}  // namespace sterna::io
