#include "scripting/verbs/draw_verbs.h"

#include <array>
#include <charconv>

#include "scripting/lua/script_check.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/draw_command.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_draw_usage =
    "draw{ mesh, \"mesh.png\", view = \"iso\", color = \"quality\" }  or  draw{ mesh, \"edge.png\", cut = \"section 50%\" }  or  draw{ wall, \"wall.png\", "
    "color = \"edge_length\" }";

/// Returns the shortest string that reads back as the same number.
std::string exact_text(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string list_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ",") + exact_text(number);
  return text;
}

std::string point_text(const Vec3& p) { return list_text(std::array{p.x, p.y, p.z}); }

/// Converts { {1, 2, 0}, radius = 0.5 }.
std::optional<std::string> focus_text(const ScriptTable& table) {
  const auto found = table.fields.find("radius");
  if (table.items.size() != 1 || table.fields.size() != 1 || found == table.fields.end()) return std::nullopt;
  const auto center = point_of(table.items.front());
  const auto radius = number_of(found->second);
  return center && radius ? std::optional(point_text(*center) + " radius=" + exact_text(*radius)) : std::nullopt;
}

/// Converts { 225, 30 } or { -1, -1, 0.5 }.
std::optional<std::string> view_text(const ScriptTable& table) {
  const auto numbers = numbers_of(std::make_shared<const ScriptTable>(table));
  return numbers && (numbers->size() == 2 || numbers->size() == 3) ? std::optional(list_text(*numbers)) : std::nullopt;
}

/// Converts entries that may be tables to the strings of their options.
ScriptTable with_texts(const ScriptCall& call, ScriptTable table) {
  struct Entry {
    const char* name;
    std::optional<std::string> (*text)(const ScriptTable&);
    const char* form;
  };
  constexpr std::array<Entry, 3> k_entries = {
      {{"cut", cut_text, "cut = \"leading edge\", { x = 1.2 } or { point = {0, 0, 0}, normal = {0, 1, 0} }"},
       {"focus", focus_text, "focus = { {1, 2, 0}, radius = 0.5 } or the name of a location"},
       {"view", view_text, "view = \"iso\", { 225, 30 } (azimuth, elevation) or { -1, -1, 0.5 } (from the mesh to the eye)"}}};
  for (const Entry& entry : k_entries) {
    const auto found = table.fields.find(entry.name);
    const auto* given = found == table.fields.end() ? nullptr : std::get_if<TableHandle>(&found->second);
    if (!given) continue;
    const std::optional<std::string> text = entry.text(**given);
    if (!text) reject(call, std::string(entry.name) + ": the table cannot be read", std::string("write ") + entry.form);
    found->second = *text;
  }
  return table;
}

/// Returns the name for a picture's title: the case of a series; or the first input file and the number of further ones; or the script.
std::string name_of(const std::vector<InputFile>& inputs, const ScriptCall& call) {
  if (!call.session.output_folder.empty()) return call.session.output_folder.filename().string();
  if (inputs.empty()) return call.session.script.filename().string();
  const std::string first = std::filesystem::path(inputs.front().name).filename().string();
  return inputs.size() == 1 ? first : first + " and " + std::to_string(inputs.size() - 1) + " more";
}

ScriptValue draw_object(const ScriptCall& call) {
  const ScriptTable table = with_texts(call, table_argument(call, 0, k_draw_usage));
  DrawOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const ScriptValue object = items.empty() ? ScriptValue{} : items.front();
  const auto* mesh = std::get_if<MeshHandle>(&object);
  const auto* surface = std::get_if<SurfaceHandle>(&object);
  const auto* file = std::get_if<std::string>(&object);
  if (std::holds_alternative<ModelHandle>(object) || std::holds_alternative<ComponentHandle>(object))
    reader.add_problem("entry 1: a model has no mesh yet: draw surface_mesh{ model }");
  else if (!mesh && !surface && !file)
    reader.add_problem("entry 1: expected a mesh, a surface or the name of a file, not " + std::string(items.empty() ? "nothing" : type_text(object)));
  const auto* output = items.size() > 1 ? std::get_if<std::string>(&items[1]) : nullptr;
  if (!output) reader.add_problem("entry 2: expected the name of the picture, such as \"mesh.png\"");
  refuse_items_beyond(reader, 2);
  reader.read_options(schema);
  apply_overrides(call, schema);
  if (!file && options.unit != 1.0) reader.add_problem("unit: applies to files only; meshes and surfaces are in metres");
  try {
    if (!reader.has_problems()) require_draw_options(options);
    if (output) require_picture_output(*output);
  } catch (const Error& error) {
    reader.add_problem(error.info().problem + (error.info().hint.empty() ? "" : " (" + error.info().hint + ")"));
  }
  if (file && call.session.check) check_input(call, find_input(call, *file));
  reader.finish();
  const std::filesystem::path path = output_path(call, *output);
  const RunContext context = call.session.context.part("draw", 0.0, 1.0);
  if (mesh) {
    write_picture((*mesh)->mesh, (*mesh)->check ? &*(*mesh)->check : nullptr, options, name_of((*mesh)->inputs, call), path, context);
  } else if (surface) {
    write_picture((*surface)->mesh, options, name_of((*surface)->inputs, call), path, context);
  } else {
    const auto drawable = read_drawable(find_input(call, *file), options.unit, context);
    const std::string name = std::filesystem::path(*file).filename().string();
    if (const auto* volume = std::get_if<HybridMesh>(&drawable)) write_picture(*volume, nullptr, options, name, path, context);
    else write_picture(std::get<TriMesh>(drawable), options, name, path, context);
  }
  return std::monostate{};
}

constexpr std::array<ScriptVerb, 1> k_draw_verbs = {{{"draw", k_draw_usage,
                                                      "Draws a mesh, a surface or a file of either as a PNG picture: walls coloured by patch or quantity, "
                                                      "cells along a plane, the worst locations. Needs no display (docs/draw.md).",
                                                      draw_object, nullptr, true, "nothing", false, held_options<DrawOptions>}}};

}  // namespace

std::optional<std::string> cut_text(const ScriptTable& table) {
  const auto at = [&](const char* name) { return table.fields.find(name); };
  if (!table.items.empty() || table.fields.empty()) return std::nullopt;
  if (table.fields.size() == 1)
    for (const char* axis : {"x", "y", "z"})
      if (at(axis) != table.fields.end())
        if (const auto number = number_of(at(axis)->second)) return std::string(axis) + "=" + exact_text(*number);
  const auto normal = at("normal") == table.fields.end() ? std::nullopt : point_of(at("normal")->second);
  const auto point = at("point") == table.fields.end() ? std::nullopt : point_of(at("point")->second);
  if (!normal || !point || table.fields.size() != 2) return std::nullopt;
  return "point=" + point_text(*point) + " normal=" + point_text(*normal);
}

std::span<const ScriptVerb> draw_verbs() { return k_draw_verbs; }

}  // namespace sterna::scripting
