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

namespace {

using volmesh::SizeSource;
using volmesh::SourceKind;

struct KindOfSource {
  SourceKind kind;
  std::string_view verb;
  std::size_t n_points;
  std::string_view options;  ///< names of the options that the verb accepts, each between blanks
  std::string_view usage;
};
constexpr std::array<KindOfSource, 6> k_source_kinds = {{
    {SourceKind::point, "point", 1, " size ", "point{ {0, 0, 0}, size = 0.01 }"},
    {SourceKind::line, "line", 2, " size radius ", "line{ {0, 0, 0}, {8, 0, 0}, size = 0.02, radius = 0.5 }"},
    {SourceKind::box, "box", 2, " size ", "box{ {-1, -2, -1}, {9, 2, 3}, size = 0.05 }"},
    {SourceKind::sphere, "sphere", 1, " size radius ", "sphere{ {0, 0, 0}, radius = 1, size = 0.1 }"},
    {SourceKind::cylinder, "cylinder", 2, " size radius ", "cylinder{ {0, 0, 0}, {8, 0, 0}, radius = 1, size = 0.1 }"},
    {SourceKind::wake, "wake", 2, " size size_end length height spread direction ",
     "wake{ {1, 0, 0}, {2, 5, 0}, direction = {1, 0, 0.05}, length = 10, height = 0.2, spread = 0.05, size = 0.05 }"},
}};
constexpr std::string_view k_wake_usage =
    "wake{ {1, 0, 0}, {2, 5, 0}, direction = {1, 0, 0.05}, length = 10, height = 0.2, spread = 0.05, size = 0.05 }  or, behind a surface,  wake{ wall, length "
    "= 2 }";
constexpr std::string_view k_samples_usage = "size_samples{ \"sizes.vtu\", name = \"size\" }";

/// Returns "line takes two points, size, radius".
std::string keys_text(const KindOfSource& kind) {
  std::string text = std::string(kind.verb) + " takes " + (kind.n_points == 2 ? "two points" : "a point");
  std::istringstream options{std::string(kind.options)};
  for (std::string name; options >> name;) text += ", " + name;
  return text;
}

/// Returns the options of this kind; `source` must outlive them.
OptionTable options_of(SizeSource& source, const KindOfSource& kind) {
  OptionTable table = sterna::options_of(source);
  std::erase_if(table, [&](const Option& option) { return kind.options.find(" " + std::string(option.name) + " ") == std::string_view::npos; });
  return table;
}

SizeSource source_of(ScriptTable table, const KindOfSource& kind, const std::string& attempted) {
  table.fields.erase("shape");  // the verb sets it; it is no key of the user's
  SizeSource source{.kind = kind.kind};
  const OptionTable options = options_of(source, kind);
  TableReader reader(table, attempted);
  const std::vector<ScriptValue>& points = reader.items();
  const auto first = points.empty() ? std::nullopt : point_of(points[0]);
  const auto second = points.size() < 2 ? std::nullopt : point_of(points[1]);
  if (points.size() != kind.n_points || !first || (kind.n_points == 2 && !second))
    reader.add_problem("expected " + std::string(kind.n_points == 2 ? "two points" : "a point") + " {x, y, z}: " + std::string(kind.usage));
  if (first) source.from = *first;
  if (second) source.to = *second;
  reader.read_options(options);
  reader.require(options);
  try {
    reader.finish();
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.hint = keys_text(kind);
    throw Error(std::move(info));
  }
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

/// Makes wake{ wall, length = 2 }. The numbers follow from the surface, so the result is the table of an ordinary wake.
ScriptValue make_wake_behind(const ScriptCall& call, const SurfaceHandle& wall) {
  const ScriptTable table = source_table(call);
  TableReader reader(table, call.attempted());
  volmesh::BodyWake wake;
  if (reader.items().size() > 1) reader.add_problem("takes one surface, or two points");
  reader.read_options(sterna::options_of(wake));
  reader.finish();
  SizeSource source;
  try {
    source = volmesh::wake_behind(wall->mesh, wake);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = call.attempted();
    throw Error(std::move(info));
  }
  return table_of_source(source);
}

ScriptValue make_wake(const ScriptCall& call) {
  const auto* table = call.arguments.empty() ? nullptr : std::get_if<TableHandle>(&call.arguments.front());
  const auto* wall = table && !(*table)->items.empty() ? std::get_if<SurfaceHandle>(&(*table)->items.front()) : nullptr;
  return wall ? make_wake_behind(call, *wall) : make_source_of_verb(call);
}

std::string wake_help() {
  SizeSource source;
  volmesh::BodyWake wake;
  return options_help(options_of(source, k_source_kinds[5])) + "behind a surface, wake{ wall, length = 2 }:\n" + options_help(sterna::options_of(wake));
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
  SizeSource source;
  return options_help(options_of(source, k_source_kinds[I]));
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
  SizeSource source{.kind = kind->kind, .from = k_no_vector, .to = k_no_vector};
  OptionTable options = options_of(source, *kind);
  for (const Option& option : sterna::options_of(source))
    if (option.name == "from" || (option.name == "to" && kind->n_points == 2)) {
      options.push_back(option);
      options.back().required = true;
      if (kind->n_points == 2) continue;
      options.push_back(option);
      options.back().name = "center";
    }
  std::string rest;
  std::getline(words, rest);
  std::vector<double> coordinates;
  try {
    for (const std::string& word : set_options_as_typed(options, rest, attempted)) coordinates.push_back(typed_number(word, Unit::metre));
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    if (info.hint.find("did you mean") == std::string::npos) info.hint = keys_text(*kind);
    throw Error(std::move(info));
  }
  if (!coordinates.empty()) {
    if (!is_automatic(source.from.x) || !is_automatic(source.to.x))
      throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = "the points are given twice, with and without a name"});
    if (coordinates.size() != 3 * kind->n_points)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = attempted,
                   .problem = "expected " + std::to_string(3 * kind->n_points) + " coordinates, found " + std::to_string(coordinates.size()),
                   .hint = keys_text(*kind)});
    source.from = {coordinates[0], coordinates[1], coordinates[2]};
    if (kind->n_points == 2) source.to = {coordinates[3], coordinates[4], coordinates[5]};
  }
  require_options(options, attempted);
  if (kind->n_points == 1) source.to = {};
  return source;
}

SizeSource wake_of_text(const std::string& text, const TriMesh& wall) {
  const std::string attempted = "wake \"" + text + "\"";
  volmesh::BodyWake wake;
  const std::vector<std::string> others = set_options_as_typed(sterna::options_of(wake), text, attempted);
  if (!others.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = others.front() + " is not NAME=VALUE",
                 .hint = "such as --wake \"length=2 size=5cm\""});
  return volmesh::wake_behind(wall, wake);
}

TableHandle table_of_source(SizeSource source) {
  const KindOfSource& kind = *std::ranges::find(k_source_kinds, source.kind, &KindOfSource::kind);
  ScriptTable made;
  made.items = {script_value_of(source.from)};
  if (kind.n_points == 2) made.items.push_back(script_value_of(source.to));
  for (const Option& option : options_of(source, kind))
    if (option.has_value()) made.fields[std::string(option.name)] = script_value_of(option.get());
  made.fields["shape"] = std::string(kind.verb);
  return std::make_shared<const ScriptTable>(std::move(made));
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
