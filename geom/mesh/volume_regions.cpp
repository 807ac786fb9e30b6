#include "geom/mesh/volume_regions.h"

#include <algorithm>
#include <map>
#include <span>

#include "geom/base/disjoint_sets.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/baffles.h"

namespace sterna {
namespace {

constexpr std::size_t k_named_regions = 5;
constexpr std::size_t k_named_patches = 4;
constexpr int k_volume_digits = 4;
constexpr double k_region_rounding = 1e-9;  ///< relative to the volume of the bounding box

/// Joins the two sides of discs.
void join_baffles(const HybridMesh& mesh, DisjointSets& sets) {
  const BaffleSides baffles = find_baffle_sides(mesh);
  for (std::uint32_t i = 0; i < baffles.twin.size(); ++i) sets.join(i, baffles.twin[i]);
}

/// Returns for each node the lowest node of its region.
std::vector<std::uint32_t> region_of_nodes(const HybridMesh& mesh) {
  DisjointSets sets(mesh.points.size());
  for_each_cell(mesh, [&](const Cell& cell) {
    for (int k = 1; k < n_nodes(cell.kind); ++k) sets.join(cell.nodes[0].value(), cell.nodes[static_cast<std::size_t>(k)].value());
  });
  join_baffles(mesh, sets);
  return std::move(sets).roots();
}

/// Returns for each boundary node the lowest node of its connected part of the boundary.
std::vector<std::uint32_t> shell_of_nodes(const HybridMesh& mesh) {
  DisjointSets sets(mesh.points.size());
  const auto join = [&](std::span<const NodeId> nodes) {
    for (const NodeId node : nodes) sets.join(nodes[0].value(), node.value());
  };
  for (const BoundaryTriangle& face : mesh.boundary_triangles) join(face.nodes);
  for (const BoundaryQuad& face : mesh.boundary_quads) join(face.nodes);
  join_baffles(mesh, sets);
  return std::move(sets).roots();
}

/// Sums over one region.
struct RegionSums {
  CompensatedSum volume;
  Point origin;
  bool has_origin = false;
  Box box;
  std::vector<std::uint8_t> has_patch;
};

std::string patches_text(const std::vector<std::string>& patches) {
  std::string text;
  for (std::size_t i = 0; i < std::min(patches.size(), k_named_patches); ++i) text += (i == 0 ? "\"" : ", \"") + patches[i] + "\"";
  return (patches.size() == 1 ? "patch " : "patches ") + text + (patches.size() > k_named_patches ? " and more" : "");
}

/// Sums the boundary faces by the part that contains their nodes.
std::vector<VolumeRegion> sum_up(const HybridMesh& mesh, const std::vector<std::uint32_t>& part) {
  std::map<std::uint32_t, RegionSums> sums;
  const auto add_face = [&](std::span<const NodeId> nodes, PatchId patch) {
    RegionSums& sum = sums[part[nodes[0].index()]];
    sum.has_patch.resize(mesh.patches.size(), 0);
    sum.has_patch[patch.index()] = 1;
    if (!sum.has_origin) sum.origin = mesh.points[nodes[0]];
    sum.has_origin = true;
    for (const NodeId node : nodes) sum.box.add(mesh.points[node]);
    for (std::size_t k = 2; k < nodes.size(); ++k)
      sum.volume.add(tet_volume(sum.origin, mesh.points[nodes[0]], mesh.points[nodes[k - 1]], mesh.points[nodes[k]]));
  };
  for (const BoundaryTriangle& face : mesh.boundary_triangles) add_face(face.nodes, face.patch);
  for (const BoundaryQuad& face : mesh.boundary_quads) add_face(face.nodes, face.patch);
  std::vector<VolumeRegion> regions;
  for (const auto& [root, sum] : sums) {
    VolumeRegion& made = regions.emplace_back(VolumeRegion{sum.volume.value(), sum.box, {}});
    for (const PatchId p : mesh.patches.ids())
      if (sum.has_patch[p.index()] != 0) made.patches.push_back(mesh.patches[p].name);
  }
  std::ranges::stable_sort(regions, std::ranges::greater(), &VolumeRegion::volume);
  return regions;
}

/// Returns true if fluid is inside a part of the boundary. A disc in the fluid has no volume except for rounding.
bool encloses_fluid(const VolumeRegion& shell) {
  const Vec3 sides = shell.box.max - shell.box.min;
  return shell.volume > k_region_rounding * sides.x * sides.y * sides.z;
}

}  // namespace

std::vector<VolumeRegion> volume_regions(const HybridMesh& mesh) {
  const std::vector<VolumeRegion> shells = sum_up(mesh, shell_of_nodes(mesh));
  const std::vector<std::uint32_t> one(mesh.points.size(), 0);
  // Each region is enclosed by one part of the boundary. Cells are therefore traversed only if several parts enclose fluid.
  return sum_up(mesh, std::ranges::count_if(shells, encloses_fluid) > 1 ? region_of_nodes(mesh) : one);
}

std::string describe_regions(const std::vector<VolumeRegion>& regions) {
  if (regions.size() < 2) return {};
  std::string text = std::to_string(regions.size()) + " that are not connected:";
  for (std::size_t i = 0; i < std::min(regions.size(), k_named_regions); ++i)
    text += (i == 0 ? " " : ", ") + number_text(regions[i].volume, k_volume_digits) + " m^3 (" + patches_text(regions[i].patches) + ")";
  return text + (regions.size() > k_named_regions ? ", ..." : "");
}

}  // namespace sterna
