// Sets every option of every verb once through Lua. The options come from the help of the verbs, so that new verbs are included automatically. Sets every
// option of every command once through the command line.
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "geom/cad/read_cad.h"
#include "geom/cad/unite.h"
#include "geom/cad/write_cad.h"
#include "geom/draw/draw_options.h"
#include "geom/mesh/half.h"
#include "scripting/cli/commands.h"
#include "scripting/interpreter/script_manual.h"
#include "scripting/interpreter/script_state.h"
#include "scripting/interpreter/script_verbs.h"
#include "scripting/lua/script_check.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/repair_surfaces.h"
#include "surfmesh/remesh/remesh_surface.h"
#include "tests/scripting/manual/option_values.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

/// Returns the example with one more entry in its table, or with another value of an existing entry.
std::string with_entry(const std::string& example, const std::string& name, const std::string& entry) {
  const std::regex given("([{,] *)" + name + " = [^,{}]*[^,{} ]");
  if (std::regex_search(example, given))
    return std::regex_replace(example, given, "$1" + std::regex_replace(entry, std::regex("\\$"), "$$$$"), std::regex_constants::format_first_only);
  const std::size_t end = example.rfind('}');
  if (end != std::string::npos) return example.substr(0, end) + ", " + entry + " }" + example.substr(end + 1);
  const std::size_t open = example.find_first_of(" (");  // verb "text", object:method(...)
  if (example.find("()") != std::string::npos) return example.substr(0, example.find("()")) + "{ " + entry + " }";
  std::string argument = example.substr(open + (example[open] == '(' ? 1 : 0));
  if (example[open] == '(') argument.erase(argument.rfind(')'));
  return example.substr(0, open) + "{ " + argument + ", " + entry + " }";
}

/// Returns the entry for an option in the table of its verb: the assignment itself, or a nested table that the title of the option group names.
std::string entry_of(const OptionGroup& group, const std::string& assignment) {
  std::smatch match;
  if (std::regex_search(group.title, match, std::regex("patches = \\{ \\[\"[^\"]*\"\\] = \\{ \\.\\.\\. \\} \\}")))
    return "patches = { [\"*\"] = { " + assignment + " } }";
  if (std::regex_search(group.title, match, std::regex("(\\w+) = \\{ \\{"))) return std::string(match[1]) + " = { { " + assignment + " } }";
  return assignment;
}

