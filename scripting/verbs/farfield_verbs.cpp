#include "scripting/verbs/farfield_verbs.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "geom/base/error.h"
#include "scripting/lua/script_check.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/typed_number.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_farfield_sphere_usage =
    "sphere{ radius = 100, edge = 20, center = {0, 0, 0} }  or, as a source,  sphere{ {0, 0, 0}, radius = 1, size = 0.1 }";
constexpr std::string_view k_box_usage =
    "box{ {-10, -5, -5}, {20, 5, 5}, edge = 2, sides = { x_min = \"inflow\", x_max = { kind = \"outflow\", edge = 0.5 } } }  or, "
    "above an open sheet,  box{ floor = \"terrain\" }";
constexpr std::string_view k_cylinder_usage =
    "cylinder{ {-10, 0, 0}, {20, 0, 0}, radius = 5, edge = 1, sides = { start = \"inflow\", [\"end\"] = \"outflow\" } }";
constexpr std::string_view k_text_usage =
    "\"sphere radius=100 edge=20\", \"box -10 -5 -5 20 5 5 edge=2 x_min=inflow\", \"box floor=terrain\", \"cylinder -10 0 0 20 0 0 radius=5 edge=1\", \"none\" "
    "or the name of a file";
constexpr std::string_view k_prefix = "farfield_";

/// Returns options of the stage by their names in its own table. `options` must outlive the table.
OptionTable short_options(volmesh::FarfieldOptions& options, std::initializer_list<std::string_view> names) {
  OptionTable table = sterna::options_of(options);
  for (Option& option : table) option.name.remove_prefix(k_prefix.size());
  std::erase_if(table, [&](const Option& option) { return std::find(names.begin(), names.end(), option.name) == names.end(); });
  return table;
}

/// Reads sides = { x_min = "inflow", x_max = { kind = "outflow", name = "exit", edge = 0.5 } }, or the string form of the option.
std::string read_sides(TableReader& reader) {
  const ScriptValue* value = reader.field("sides");
  if (!value) return {};
  if (const auto* text = std::get_if<std::string>(value)) {
    try {
      return volmesh::sides_text(volmesh::parse_sides(*text));
    } catch (const Error& error) {
      reader.add_problem("sides: " + error.info().problem + " (" + error.info().hint + ")");
      return {};
    }
  }
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty() || !(*table)->other_keys.empty()) {
    reader.add_problem("sides: expected a table such as { x_min = \"inflow\", x_max = { kind = \"outflow\", edge = 0.5 } }");
    return {};
  }
  std::vector<volmesh::SideRule> rules;
  for (const auto& [side, of_side] : (*table)->fields) {
    volmesh::SideRule rule{.side = side, .name = {}};
    const auto take = [&](const std::string& key, const ScriptValue& entry) {
      const auto* text = std::get_if<std::string>(&entry);
      const auto number = number_of(entry);
      if (key == "kind" && text) {
        rule.kind = volmesh::patch_kind_of(*text, "sides." + side);
        rule.has_kind = true;
      } else if (key == "name" && text && !text->empty() && text->find_first_of(" ,=:") == std::string::npos) {
        rule.name = *text;
      } else if (key == "edge" && number && *number > 0.0) {
        rule.edge = *number;
      } else {
        reader.add_problem("sides." + side + ": \"" + key + "\" is not a valid kind, name (without blanks) or edge (above zero)");
      }
    };
    try {
      if (const auto* fields = std::get_if<TableHandle>(&of_side))
        for (const auto& [key, entry] : (*fields)->fields) take(key, entry);
      else take("kind", of_side);
    } catch (const Error& error) {
      reader.add_problem(error.info().attempted + ": " + error.info().problem + " (" + error.info().hint + ")");
    }
    rules.push_back(std::move(rule));
  }
  return volmesh::sides_text(rules);
}

void put_point(ScriptTable& shape, const std::string& name, const Vec3& p) {
  for (std::size_t k = 0; k < 3; ++k) shape.fields[name + "_" + "xyz"[k]] = p[k];
}

void put_values(ScriptTable& shape, const OptionTable& schema) {
  for (const Option& option : schema) {
    const OptionValue value = option.get();
    if (const auto* number = std::get_if<double>(&value); number && !is_automatic(*number)) shape.fields[std::string(option.name)] = *number;
    if (const auto* text = std::get_if<std::string>(&value); text && !text->empty()) shape.fields[std::string(option.name)] = *text;
  }
}

