// Converts arbitrarily torn triangle soups to a closed surface around them. Makes an alpha wrap, and fits it back onto the input with its sharp edges and
// patches.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

struct WrapOptions {
  double edge = k_automatic;       ///< m; approximate size of triangles, which are smaller where the input bends
  double gap = k_automatic;        ///< m; openings up to this width are closed
  double tolerance = k_automatic;  ///< m; limit of the distance from the wrap to the input, except on closures
  double offset = k_automatic;     ///< m; approximate thickness of baffles in the result
  double features = 0.698;         ///< rad, default 40 degrees; edges of the input that bend by more are sharp
  std::string half = "automatic";  ///< automatic: a surface that is open in a plane x, y or z = constant is half of a model
  int max_triangles = 3'000'000;
  double unit = 1.0;                 ///< metres per file unit
  double split_angle = k_automatic;  ///< rad
  std::string fluid = "automatic";   ///< side of the outermost surface that contains the fluid
};

/// A closed opening, or a groove too narrow for the wrap.
struct WrapClosure {
  Vec3 position;           ///< m, middle of the closure
  double size = 0.0;       ///< m, longest side of its box
  double area = 0.0;       ///< m^2
  double distance = 0.0;   ///< m, largest distance from the input
  bool is_opening = true;  ///< its boundary is a border of the input; false: a groove, or a corner between parts
};

/// An opening wider than `gap`, behind which the wrap lies on the inner side of the input.
struct WrapLeak {
  Vec3 position;      ///< m, location where the wrap enters the opening
  double area = 0.0;  ///< m^2, area of the wrap inside
};

