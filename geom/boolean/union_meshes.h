// Union of triangulated solids: one wall from overlapping parts.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// A part: one or several closed surfaces, which may also cross each other.
struct UnionPart {
  std::string name;  ///< name for messages; prefix of patches whose name also occurs in another part
  TriMesh mesh;
};

struct UnionOptions {
  bool remesh = true;          ///< improve the triangles along the intersection curves
  double strip_width = 4.0;    ///< width of the remeshed strip on each side of the curve, in local edge lengths
  double strip_growth = 1.3;   ///< growth factor of edge lengths with the distance from the curve
  double deviation = 0.01;     ///< largest distance from the input surface, in local edge lengths
  bool keep_cavities = false;  ///< keep cavities enclosed by the parts
};

/// Quality of the triangles along the curves that the remesher may change.
struct StripQuality {
  std::int64_t n_triangles = 0;
  std::int64_t n_slivers = 0;  ///< triangles with an angle below k_sliver_angle
  double min_angle = 0.0;      ///< rad
  double shortest_edge = 0.0;  ///< m
};

/// rad, 5 degrees. A triangle with a smaller angle is a sliver; next to it wall layers rarely reach their full height.
inline constexpr double k_sliver_angle = 0.0873;

struct UnionReport {
  std::int64_t n_solids = 0;       ///< closed components of the parts
  std::int64_t n_vanished = 0;     ///< solids of which no triangle remains
  std::int64_t n_cavities = 0;     ///< enclosed cavities found
  std::int64_t n_components = 0;   ///< components of the result
  std::int64_t n_curve_edges = 0;  ///< edges of the intersection curves, before remeshing
  double curve_length = 0.0;       ///< m
  StripQuality before, after;
  std::int64_t n_split = 0, n_collapsed = 0, n_flipped = 0, n_moved = 0;
  double max_deviation = 0.0;         ///< m; between the result and the exact union of the input, sampled in both directions at vertices, edges and centres
  std::vector<std::string> messages;  ///< one sentence per notable event, as logged
};

struct UnionResult {
  TriMesh mesh;
  UnionReport report;
};

/// Unites closed parts. Each closed component of each part is a solid, whatever its orientation; the result is the surface of all points that are in at least
/// one solid. Solids that cross are united exactly (CGAL) in the order of parts and components, then rounded to doubles; solids inside others are removed, with
/// a message. Triangles away from the intersection curves are those of the input. Patches keep name and kind; a name used by two parts gets the part's name as
/// a prefix ("body_wall"). Deterministic, the same for any number of threads; a stop request in `context` is checked between solids and rounds.
/// \pre every part is edge-manifold, with a consistent orientation in each component (surfmesh::stitch_surface ensures that, without its test for crossings).
/// \post closed, manifold, no crossings, normals out of the solids, every vertex used.
/// \throws Error with locations: empty_surface (no triangle), open_surface (a part has a boundary), non_manifold_surface (an edge with more than two triangles;
/// or a pair of solids touches only in a point or along an edge, so that the union has no manifold surface), self_intersection (a component crosses itself,
/// naming part and location; or the result does, after rounding)
UnionResult unite_meshes(const std::vector<UnionPart>& parts, const UnionOptions& options, const RunContext& context);

template <>
struct Schema<UnionOptions> {
  using O = UnionOptions;
  static constexpr std::string_view stage = "union";
  static constexpr std::array fields = {
      Field<O>{.name = "remesh", .member = &O::remesh, .help = "improve the triangles along the curves in which parts cross"},
      Field<O>{.name = "strip_width",
               .member = &O::strip_width,
               .min = 0.0,
               .max = 100.0,
               .help = "distance from the curve within which triangles may change, in local edge lengths"},
      Field<O>{.name = "strip_growth", .member = &O::strip_growth, .min = 1.0, .max = 3.0, .help = "growth of edge lengths away from the curve"},
      Field<O>{.name = "deviation",
               .member = &O::deviation,
               .min = 0.0,
               .max = 0.2,
               .help = "largest distance of remeshed triangles from the input, in local edge lengths"},
      Field<O>{.name = "keep_cavities", .member = &O::keep_cavities, .help = "keep cavities that the parts enclose and the outer flow does not reach"},
  };
};

}  // namespace sterna
