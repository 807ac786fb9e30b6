#include "scripting/view/view_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/draw/choices.h"
#include "geom/mesh/cut.h"
#include "geom/mesh/cut_locations.h"
#include "scripting/report/page_surface.h"
#include "scripting/report/report_gates.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/inspect_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/verbs/component_verbs.h"
#include "surfmesh/model/model_facets.h"

namespace sterna::scripting {
namespace {

using SceneJson = nlohmann::ordered_json;

constexpr double k_no_limit = std::numeric_limits<double>::quiet_NaN();
constexpr GateLimits k_without_limits{k_no_limit, k_no_limit, k_no_limit, 1.0};

std::string block_of(const SceneJson& json, const PageArrays& arrays) {
  std::string text = json.dump(-1, ' ', false, SceneJson::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes(8, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>((text.size() >> (8 * i)) & 0xff);
  bytes.reserve(8 + text.size() + arrays.bytes().size());
  return bytes.append(text).append(arrays.bytes());
}

void add_fact(SceneJson& scene, const std::string& name, const std::string& text) { scene["facts"].push_back(SceneJson::array({name, text})); }

std::string metres(double value) { return number_text(value, 5) + " m"; }

SceneJson scene_of(std::string_view kind) { return {{"schema", "sterna-scene-1"}, {"kind", kind}, {"facts", SceneJson::array()}}; }

/// Adds frame, patches and surface of an object that consists of triangles.
void add_surface(SceneJson& scene, std::span<const Point> points, const PageTriangles& triangles, const Column<PatchId, Patch>& patches,
                 const std::vector<SurfaceField>& fields, const SceneOptions& options, PageArrays& arrays) {
  const PageMaker maker(points, triangles, patches, fields);
  scene.update(maker.frame_json());
  scene["patches"] = maker.patches_json();
  scene["surface"] = maker.surface_json(options.max_triangles, arrays);
}

// ---- Models --------------------------------------------------------------------------------------------------------------------------------

SurfaceField curvature_field(std::vector<double> values) {
  return {{.name = "curvature", .title = "curvature", .unit = "1/m", .is_log = true, .is_low_bad = false, .limits = k_without_limits, .is_of_layer = false},
          std::move(values)};
}

SceneJson location_of(const Point& p) { return SceneJson::array({p.x, p.y, p.z}); }

/// Returns the data of a wing section: leading edge, chord, angles, airfoil. If the section is given as a loop, its chord is that of the loop.
SceneJson section_json(const WingSection& section, const Transform& map, std::size_t number) {
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  SceneJson entry = {{"name", section.name.empty() ? "section " + std::to_string(number) : section.name}};
  if (section.loop.empty()) {
    entry["at"] = location_of(map.point(section.leading_edge));
    entry["chord"] = section.chord;
    entry["twist"] = section.twist * k_degrees;
    entry["airfoil"] = section.airfoil;
    return entry;
  }
  const Point leading = map.point(section.loop[section.loop.size() / 2]);
  entry["at"] = location_of(leading);
  entry["chord"] = distance(leading, map.point(section.loop.front() + 0.5 * (section.loop.back() - section.loop.front())));
  return entry;
}

/// Returns wing sections from the root outwards, body frames, and control surfaces, by component name.
SceneJson parts_json(const Aircraft& aircraft) {
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  SceneJson parts = SceneJson::object();
  for (const Wing& wing : aircraft.wings) {
    const Transform map = transform_of(wing.placement);
    SceneJson& list = parts[wing.name]["sections"] = SceneJson::array();
    for (std::size_t i = wing.sections.size(); i-- > 0;) list.push_back(section_json(wing.sections[i], map, wing.sections.size() - i));
  }
  for (const Body& body : aircraft.bodies) {
    const Transform map = transform_of(body.placement);
    SceneJson& list = parts[body.name]["sections"] = SceneJson::array();
    for (std::size_t i = 0; i < body.frames.size(); ++i) {
      const BodyFrame& frame = body.frames[i];
      list.push_back({{"name", frame.name.empty() ? "frame " + std::to_string(i + 1) : frame.name},
                      {"at", location_of(map.point(frame.center))},
                      {"width", frame.width},
                      {"height", frame.height}});
    }
  }
  const auto add_control = [&](const ControlSurface& surface, double angle) {
    parts[surface.wing]["controls"].push_back({{"name", surface.name}, {"angle", angle * k_degrees}});
  };
  for (const Deflection& deflection : aircraft.deflections) add_control(deflection.surface, deflection.angle);
  for (const ControlSurface& surface : aircraft.control_surfaces)
    if (std::ranges::none_of(aircraft.deflections, [&](const Deflection& d) { return d.surface.wing == surface.wing && d.surface.name == surface.name; }))
      add_control(surface, 0.0);
  return parts;
}

void add_model_facts(SceneJson& scene, const ModelValue& value, const RunContext& context) {
  const ModelReport report = measure_model(value, context);
  const Box& box = report.total.box;
  if (!box.empty())
    add_fact(scene, "length, span, height", metres(box.max.x - box.min.x) + ", " + metres(box.max.y - box.min.y) + ", " + metres(box.max.z - box.min.z));
  add_fact(scene, "wetted area", number_text(report.total.area, 5) + " m^2");
  if (report.total.is_closed) add_fact(scene, "volume", number_text(report.total.volume, 5) + " m^3");
  add_fact(scene, "closed", report.total.is_closed ? "yes" : "no");
  for (const WingReference& wing : report.wings)
    add_fact(scene, wing.name, "span " + metres(wing.span) + ", area " + number_text(wing.area, 5) + " m^2, mean chord " + metres(wing.mean_aerodynamic_chord));
  SceneJson components = SceneJson::array();
  for (const PartMeasures& part : report.components)
    components.push_back(
        {{"name", part.name}, {"kind", part.kind}, {"area", part.area}, {"volume", part.is_closed ? SceneJson(part.volume) : SceneJson(nullptr)}});
  scene["components"] = std::move(components);
}

/// Facet tolerance of a sketch as a fraction of the model's longest side. It is four times as coarse as usual and gives half the triangles.
constexpr double k_sketch_tolerance = 8e-4;

surfmesh::FacetOptions facet_options(const SceneOptions& options) {
  if (options.is_quick) return {.tolerance = k_sketch_tolerance};
  return {.with_curvature = true};
}

std::string model_scene(const ModelValue& value, const SceneOptions& options, const RunContext& context) {
  const Model& model = value.model;
  surfmesh::ModelFacets facets = surfmesh::facets_of(model, facet_options(options), context);
  // There is one patch per name within a component, as in meshes. Patches are sorted by name, so that a sketch has the same colours as the united model.
  const auto key_of = [&](const ModelFace& face) {
    return std::pair(face.component.is_valid() ? model.components[face.component].name : std::string(), face.name);
  };
  std::map<std::pair<std::string, std::string>, const ModelFace*> first;
  for (const ModelFace& face : model.faces) first.emplace(key_of(face), &face);
  Column<PatchId, Patch> patches;
  std::vector<const ModelFace*> first_face;
  std::map<std::pair<std::string, std::string>, PatchId> known;
  for (const auto& [key, face] : first) {
    known.emplace(key, PatchId(static_cast<std::uint32_t>(patches.size())));
    patches.push_back({.name = face->name, .kind = patch_kind(*face)});
    first_face.push_back(face);
  }
  std::vector<PatchId> patch_of_face;
  for (const ModelFace& face : model.faces) patch_of_face.push_back(known.at(key_of(face)));
  PageTriangles triangles{.triangles = std::move(facets.triangles), .face = {}, .edges = std::move(facets.edges), .patch = {}};
  for (std::size_t t = 0; t < facets.face.size(); ++t) {
    triangles.face.push_back(static_cast<std::uint32_t>(t));
    triangles.patch.push_back(static_cast<std::uint16_t>(patch_of_face[facets.face[t].index()].value()));
  }
  std::vector<SurfaceField> fields;
  if (!facets.curvature.empty()) fields.push_back(curvature_field(std::move(facets.curvature)));
  SceneJson scene = scene_of("model");
  PageArrays arrays;
  add_surface(scene, facets.points, triangles, patches, fields, options, arrays);
  for (std::size_t p = 0; p < first_face.size(); ++p) {
    const ModelFace& face = *first_face[p];
    if (face.component.is_valid()) scene["patches"][p]["component"] = model.components[face.component].name;
    scene["patches"][p]["role"] = to_string(face.role);
  }
  scene["is_quick"] = options.is_quick;
  if (!options.is_quick) {
    add_model_facts(scene, value, context);
    if (value.description) scene["parts"] = parts_json(*value.description);
  }
  if (!facets.untrimmed.empty()) add_fact(scene, "drawn approximately", std::to_string(facets.untrimmed.size()) + " faces with self-crossing borders");
  return block_of(scene, arrays);
}

// ---- Surfaces, envelopes ---------------------------------------------------------------------------------------------------------------------

std::string surface_scene(const SurfaceValue& value, const SceneOptions& options, const RunContext& context) {
  const TriMesh& mesh = value.mesh;
  SceneJson scene = scene_of("surface");
  PageArrays arrays;
  const std::vector<SurfaceField> fields = surface_fields(mesh, context);
  add_surface(scene, mesh.points.raw(), page_triangles(mesh), mesh.patches, fields, options, arrays);
  const Box box = bounding_box(mesh);
  double area = 0.0, volume = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    area += 0.5 * norm(cross(b - a, c - a));
    volume += dot(a - Point{}, cross(b - Point{}, c - Point{})) / 6.0;
  }
  add_fact(scene, "triangles", count_text(static_cast<std::int64_t>(mesh.n_triangles())));
  if (!box.empty())
    add_fact(scene, "length, span, height", metres(box.max.x - box.min.x) + ", " + metres(box.max.y - box.min.y) + ", " + metres(box.max.z - box.min.z));
  add_fact(scene, "area", number_text(area, 5) + " m^2");
  if (value.report.is_closed) add_fact(scene, "volume", number_text(std::abs(volume), 5) + " m^3");
  add_fact(scene, "closed", value.report.is_closed ? "yes" : "no");
  if (value.mesh_report) add_fact(scene, "smallest angle", number_text(value.mesh_report->min_angle * 180.0 / std::numbers::pi, 3) + " deg");
  for (const std::string& change : changes_of(value.history)) add_fact(scene, "changed", change);
  return block_of(scene, arrays);
}

std::string envelope_scene(const EnvelopeValue& value, const SceneOptions& options, const RunContext& context) {
  TriMesh mesh = value.wall->mesh;
  const volmesh::Envelope& envelope = value.stage.envelope;
  if (envelope.height.size() != mesh.n_vertices())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "drawing an envelope",
                 .problem = "the envelope has no heights yet",
                 .hint = "draw the result of envelope.initial"});
  SurfaceField height{.info = {.name = "layer_height",
                               .title = "height of the envelope",
                               .unit = "m",
                               .is_log = false,
                               .is_low_bad = true,
                               .limits = k_without_limits,
                               .is_of_layer = true},
                      .values = {}};
  for (const TriangleVertices& v : mesh.triangles) height.values.push_back((envelope.height[v[0]] + envelope.height[v[1]] + envelope.height[v[2]]) / 3.0);
  for (const VertexId v : mesh.points.ids()) mesh.points[v] = envelope.point(value.wall->mesh, v);
  std::vector<SurfaceField> fields = surface_fields(mesh, context);
  fields.insert(fields.begin(), std::move(height));
  SceneJson scene = scene_of("envelope");
  PageArrays arrays;
  add_surface(scene, mesh.points.raw(), page_triangles(mesh), mesh.patches, fields, options, arrays);
  add_fact(scene, "triangles", count_text(static_cast<std::int64_t>(mesh.n_triangles())));
  const auto n_collapsed = std::count(envelope.height.begin(), envelope.height.end(), 0.0);
  add_fact(scene, "collapsed", count_text(n_collapsed) + " vertices");
  return block_of(scene, arrays);
}

// ---- Volume meshes ---------------------------------------------------------------------------------------------------------------------------

std::string mesh_scene(const MeshValue& value, const SceneOptions& options, const RunContext& context) {
  const HybridMesh& mesh = value.mesh;
  if (!value.check || !value.check->quality_measured) value.check = check(mesh, {}, context);
  SceneJson scene = scene_of("volume");
  PageArrays arrays;
  const std::vector<SurfaceField> fields = surface_fields(mesh, context);
  add_surface(scene, mesh.points.raw(), page_triangles(mesh), mesh.patches, fields, options, arrays);
  scene.update(page_check_json(*value.check));
  const Vec3 normal = symmetry_normal(mesh);
  scene["symmetry_normal"] = SceneJson::array({normal.x, normal.y, normal.z});
  const CellCounts cells = count_cells(mesh);
  add_fact(scene, "nodes", count_text(static_cast<std::int64_t>(mesh.points.size())));
  for (const auto& [name, n] : {std::pair("prisms", cells.prisms), std::pair("pyramids", cells.pyramids), std::pair("hexahedra", cells.hexahedra),
                                std::pair("tetrahedra", cells.tetrahedra)})
    if (n > 0) add_fact(scene, name, count_text(n));
  if (value.origin) {
    add_fact(scene, "mean height of the layer", metres(value.origin->report.layer.mean_height));
    add_fact(scene, "full height", number_text(100.0 * value.origin->report.layer.coverage, 4) + " % of the area");
  }
  return block_of(scene, arrays);
}

}  // namespace

