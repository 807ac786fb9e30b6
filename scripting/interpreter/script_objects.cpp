#include "scripting/interpreter/script_objects.h"

#include <array>

#include "scripting/interpreter/script_verbs.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/verbs/component_verbs.h"
#include "scripting/verbs/geometry_verbs.h"
#include "scripting/verbs/model_methods.h"
#include "scripting/verbs/stage_verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::array k_surface_fields = {
    FieldDoc{"triangles", "their number"},
    FieldDoc{"vertices", "their number"},
    FieldDoc{"length", "longest side of the bounding box, m"},
    FieldDoc{"is_closed", "true if there is no open edge"},
    FieldDoc{"patches", "list of the patches' names"},
    FieldDoc{"min_angle", "smallest angle of a triangle, rad; only for results of surface_mesh"},
    FieldDoc{"max_angle", "largest angle of a triangle, rad; only for results of surface_mesh"},
    FieldDoc{"share_20_130", "fraction of the triangles with all angles in 20 .. 130 deg; only for results of surface_mesh"},
    FieldDoc{"crossings", "number of pairs of crossing triangles; only for results of surface_mesh"},
    FieldDoc{"absorbed", "number of model parts too small to be meshed; only for results of surface_mesh"},
    FieldDoc{"smooth_angle", "largest angle between adjacent triangles where the surface is smooth, rad; only if known"},
};
constexpr std::array k_envelope_fields = {
    FieldDoc{"wall", "the wall below the envelope"},
    FieldDoc{"vertices", "their number"},
    FieldDoc{"collapsed", "number of vertices without a layer"},
    FieldDoc{"step", "last completed step: classified, initial, smoothed, untangled, unwarped, retracted, finished"},
    FieldDoc{"feature_angle", "angle above which an edge is a feature edge, rad"},
};
constexpr std::array k_tetrahedra_fields = {
    FieldDoc{"tetrahedra", "their number"},
    FieldDoc{"points", "number of new points"},
    FieldDoc{"engine", "name of the tetrahedra engine"},
};
constexpr std::array k_mesh_fields = {
    FieldDoc{"nodes", "their number"},
    FieldDoc{"prisms", "their number"},
    FieldDoc{"pyramids", "their number"},
    FieldDoc{"tetrahedra", "their number"},
    FieldDoc{"hexahedra", "their number"},
    FieldDoc{"cells", "number of all cells"},
    FieldDoc{"patches", "list of the patches' names"},
    FieldDoc{"coverage", "fraction of the wall's area with at least 0.9 of the target height, along the normal; only for meshes made in this run"},
    FieldDoc{"attainable", "fraction of the wall's area on which gaps and corners permit this height; only for meshes made in this run"},
    FieldDoc{"mean_height", "mean height of the layer, m; only for meshes made in this run"},
    FieldDoc{"compressed", "number of vertices with a layer too low for the first height; only for meshes made in this run"},
    FieldDoc{"collapsed", "number of vertices without a layer; only for meshes made in this run"},
};
constexpr std::array k_model_fields = {
    FieldDoc{
        "components",
        "list of the components' names; model[\"wing*\"] is a model of the components with matching names, also model[\"wing\"] if no field has this name"},
    FieldDoc{"patches", "list of the faces' names"},
    FieldDoc{"solids", "list of the solids' names"},
    FieldDoc{"faces", "their number"},
    FieldDoc{"edges", "their number"},
    FieldDoc{"is_closed", "true if there is no open edge"},
    FieldDoc{"unit", "length of one unit of the model's file, m"},
    FieldDoc{"report", "text that describes how the model was read or made"},
    FieldDoc{"length", "length along x, m; only if the model has faces"},
    FieldDoc{"min", "corner of the bounding box {x, y, z}, m; only if the model has faces"},
    FieldDoc{"max", "corner of the bounding box {x, y, z}, m; only if the model has faces"},
};
constexpr std::array k_component_fields = {
    FieldDoc{"name", "its own"},
    FieldDoc{"kind", "wing, body, nacelle, pylon ..."},
    FieldDoc{"position", "{x, y, z}, m"},
    FieldDoc{"span", "span from tip to tip, m; wings only"},
    FieldDoc{"area", "planform area in the plane of x and the span, m^2; wings only"},
    FieldDoc{"projected_area", "area projected from above, m^2; wings only"},
    FieldDoc{"unrolled_area", "planform area with unrolled dihedral, m^2; wings only"},
    FieldDoc{"aspect_ratio", "span^2 / area; wings only"},
    FieldDoc{"mean_geometric_chord", "area / span, m; wings only"},
    FieldDoc{"mean_aerodynamic_chord", "mean aerodynamic chord, m; wings only"},
    FieldDoc{"aerodynamic_chord_start", "leading edge of the mean aerodynamic chord {x, y, z}, m; wings only"},
    FieldDoc{"length", "m; bodies only"},
    FieldDoc{"width", "m; bodies only"},
    FieldDoc{"height", "m; bodies only"},
};
constexpr std::array k_airfoil_fields = {
    FieldDoc{"name", "its own"},
    FieldDoc{"points", "rows {x, z}, relative to the chord"},
    FieldDoc{"thickness", "largest value, relative to the chord"},
    FieldDoc{"thickness_at", "x of the largest value, relative to the chord"},
    FieldDoc{"camber", "largest value, relative to the chord"},
    FieldDoc{"camber_at", "x of the largest value, relative to the chord"},
    FieldDoc{"trailing_edge", "thickness of the trailing edge, relative to the chord"},
};
constexpr std::array k_quantity_fields = {
    FieldDoc{"height", "first height or total height, m; y_plus and boundary_layer only"},
    FieldDoc{"y_plus", "target y+; y_plus only"},
    FieldDoc{"wall_distance", "wall distance with this y+, m; y_plus only"},
    FieldDoc{"skin_friction", "skin friction coefficient; y_plus only"},
    FieldDoc{"friction_velocity", "m/s; y_plus only"},
    FieldDoc{"thickness", "thickness of the boundary layer without the factor, m; boundary_layer only"},
    FieldDoc{"reynolds", "Reynolds number of the reference length"},
    FieldDoc{"length", "reference length, m"},
    FieldDoc{"mach", "Mach number, if known"},
    FieldDoc{"speed", "m/s, if known"},
    FieldDoc{"temperature", "K, if known"},
    FieldDoc{"pressure", "Pa, if known"},
    FieldDoc{"density", "kg/m^3, if known"},
    FieldDoc{"viscosity", "dynamic viscosity, Pa s, if known"},
    FieldDoc{"altitude", "m, if known"},
};
constexpr std::array k_error_fields = {
    FieldDoc{"code", "kind of error: bad_argument, file_not_found ..."},
    FieldDoc{"message", "text of the error message"},
    FieldDoc{"places", "number of locations in the message"},
};

