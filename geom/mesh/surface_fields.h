// Figures of every boundary face, for pictures and reports: shape of the face, and properties of the layer on it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Fixed properties of a field; names and limits in the unit of reports.
struct SurfaceFieldInfo {
  std::string_view name;   ///< "layer_height"
  std::string_view title;  ///< human-readable
  std::string_view unit;   ///< "m", "deg" or ""
  bool is_log;             ///< spans decades: coloured by its logarithm
  bool is_low_bad;
  GateLimits limits;  ///< limits of the corresponding gate; NaN if there is none
  bool is_of_layer;   ///< defined only for faces under a layer
};

struct SurfaceField {
  SurfaceFieldInfo info;
  std::vector<double> values;  ///< one per face; NaN if the field is not defined for the face
};

/// Returns all fields, in the order of surface_fields():
///   edge_length   mean of the face's edges, m
///   min_angle     smallest corner angle, degrees
///   aspect        triangles: longest edge over the height on it, times sqrt(3)/2 (regular: 1); quads: longer over shorter mean of opposite edges
///   area_ratio    largest area ratio to a face across an edge (the larger over the smaller), among faces with as many corners and patches of the same kind
/// layer_height  mean over its three lines of the distance from the wall to the end of the line (collapsed lines count 0), m
///   first_height  mean length of the first step of its lines that are not collapsed, m
///   coverage      mean over its lines of height along the wall normal over target height, at most 1 each; only if the mesh has a layer request
///   layers        cells of the longest line
///   growth        largest ratio of consecutive heights along a line (G8)
///   skew          skew angle of the worst prism, degrees
///   stack_angle   largest of its three lines, degrees (G10)
///   interface_jump  last height against the height of a regular tet on the envelope's edge (G9)
///   scaled_jacobian  of the worst prism (G3)
std::span<const SurfaceFieldInfo> surface_field_table();

/// Computes the fields of the boundary faces: triangles, then quads. Layers of a mesh without columns are found by walking up prisms from the walls, as in
/// check(), which requires matching of all faces. Fields that are not available are NaN throughout. A column over a collapsed line has no skew,
/// interface_jump and scaled_jacobian; over three, its layer_height and layers are 0.
/// \throws Error(mesh_invalid) if indices are out of range or points are not finite
std::vector<SurfaceField> surface_fields(const HybridMesh& mesh, const RunContext& context);
/// Computes the fields of the face shapes.
std::vector<SurfaceField> surface_fields(const TriMesh& mesh, const RunContext& context);

/// Returns the field with this name, or nullptr.
const SurfaceField* find_field(std::span<const SurfaceField> fields, std::string_view name);

}  // namespace sterna