bool is_drawable(const ScriptValue& value) {
  if (const auto* mesh = std::get_if<MeshHandle>(&value))
    return count_cells((*mesh)->mesh).total() > 0;  // otherwise it is a surface file that was read as a mesh
  return std::holds_alternative<ModelHandle>(value) || std::holds_alternative<ComponentHandle>(value) || std::holds_alternative<SurfaceHandle>(value) ||
         std::holds_alternative<EnvelopeHandle>(value) || std::holds_alternative<TetrahedraHandle>(value);
}

std::string object_text(const ScriptValue& value) {
  if (const auto* model = std::get_if<ModelHandle>(&value)) return describe(**model);
  if (const auto* component = std::get_if<ComponentHandle>(&value)) return describe(**component);
  if (const auto* surface = std::get_if<SurfaceHandle>(&value)) return describe(**surface);
  if (const auto* envelope = std::get_if<EnvelopeHandle>(&value)) return describe(**envelope);
  if (const auto* tetrahedra = std::get_if<TetrahedraHandle>(&value)) return describe(**tetrahedra);
  if (const auto* mesh = std::get_if<MeshHandle>(&value)) return describe(**mesh);
  return std::string(type_text(value));
}

std::string scene_bytes(const ScriptValue& value, const SceneOptions& options, const RunContext& context) {
  if (const auto* model = std::get_if<ModelHandle>(&value)) return model_scene(**model, options, context);
  if (const auto* component = std::get_if<ComponentHandle>(&value))
    return model_scene(make_aircraft({.name = (*component)->name(), .components = {*component}, .models = {}}, context), options, context);
  if (const auto* surface = std::get_if<SurfaceHandle>(&value)) return surface_scene(**surface, options, context);
  if (const auto* envelope = std::get_if<EnvelopeHandle>(&value)) return envelope_scene(**envelope, options, context);
  if (const auto* tetrahedra = std::get_if<TetrahedraHandle>(&value)) return surface_scene(*(*tetrahedra)->wall, options, context);
  if (const auto* mesh = std::get_if<MeshHandle>(&value)) return mesh_scene(**mesh, options, context);
  throw Error({.code = ErrorCode::bad_argument, .attempted = "drawing " + std::string(type_text(value)), .problem = "there is nothing to draw"});
}

std::string inspection_json(const ScriptValue& value, const RunContext& context) {
  const auto* surface = std::get_if<SurfaceHandle>(&value);
  if (!surface)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "inspecting " + std::string(type_text(value)),
                 .problem = "only surfaces can be inspected",
                 .hint = "choose one in the tree"});
  return json_of(inspect_surface(**surface, {}, context), "surface");
}

std::string cut_bytes(const ScriptValue& value, const std::string& plane_text, std::size_t max_polygons, const RunContext& context) {
  const auto* mesh = std::get_if<MeshHandle>(&value);
  const std::optional<CutPlane> plane = draw::plane_of(plane_text);
  if (!mesh || !plane)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "cutting by \"" + plane_text + "\"",
                 .problem = mesh ? "expected a plane" : "only volume meshes have cells to cut",
                 .hint = "x=1.2, or point=0,0,0 normal=0,1,0"});
  const MeshCut cut = cut_mesh((*mesh)->mesh, *plane, context);
  PageArrays arrays;
  const CutLocation location{.name = plane_text, .plane = *plane, .focus = plane->origin, .radius = 1.0};
  return block_of(page_cut_json(location, cut, max_polygons, arrays), arrays);
}

}  // namespace sterna::scripting
