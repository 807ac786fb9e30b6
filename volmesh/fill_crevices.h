// Fills narrow crevices and gaps of a wall: the space between walls that face each other at a small distance becomes solid. No boundary layer has room there,
// and solvers diverge beside vertices whose layer has no height (docs/crevices.md).
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

struct CreviceOptions {
  double width = k_automatic;
  double angle = 60.0 * std::numbers::pi / 180.0;
};

/// A connected region that became solid.
struct FilledCrevice {
  Point location;                    ///< m, centre of the largest tetrahedron
  Box box;                           ///< m
  double volume = 0.0;               ///< m^3
  double width = 0.0;                ///< m, largest thickness of its tetrahedra
  double distance = 0.0;             ///< m, largest distance of the new triangles from the given wall, at their middles and the middles of their edges
  std::int64_t n_tetrahedra = 0;     ///< in the region
  std::vector<std::string> patches;  ///< names of the walls around it, ascending
};

struct CreviceReport {
  std::vector<FilledCrevice> crevices;  ///< by descending volume
  double volume = 0.0;                  ///< m^3, of all crevices
  double distance = 0.0;                ///< m, largest of all crevices
  std::int64_t n_triangles_before = 0, n_triangles = 0;
  std::int64_t n_left = 0;  ///< tetrahedra that stay fluid although they are thin: the wall around them would not be manifold, or fluid would be enclosed
  std::vector<Point> left;  ///< m, centres of the first of these, at most k_max_locations
};

struct CreviceResult {
  TriMesh wall;  ///< patches as given, in the same order
  CreviceReport report;
};

/// Fills crevices and gaps. The fluid beside the wall is divided into tetrahedra whose nodes are the points of its boundary (geom/tets/recover.h). A
/// tetrahedron becomes solid if all of this holds: its nodes are on walls; its thickness (smallest of its heights and of the distances between opposite edges)
/// is at most `width`; two triangles at its nodes face each other, and no node of the tetrahedron is farther in front of either than `width`. Triangles face
/// each other if their normals enclose more than pi - `angle` and one lies over the other, along its normal and within `width`. Faces between solid and fluid
/// tetrahedra become wall triangles, with the patch of the wall nearest through the solid tetrahedra. This is repeated on the new wall until nothing changes.
/// \pre manifold, oriented, without self-intersection; closed, or open along boundaries in planes
/// \post the same; no vertex of the wall has moved; the wall is unchanged if nothing is filled
/// \throws Error(bad_argument) for a width that is not positive, or that would fill more than half of a region of the fluid; geometry_failed if the fluid cannot be divided; the errors of complete_boundary()
CreviceResult fill_crevices(const TriMesh& wall, const CreviceOptions& options, const RunContext& context);

/// Returns one line for each crevice, the largest first, at most `n` of them.
std::vector<std::string> to_lines(const CreviceReport& report, std::size_t n);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::CreviceOptions> {
  using O = volmesh::CreviceOptions;
  static constexpr std::string_view stage = "fill_crevices";
  static constexpr std::array fields = {
      Field<O>{.name = "width",
               .member = &O::width,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "largest distance between facing walls that is filled",
               .automatic = "none: a width is required",
               .required = true},
      Field<O>{.name = "angle",
               .member = &O::angle,
               .unit = Unit::radian,
               .min = 0.01,
               .max = 1.6,
               .help = "largest angle of fluid between facing walls that is filled; parallel walls enclose 0"},
  };
};

}  // namespace sterna
