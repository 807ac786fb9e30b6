#include <cmath>

#include "geom/base/error.h"
#include "io/container/ffa_tree.h"
#include "io/mesh/orientation.h"
#include "io/names/edge_conditions.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_edge.h"

namespace sterna::io {
namespace {

void read_points(const FfaNode& coordinates, HybridMesh& mesh) {
  if (!coordinates.is_real() || coordinates.n_columns != 3)
    coordinates.fail("found " + std::to_string(coordinates.n_columns) + " columns, expected the 3 of real coordinates");
  if (coordinates.n_rows >= NodeId::k_invalid) throw_id_overflow(coordinates.n_rows);
  mesh.points.resize(coordinates.n_rows);
  for (std::uint64_t i = 0; i < coordinates.n_rows; ++i) {
    const Point p{coordinates.real(i, 0), coordinates.real(i, 1), coordinates.real(i, 2)};
    if (!is_finite(p)) coordinates.fail("the coordinates of node " + std::to_string(i + 1) + " are not finite");
    mesh.points.raw()[i] = p;
  }
}

std::string text_below(const FfaNode& node, std::string_view child) {
  const FfaNode& value = node.at(child);
  if (!value.is_text() || value.n_values() == 0) value.fail("found no string");
  return value.text();
}

/// Appends elements of N nodes; calls take(nodes) for each.
template <std::size_t N, class Take>
void read_nodes(const FfaNode& table, std::size_t n_points, const Take& take) {
  if (!table.is_integer() || table.n_columns != N)
    table.fail("found " + std::to_string(table.n_columns) + " columns, expected " + std::to_string(N) + " of integers");
  for (std::uint64_t i = 0; i < table.n_rows; ++i) {
    std::array<NodeId, N> nodes;
    for (std::size_t k = 0; k < N; ++k) {
      const std::int64_t node = table.integer(i, k);
      if (node < 1 || static_cast<std::uint64_t>(node) > n_points)
        table.fail("element " + std::to_string(i + 1) + " has the node " + std::to_string(node) + ", expected 1 to " + std::to_string(n_points));
      nodes[k] = NodeId(static_cast<std::uint32_t>(node - 1));
    }
    take(nodes);
  }
}

void read_group(const FfaNode& group, HybridMesh& mesh, std::int64_t& n_dropped) {
  const std::string type = text_below(group, "element_type");
  const FfaNode& table = group.at("element_nodes");
  const std::size_t n = mesh.points.size();
  if (type == "tetra4") read_nodes<4>(table, n, [&](const auto& nodes) { mesh.tetrahedra.push_back(nodes); });
  else if (type == "penta5") read_nodes<5>(table, n, [&](const auto& nodes) { mesh.pyramids.push_back(nodes); });
  else if (type == "penta6") read_nodes<6>(table, n, [&](const auto& nodes) { mesh.prisms.push_back(nodes); });
  else if (type == "hexa8") read_nodes<8>(table, n, [&](const auto& nodes) { mesh.hexahedra.push_back(nodes); });
  else if (type == "bar2") n_dropped += static_cast<std::int64_t>(table.n_rows);
  else table.fail("found elements of the type " + quoted_excerpt(type) + ", expected tetra4, penta5, penta6 or hexa8");
}

/// Reads the boundary. In most files faces point into the fluid, so all faces are reversed; orient_mesh() then corrects the others.
void read_boundary(const FfaNode& boundary, const std::map<std::string, PatchKind>& kinds, HybridMesh& mesh) {
  const std::string name = text_below(boundary, "boundary_name");
  const PatchId patch = find_or_add_patch(mesh.patches, name);
  if (const auto kind = kinds.find(name); kind != kinds.end()) mesh.patches[patch].kind = kind->second;
  const std::size_t n = mesh.points.size();
  for (const FfaNode& group : boundary.children) {
    if (group.name != "belem_group") continue;
    const std::string type = text_below(group, "bound_elem_type");
    const FfaNode& table = group.at("bound_elem_nodes");
    if (type == "tria3") read_nodes<3>(table, n, [&](const auto& f) { mesh.boundary_triangles.push_back({{f[2], f[1], f[0]}, patch}); });
    else if (type == "quad4") read_nodes<4>(table, n, [&](const auto& f) { mesh.boundary_quads.push_back({{f[3], f[2], f[1], f[0]}, patch}); });
    else table.fail("found boundary elements of the type " + quoted_excerpt(type) + ", expected tria3 or quad4");
  }
}

}  // namespace

HybridMesh read_volume_edge(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const FfaNode root = parse_ffa(buffer);
  if (root.name != "unstr_grid_data") root.fail("expected \"unstr_grid_data\" as the root");
  const FfaNode* const found = root.find("region");
  const FfaNode& region = found ? *found : root;
  const std::map<std::string, PatchKind> kinds = read_edge_conditions(path, context);
  context.progress(0.2);
  HybridMesh mesh;
  read_points(region.at("coordinates"), mesh);
  std::int64_t n_dropped = 0;
  for (const FfaNode& node : region.children) {
    if (node.name == "element_group") read_group(node, mesh, n_dropped);
    if (node.name == "boundary") read_boundary(node, kinds, mesh);
  }
  if (n_dropped > 0) context.info("lines left out: " + std::to_string(n_dropped));
  context.progress(0.7);
  orient_mesh(mesh, context);
  return mesh;
}

}  // namespace sterna::io
