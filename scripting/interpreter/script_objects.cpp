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
    FieldDoc{"length", "longest side of its box, m"},
    FieldDoc{"is_closed", "true where no edge is free"},
    FieldDoc{"patches", "names of the patches, a list"},
    FieldDoc{"min_angle", "smallest angle of a triangle, rad; if surface_mesh made it"},
    FieldDoc{"max_angle", "largest angle of a triangle, rad; if surface_mesh made it"},
    FieldDoc{"share_20_130", "part of the triangles with all angles in 20 .. 130 deg; if surface_mesh made it"},
    FieldDoc{"crossings", "pairs of triangles that cross; if surface_mesh made it"},
    FieldDoc{"absorbed", "parts of the model too small to be meshed; if surface_mesh made it"},
    FieldDoc{"smooth_angle", "largest turn between triangles where the surface is smooth, rad; if its maker knew it"},
};
constexpr std::array k_envelope_fields = {
    FieldDoc{"wall", "the surface that it stands on"},
    FieldDoc{"vertices", "their number"},
    FieldDoc{"collapsed", "vertices without a layer"},
    FieldDoc{"step", "what has been done to it: classified, initial, smoothed, untangled, unwarped, retracted, finished"},
    FieldDoc{"feature_angle", "an edge that bends by more is a feature edge, rad"},
};
constexpr std::array k_tetrahedra_fields = {
    FieldDoc{"tetrahedra", "their number"},
    FieldDoc{"points", "those that are new"},
    FieldDoc{"engine", "what made them"},
};
constexpr std::array k_mesh_fields = {
    FieldDoc{"nodes", "their number"},
    FieldDoc{"prisms", "their number"},
    FieldDoc{"pyramids", "their number"},
    FieldDoc{"tetrahedra", "their number"},
    FieldDoc{"hexahedra", "their number"},
    FieldDoc{"cells", "all of them"},
    FieldDoc{"patches", "names of the patches, a list"},
    FieldDoc{"coverage", "part of the wall's area with at least 0.9 of the wanted height, along its normal; if it was made in this run"},
    FieldDoc{"attainable", "part of the wall's area on which gaps and corners permit that; if it was made in this run"},
    FieldDoc{"mean_height", "of the layer, m; if it was made in this run"},
    FieldDoc{"compressed", "vertices whose layer is too low for the first height; if it was made in this run"},
    FieldDoc{"collapsed", "vertices without a layer; if it was made in this run"},
};
constexpr std::array k_model_fields = {
    FieldDoc{"components", "their names, a list; model[\"wing*\"], or model[\"wing\"] where it is no member, is a model of those with such names"},
    FieldDoc{"patches", "names of the faces, a list"},
    FieldDoc{"solids", "their names, a list"},
    FieldDoc{"faces", "their number"},
    FieldDoc{"edges", "their number"},
    FieldDoc{"is_closed", "true where no edge is free"},
    FieldDoc{"unit", "length of one unit of the file that it is from, m"},
    FieldDoc{"report", "lines about how it was read or made"},
    FieldDoc{"length", "along x, m; if it has faces"},
    FieldDoc{"min", "corner of its box {x, y, z}, m; if it has faces"},
    FieldDoc{"max", "corner of its box {x, y, z}, m; if it has faces"},
};
constexpr std::array k_component_fields = {
    FieldDoc{"name", "its own"},
    FieldDoc{"kind", "wing, body, nacelle, pylon ..."},
    FieldDoc{"position", "{x, y, z}, m"},
    FieldDoc{"span", "from tip to tip, m; of wings"},
    FieldDoc{"area", "planform in the plane of x and the span, m^2; of wings"},
    FieldDoc{"projected_area", "as seen from above, m^2; of wings"},
    FieldDoc{"unrolled_area", "planform with dihedral laid flat, m^2; of wings"},
    FieldDoc{"aspect_ratio", "span^2 / area; of wings"},
    FieldDoc{"mean_geometric_chord", "area / span, m; of wings"},
    FieldDoc{"mean_aerodynamic_chord", "m; of wings"},
    FieldDoc{"aerodynamic_chord_start", "its leading edge {x, y, z}, m; of wings"},
    FieldDoc{"length", "m; of bodies"},
    FieldDoc{"width", "m; of bodies"},
    FieldDoc{"height", "m; of bodies"},
};
constexpr std::array k_airfoil_fields = {
    FieldDoc{"name", "its own"},
    FieldDoc{"points", "rows {x, z}, parts of the chord"},
    FieldDoc{"thickness", "largest, of the chord"},
    FieldDoc{"thickness_at", "where, of the chord"},
    FieldDoc{"camber", "largest, of the chord"},
    FieldDoc{"camber_at", "where, of the chord"},
    FieldDoc{"trailing_edge", "its thickness, of the chord"},
};
constexpr std::array k_quantity_fields = {
    FieldDoc{"height", "the length itself, m; of y_plus and boundary_layer"},
    FieldDoc{"y_plus", "of the wanted place; of y_plus"},
    FieldDoc{"wall_distance", "of that place, m; of y_plus"},
    FieldDoc{"skin_friction", "coefficient; of y_plus"},
    FieldDoc{"friction_velocity", "m/s; of y_plus"},
    FieldDoc{"thickness", "of the boundary layer without the factor, m; of boundary_layer"},
    FieldDoc{"reynolds", "of the length"},
    FieldDoc{"length", "reference length, m"},
    FieldDoc{"mach", "if it is known"},
    FieldDoc{"speed", "m/s; if it is known"},
    FieldDoc{"temperature", "K; if it is known"},
    FieldDoc{"pressure", "Pa; if it is known"},
    FieldDoc{"density", "kg/m^3; if it is known"},
    FieldDoc{"viscosity", "dynamic, Pa s; if it is known"},
    FieldDoc{"altitude", "m; if it is known"},
};
constexpr std::array k_error_fields = {
    FieldDoc{"code", "kind of error: bad_argument, file_not_found ..."},
    FieldDoc{"message", "what is printed"},
    FieldDoc{"places", "number of places that it names"},
};

