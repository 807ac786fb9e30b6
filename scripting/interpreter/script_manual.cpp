#include "scripting/interpreter/script_manual.h"

#include <algorithm>

#include "scripting/interpreter/script_help.h"
#include "scripting/interpreter/script_verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_head = R"(# Lua reference

Made by `sterna manual` from the tables of verbs and options; a test fails when this file is stale. Do not edit it.

A call is one verb with one table of named entries: `volume_mesh{ wall, layers = 30, first_height = 2e-6 }`. Lengths are in metres, angles in radians; `m`, `mm`, `um`, `cm`, `inch`, `ft` and `deg`
are numbers: `5*mm`, `40*deg`. An unknown entry, a wrong type or a value out of range is an error at file:line, with a suggestion; all problems of a table are reported together.
Options of a stage can be given in a table with the name of the stage: `envelope = { layers = 30 }`. `"automatic"` requests the automatic value of an option that has one.

`sterna run case.lua` runs a script, `sterna` without a command opens a prompt. `help(volume_mesh)`, `help(wall)` and `help "first_height"` print parts of this page. Scripts have Lua's base library
(without dofile, loadfile and load), `table`, `string`, `math` and `utf8`; `require "name"` loads name.lua beside the script; `math.random` depends on `--seed`; `__gc` is not available. Lua values of a
script can use up to 1 GiB. `pairs` visits keys in ascending order. Undefined names are errors, not nil. Files are searched in the current folder, then beside the script.

`sterna check-script case.lua` runs a script without meshing: every verb reads its whole table; verbs that mesh or write files stop there and return a placeholder. The check finds unknown verbs,
misspelt keys, wrong types, units and ranges, and missing files, all at once. It does not find problems that depend on results: names of patches and parts that are read or meshed, values of
fields, lines that run only with certain results, branches that are not taken, and geometry that cannot be meshed.

`sterna run case.lua alpha=4 --set envelope.layers=24` gives the script the argument `alpha` (see `args`) and sets options of all verbs that have them, with priority over the script.
)";

constexpr std::string_view k_setup =
    R"(body = fuselage{ name = "body", along = "smooth", frames = { { x = 0, diameter = 0.4 }, { x = 4, diameter = 1.2 }, { x = 8, diameter = 0.4 } } }
main_wing = wing{ name = "wing", symmetric = true, position = {3, 0, 0}, sections = { { y = 0, chord = 2, airfoil = "naca2412" }, { y = 5, chord = 1 } } }
fin = wing{ name = "fin", position = {6, 0, 0}, trailing_edge = 0, sections = { { chord = 2, airfoil = "naca0012" }, { z = 2, chord = 1 } } }
fin:control{ "Rudder", from = {0.2, 0.7}, to = {0.9, 0.7} }
engine = nacelle{ name = "engine", symmetric = true, position = {3, 2, -0.9}, length = 1.2, diameter = 0.6 }
model = box{ {0, 0, 0}, {1, 1, 1}, name = "Body" }
sting_model = box{ {0.9, 0.4, 0.4}, {2, 0.6, 0.6}, name = "sting" }
tunnel = test_section{ length = 6, width = 3, height = 3 }
wall = surface_mesh{ model, max_edge = 0.5 }
class = envelope.classify{ wall }
env = make_envelope{ wall, layers = 3, first_height = 0.01, max_thickness = 0.1 }
tets = tetrahedra{ env, farfield = sphere{ radius = 6 } }
mesh = finish_mesh{ env, tets }
model:write("model.step", "model.igs"); sting_model:write "sting.step"
aircraft{ body, fin, unite = false }:write "widebody.smx"; airliner = read_smx "widebody.smx"
wall:write("wing.stl", "body.stl"); surface_mesh{ sting_model, max_edge = 0.5 }:write "sting.stl"
mesh:write "mesh.su2"; env:write "case.sterna"
finer = volume_mesh{ surface_mesh{ model, max_edge = 0.3 }, layers = 5, first_height = 0.006, farfield = sphere{ radius = 6 } }
)";

/// Escapes bars, which cells of a Markdown table must not contain.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string options_markdown(const ScriptVerb& verb) {
  std::string text;
  for (const OptionGroup& group : option_groups(verb)) {
    if (!group.title.empty()) text += "\n" + group.title + "\n";
    if (group.options.empty()) continue;
    text += "\n| option | default | range | |\n|---|---|---|---|\n";
    for (const OptionDoc& option : group.options)
      text += "| `" + option.name + "` | " + cell(option.value) + " | " + cell(option.range) + " | " + cell(option.help) + " |\n";
  }
  return text;
}

std::string_view without_article(std::string_view gives) { return gives == "self" ? "the object itself" : gives == "inspection" ? "table" : gives; }

std::string verb_markdown(const ScriptVerb& verb) {
  std::string text = "\n### " + std::string(verb.name) + "\n\n" + std::string(verb.summary);
  if (!verb.gives.empty()) text += " Returns: " + std::string(without_article(verb.gives)) + ".";
  text += "\n\n```lua\n";
  for (const std::string& example : examples_of(verb)) text += example + "\n";
  return text + "```\n" + options_markdown(verb);
}

std::string object_markdown(const ObjectKind& kind) {
  std::string text = "\n## Object: " + std::string(kind.name) + "\n\n" + std::string(kind.summary) + "\n";
  if (!kind.fields.empty()) text += "\n| field | |\n|---|---|\n";
  for (const FieldDoc& field : kind.fields) text += "| `" + std::string(field.name) + "` | " + cell(std::string(field.help)) + " |\n";
  for (const ScriptVerb& method : kind.methods()) text += verb_markdown(method);
  return text;
}

}  // namespace

std::string_view manual_setup() { return k_setup; }

std::string manual_text(std::string_view commands) {
  std::string text(k_head);
  text += "\n## Objects of the examples\n\n```lua\n" + std::string(k_setup) + "```\n\n## Verbs\n";
  std::vector<const ScriptVerb*> verbs;
  for (const ScriptVerb& verb : script_verbs()) verbs.push_back(&verb);
  std::sort(verbs.begin(), verbs.end(), [](const ScriptVerb* a, const ScriptVerb* b) { return a->name < b->name; });
  for (const ScriptVerb* verb : verbs) text += verb_markdown(*verb);
  for (const ObjectKind& kind : object_kinds()) text += object_markdown(kind);
  return text + "\n## Command line\n\n" + std::string(commands);
}

}  // namespace sterna::scripting
