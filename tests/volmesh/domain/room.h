// A room whose sides have any patch kind, with bodies of blocks in it, and functions to count in its meshes.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>

#include "tests/support/voxels.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

inline MeshCase layers(int n, double first_height) {
  MeshCase options;
  options.envelope.layers = n;
  options.envelope.first_height = first_height;
  return options;
}

/// A room of 4 x 2 x 2 m: inlet at x = 0, outlet at x = 4; `kind_of` gives the kind of the other sides by name: floor, ceiling, left, right.
inline TriMesh room(const std::function<PatchKind(const std::string&)>& kind_of, const std::function<bool(int, int, int)>& is_solid = {}) {
  const std::array<int, 3> n = {24, 12, 12};
  const double size = 1.0 / 6.0;
  return test::voxel_boundary(
      n, size, [&](int i, int j, int k) { return !is_solid || !is_solid(i, j, k); },
      [&](const Point& p, const Vec3& normal) -> Patch {
        if (p.x == 0.0) return {"inlet", PatchKind::inflow};
        if (p.x == 4.0) return {"outlet", PatchKind::outflow};
        const std::string name = p.z == 0.0 && normal.z > 0.0 ? "floor" : p.z == 2.0 ? "ceiling" : p.y == 0.0 ? "left" : p.y == 2.0 ? "right" : "model";
        return {name, name == "model" ? PatchKind::wall : kind_of(name)};
      });
}

/// Counts the boundary quadrilaterals of a patch over the layers: edges of the footprint in the patch.
inline std::map<std::string, std::size_t> border_edges(const VolumeMeshResult& result) {
  std::map<std::string, std::size_t> n;
  for (const BoundaryQuad& quad : result.mesh.boundary_quads) ++n[result.mesh.patches[quad.patch].name];
  for (auto& [name, count] : n) count /= static_cast<std::size_t>(result.mesh.layers.n_layers);
  return n;
}

using Edges = std::map<std::string, std::size_t>;

}  // namespace sterna::volmesh
