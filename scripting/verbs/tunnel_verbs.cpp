// test_section{} makes a rectangular or round duct, or takes a solid of the user's; its patches have their own kinds, sizes and layers. assembly{} combines
// models, which are united where they touch.
#include "scripting/verbs/tunnel_verbs.h"

#include <algorithm>
#include <array>
#include <set>

#include "geom/base/glob.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "geom/model/shapes.h"
#include "scripting/lua/script_check.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/fluid_model.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/patch_rules.h"
#include "scripting/verbs/surface_motion.h"

namespace sterna::scripting {

struct AssemblyOptions {
  bool unite = true;
};
struct TunnelSizeOptions {
  double max_edge = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::AssemblyOptions> {
  using O = scripting::AssemblyOptions;
  static constexpr std::string_view stage = "assembly";
  static constexpr std::array fields = {
      Field<O>{.name = "unite", .member = &O::unite, .help = "unite solids that touch to one closed surface (except tunnels); otherwise all stay separate"},
  };
};

template <>
struct Schema<scripting::TunnelSizeOptions> {
  using O = scripting::TunnelSizeOptions;
  static constexpr std::string_view stage = "tunnel_sizes";
  static constexpr std::array fields = {
      Field<O>{.name = "max_edge",
               .member = &O::max_edge,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "longest edge on all patches of the tunnel, independent of surface_mesh options for the model",
               .automatic = "a twelfth of the shortest side of the tunnel"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

/// Default number of edges along the shortest side of a tunnel. It is sufficient for walls without a body nearby.
constexpr double k_edges_across = 12.0;

constexpr std::string_view k_test_section_usage =
    "test_section{ length = 6, width = 2.1, height = 1.5, position = {0, 0, 0}, inflow = \"inlet\", outflow = \"outlet\", walls = { layers = 20, first_height "
    "= 20e-6 }, floor = \"slip\" }  or  test_section{ length = 6, diameter = 2 }";
constexpr std::string_view k_assembly_usage = "assembly{ model, sting_model }  or, of surfaces,  assembly{ wall, read_surface(\"sting.stl\"):move{ 3, 0, 0 } }";

/// Names of the walls in scripts.
constexpr std::array<const char*, 4> k_sides = {"floor", "right", "ceiling", "left"};

std::set<std::string> names_of_role(const Model& model, FaceRole role) {
  std::set<std::string> names;
  for (const ModelFace& face : model.faces)
    if (face.role == role) names.insert(face.name);
  return names;
}

/// Returns the layer options of the walls of a tunnel. Their kind is read apart from these options. `rule` must outlive the table.
OptionTable tunnel_layer_options(Rule& rule) {
  OptionTable table = volmesh::layer_rule_options(rule);
  std::erase_if(table, [](const Option& option) { return option.name == "kind"; });
  return table;
}

/// Sets the size of all patches by a rule that rules of single patches override.
void add_size(const TunnelSizeOptions& options, ModelValue& tunnel) {
  const Box box = box_of(tunnel.model);
  if (box.empty()) return;
  const Vec3 sides = box.max - box.min;
  const double size = is_automatic(options.max_edge) ? std::min({sides.x, sides.y, sides.z}) / k_edges_across : options.max_edge;
  std::set<std::string> names;
  for (const ModelFace& face : tunnel.model.faces) names.insert(face.name);
  for (const std::string& name : names) tunnel.sizes.push_back({.names = name, .options = {{"max_edge", size}}});
}

/// Reads the value of walls = ... or of an entry of patches = {...}: the kind of patches, or a table with kind, sizes and layers. Notes problems.
void read_patch(const ScriptValue& value, const std::string& key, const std::set<std::string>& names, ModelValue& tunnel, TableReader& reader) {
  std::optional<PatchKind> kind;
  Rule sizes, layer;
  if (const auto* table = std::get_if<TableHandle>(&value)) {
    TableReader entries(**table, key);
    entries.read_options(size_rule_options(sizes));
    entries.read_options(tunnel_layer_options(layer));
    if (const ScriptValue* given = entries.field("kind")) kind = read_patch_kind(*given, "kind", entries);
    try {
      entries.finish();
    } catch (const Error& error) {
      reader.add_problem(key + ": " + error.info().problem);
      return;
    }
  } else {
    kind = read_patch_kind(value, key, reader);
  }
  // A table with layers makes a side of a tunnel a wall, even if a less specific entry gives another kind. A kind beside the layers is kept.
  const int n_layers = value_or(layer, "layers", k_automatic_count);
  if (kind && *kind != PatchKind::wall && !layer.options.empty() && n_layers != 0)
    reader.add_problem(key + ": only walls have layers, and this patch is of kind " + std::string(to_string(*kind)) +
                       ": leave out the layer options, or set kind = \"wall\"");
  for (const std::string& name : names) {
    if (kind && *kind != PatchKind::wall) std::erase_if(tunnel.layers, [&](const Rule& rule) { return rule.names == name; });
    sizes.names = layer.names = name;
    if (!sizes.options.empty()) tunnel.sizes.push_back(sizes);
    if (!layer.options.empty()) tunnel.layers.push_back(layer);
  }
  for (ModelFace& face : tunnel.model.faces) {
    if (!names.contains(face.name)) continue;
    if (kind) face.kind = kind;
    else if (n_layers > 0 && face.role == FaceRole::wall) face.kind = PatchKind::wall;
  }
}

/// Reads patches = { ["inlet*"] = { max_edge = 0.2 } }.
void read_patches(TableReader& reader, ModelValue& tunnel) {
  const ScriptValue* value = reader.field("patches");
  if (!value) return;
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty()) {
    reader.add_problem("patches: expected a table with names of faces as keys, { [\"tunnel*\"] = { max_edge = 0.1 } }");
    return;
  }
  std::vector<std::string> patterns;
  for (const auto& [pattern, entry] : (*table)->fields) patterns.push_back(pattern);
  std::stable_sort(patterns.begin(), patterns.end(), [](const std::string& a, const std::string& b) { return n_spelled_out(a) < n_spelled_out(b); });
  for (const std::string& pattern : patterns) {
    std::set<std::string> names;
    for (const ModelFace& face : tunnel.model.faces)
      if (matches_glob(face.name, pattern)) names.insert(face.name);
    if (names.empty()) reader.add_problem("patches: no face of the tunnel has a name like \"" + pattern + "\"");
    else read_patch((*table)->fields.at(pattern), "patches[\"" + pattern + "\"]", names, tunnel, reader);
  }
}

/// Uses the user's solid as a tunnel. Inflow and outflow are patterns of names of its faces; all other faces are walls.
void take_solid(const ModelHandle& solid, TableReader& reader, ModelValue& tunnel) {
  tunnel = *solid;
  tunnel.description.reset();
  tunnel.without_description = "it is a tunnel";
  for (Component& component : tunnel.model.components) component.kind = ComponentKind::tunnel;
  for (ModelFace& face : tunnel.model.faces) face.role = FaceRole::wall;
  for (const auto& [key, role] : {std::pair<const char*, FaceRole>{"inflow", FaceRole::inflow}, {"outflow", FaceRole::outflow}}) {
    const ScriptValue* value = reader.field(key);
    if (!value) continue;
    const auto* pattern = std::get_if<std::string>(value);
    bool is_used = false;
    for (ModelFace& face : tunnel.model.faces)
      if (pattern && matches_glob(face.name, *pattern)) {
        face.role = role;
        is_used = true;
      }
    if (!is_used) reader.add_problem(std::string(key) + ": no face has a matching name; expected a name of faces of the model, or a pattern");
  }
  if (tunnel.model.solids.size() != 1 || !tunnel.model.solids.raw().front().is_closed)
    reader.add_problem("a tunnel must be one closed solid; this model is " + describe(tunnel));
  else if (solid_measures(tunnel.model, SolidId(0)).volume > 0.0) {  // the normals point outwards, but the fluid is inside
    turn_inside_out(tunnel.model);
    tunnel.parts.clear();
  }
}

/// Reads through = "sting*" or { "sting*", "strut" }.
void read_through(TableReader& reader, ModelValue& tunnel) {
  const ScriptValue* value = reader.field("through");
  if (!value) return;
  const auto* table = std::get_if<TableHandle>(value);
  const std::vector<ScriptValue> names = table ? (*table)->items : std::vector<ScriptValue>{*value};
  const bool are_texts = std::ranges::all_of(names, [](const ScriptValue& name) { return std::holds_alternative<std::string>(name); });
  if (!are_texts || (table && !(*table)->fields.empty())) {
    reader.add_problem("through: expected names or patterns of components or faces that pass through walls: through = { \"sting*\", \"strut\" }");
    return;
  }
  for (const ScriptValue& name : names) tunnel.through.push_back(std::get<std::string>(name));
}

ScriptValue make_test_section_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_test_section_usage);
  TestSectionOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  ModelValue tunnel{.without_description = "it is a test section"};
  const bool is_given = !items.empty();
  refuse_items_beyond(reader, 1);
  if (is_given && is_placeholder(call, items.front())) finish_checks(call);  // the faces of a placeholder are unknown
  if (is_given) {
    if (const ModelHandle solid = model_of(items.front(), call)) take_solid(solid, reader, tunnel);
    else reader.add_problem("entry 1: expected the model of a closed solid, not " + std::string(type_text(items.front())));
  } else {
    reader.read_options(schema);
    apply_overrides(call, schema);
    reader.require(schema);
    const bool is_round = !is_automatic(options.diameter);
    if (is_round && (!is_automatic(options.width) || !is_automatic(options.height)))
      reader.add_problem("diameter: a round section has neither width nor height");
    if (!is_round && (is_automatic(options.width) || is_automatic(options.height)))
      reader.add_problem("needs width and height, or the diameter of a round section");
    const std::optional<Vec3> position = read_point(reader, "position");
    // Problems found so far are reported together with later ones, because a section that cannot be made has no faces.
    if (!is_automatic(options.length) && is_round == (is_automatic(options.width) && is_automatic(options.height))) {
      tunnel.model = make_test_section(options);
      if (position) tunnel.model = transformed(tunnel.model, translation(*position));
    }
  }
  TunnelSizeOptions size;
  reader.read_options(sterna::options_of(size));
  add_size(size, tunnel);
  if (const ScriptValue* walls = reader.field("walls")) read_patch(*walls, "walls", names_of_role(tunnel.model, FaceRole::wall), tunnel, reader);
  if (!is_given)
    for (const char* side : k_sides)
      if (const ScriptValue* value = reader.field(side)) {
        if (!is_automatic(options.diameter)) reader.add_problem(std::string(side) + ": a round section has one wall: walls = ...");
        else read_patch(*value, side, {options.wall + "_" + side}, tunnel, reader);
      }
  read_patches(reader, tunnel);
  read_through(reader, tunnel);
  reader.finish();
  return std::make_shared<const ModelValue>(std::move(tunnel));
}

std::string test_section_help() {
  TestSectionOptions options;
  TunnelSizeOptions size;
  Rule rule;
  return options_help(sterna::options_of(options)) + options_help(sterna::options_of(size)) +
         "position = {x, y, z}: position of the model, instead of the origin. walls, floor, ceiling, left, right = \"slip\", \"symmetry\", \"wall\" or a table "
         "(with layers the side becomes a wall); patches = { [\"outlet*\"] = { ... } } for any patch:\n  kind: wall, slip, symmetry, inflow, outflow, "
         "farfield, interface\n" +
         options_help(size_rule_options(rule)) + options_help(tunnel_layer_options(rule)) +
         "through = \"strut*\" or { \"strut*\", \"wing\" }: components or faces, by name, that pass through the walls and are cut off there; stings made "
         "by\nsting{} always may. Any other part outside the tunnel is an error\ntest_section{ model, inflow = \"in*\", outflow = \"out*\", walls = ... }: "
         "uses a closed solid as the tunnel\n";
}

/// Returns all entries as models; notes a problem for any other value.
std::vector<ModelHandle> model_items(const ScriptCall& call, TableReader& reader) {
  std::vector<ModelHandle> models;
  std::size_t number = 0;
  for (const ScriptValue& item : reader.items()) {
    ++number;
    if (ModelHandle model = model_of(item, call)) models.push_back(std::move(model));
    else reader.add_problem("entry " + std::to_string(number) + ": expected a model or a component, not " + std::string(type_text(item)));
  }
  if (number == 0) reader.add_problem("needs a model or a component");
  return models;
}

/// Returns true if all entries are surfaces.
bool is_of_surfaces(TableReader& reader, std::vector<SurfaceHandle>& surfaces) {
  const std::vector<ScriptValue>& items = reader.items();
  for (const ScriptValue& item : items)
    if (const auto* surface = std::get_if<SurfaceHandle>(&item)) surfaces.push_back(*surface);
  return !items.empty() && surfaces.size() == items.size();
}

ScriptValue make_assembly(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_assembly_usage);
  AssemblyOptions options;
  TableReader reader(table, call.attempted());
  const RunContext& context = call.session.context;
  if (std::vector<SurfaceHandle> surfaces; is_of_surfaces(reader, surfaces)) {
    reader.finish();
    return std::make_shared<const SurfaceValue>(side_by_side(surfaces, context));
  }
  const std::vector<ModelHandle> models = model_items(call, reader);
  reader.read_options(sterna::options_of(options));
  reader.finish();
  return std::make_shared<const ModelValue>(options.unite ? assemble_united(models, context) : assemble(models, context));
}

std::string assembly_help() {
  AssemblyOptions options;
  return options_help(sterna::options_of(options));
}

constexpr std::array<ScriptVerb, 2> k_tunnel_verbs = {{
    {"test_section", k_test_section_usage,
     "Makes a wind tunnel around the x axis, rectangular, round, or from a closed solid. surface_mesh{ model, tunnel } meshes the boundary of the fluid "
     "between model and tunnel.",
     make_test_section_verb, test_section_help, true, "model"},
    {"assembly", k_assembly_usage, "Joins models and components to one model, united where they touch. Surfaces are joined without union.", make_assembly,
     assembly_help, true, "model or surface", true},
}};

}  // namespace

std::span<const ScriptVerb> tunnel_verbs() { return k_tunnel_verbs; }

}  // namespace sterna::scripting
