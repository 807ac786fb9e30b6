// Meshes a model as one watertight triangulation: computes sizes, cuts each edge once, meshes the faces in parallel and joins them (docs/method/surface.md).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/rules.h"
#include "geom/base/run_context.h"
#include "geom/mesh/periodic_names.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/deform.h"
#include "geom/model/model.h"
#include "surfmesh/model/background_sizes.h"
#include "surfmesh/model/size_options.h"

namespace sterna::surfmesh {

struct SurfaceMeshOptions {
  SurfaceSizeOptions sizes;
  double leading_edge_factor = 0.5;
  double trailing_edge_factor = 0.5;
  bool tip_strips = true;
  double intersection_factor = 0.5;
  std::string crossings = "error";
  std::string failed_faces = "error";
  double trailing_edge_cells = k_automatic;
  std::vector<PeriodicNames> periodic;
};

/// Target edge lengths in space, independent of faces. They are also divided by `refinement`.
struct SpaceSizes {
  /// Returns the target length in m, for a point and the change of length per distance. The length grows with distance and is infinite where there is no
  /// target. Thread-safe.
  std::function<double(const Point&, double)> regions;
  /// Returns the target length in m, > 0; called only by the thread that called mesh_model; may be discontinuous.
  std::function<double(const Point&)> function;
  std::vector<SizePoint> samples;  ///< targets at single points; the smallest applies
};

/// Location of a vertex on an edge of the model. Without edge the vertex is a corner or lies inside a face.
struct EdgeLocation {
  EdgeId edge;
  double t = 0.0;
};

struct FaceMeshSummary {
  FaceId face;
  std::string name;
  std::int64_t n_triangles = 0;
  std::int64_t n_band = 0;  ///< number of these triangles in bands and strips; the angles below exclude them
  double min_angle = 0.0;   ///< rad
  double max_angle = 0.0;
  Point worst_location{};             ///< location of the smallest angle
  std::int64_t n_outside_20_130 = 0;  ///< number of triangles with an angle outside [20, 130] degrees
  double max_normal_angle = 0.0;      ///< rad: largest angle between a triangle and the surface at one of its corners
  Point normal_location{};
  double curvature_angle = 0.0;  ///< rad: target for max_normal_angle
  double area = 0.0;             ///< m^2, area of its triangles
  double area_above = 0.0;       ///< m^2, area of the triangles whose normals deviate by more than curvature_angle
};

/// An entity of the model that the mesh does not resolve.
struct AbsorbedPart {
  std::string what;  ///< such as "edge shorter than its tolerance", with the names of faces
  Point location;
  double size = 0.0;  ///< metres
};

/// Two faces whose triangles cross, or one face with self-crossing triangles.
struct CrossingFaces {
  FaceId first, second;
  std::int64_t n_pairs = 0;
  Point location{};          ///< location of the first pair
  bool is_one_part = false;  ///< both faces belong to one solid, or to one open part
  bool is_closed = false;    ///< the parts of both faces are closed
};

/// An edge whose vertices are farther from an adjacent face than the model's tolerances allow.
struct LooseEdge {
  EdgeId edge;
  FaceId face;
  double distance = 0.0;   ///< m, largest distance of its vertices
  double tolerance = 0.0;  ///< m: largest of the tolerances of the edge, its corners and the face
  Point location{};
};

/// Bands along leading and trailing edges, and strips on the bases of blunt trailing edges.
struct BandSummary {
  std::int64_t n_edges = 0;   ///< model edges with rows beside them
  std::int64_t n_strips = 0;  ///< bases with a strip
  std::int64_t n_triangles = 0;
  double max_stretch = 0.0;        ///< cells in rows: largest ratio of length along the edge to height across it
  double max_strip_stretch = 0.0;  ///< the same ratio for cells on bases
  double max_growth = 0.0;         ///< largest ratio of consecutive row heights
  std::vector<std::string> notes;  ///< requirements that could not be met, and locations where rows had to be omitted
};

struct SurfaceMeshReport {
  std::vector<FaceMeshSummary> faces;  ///< summaries in the order of the model's faces
  std::vector<AbsorbedPart> absorbed;
  double min_angle = 0.0;  ///< rad; this value and the next three describe isotropic triangles, without those of bands
  double max_angle = 0.0;
  double mean_radius_ratio = 0.0;              ///< mean weighted by area of 2 r / R, which is 1 for an equilateral triangle
  std::array<std::int64_t, 6> least_angles{};  ///< numbers of triangles by their smallest angle: below 10 degrees, below 20, and so on up to 60
  double angle_quantile_1 = 0.0;               ///< rad: 1 % of the triangles have their smallest angle below this value
  double share_20_130 = 1.0;                   ///< fraction of the triangles whose angles are all within [20, 130] degrees
  FaceId worst_face;                           ///< face with the smallest angle min_angle
  double max_edge_distance = 0.0;              ///< metres: largest distance of a vertex on an edge from an adjacent face
  Point edge_distance_location{};
  std::vector<LooseEdge> loose_edges;  ///< sorted by falling ratio of distance to tolerance
  FaceId worst_normal_face;            ///< face whose normals exceed the curvature angle by most; invalid if none does
  double share_normals = 1.0;     ///< fraction of the area covered by triangles that are within the curvature angle of the surface's normals at their corners
  double max_smooth_angle = 0.0;  ///< rad: largest turn between two triangles where the model has no crease; a feature angle must exceed it
  Point smooth_angle_location{};
  std::int64_t n_free_edges = 0;         ///< number of free edges of triangles, which lie along free edges of the model
  int n_rounds = 1;                      ///< rounds of meshing; above 1 if regions had to be refined to become valid
  std::int64_t n_crossings = 0;          ///< pairs of triangles that cross and could not be separated by refinement
  std::vector<CrossingFaces> crossings;  ///< sorted by falling number; from the first 100 000 pairs only
  BandSummary bands;
};

/// A surface mesh with the model locations of its vertices.
struct SurfaceMesh {
  TriMesh mesh;  ///< one patch per face name. Vertices: corners, then edges, then inner ones; if parts were joined, part by part (join_parts.h)
  Column<VertexId, VertexLocation> locations;  ///< a vertex on an edge has its place on the first face that uses it
  Column<VertexId, EdgeLocation> edge_locations;
  Column<CornerId, VertexId> corner_vertices;  ///< vertex of each corner of the model; invalid if no triangle has it
  Column<TriangleId, FaceId> triangle_face;
  Column<TriangleId, std::uint8_t> is_band;  ///< true for triangles laid in rows, possibly stretched
  SurfaceMeshReport report;
};

/// Meshes a whole model. Vertices inside faces lie exactly on their surface, and vertices on edges exactly on the edge's curve. Corners are those of the model.
/// Normals point outwards as defined by the model's faces. Closed models give closed meshes. The boundary loops of other meshes are the model's free edges.
/// \throws Error(geometry_failed) naming the faces that cannot be meshed, with locations; Error(bad_argument) for sizes that are not positive, a rule that
/// matches no face's name, or sides of `periodic` that are not images of each other; Error(overflow) for more than max_triangles, before meshing if sizes and
/// areas predict it; Error(non_manifold_surface) if triangles of faces do not join; Error(self_intersection) for crossing triangles that refinement does not
/// separate, unless options.crossings allows them
SurfaceMesh mesh_model(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, const RunContext& context);
SurfaceMesh mesh_model(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                       const RunContext& context);

/// Returns several human-readable lines.
std::string to_text(const SurfaceMeshReport& report);

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::SurfaceMeshOptions> {
  using O = surfmesh::SurfaceMeshOptions;
  static constexpr std::string_view stage = "surface_mesh";
  static constexpr surfmesh::SizeTexts texts = {
      .automatic_max_edge =
          "8 % of the mean circumference of bodies, 15 % of the mean chord of wings, else 2 % of the component's longest side and a quarter "
          "of the root of each face's area",
      .automatic_min_edge =
          "2 % of the longest edge, at least 1e-5 of the model's length; half where an edge would span more than 30 degrees, less where "
          "chord_error needs it",
      .chord_error = "largest distance between the middle of a triangle and the surface; smaller details need not be resolved",
      .narrow = "largest edge length along a narrow face, in widths of the face (never below a fifth of min_edge)",
      .gap_cells = "number of edges across a gap between opposite faces; 0: gaps are ignored"};
  static constexpr std::array wing_fields = {
      Field<O>{.name = "leading_edge_factor",
               .member = &O::leading_edge_factor,
               .min = 0.01,
               .max = 1.0,
               .help = "edge length at leading edges of wings made of sections, relative to the longest edge; increases to 1 at half of the chord"},
      Field<O>{.name = "trailing_edge_factor",
               .member = &O::trailing_edge_factor,
               .min = 0.01,
               .max = 1.0,
               .help = "edge length at trailing edges of wings made of sections, relative to the longest edge"},
      Field<O>{.name = "tip_strips",
               .member = &O::tip_strips,
               .help = "wings made of sections: 0.4 of the longest edge within 3 % of the span from the tips, 0.6 within 6 %"},
      Field<O>{.name = "intersection_factor",
               .member = &O::intersection_factor,
               .min = 0.01,
               .max = 1.0,
               .help = "edge length where components of a union meet, relative to the longest edge of their faces"},
  };
  static constexpr std::array failure_fields = {
      Field<O>{.name = "crossings",
               .member = &O::crossings,
               .help = "crossing triangles are refined; remaining crossings are an error (error) or kept with a warning (warn); ignore: no test for crossings",
               .choices = "error warn ignore"},
      Field<O>{.name = "failed_faces",
               .member = &O::failed_faces,
               .help = "a face that cannot be meshed is an error, or is left as a hole with a warning; --auto leaves holes and fills them",
               .choices = "error hole"},
  };
  static constexpr std::array base_fields = {
      Field<O>{.name = "trailing_edge_cells",
               .member = &O::trailing_edge_cells,
               .min = 1.0,
               .max = 100.0,
               .help = "number of cells across the base of blunt trailing edges (rounded to a whole number)",
               .automatic = "from the edge length; with rows from their first cell"},
  };
  static constexpr std::array side_fields = {
      Field<O>{.name = "periodic",
               .member = text_option<&O::periodic, side_pairs, side_pairs_text>(),
               .help = "pairs of flat faces that are translated images of each other: \"left,right; floor,ceiling\"; their borders are divided alike"},
  };
  static constexpr auto fields = joined(surfmesh::length_fields<O>(texts), wing_fields, surfmesh::gap_fields<O>(texts), failure_fields,
                                        surfmesh::count_fields<O>(), base_fields, surfmesh::edge_row_fields<O>(), side_fields);
};

}  // namespace sterna
