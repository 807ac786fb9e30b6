// Private to geom/boolean: separates the parts into closed components, each a solid, and finds the solids that cross.
#pragma once

#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/boolean/cgal_corefine.h"
#include "geom/boolean/remesh_strip.h"
#include "geom/boolean/union_meshes.h"

namespace sterna {

/// Data of an input triangle; the tags of TaggedSolid number the triangles consecutively through all parts.
struct InputFacet {
  std::uint32_t solid = 0;
  std::uint32_t region = 0;  ///< index of the combination of solid and patch
  Vec3 normal;               ///< unit, out of the solid
  LocalLength length;
};

struct Solid {
  std::size_t part = 0;
  std::uint32_t number = 0;  ///< within the part, from 0
  TaggedSolid surface;       ///< normals outwards
  Box box;
};

struct SolidParts {
  std::vector<Solid> solids;                       ///< in the order of parts and components
  std::vector<InputFacet> facets;                  ///< by tag
  std::vector<Patch> region_patch;                 ///< by region; names as in the result
  std::vector<std::string> names;                  ///< names of the solids for messages: "body.stl", "component 3 of body.stl (124 triangles about (0, 1, 0))"
  std::vector<std::vector<std::uint32_t>> groups;  ///< solids connected by crossings, ascending; groups ordered by first member
  std::vector<std::array<std::uint32_t, 2>> crossings;  ///< pairs of facets of different solids that intersect
};

/// \throws Error empty_surface, open_surface, non_manifold_surface, self_intersection (a solid with itself)
SolidParts find_solids(const std::vector<UnionPart>& parts, UnionReport& report, const RunContext& context);

/// Adds the locations of some of the crossings, and their triangles as geometry, to an error's info.
void add_crossing_locations(ErrorInfo& info, const SolidParts& parts, const std::vector<std::array<std::uint32_t, 2>>& crossings);

/// Returns the signed volume, m^3.
double volume_of(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sterna