/// Options whose value depends on other entries: the whole statement.
const std::map<std::string, std::string> k_statements = {
    {"draw.view", "draw{ mesh, 'a.png', view = 'top' }"},  // strings with a special meaning
    {"draw.color", "draw{ mesh, 'a.png', color = 'skew' }"},
    {"draw.cut", "draw{ mesh, 'a.png', cut = { x = 1.2 } }"},
    {"draw.focus", "draw{ mesh, 'a.png', focus = { {1, 2, 0}, radius = 0.5 } }"},
    {"wake_sheet.direction", "wake_sheet{ wing = 'main*', direction = {1, 0, 0.05} }"},
    {"draw.unit", "draw{ 'wing.stl', 'a.png', unit = mm }"},
    {"union.tolerance", "union{ model, sting_model, tolerance = 0.5 }"},
    {"union.time_limit", "union{ model, sting_model, time_limit = 601 }"},
    {"volume_mesh.farfield_shape", "volume_mesh{ wall, first_height = 1e-6, farfield_shape = 'sphere' }"},
    {"volume_mesh.farfield_radius", "volume_mesh{ wall, first_height = 1e-6, farfield_radius = 70 }"},
    {"nacelle.highlight_ratio", "nacelle{ name = 'engine', length = 3.6, diameter = 2.1, highlight_ratio = 0.9 }"},
    {"make_envelope.total_height", "make_envelope{ wall, layers = 10, first_height = 1e-3, total_height = 0.1 }"},  // with layers or growth, not both
    {"envelope.initial.total_height", "envelope.initial{ wall, class, layers = 5, first_height = 0.01, total_height = 0.3 }"},
    {"jobs.tasks", "jobs{ tasks = 3 }"},  // or as the single number without a name
    {"y_plus.y_plus", "y_plus{ y_plus = 2, reynolds = 5e6, length = 7 }"},
    {"mesh:su2_config.mesh", "mesh:su2_config{ 'case.cfg', mesh = 'other.su2', mach = 0.5, reynolds = 5e6, length = 7, reference_area = 1 }"},
    {"mesh:su2_config.wing", "mesh:su2_config{ 'case.cfg', wing = 'wing', mach = 0.5, reynolds = 5e6, length = 7, reference = main_wing }"},
    {"mesh:foam_case.wing", "mesh:foam_case{ 'case', wing = 'wing', reynolds = 5e6, length = 7, reference = main_wing }"},
    {"airfoil.points", "airfoil{ 'naca0012', points = 90 }"},
    {"surface.periodic_u", "surface{ function(u, v) return math.cos(2*math.pi*u), math.sin(2*math.pi*u), v end, u = {0, 1}, v = {0, 1}, periodic_u = true }"},
    {"surface.periodic_v", "surface{ function(u, v) return math.cos(2*math.pi*v), math.sin(2*math.pi*v), u end, u = {0, 1}, v = {0, 1}, periodic_v = true }"},
    {"fuselage.y", "fuselage{ frames = { { x = 0, diameter = 1, y = 0.1 }, { x = 3, diameter = 2 } } }"},
    {"fuselage.offset", "fuselage{ frames = { { x = 0, diameter = 1 }, { x = 3, width = 2, height = 2, shape = 'double_ellipse', offset = 0.2 } } }"},
    {"fuselage.distortion", "fuselage{ frames = { { x = 0, diameter = 1 }, { x = 3, width = 2, height = 2, shape = 'egg', distortion = 0.2 } } }"},
    {"fuselage.points", "fuselage{ frames = { { x = 0, points = { {0, -1}, {1, 0}, {0, 1} } }, { x = 3, points = { {0, -1}, {1, 0}, {0, 1} } } } }"},
    {"wing.winglet", "wing{ sections = { { y = 0, chord = 2, airfoil = 'naca0012' }, { y = 5, chord = 1 } }, winglet = { height = 1, cant = 80*deg } }"},
    {"wing:deflect.hinge",
     "wing{ sections = { { y = 0, chord = 2, airfoil = 'naca0012' }, { y = 5, chord = 1 } } }:deflect{ 'flap', hinge = { {0.1, 0.7}, {0.5, 0.7} }, angle = "
     "5*deg }"},
    {"wing:control.hinge",
     "wing{ sections = { { y = 0, chord = 2, airfoil = 'naca0012' }, { y = 5, chord = 1 } } }:control{ 'flap', hinge = { {0.1, 0.7}, {0.5, 0.7} } }"},
};

/// Consistent sets of flow conditions.
const std::vector<std::string> k_flows = {
    "mach = 0.5, altitude = 1000, temperature_offset = 10, length = 2", "speed = 60, temperature = 293, pressure = 101325, length = 0.3",
    "speed = 60, temperature = 293, density = 1.2, viscosity = 1.8e-5, length = 0.3", "reynolds = 5e6, temperature = 293, mach = 0.2, length = 7"};
const std::map<std::string_view, std::string> k_flow_verbs = {{"flow", "flow{ "},
                                                              {"y_plus", "y_plus{ 1, "},
                                                              {"boundary_layer", "boundary_layer{ "},
                                                              {"mesh:su2_config", "mesh:su2_config{ 'case.cfg', reference_area = 1, "},
                                                              {"mesh:foam_case", "mesh:foam_case{ 'case', reference_area = 1, "}};

