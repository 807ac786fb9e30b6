// Figures of every boundary face, for pictures and reports: shape of the face, and the layer that stands on it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// What is fixed of a field; names and limits in the unit of reports.
struct SurfaceFieldInfo {
  std::string_view name;   ///< "layer_height"
  std::string_view title;  ///< for people
  std::string_view unit;   ///< "m", "deg" or ""
  bool is_log;             ///< spans decades: colours by its logarithm
  bool is_low_bad;
  GateLimits limits;  ///< of the gate that judges it; NaN where there is none
  bool is_of_layer;   ///< only faces under a layer have it
};

struct SurfaceField {
  SurfaceFieldInfo info;
  std::vector<double> values;  ///< one per face; NaN where the face has no such figure
};

/// All fields, in the order in which surface_fields() gives them:
///   edge_length   mean of the face's edges, m
///   min_angle     smallest corner angle, degrees
///   aspect        triangles: longest edge over the height on it, times sqrt(3)/2 (regular: 1); quads: longer over shorter mean of opposite edges
///   area_ratio    largest ratio of areas to a face across an edge (the larger over the smaller), among faces of as many corners whose patches are of one kind
///   layer_height  mean of its three lines from the wall to the end (chords; collapsed lines count 0), m
///   first_height  mean length of the first step of its lines that stand, m
///   coverage      mean of height along the wall's normal over target height of its lines, at most 1 each; only where the mesh says what was asked for
///   layers        cells of the longest line
///   growth        largest ratio of consecutive heights along a line (G8)
///   skew          skew angle of the worst prism, degrees
///   stack_angle   largest of its lines, degrees (G10)
///   interface_jump  last height against a regular tet on the envelope's edge (G9)
///   scaled_jacobian  of the worst prism (G3)
std::span<const SurfaceFieldInfo> surface_field_table();

/// Fields of the boundary faces: triangles, then quads. A mesh without columns has its layers found by walking prisms up from walls, as check() does, which
/// costs the matching of all faces; fields that it cannot have are NaN throughout.
/// A column over a collapsed line has no skew, interface_jump and scaled_jacobian; over three, its layer_height and layers are 0.
/// \throws Error(mesh_invalid) when indices are out of range or points not finite
std::vector<SurfaceField> surface_fields(const HybridMesh& mesh, const RunContext& context);
/// Those of the faces' shape.
std::vector<SurfaceField> surface_fields(const TriMesh& mesh, const RunContext& context);

/// nullptr when there is none of this name.
const SurfaceField* find_field(std::span<const SurfaceField> fields, std::string_view name);

}  // namespace sterna