std::span<const ScriptVerb> no_methods() { return {}; }

const std::array k_kinds = {
    ObjectKind{"surface", "sterna.surface", "A triangulated surface: the wall for volume_mesh.", &k_surface_field, surface_methods, k_surface_fields},
    ObjectKind{"envelope", "sterna.envelope", "The outer surface of the prism layer above its wall.", &k_envelope_field, envelope_methods, k_envelope_fields},
    ObjectKind{"tetrahedra", "sterna.tetrahedra", "A prism layer and the tetrahedra around it, not yet joined to one mesh.", &k_tetrahedra_field,
               tetrahedra_methods, k_tetrahedra_fields},
    ObjectKind{"mesh", "sterna.mesh", "A volume mesh.", &k_mesh_field, mesh_methods, k_mesh_fields},
    ObjectKind{"model", "sterna.model", "Exact geometry: faces, edges and solids by name. Methods return new models.", &k_model_field, model_methods,
               k_model_fields},
    ObjectKind{"component", "sterna.component", "A part of an aircraft, defined as data: wing, body, nacelle, pylon. Methods change the component in place.",
               &k_component_field, component_methods, k_component_fields},
    ObjectKind{"airfoil", "sterna.airfoil", "A wing section.", &k_airfoil_field, no_methods, k_airfoil_fields},
    ObjectKind{"quantity", "sterna.quantity",
               "Flow conditions, or a length computed from them. The length can be used wherever a number of metres is expected.", &k_quantity_field,
               no_methods, k_quantity_fields},
    ObjectKind{"error", "sterna.error", "The error raised by a verb, as returned by pcall.", &k_error_field, no_methods, k_error_fields},
};

}  // namespace

std::span<const ObjectKind> object_kinds() { return k_kinds; }

const ObjectKind* object_kind(std::string_view name) {
  for (const ObjectKind& kind : k_kinds)
    if (kind.name == name) return &kind;
  return nullptr;
}

const ObjectKind* kind_of(const ScriptValue& value) { return object_kind(object_name(value)); }

}  // namespace sterna::scripting