/// Returns the statements in which an option may be set: the examples with the option in their table.
std::vector<std::string> statements_for(const ScriptVerb& verb, const OptionGroup& group, const OptionDoc& option) {
  if (const auto known = k_statements.find(std::string(verb.name) + "." + option.name); known != k_statements.end()) return {known->second};
  std::vector<std::string> statements;
  const std::string assignment = option.name + " = " +
                                 (option.name == "airfoil"      ? "'naca0012'"
                                  : option.value == "{x, y, z}" ? "{1, 5, 0.5}"
                                                                : other_value(option));
  if (const auto verb_of_flow = k_flow_verbs.find(verb.name); verb_of_flow != k_flow_verbs.end()) {
    if (group.title.find("boundaries = {") != std::string::npos)
      return {verb_of_flow->second + k_flows.front() + ", boundaries = { prop = { " + assignment + " } } }"};
    for (const std::string& flow : k_flows)
      if ((", " + flow).find(", " + option.name + " = ") != std::string::npos) return {verb_of_flow->second + flow + " }"};
  }
  if (group.title.starts_with("deflections = {")) {
    const std::string settings = " Rudder = { " + (option.name == "angle" ? "" : std::string("angle = 5*deg, ")) + assignment + " } }";
    if (verb.name == "model:deflect") return {"airliner:deflect{" + settings};
    return {std::string(verb.name) + "{ " + (verb.name == "read_smx" ? "'widebody.smx'" : "'d150.xml'") + ", deflections = {" + settings + " }"};
  }
  const std::string root = "wing{ sections = { { y = 0, chord = 2, airfoil = 'naca0012' }, { ";
  if (group.title.starts_with("each section"))
    return {root + assignment + ", y = 5 } } }", root + assignment + " } } }", root + "y = 5, " + assignment + ", z = 1 } } }"};
  if (group.title.starts_with("winglet")) return {root + "y = 5, chord = 1 } }, winglet = { height = 1, " + assignment + " } }"};
  for (const std::string& example : examples_of(verb)) {
    if (const std::size_t patch = example.find("[\"Body*\"] = { "); patch != std::string::npos && group.title.find("patches = {") != std::string::npos) {
      statements.push_back(example.substr(0, patch + 14) + assignment + ", " + example.substr(patch + 14));
      continue;
    }
    if ((option.value.starts_with("{") || option.range == "{x, y, z}") && example.find(" " + option.name + " = {") != std::string::npos)
      statements.push_back(example);  // a point or list that exists already
    else
      statements.push_back(with_entry(
          example, option.name,
          entry_of(group, option.name + " = " + (option.value == "{x, y, z}" || option.range == "{x, y, z}" ? "{1, 0, 0.5}" : other_value(option)))));
  }
  return statements;
}

class EveryOption : public testing::Test {
 protected:
  EveryOption() {
    for (const char* name : {"wing.stl", "body.stl", "sting.stl", "torn.stl", "tail.stl", "model.step", "model.igs", "sting.step", "widebody.smx", "d150.xml",
                             "mesh.su2", "case.sterna", "sizes.vtu"})
      std::ofstream(folder_ / name) << "";
    state_ = std::make_unique<ScriptState>(
        ScriptSettings{.script = folder_ / "case.lua", .overrides = {}, .print = [](std::string_view) {}, .on_mesh = {}, .check = &check_},
        RunContext({.threads = 1}));
    state_->run(std::string(manual_setup()), "=setup");
  }

  /// Returns the problems of a statement; empty if there are none.
  std::string problems_of(const std::string& statement) {
    check_.problems.clear();
    check_.options.clear();
    try {
      state_->run(statement, "=test");
    } catch (const Error& error) {
      return error.what();
    }
    return check_.problems.empty() ? "" : check_.problems.front()->what();
  }
  bool is_set(const std::string& name) const {
    for (const OptionSet& option : check_.options)
      if (option.option.ends_with("." + name) || option.option.ends_with("_" + name)) return true;
    return false;
  }

  const std::filesystem::path folder_ = test::scratch();
  ScriptCheck check_;
  std::unique_ptr<ScriptState> state_;
};

TEST_F(EveryOption, ThroughLua) {
  ASSERT_TRUE(check_.problems.empty()) << check_.problems.front()->what();
  int n_options = 0, n_read_back = 0;
  for (const ScriptVerb* verb : all_verbs())
    for (const OptionGroup& group : option_groups(*verb))
      for (const OptionDoc& option : group.options) {
        ++n_options;
        std::string tried;
        bool is_accepted = false;
        for (const std::string& statement : statements_for(*verb, group, option)) {
          if (verb->gives == "self") state_->run(std::string(manual_setup()), "=setup");  // components change in place
          const std::string problem = problems_of(statement);
          tried += "\n" + statement + "\n  " + problem;
          is_accepted = is_accepted || problem.empty();
          if (!problem.empty()) continue;
          n_read_back += is_set(option.name) ? 1 : 0;
          // The option name with one more letter is an error that names the option.
          const std::string wrong = option.name + "q",
                            misspelt = std::regex_replace(statement, std::regex("([{,] *)" + option.name + " ="), "$1" + wrong + " =");
          EXPECT_FALSE(problems_of(misspelt).empty()) << verb->name << ": " << misspelt;
          break;
        }
        EXPECT_TRUE(is_accepted) << verb->name << ", " << option.name << " (" << option.value << "; " << option.range << "), " << group.title << ":" << tried;
      }
  EXPECT_GT(n_options, 250);
  EXPECT_GT(n_read_back, n_options * 6 / 10);
  std::printf("%d options, %d read back\n", n_options, n_read_back);
}