/// Makes the value of a verb: a table for the stage "farfield".
ScriptValue make_shape(const ScriptCall& call, std::string_view shape_name, std::string_view usage, std::initializer_list<std::string_view> names) {
  const ScriptTable table = table_argument(call, 0, usage);
  volmesh::FarfieldOptions options;
  const OptionTable schema = short_options(options, names);
  TableReader reader(table, call.attempted());
  ScriptTable shape;
  shape.fields["shape"] = std::string(shape_name);
  if (shape_name == "sphere") {
    if (const auto center = read_point(reader, "center")) put_point(shape, "center", *center);
  } else {
    const std::vector<ScriptValue>& points = reader.items();
    const auto from = points.size() == 2 ? point_of(points[0]) : std::nullopt, to = points.size() == 2 ? point_of(points[1]) : std::nullopt;
    if (!points.empty() && (!from || !to)) reader.add_problem("expected two points {x, y, z}, or none: " + std::string(usage));
    if (from) put_point(shape, "from", *from);
    if (to) put_point(shape, "to", *to);
  }
  if (const std::string sides = read_sides(reader); !sides.empty()) shape.fields["sides"] = sides;
  reader.read_options(schema);
  reader.finish();
  put_values(shape, schema);
  return std::make_shared<const ScriptTable>(std::move(shape));
}

}  // namespace

ScriptValue make_sphere(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_farfield_sphere_usage);
  if (!table.items.empty() || table.fields.contains("size")) return make_sphere_source(call);
  return make_shape(call, "sphere", k_farfield_sphere_usage, {"radius", "edge"});
}
ScriptValue make_farfield_box(const ScriptCall& call) { return make_shape(call, "box", k_box_usage, {"edge", "floor"}); }
ScriptValue make_farfield_cylinder(const ScriptCall& call) { return make_shape(call, "cylinder", k_cylinder_usage, {"radius", "edge"}); }

bool is_farfield(const ScriptCall& call) {
  const auto* table = call.arguments.empty() ? nullptr : std::get_if<TableHandle>(&call.arguments.front());
  return table && !(*table)->fields.contains("size") &&
         std::ranges::any_of(std::array{"edge", "sides", "floor"}, [&](const char* name) { return (*table)->fields.contains(name); });
}

std::string sphere_help() {
  volmesh::FarfieldOptions options;
  return options_help(short_options(options, {"radius", "edge"})) +
         "center = {x, y, z}: centre, instead of the centre of the wall's bounding box; sides = { ... }: kinds of the farfield's patches\n";
}

namespace {

/// Returns the options of the stage as a table, from a string; numbers as numbers.
ScriptTable table_of_text(const std::string& text) {
  volmesh::FarfieldOptions options, defaults;
  const OptionTable schema = sterna::options_of(options);
  for (const auto& [name, value] : farfield_of_text(text)) set_option_as_typed(find_option(schema, name, "farfield"), value);
  ScriptTable table;
  for (const Option& option : schema) {
    const OptionValue value = option.get();
    const std::string name(option.name.substr(k_prefix.size()));
    if (const auto* word = std::get_if<std::string>(&value); word && *word != std::get<std::string>(option.default_value)) table.fields[name] = *word;
    if (const auto* number = std::get_if<double>(&value); number && !is_automatic(*number)) table.fields[name] = *number;
  }
  return table;
}

/// Reads { tunnel, sides = { floor = "wall" } }. Returns the table of the first entry, with the sides.
ScriptTable table_of_entry(const ScriptCall& call, const ScriptTable& given) {
  TableReader reader(given, call.attempted() + ", farfield");
  ScriptTable table;
  if (reader.items().size() != 1) reader.add_problem("expected one surface, model or file name");
  if (const std::string sides = read_sides(reader); !sides.empty()) table.fields["sides"] = sides;
  reader.finish();
  return table;
}

}  // namespace