std::span<const ScriptVerb> no_methods() { return {}; }

const std::array k_kinds = {
    ObjectKind{"surface", "sterna.surface", "A triangulated surface: the wall that volume_mesh takes.", &k_surface_field, surface_methods, k_surface_fields},
    ObjectKind{"envelope", "sterna.envelope", "The surface in which the layer of prisms ends, above its wall.", &k_envelope_field, envelope_methods,
               k_envelope_fields},
    ObjectKind{"tetrahedra", "sterna.tetrahedra", "A layer of prisms and the tetrahedra around it, not yet one mesh.", &k_tetrahedra_field, tetrahedra_methods,
               k_tetrahedra_fields},
    ObjectKind{"mesh", "sterna.mesh", "A volume mesh.", &k_mesh_field, mesh_methods, k_mesh_fields},
    ObjectKind{"model", "sterna.model", "Exact geometry: faces, edges and solids by name. Its methods give new models.", &k_model_field, model_methods,
               k_model_fields},
    ObjectKind{"component", "sterna.component", "A part of an aircraft as data: wing, body, nacelle, pylon. Its methods change it in place.",
               &k_component_field, component_methods, k_component_fields},
    ObjectKind{"airfoil", "sterna.airfoil", "A wing section.", &k_airfoil_field, no_methods, k_airfoil_fields},
    ObjectKind{"quantity", "sterna.quantity",
               "Flow conditions, or a length that was found from them, which counts as a number of metres wherever one is expected.", &k_quantity_field,
               no_methods, k_quantity_fields},
    ObjectKind{"error", "sterna.error", "What a verb raised, as pcall gives it.", &k_error_field, no_methods, k_error_fields},
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