// ---- The command line ------------------------------------------------------------------------------------------------------------------------

std::string kebab(std::string text) {
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

struct Case {
  std::vector<std::string> arguments;
  OptionTable options;
};

void expect_all_set(const Case& command, bool with_set, const std::filesystem::path& folder) {
  std::vector<std::string> arguments = command.arguments;
  for (const Option& option : command.options) {
    const std::string text = text_of(other_value(option)) + (option.unit == Unit::radian ? "rad" : "");
    if (with_set) arguments.insert(arguments.end(), {"--set", std::string(option.stage) + "." + std::string(option.name) + "=" + text});
    else arguments.push_back("--" + kebab(std::string(option.name)) + "=" + text);
  }
  arguments.push_back("--show-options");
  const test::ProcessResult result = test::run_process(test::sterna_program(), arguments, folder);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  for (const Option& option : command.options) {
    const auto& shown = json.at(std::string(option.stage)).at(std::string(option.name));
    const OptionValue expected = other_value(option);
    EXPECT_TRUE(std::visit(
        [&]<class V>(const V& value) {
          if constexpr (std::is_constructible_v<nlohmann::json, const V&>) return shown == nlohmann::json(value);
          else return false;
        },
        expected))
        << option.stage << "." << option.name << ": " << shown << " instead of " << text_of(expected);
    EXPECT_NE(expected, option.default_value) << option.name;
  }
}

TEST(EveryOptionOfCommands, IsSetAsAnOptionAndWithSet) {
  const std::filesystem::path folder = test::scratch();
  std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl");
  surfmesh::StitchOptions stitch;
  volmesh::MeshCase volume;
  surfmesh::SurfaceMeshOptions surface;
  ReadCadOptions reading;
  WriteCadOptions writing;
  HalfOptions half;
  UnionOptions unite;
  UniteOptions unite_models;
  OptionTable converting = sterna::options_of(reading);
  for (Option& option : sterna::options_of(writing)) converting.push_back(std::move(option));
  OptionTable of_model = volmesh::options_of(volume);
  for (Option& option : model_surface_options(surface, reading)) of_model.push_back(std::move(option));
  const Case mesh{{"mesh", "box.stl", "-o", "m.su2"}, all_options(stitch, volume)}, mesh_of_model{{"mesh", "m.step", "-o", "m.su2"}, of_model},
      of_surface{{"surface", "m.step", "-o", "s.stl"}, model_surface_options(surface, reading)},
      halving{{"half", "box.stl", "-o", "h.stl"}, sterna::options_of(half)}, uniting{{"union", "box.stl", "-o", "u.stl"}, sterna::options_of(unite)},
      of_models{{"union", "m.step", "-o", "u.step"}, sterna::options_of(unite_models)}, convert{{"convert", "m.step", "c.step"}, converting};
  surfmesh::StitchOptions stitching;
  surfmesh::RepairOptions repair;
  surfmesh::WrapOptions wrap;
  surfmesh::RemeshOptions remesh;
  const Case repairing{{"repair", "box.stl", "-o", "r.stl"}, repair_options(stitching, repair)},
      wrapping{{"wrap", "box.stl", "-o", "w.stl"}, sterna::options_of(wrap)}, remeshing{{"remesh", "box.stl", "-o", "n.stl"}, sterna::options_of(remesh)};
  DrawOptions draw;
  const Case drawing{{"draw", "box.stl", "-o", "d.png"}, sterna::options_of(draw)};
  for (const Case* command : {&mesh, &of_surface, &halving, &uniting, &of_models, &convert, &drawing, &repairing, &wrapping, &remeshing}) {
    SCOPED_TRACE(command->arguments.front());
    expect_all_set(*command, false, folder);
  }
  for (const Case* command : {&mesh, &mesh_of_model, &of_surface}) {
    SCOPED_TRACE(command->arguments.front() + " --set");
    expect_all_set(*command, true, folder);
  }
}

}  // namespace
}  // namespace sterna::scripting
