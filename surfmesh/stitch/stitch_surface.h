// Converts triangle soups to a TriMesh that can be meshed. Welds vertices, drops duplicate and degenerate facets, orients facets and names patches. Reports
// remaining defects with their locations.
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
  double weld_tolerance = k_automatic;  ///< m; vertices with equal coordinates are always welded
  double split_angle = k_automatic;     ///< rad; automatic: patches by the names in the file, or one patch if there are none
  std::string fluid = "automatic";      ///< side of the outermost surface that contains the fluid; automatic: outside, unless sterna wrote the file and its
                                        ///< manifest states otherwise (the file reader handles this)
  bool allow_open = false;
  bool check_intersections = true;
  bool take_boundary = false;  ///< accept the boundary of a file with a volume mesh (evaluated by the file reader); if false, such a file is refused
};

struct StitchReport {
  std::int64_t n_triangles_read = 0, n_vertices_read = 0;
  std::int64_t n_welded_exact = 0, n_welded_near = 0;
  std::int64_t n_degenerate_removed = 0, n_duplicate_removed = 0, n_unused_vertices = 0;
  std::int64_t n_flipped = 0;  ///< number of triangles whose orientation was repaired
  std::int64_t n_components = 0;
  bool is_closed = true;
  std::vector<std::string> messages;  ///< one sentence for each repair, as written to the log
  std::vector<std::string> warnings;  ///< repairs that change the meaning of the geometry: parts turned into cavities, contacts opened; the caller logs them
};

struct StitchResult {
  TriMesh mesh;
  StitchReport report;
};

/// Joins the soups to one surface. The following defects are repaired, each with a message. Vertices are welded, and unused vertices are dropped. Facets with a
/// repeated vertex, copies of facets, doubled baffles without thickness, and closed parts without thickness are dropped. Facets of exactly zero area are
/// flipped away; the surface stays the same set of points. Inconsistent or inverted orientation is corrected. Closed components are oriented by signed volume
/// and nesting (winding numbers). A body is oriented outwards. A shell inside a body's solid becomes a cavity, whatever its orientation in the file (with a
/// message, because the outer flow does not reach it). A shell in a cavity is a body again. With fluid = "inside" the outermost shells enclose the fluid (a
/// tunnel, a complete domain): they are oriented inwards, and the shells in them are bodies. Open components keep the orientation of most of their area.
/// Automatic welding of vertices with different coordinates happens only if the surface is open, and only between vertices of its boundary within 1e-9 of the
/// body length (files in single precision: 2.5e-7 of the largest coordinate). It must close edges and must not cause another defect, so small features stay.
/// Patch names are unique and consist of [A-Za-z0-9_.-]. Without names in the file the patch is "wall", or with several files the file's stem. Patches split by
/// angle are named name_1, name_2 and so on.
/// \post The surface is closed (unless allow_open), manifold and without self-intersection; normals point out of the body. Patch names are unique, and every
/// vertex is used.
/// \throws Error with the number of locations, the coordinates (metres) of the first few, the names of facets, a drawing and a hint. The first of the following
/// errors that applies is thrown, and its text names the others: file_malformed (index out of range, coordinate not finite); empty_surface;
/// non_manifold_surface (places = edges with more than two facets, and vertices with several fans of one component); open_surface (places = edges with one
/// facet); non_manifold_surface (places = such vertices only); not_orientable (places = components); self_intersection (places = pairs of facets that meet in
/// more than they share, and zero-area facets that cannot be flipped; exact test on the final coordinates). Also bad_argument for a weld_tolerance above 2 % of
/// the body length.
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