/// Triangles of the wrap at closures and leaks, for drawing. For a half model only those of the given half.
struct WrapDrawing {
  std::vector<Vec3> points;  ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Quality of the wrap: numbers of triangles by their smallest angle.
struct WrapQuality {
  double min_angle = 0.0;          ///< rad
  std::int64_t n_below_15 = 0;     ///< number of triangles with an angle below 15 degrees
  std::int64_t n_at_features = 0;  ///< number of these triangles that have a corner on a sharp edge
};

struct WrapReport {
  std::int64_t n_facets_read = 0;
  std::int64_t n_triangles = 0, n_vertices = 0, n_components = 0;
  std::int64_t expected_triangles = 0;                          ///< number of triangles estimated before wrapping
  double edge = 0.0, gap = 0.0, tolerance = 0.0, offset = 0.0;  ///< m, values used
  std::int64_t n_feature_edges = 0;                             ///< number of sharp edges and patch borders of the input
  std::int64_t n_on_features = 0;                               ///< number of vertices of the wrap on these edges
  std::int64_t n_off_input = 0;                                 ///< number of vertices that could not be moved back within the tolerance
  double to_input = 0.0;                                        ///< m; largest distance of samples of the wrap from the input, outside of closures
  double to_input_closed = 0.0;                                 ///< m; the same distance on closures
  double from_input = 0.0;                                      ///< m; largest distance of samples of the input that are not inside the wrap
  std::int64_t n_beyond_tolerance = 0;                          ///< number of triangles outside of closures that are farther from the input than the tolerance
  Vec3 farthest;                                                ///< m, farthest location on the wrap outside of closures
  std::int64_t n_inside = 0;                                    ///< number of facets of the input inside the wrap: inner parts, walls of closed volumes
  double inside_area = 0.0;                                     ///< m^2
  std::int64_t n_closures = 0;                                  ///< total number; `closures` contains the largest ones
  std::vector<WrapClosure> closures;                            ///< sorted by falling size, at most k_max_closures
  std::vector<WrapLeak> leaks;                                  ///< sorted by falling area
  std::string half_axis;                                        ///< axis "x", "y" or "z" of a half model; empty if it is none
  double half_at = 0.0;                                         ///< m, coordinate of the plane
  double half_moved = 0.0;                                      ///< m, largest distance of the input's boundary from the plane before it was moved there
  WrapDrawing drawing;
  WrapQuality quality;
  std::vector<std::string> messages;  ///< sentences for the user, as written to the log
};

inline constexpr std::size_t k_max_closures = 50;

struct WrapResult {
  TriMesh mesh;
  WrapReport report;
};

/// Wraps the soups by an alpha wrap with a ball of the edge's size. Openings between edge and gap are first closed by a coarser wrap. The vertices of the wrap
/// are moved back onto the input and onto its sharp edges, unless a self-intersection would result. Edges that are farther from the input than the tolerance
/// are split. Triangles are improved, and each gets the patch of the nearest input facet. The only requirement for the soups is that coordinates are finite.
/// Inner parts vanish. A surface that is open in a plane x, y or z = constant by more than `gap` is a half model: it is mirrored, wrapped, and cut in the
/// plane. Deterministic; the result does not depend on the number of threads. Can be cancelled between points and between steps.
/// \post The result is closed (a half model is open exactly in its plane, and only there), manifold, and free of self-intersection by the exact test. Normals
/// point into the fluid. Patch names are unique, and every vertex is used.
/// \throws Error(file_malformed) (index out of range, coordinate not finite); empty_surface; bad_argument for an edge that gives more than max_triangles (with
/// the number), or a gap below the edge; self_intersection or open_surface if the final check fails
WrapResult wrap_surface(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, const RunContext& context);

/// Estimate of a wrap, made before the work.
struct WrapEstimate {
  double edge = 0.0;             ///< m
  double widest_gap = 0.0;       ///< m; openings wider than this leak. An automatic gap is increased up to this value
  std::int64_t n_triangles = 0;  ///< estimated number, within a factor of 3; features and curvature add some
};
/// Estimates a wrap for facets of the given area (m^2) and a body of the given length (m).
WrapEstimate estimate_wrap(double area, double length, const WrapOptions& options);

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::WrapOptions> {
  using O = surfmesh::WrapOptions;
  static constexpr std::string_view stage = "wrap";
  static constexpr std::array fields = {
      Field<O>{.name = "edge",
               .member = &O::edge,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "edge length of the triangles; smaller where the input bends",
               .automatic = "about 60 000 triangles, between 1/400 and 1/50 of the body length"},
      Field<O>{.name = "gap",
               .member = &O::gap,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "width of the widest openings that are closed",
               .automatic = "twice the edge, at least 2 % of the body length; doubled, up to 16 %, while the wrap enters the inside"},
      Field<O>{.name = "tolerance",
               .member = &O::tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "largest distance of the wrap from the input, except at closed openings",
               .automatic = "a tenth of the edge"},
      Field<O>{.name = "offset",
               .member = &O::offset,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "distance at which the wrap is made before it is moved onto the input; about the thickness of wrapped sheets",
               .automatic = "1/20 of the edge"},
      Field<O>{.name = "features",
               .member = &O::features,
               .unit = Unit::radian,
               .min = 0.1,
               .max = 3.15,
               .help = "edges of the input that bend by more than this stay sharp"},
      Field<O>{.name = "half",
               .member = &O::half,
               .help = "automatic: treat a surface that is open in a plane x, y or z = constant by more than the gap as a half model; never: close it",
               .choices = "automatic never"},
      Field<O>{
          .name = "max_triangles", .member = &O::max_triangles, .min = 100, .help = "largest number of triangles; an edge length that gives more is an error"},
      Field<O>{.name = "unit",
               .member = &O::unit,
               .unit = Unit::metre,
               .min = 1e-9,
               .max = 1e9,
               .help = "length of one unit of the file (mm, cm, inch, ft are numbers)"},
      Field<O>{.name = "split_angle",
               .member = &O::split_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 3.15,
               .help = "split into patches along edges that bend by more than this",
               .automatic = "patches as named in the file, else one patch"},
      Field<O>{.name = "fluid",
               .member = &O::fluid,
               .help = "side of the outermost surface on which the fluid lies: wrapped from outside, or from within a tunnel. automatic: outside",
               .choices = "automatic outside inside"},
  };
};

}  // namespace sterna
