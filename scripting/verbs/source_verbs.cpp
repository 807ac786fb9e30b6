#include "scripting/verbs/source_verbs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "io/field/point_field.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/geometry_verbs.h"
#include "volmesh/case/body_wake.h"

namespace sterna::scripting {

/// The numbers of all kinds of sources. Each verb accepts some of them.
struct SourceNumbers {
  double size = k_automatic;
  double size_end = k_automatic;
  double radius = k_automatic;
  double length = k_automatic;
  double height = k_automatic;
  double spread = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::SourceNumbers> {
  using O = scripting::SourceNumbers;
  static constexpr std::string_view stage = "source";
  static constexpr std::array fields = {
      Field<O>{.name = "size", .member = &O::size, .unit = Unit::metre, .min = 1e-12, .help = "edge length inside the region", .required = true},
      Field<O>{.name = "size_end", .member = &O::size_end, .unit = Unit::metre, .min = 1e-12, .help = "edge length at the downstream end", .automatic = "size"},
      Field<O>{.name = "radius",
               .member = &O::radius,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "distance from the point or line within which the edge length applies",
               .automatic = "0"},
      Field<O>{.name = "length", .member = &O::length, .unit = Unit::metre, .min = 1e-12, .help = "length of the region along its direction", .required = true},
      Field<O>{.name = "height", .member = &O::height, .unit = Unit::metre, .min = 0.0, .help = "thickness of the region at its start", .automatic = "0"},
      Field<O>{.name = "spread",
               .member = &O::spread,
               .min = 0.0,
               .max = 10.0,
               .help = "growth of half the thickness per distance from the start",
               .automatic = "0"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

using volmesh::SizeSource;
using volmesh::SourceKind;

struct KindOfSource {
  SourceKind kind;
  std::string_view verb;
  std::size_t n_points;
  std::string_view numbers;  ///< names of the numbers that the verb accepts, separated by blanks
  std::string_view usage;
};
constexpr std::array<KindOfSource, 6> k_source_kinds = {{
    {SourceKind::point, "point", 1, " size ", "point{ {0, 0, 0}, size = 0.01 }"},
    {SourceKind::line, "line", 2, " size radius ", "line{ {0, 0, 0}, {8, 0, 0}, size = 0.02, radius = 0.5 }"},
    {SourceKind::box, "box", 2, " size ", "box{ {-1, -2, -1}, {9, 2, 3}, size = 0.05 }"},
    {SourceKind::sphere, "sphere", 1, " size radius ", "sphere{ {0, 0, 0}, radius = 1, size = 0.1 }"},
    {SourceKind::cylinder, "cylinder", 2, " size radius ", "cylinder{ {0, 0, 0}, {8, 0, 0}, radius = 1, size = 0.1 }"},
    {SourceKind::wake, "wake", 2, " size size_end length height spread ",
     "wake{ {1, 0, 0}, {2, 5, 0}, direction = {1, 0, 0.05}, length = 10, height = 0.2, spread = 0.05, size = 0.05 }"},
}};
constexpr std::string_view k_wake_usage =
    "wake{ {1, 0, 0}, {2, 5, 0}, direction = {1, 0, 0.05}, length = 10, height = 0.2, spread = 0.05, size = 0.05 }  or, behind a surface,  wake{ wall, length "
    "= 2 }";
constexpr std::string_view k_samples_usage = "size_samples{ \"sizes.vtu\", name = \"size\" }";

/// Returns "line takes two points, size, radius".
std::string keys_text(const KindOfSource& kind) {
  std::string text = std::string(kind.verb) + " takes " + (kind.n_points == 2 ? "two points" : "a point");
  std::istringstream numbers{std::string(kind.numbers)};
  for (std::string name; numbers >> name;) text += ", " + name;
  return kind.kind == SourceKind::wake ? text + ", direction" : text;
}

/// Returns the dimension of the value of a source with that key: that of the option if there is one, none for a direction, else a length.
Unit unit_of_key(const std::string& key) {
  SourceNumbers numbers;
  for (const Option& option : sterna::options_of(numbers))
    if (option.name == key) return option.unit;
  return key == "direction" ? Unit::none : Unit::metre;
}

/// Returns the options of this kind; `numbers` must outlive them.
OptionTable options_of(SourceNumbers& numbers, const KindOfSource& kind) {
  OptionTable table = sterna::options_of(numbers);
  std::erase_if(table, [&](const Option& option) { return kind.numbers.find(" " + std::string(option.name) + " ") == std::string_view::npos; });
  return table;
}

SizeSource source_of(ScriptTable table, const KindOfSource& kind, const std::string& attempted) {
  table.fields.erase("shape");  // the verb sets it; it is no key of the user's
  SizeSource source{.kind = kind.kind};
  SourceNumbers numbers;
  const OptionTable options = options_of(numbers, kind);
  TableReader reader(table, attempted);
  const std::vector<ScriptValue>& points = reader.items();
  const auto first = points.empty() ? std::nullopt : point_of(points[0]);
  const auto second = points.size() < 2 ? std::nullopt : point_of(points[1]);
  if (points.size() != kind.n_points || !first || (kind.n_points == 2 && !second))
    reader.add_problem("expected " + std::string(kind.n_points == 2 ? "two points" : "a point") + " {x, y, z}: " + std::string(kind.usage));
  if (first) source.from = *first;
  if (second) source.to = *second;
  if (kind.kind == SourceKind::wake) {
    if (const ScriptValue* direction = reader.field("direction")) {
      if (const auto vector = point_of(*direction)) source.direction = *vector;
      else reader.add_problem("direction: expected {x, y, z}");
    }
  }
  reader.read_options(options);
  reader.require(options);
  try {
    reader.finish();
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.hint = keys_text(kind);
    throw Error(std::move(info));
  }
  const auto or_zero = [](double value) { return is_automatic(value) ? 0.0 : value; };
  source.size = numbers.size;
  source.size_end = or_zero(numbers.size_end);
  source.radius = or_zero(numbers.radius);
  source.length = or_zero(numbers.length);
  source.height = or_zero(numbers.height);
  source.spread = or_zero(numbers.spread);
  return source;
}

ScriptTable source_table(const ScriptCall& call) {
  if (call.arguments.size() == 1)
    if (const auto* table = std::get_if<TableHandle>(&call.arguments.front())) return **table;
  throw Error({.code = ErrorCode::bad_argument, .attempted = call.attempted(), .problem = "takes one table"});
}

ScriptValue make_source(const ScriptCall& call, const KindOfSource& kind) {
  ScriptTable table = source_table(call);
  const SizeSource source = source_of(table, kind, call.attempted());
  // The growth of sizes is known only in volume_mesh. All other problems can be reported for this line.
  if (const std::string problem = problem_of(source, k_unbounded); !problem.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = call.attempted(), .problem = problem, .hint = std::string(kind.usage)});
  table.fields["shape"] = std::string(kind.verb);
  return std::make_shared<const ScriptTable>(std::move(table));
}

const KindOfSource* kind_named(std::string_view verb) {
  const auto it = std::ranges::find(k_source_kinds, verb, &KindOfSource::verb);
  return it == k_source_kinds.end() ? nullptr : &*it;
}

ScriptValue make_source_of_verb(const ScriptCall& call) { return make_source(call, *kind_named(call.verb)); }

/// Returns true if box{...} or cylinder{...} is a source, that is, if it has `size`. With `edge` or `sides` it is a farfield, otherwise a solid.
bool has_size(const ScriptCall& call) {
  const auto* table = call.arguments.empty() ? nullptr : std::get_if<TableHandle>(&call.arguments.front());
  return table && (*table)->fields.contains("size");
}
ScriptValue make_box_or_source(const ScriptCall& call) {
  return has_size(call) ? make_source_of_verb(call) : is_farfield(call) ? make_farfield_box(call) : make_box_model(call);
}
ScriptValue make_cylinder_or_source(const ScriptCall& call) {
  return has_size(call) ? make_source_of_verb(call) : is_farfield(call) ? make_farfield_cylinder(call) : make_cylinder_model(call);
}

ScriptValue point_value(const Vec3& p) { return std::make_shared<const ScriptTable>(ScriptTable{.items = {p.x, p.y, p.z}, .fields = {}, .other_keys = {}}); }

/// Makes wake{ wall, length = 2 }. The numbers follow from the surface, so the result is the table of an ordinary wake.
ScriptValue make_wake_behind(const ScriptCall& call, const SurfaceHandle& wall) {
  const ScriptTable table = source_table(call);
  TableReader reader(table, call.attempted());
  volmesh::BodyWake wake;
  if (reader.items().size() > 1) reader.add_problem("takes one surface, or two points");
  reader.read_options(sterna::options_of(wake));
  Vec3 direction{1.0, 0.0, 0.0};
  if (const auto given = read_point(reader, "direction")) direction = *given;
  reader.finish();
  SizeSource source;
  try {
    source = volmesh::wake_behind(wall->mesh, wake, direction);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = call.attempted();
    throw Error(std::move(info));
  }
  ScriptTable made;
  made.items = {point_value(source.from), point_value(source.to)};
  made.fields["direction"] = point_value(source.direction);
  for (const auto& [name, value] :
       {std::pair{"length", source.length}, {"height", source.height}, {"spread", source.spread}, {"size", source.size}, {"size_end", source.size_end}})
    made.fields[name] = value;
  made.fields["shape"] = std::string("wake");
  return std::make_shared<const ScriptTable>(std::move(made));
}

ScriptValue make_wake(const ScriptCall& call) {
  const auto* table = call.arguments.empty() ? nullptr : std::get_if<TableHandle>(&call.arguments.front());
  const auto* wall = table && !(*table)->items.empty() ? std::get_if<SurfaceHandle>(&(*table)->items.front()) : nullptr;
  return wall ? make_wake_behind(call, *wall) : make_source_of_verb(call);
}

std::string wake_help() {
  SourceNumbers numbers;
  volmesh::BodyWake wake;
  return options_help(options_of(numbers, k_source_kinds[5])) + "behind a surface, wake{ wall, length = 2 }:\n" + options_help(sterna::options_of(wake));
}

/// Makes size_samples{}. Only the table is checked here; the file is read by the verb that uses it.
ScriptValue make_samples(const ScriptCall& call) {
  ScriptTable table;
  if (call.arguments.size() == 1 && std::holds_alternative<std::string>(call.arguments.front())) table.items.push_back(call.arguments.front());
  else table = source_table(call);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  if (items.size() != 1 || !std::holds_alternative<std::string>(items.front())) reader.add_problem("expected one file name: " + std::string(k_samples_usage));
  if (const ScriptValue* name = reader.field("name"); name && !std::holds_alternative<std::string>(*name))
    reader.add_problem("name: expected the name of a point data array");
  reader.finish();
  table.fields["shape"] = std::string("size_samples");
  return std::make_shared<const ScriptTable>(std::move(table));
}

SizeSource read_samples(const ScriptTable& table, const ScriptCall& call) {
  const std::filesystem::path given = std::get<std::string>(table.items.front());
  const std::filesystem::path beside_script = call.session.script.parent_path() / given;
  std::error_code ignored;  // a name that cannot be accessed is reported by the reader, with the reason
  const bool is_beside = given.is_relative() && !std::filesystem::exists(given, ignored) && std::filesystem::exists(beside_script, ignored);
  const auto name = table.fields.find("name");
  io::PointField field =
      io::read_point_field(is_beside ? beside_script : given, name == table.fields.end() ? "size" : std::get<std::string>(name->second), call.session.context);
  return {.kind = SourceKind::samples, .points = std::move(field.points), .sizes = std::move(field.values)};
}

template <std::size_t I>
std::string numbers_help() {
  SourceNumbers numbers;
  return options_help(options_of(numbers, k_source_kinds[I]));
}

constexpr std::array<ScriptVerb, 6> k_source_verbs = {{
    {"point", k_source_kinds[0].usage, "Source of short edges at a point, for volume_mesh and surface_mesh.", make_source_of_verb, numbers_help<0>, false,
     "source"},
    {"line", k_source_kinds[1].usage, "Source of short edges within a distance of a line, for volume_mesh and surface_mesh.", make_source_of_verb,
     numbers_help<1>, false, "source"},
    {"box", k_source_kinds[2].usage,
     "Axis-parallel box. With size: a source of short edges, for volume_mesh and surface_mesh; with edge, sides or floor: a farfield; otherwise a solid.",
     make_box_or_source, numbers_help<2>, false, "model"},
    {"cylinder", k_source_kinds[4].usage,
     "Cylinder. With size: a source of short edges, for volume_mesh and surface_mesh; with edge or sides: a farfield; otherwise a solid.",
     make_cylinder_or_source, numbers_help<4>, false, "model"},
    {"wake", k_wake_usage, "Source of short edges behind a trailing edge or behind a whole surface, for volume_mesh and surface_mesh.", make_wake, wake_help,
     false, "source"},
    {"size_samples", k_samples_usage, "Source of target edge lengths at the points of a VTU file, for volume_mesh and surface_mesh.", make_samples, nullptr,
     false, "source"},
}};

}  // namespace

std::span<const ScriptVerb> source_verbs() { return k_source_verbs; }

SizeSource source_of_text(const std::string& text) {
  const std::string attempted = "source \"" + text + "\"";
  std::istringstream words(text);
  std::string verb;
  words >> verb;
  const KindOfSource* kind = kind_named(verb);
  if (kind == nullptr) {
    std::string names;
    for (const KindOfSource& known : k_source_kinds) names += (names.empty() ? "" : ", ") + std::string(known.verb);
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "\"" + verb + "\" is not a kind of source",
                 .hint = "known are " + names + "; such as \"sphere 0 0 0 radius=1 size=0.1\""});
  }
  ScriptTable table;
  std::vector<double> numbers;
  const auto point_at = [](double x, double y, double z) {
    return std::make_shared<const ScriptTable>(ScriptTable{.items = {x, y, z}, .fields = {}, .other_keys = {}});
  };
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) {
      numbers.push_back(typed_number(word, Unit::metre));
      continue;
    }
    const std::string key = word.substr(0, equals);
    std::vector<double> values;
    std::istringstream list(word.substr(equals + 1));
    for (std::string value; std::getline(list, value, ',');) values.push_back(typed_number(value, unit_of_key(key)));
    if (key == "from" || key == "to" || key == "center") {
      if (values.size() != 3) throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = word + ": expected three coordinates"});
      numbers.insert(key == "to" ? numbers.end() : numbers.begin(), values.begin(), values.end());
      continue;
    }
    ScriptValue& field = table.fields[key];
    if (values.size() == 1) field = values.front();
    else if (values.size() == 3) field = point_at(values[0], values[1], values[2]);
    else throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = word + ": expected one number, or three for a direction"});
  }
  if (numbers.size() % 3 != 0)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "the number of coordinates must be a multiple of three, not " + std::to_string(numbers.size())});
  for (std::size_t i = 0; i < numbers.size(); i += 3) table.items.push_back(point_at(numbers[i], numbers[i + 1], numbers[i + 2]));
  return source_of(table, *kind, attempted);
}