ScriptTable with_farfield(const ScriptCall& call, ScriptTable table, std::shared_ptr<const TriMesh>& surface, std::vector<InputFile>& inputs) {
  const auto found = table.fields.find("farfield");
  if (found == table.fields.end()) return table;
  const RunContext context = call.session.context.part("farfield", 0.0, 0.0);
  ScriptValue given = found->second;
  ScriptTable options;
  if (const auto* fields = std::get_if<TableHandle>(&given)) {
    if ((*fields)->items.empty()) {
      options = **fields;
    } else {
      options = table_of_entry(call, **fields);
      given = ScriptValue((*fields)->items.front());
    }
  }
  if (const auto* text = std::get_if<std::string>(&given))
    for (auto& [name, value] : table_of_text(*text).fields) options.fields[name] = value;
  SurfaceHandle of_surface;
  if (const auto* handle = std::get_if<SurfaceHandle>(&given)) of_surface = *handle;
  else if (call.session.check && (std::holds_alternative<ModelHandle>(given) || std::holds_alternative<ComponentHandle>(given)))
    of_surface = std::get<SurfaceHandle>(placeholder(call, "surface"));
  else if (std::holds_alternative<ModelHandle>(given) || std::holds_alternative<ComponentHandle>(given))
    of_surface = std::make_shared<const SurfaceValue>(mesh_models({model_of(given, call)}, {}, {}, context, call.session.reuse()));
  if (of_surface) options.fields["shape"] = std::string("surface");
  const auto text_of = [&](const std::string& name) {
    const auto it = options.fields.find(name);
    const auto* text = it == options.fields.end() ? nullptr : std::get_if<std::string>(&it->second);
    return text ? *text : std::string();
  };
  if (call.session.check && !text_of("surface").empty()) {
    find_input(call, text_of("surface"));
    of_surface = std::get<SurfaceHandle>(placeholder(call, "surface"));
  }
  if (!of_surface)
    of_surface = read_farfield(
        {.farfield_shape = text_of("shape"), .farfield_surface = text_of("surface")}, [&](const std::string& name) { return find_input(call, name); }, context);
  if (of_surface) {
    surface = std::shared_ptr<const TriMesh>(of_surface, &of_surface->mesh);
    inputs = of_surface->inputs;
  }
  if (!options.fields.empty()) found->second = std::make_shared<const ScriptTable>(std::move(options));
  return table;
}

OptionOverrides farfield_of_text(const std::string& text) {
  const auto refuse = [&](const std::string& problem) {
    return Error({.code = ErrorCode::bad_argument, .attempted = "farfield \"" + text + "\"", .problem = problem, .hint = std::string(k_text_usage)});
  };
  std::istringstream words(text);
  std::string shape;
  words >> shape;
  OptionOverrides options;
  std::vector<std::string> numbers;
  const bool is_known = shape == "sphere" || shape == "box" || shape == "cylinder" || shape == "none" || shape == "automatic";
  if (shape.empty() || (!is_known && shape.find('.') == std::string::npos)) throw refuse("\"" + shape + "\" is not a farfield shape");
  options.emplace_back("farfield_shape", is_known ? shape : "surface");
  if (!is_known) options.emplace_back("farfield_surface", shape);
  std::string sides;
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) numbers.push_back(word);
    else if (const std::string name = word.substr(0, equals); name == "radius" || name == "edge" || name == "floor")
      options.emplace_back(std::string(k_prefix) + name, word.substr(equals + 1));
    else sides += (sides.empty() ? "" : " ") + word;
  }
  if (!sides.empty()) options.emplace_back("farfield_sides", volmesh::sides_text(volmesh::parse_sides(sides)));
  const std::size_t n_expected = shape == "sphere" ? 3 : shape == "box" || shape == "cylinder" ? 6 : 0;
  if (!numbers.empty() && numbers.size() != n_expected)
    throw refuse(std::to_string(numbers.size()) + " coordinates, expected " + (n_expected > 0 ? std::to_string(n_expected) + " or none" : "none"));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    options.emplace_back(std::string(k_prefix) + (shape == "sphere" ? "center_" : i < 3 ? "from_" : "to_") + "xyz"[i % 3], numbers[i]);
  return options;
}

SurfaceHandle read_farfield(const volmesh::FarfieldOptions& options, const std::function<InputPath(const std::string&)>& find, const RunContext& context) {
  if (options.farfield_shape != "surface" || options.farfield_surface.empty()) return nullptr;
  const std::array files = {find(options.farfield_surface)};
  if (is_model_file(files.front().path)) return std::make_shared<const SurfaceValue>(mesh_model_files(files, {}, {}, context));
  surfmesh::StitchOptions reading;
  reading.allow_open = true;  // the surface may end in the plane of a half model
  return std::make_shared<const SurfaceValue>(read_wall(files, reading, context));
}

}  // namespace sterna::scripting
