// Converts triangle soups to a TriMesh that can be meshed: welds, drops duplicate and degenerate facets, orients, names patches; or reports defects with
// locations.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

struct StitchOptions {
  double unit = 1.0;                    ///< metres per file unit
  double weld_tolerance = k_automatic;  ///< m; exact duplicates are always welded
  double split_angle = k_automatic;     ///< rad; automatic = patches from the file's names, else one patch
  std::string fluid = "automatic";  ///< side of the outermost surface on which the fluid is; automatic: outside, unless sterna wrote the file and its manifest
                                    ///< states otherwise (the file reader handles this)
  bool allow_open = false;
  bool check_intersections = true;
  bool take_boundary = false;  ///< accept the boundary of a file with a volume mesh (evaluated by the file reader); else such a file is refused
};

struct StitchReport {
  std::int64_t n_triangles_read = 0, n_vertices_read = 0;
  std::int64_t n_welded_exact = 0, n_welded_near = 0;
  std::int64_t n_degenerate_removed = 0, n_duplicate_removed = 0, n_unused_vertices = 0;
  std::int64_t n_flipped = 0;  ///< triangles whose orientation was repaired
  std::int64_t n_components = 0;
  bool is_closed = true;
  std::vector<std::string> messages;  ///< one sentence for each repair, as logged
  std::vector<std::string> warnings;  ///< repairs that change the meaning of the geometry: parts turned into cavities, contacts opened; the caller logs them
};

struct StitchResult {
  TriMesh mesh;
  StitchReport report;
};

/// Joins the soups to one surface. Repairs, each with a message: welding; unused vertices dropped; facets with a repeated vertex, copies of facets, doubled
/// baffles without thickness and closed parts without thickness dropped; facets of exactly zero area flipped away (the surface stays the same set of points);
/// inconsistent or inverted orientation. Closed components are oriented by signed volume and nesting (winding numbers): a body outwards; a shell inside a
/// body's solid as a cavity in it, whatever its sense in the file (with a message: the outer flow does not reach it); a shell in a cavity as a body again.
/// With fluid = "inside" the outermost shells enclose the fluid (a tunnel, a complete domain): they are oriented inwards, the shells in them as bodies. Open
/// components keep the sense of most of their area. Automatic welding beyond equal coordinates happens only if the surface is open, only between vertices of
/// its boundary, within 1e-9 of the body length (files in single precision: 2.5e-7 of the largest coordinate), and only if that closes edges without making
/// another defect; so small features survive.
/// Patches: [A-Za-z0-9_.-], unique; without names in the file "wall", with several files the file's stem; split by angle: name_1, name_2 ...
/// \post closed (unless allow_open), manifold, no self-intersection, normals out of the body; patch names unique; every vertex used.
/// \throws Error with number of locations, coordinates (metres) of the first few, facets by name, geometry, hint. The first that applies, the others in its
/// text:
///   file_malformed (index out of range, coordinate not finite), empty_surface,
///   non_manifold_surface (places = edges with more than two facets + vertices with several fans of one component),
///   open_surface (places = edges with one facet), non_manifold_surface (only such vertices), not_orientable (places = components),
///   self_intersection (places = pairs of facets that meet in more than they share + zero-area facets that cannot be flipped; exact, on the final coordinates);
///   bad_argument for a weld_tolerance above 2 % of the body length.
StitchResult stitch_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::StitchOptions> {
  using O = surfmesh::StitchOptions;
  static constexpr std::string_view stage = "surface";
  static constexpr std::array fields = {
      Field<O>{.name = "unit",
               .member = &O::unit,
               .unit = Unit::metre,
               .min = 1e-9,
               .max = 1e9,
               .help = "length of one unit of the file (mm, cm, inch, ft are numbers)"},
      Field<O>{.name = "weld_tolerance",
               .member = &O::weld_tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "vertices closer than this are merged",
               .automatic = "equal coordinates; if the surface is then open, its boundary within 1e-9 of the body length, 2.5e-7 for single precision"},
      Field<O>{.name = "split_angle",
               .member = &O::split_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 3.15,
               .help = "split into patches along edges that bend by more than this",
               .automatic = "patches as named in the file, else one patch"},
      Field<O>{.name = "fluid",
               .member = &O::fluid,
               .help = "side of the outermost surface on which the fluid lies: around bodies, or inside a tunnel or a complete domain. automatic: outside, "
                       "unless the manifest beside the file has another value",
               .choices = "automatic outside inside"},
      Field<O>{.name = "allow_open", .member = &O::allow_open, .help = "accept a surface with an open boundary"},
      Field<O>{.name = "check_intersections", .member = &O::check_intersections, .help = "test every pair of triangles exactly for intersection"},
      Field<O>{
          .name = "take_boundary",
          .member = &O::take_boundary,
          .help = "read the whole boundary of a volume mesh as the surface, including farfield and planes; if false, files with a volume mesh are rejected"},
  };
};

}  // namespace sterna