SizeSource wake_of_text(const std::string& text, const TriMesh& wall) {
  const std::string attempted = "wake \"" + text + "\"";
  volmesh::BodyWake wake;
  Vec3 direction{1.0, 0.0, 0.0};
  const OptionTable table = sterna::options_of(wake);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw Error(
          {.code = ErrorCode::bad_argument, .attempted = attempted, .problem = word + " is not NAME=VALUE", .hint = "such as --wake \"length=2 size=5cm\""});
    const std::string value = word.substr(equals + 1);
    if (word.substr(0, equals) != "direction") {
      set_option_as_typed(find_option(table, word.substr(0, equals), attempted), value);
      continue;
    }
    std::vector<double> numbers;
    std::istringstream list(value);
    for (std::string number; std::getline(list, number, ',');) numbers.push_back(typed_number(number, Unit::none));
    if (numbers.size() != 3) throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = word + ": expected three numbers"});
    direction = {numbers[0], numbers[1], numbers[2]};
  }
  return volmesh::wake_behind(wall, wake, direction);
}

ScriptValue make_sphere_source(const ScriptCall& call) { return make_source(call, *kind_named("sphere")); }

std::vector<SizeSource> read_sources(TableReader& reader, const ScriptCall& call) {
  std::vector<SizeSource> sources;
  for (const ShapeEntry& entry : read_shapes(reader, "sources", k_source_kinds[2].usage)) {
    const KindOfSource* kind = entry.shape.empty() ? nullptr : kind_named(entry.shape);
    if (entry.shape == "size_samples") sources.push_back(read_samples(*entry.table, call));
    else if (kind && entry.table->fields.contains("size")) sources.push_back(source_of(*entry.table, *kind, call.attempted() + ", " + entry.where));
    else
      reader.add_problem(entry.where + ": expected a source such as " + std::string(k_source_kinds[2].usage) + ", not " + std::string(type_text(entry.value)));
  }
  return sources;
}

}  // namespace sterna::scripting
