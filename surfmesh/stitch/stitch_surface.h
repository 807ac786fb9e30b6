// From triangle soups to a TriMesh that can be meshed: weld, drop duplicate and degenerate facets, orient, name patches; or say what is wrong and where.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

struct StitchOptions {
  double unit = 1.0;                      ///< metres per file unit
  double weld_tolerance = k_automatic;    ///< m; exact duplicates are always welded
  double split_angle = k_automatic;       ///< rad; automatic = patches from the file's names, else one patch
  bool allow_open = false;
  bool check_intersections = true;
};

struct StitchReport {
  std::int64_t n_triangles_read = 0, n_vertices_read = 0;
  std::int64_t n_welded_exact = 0, n_welded_near = 0;
  std::int64_t n_degenerate_removed = 0, n_duplicate_removed = 0, n_unused_vertices = 0;
  std::int64_t n_flipped = 0;             ///< triangles whose orientation was repaired
  std::int64_t n_components = 0;
  bool is_closed = true;
  std::vector<std::string> messages;      ///< one sentence for each repair, as logged
};

struct StitchResult {
  TriMesh mesh;
  StitchReport report;
};

/// Joins the soups to one surface. Repairs (each with a message): welding, unused vertices, duplicate and degenerate facets, inconsistent or inverted
/// orientation (winding number; a closed shell inside another's solid keeps its cavity sense).
/// \post closed (unless allow_open), manifold, no self-intersection, normals out of the body; patch names unique; every vertex used.
/// \throws Error empty_surface, open_surface, non_manifold_surface, self_intersection, not_orientable: number of places, coordinates of the first few, geometry.
StitchResult stitch_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::StitchOptions> {
  using O = surfmesh::StitchOptions;
  static constexpr std::string_view stage = "surface";
  static constexpr std::array fields = {
      Field<O>{.name = "unit", .member = &O::unit, .unit = Unit::metre, .min = 1e-9, .max = 1e9, .help = "length of one unit of the file (mm, cm, inch, ft are numbers)"},
      Field<O>{.name = "weld_tolerance", .member = &O::weld_tolerance, .unit = Unit::metre, .min = 0.0, .help = "vertices nearer than this become one",
               .automatic = "exact duplicates, then 1e-9 of the body length (1e-7 for single-precision files)"},
      Field<O>{.name = "split_angle", .member = &O::split_angle, .unit = Unit::radian, .min = 0.0, .max = 3.15, .help = "split into patches along edges that bend by more than this",
               .automatic = "patches as named in the file, else one"},
      Field<O>{.name = "allow_open", .member = &O::allow_open, .help = "accept a surface with a boundary"},
      Field<O>{.name = "check_intersections", .member = &O::check_intersections, .help = "test every pair of triangles exactly for intersection"},
  };
};

}  // namespace sterna
