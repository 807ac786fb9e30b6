// A number without a unit on the command line is in metres, degrees, kelvin, seconds or bytes in every option; the same number with that unit gives the same
// value. The options come from the program's own help and its option tables, so that new options are included automatically.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>

#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"
#include "geom/draw/choices.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/wake_verbs.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/gate_limits.h"
#include "scripting/verbs/solver_case.h"
#include "scripting/verbs/source_verbs.h"
#include "tests/scripting/manual/option_values.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

constexpr double k_degree = std::numbers::pi / 180.0;

/// An option in the help of a command: "--alpha NUMBER[deg]   ...; 0 deg; -91.7 deg .. 91.7 deg".
struct HelpedOption {
  std::string name, unit;
  double value = 0.0;  ///< within its range
};

double value_in_range(const std::string& line) {
  std::smatch match;
  static const std::regex both("; (-?[0-9.e+-]+)(?: [a-zA-Z]+)? \\.\\. (-?[0-9.e+-]+) (?:deg|m|K|s|B)"), least("; x >= (-?[0-9.e+-]+)");
  constexpr double usual = 3.5;
  if (std::regex_search(line, match, both)) {
    const double min = std::stod(match[1]), max = std::stod(match[2]);
    return min <= usual && usual <= max ? usual : 0.75 * min + 0.25 * max;
  }
  return std::regex_search(line, match, least) ? std::stod(match[1]) + usual : usual;
}

std::vector<HelpedOption> options_with_units(const std::string& help) {
  std::vector<HelpedOption> options;
  std::istringstream lines(help);
  static const std::regex option("^ +--([a-z0-9-]+) NUMBER\\[([a-zA-Z]+)\\]");
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::smatch match;
    if (!std::regex_search(all[i], match, option)) continue;
    const bool goes_on = i + 1 < all.size() && all[i + 1].starts_with(std::string(20, ' '));  // the help of long names is on the next line
    options.push_back({match[1], match[2], value_in_range(all[i] + (goes_on ? " " + all[i + 1] : ""))});
  }
  return options;
}

std::string text_of_number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

class Units : public testing::Test {
 protected:
  Units() {
    std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl");
    for (const char* name : {"m.step", "n.step"}) std::ofstream(folder_ / name) << "";  // never read
  }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) const { return test::run_process(test::sterna_program(), arguments, folder_); }

  const std::filesystem::path folder_ = test::scratch();
};

/// Commands with a table of options, each with an input that accepts as many of them as possible.
const std::vector<std::vector<std::string>> k_commands = {
    {"mesh", "box.stl", "-o", "m.su2"},
    {"mesh", "m.step", "-o", "m.su2"},
    {"surface", "m.step", "-o", "m.stl"},
    {"half", "box.stl", "-o", "h.stl"},
    {"remesh", "box.stl", "-o", "r.stl"},
    {"union", "box.stl", "-o", "u.stl"},
    {"union", "m.step", "n.step", "-o", "u.step"},
    {"repair", "box.stl", "-o", "r.stl"},
    {"wrap", "box.stl", "-o", "w.stl"},
    {"inspect", "box.stl"},
    {"inspect", "m.step"},
    {"convert", "m.step", "a.step"},
    {"draw", "box.stl", "-o", "a.png"},
    {"report", "box.stl", "-o", "a.html"},
    {"su2-config", "m.su2", "-o", "a.cfg"},
    {"foam-case", "m.su2", "-o", "case"},
};

TEST_F(Units, CommandOptionsCountInUnitsOfTheirHelp) {
  std::size_t n = 0;
  std::map<std::string, std::string> helps;
  for (const std::vector<std::string>& command : k_commands) {
    SCOPED_TRACE(command[0] + " " + command[1]);
    std::string& help = helps[command[0]];
    if (help.empty()) help = sterna({command[0], "--help"}).output;
    // Options that this input does not accept are refused by name; all others must arrive.
    std::vector<std::string> bare = command, with_unit = command;
    std::map<std::string, double> expected;
    const auto show = [&](std::vector<std::string> arguments) {
      arguments.push_back("--show-options");
      return sterna(arguments);
    };
    std::vector<HelpedOption> options = options_with_units(help);
    std::vector<std::string> all = command;
    for (const HelpedOption& option : options) all.push_back("--" + option.name + "=" + text_of_number(option.value));
    const std::string refused = show(all).errors;
    std::erase_if(options, [&](const HelpedOption& option) {
      return std::regex_search(refused, std::regex("option " + std::regex_replace(option.name, std::regex("-"), "_") + ": (unknown|is |applies )"));
    });
    for (const HelpedOption& option : options) {
      bare.push_back("--" + option.name + "=" + text_of_number(option.value));
      with_unit.push_back("--" + option.name + "=" + text_of_number(option.value) + (option.unit == "B" ? "" : option.unit));
      expected[std::regex_replace(option.name, std::regex("-"), "_")] = option.value * (option.unit == "deg" ? k_degree : 1.0);
    }
    const test::ProcessResult as_bare = show(bare), as_unit = show(with_unit);
    ASSERT_EQ(as_bare.status, k_exit_success) << as_bare.errors;
    ASSERT_EQ(as_unit.status, k_exit_success) << as_unit.errors;
    EXPECT_EQ(as_bare.output, as_unit.output);
    std::vector<std::string> by_set = command;
    const nlohmann::json shown = nlohmann::json::parse(as_bare.output);
    const auto arrived_elsewhere = [&](const std::string& here, const std::string& name) {
      for (const auto& [stage, entries] : shown.items())
        if (stage != here && entries.contains(name) && entries[name] == nlohmann::json(expected.at(name))) return true;
      return false;
    };
    for (const auto& [stage, entries] : shown.items())
      for (const auto& [name, value] : entries.items()) {
        const auto found = expected.find(name);
        if (found == expected.end()) continue;
        // time_limit of read_cad has the same name as an option of the tetrahedra, and the command line means the latter.
        if (value != nlohmann::json(found->second) && arrived_elsewhere(stage, name)) continue;
        EXPECT_EQ(value, nlohmann::json(found->second)) << stage << "." << name;
        ++n;
        const auto option = std::ranges::find_if(options, [&](const HelpedOption& o) { return std::regex_replace(o.name, std::regex("-"), "_") == name; });
        by_set.insert(by_set.end(), {"--set", stage + "." + name + "=" + text_of_number(option->value)});
      }
    if (help.find("--set ") == std::string::npos) continue;
    const test::ProcessResult as_set = show(by_set);
    EXPECT_EQ(as_set.output, as_bare.output) << as_set.errors;
  }
  EXPECT_GT(n, 150u);
}

/// Returns the unit in the syntax of the command line: "deg", "m", "K".
std::string unit_text(Unit unit) { return unit == Unit::radian ? "deg" : unit == Unit::byte ? "" : std::string(to_string(unit)); }

/// Sets the option from a number without and with its unit, and expects the same value.
std::size_t expect_same(const OptionTable& table) {
  std::size_t n = 0;
  for (const Option& option : table) {
    if (option.kind != OptionKind::number || option.unit == Unit::none) continue;
    ++n;
    const double factor = option.unit == Unit::radian ? k_degree : 1.0;
    const double value = std::get<double>(other_value(option)) / factor;
    set_option_as_typed(option, text_of_number(value));
    const double bare = std::get<double>(option.get());
    set_option_as_typed(option, text_of_number(value) + unit_text(option.unit));
    EXPECT_EQ(std::get<double>(option.get()), bare) << option.stage << "." << option.name;
    EXPECT_EQ(bare, value * factor) << option.stage << "." << option.name;
  }
  return n;
}

TEST_F(Units, RulesOfPatchesAndConditionsOfBoundaries) {
  Rule rule;
  CaseBoundary boundary;
  volmesh::FlowConditions flow;
  CaseOptions common;
  std::size_t n = 0;
  for (const OptionTable& table :
       {volmesh::layer_rule_options(rule), size_rule_options(rule), sterna::options_of(boundary), flow_options(flow), sterna::options_of(common)})
    n += expect_same(table);
  EXPECT_GT(n, 15u);
  std::vector<Rule> of_surface;
  const auto rules = layer_rules_of({{"a", {{"curvature_angle", "8"}, {"max_edge", "0.5"}, {"first_height", "0.001"}}},
                                     {"b", {{"curvature_angle", "8deg"}, {"max_edge", "500mm"}, {"first_height", "1mm"}}}},
                                    &of_surface);
  ASSERT_EQ(of_surface.size(), 2u);
  EXPECT_EQ(value_or(of_surface[0], "curvature_angle", 0.0), 8.0 * k_degree);
  EXPECT_EQ(of_surface[0].options.at("curvature_angle"), of_surface[1].options.at("curvature_angle"));
  EXPECT_DOUBLE_EQ(value_or(of_surface[0], "max_edge", 0.0), value_or(of_surface[1], "max_edge", 1.0));
  EXPECT_DOUBLE_EQ(value_or(rules[0], "first_height", 0.0), value_or(rules[1], "first_height", 1.0));
}

TEST_F(Units, UnitsInStringsOfSourcesDiscsAndViews) {
  const volmesh::SizeSource bare = source_of_text("cylinder from=1,0,0 to=8,0,0 radius=0.5 size=0.05"),
                            named = source_of_text("cylinder from=100cm,0,0m to=8m,0,0 radius=500mm size=5cm");
  EXPECT_EQ(bare.from, named.from);
  EXPECT_DOUBLE_EQ(bare.radius, named.radius);
  EXPECT_DOUBLE_EQ(bare.size, named.size);
  EXPECT_EQ(*wake_sheet_of_text("wing=main* alpha=2").direction, *wake_sheet_of_text("wing=main* alpha=2deg").direction);
  EXPECT_NEAR(wake_sheet_of_text("alpha=2").direction->z, std::sin(2.0 * k_degree), 1e-15);
  GateTable by_number, by_unit;
  set_gate_limits("orthogonality:hard=3,target=15", by_number);
  set_gate_limits("orthogonality:hard=3deg,target=15deg", by_unit);
  const Measure orthogonality = std::ranges::find(measures(), "orthogonality", &MeasureInfo::name)->measure;
  EXPECT_EQ(by_number[orthogonality].hard, by_unit[orthogonality].hard);
  EXPECT_EQ(by_number[orthogonality].hard, 3.0 * k_degree);
  EXPECT_DOUBLE_EQ(disc_of_text("prop center=-0.4,0,0 radius=1.2 edge=0.05").radius, disc_of_text("prop center=-40cm,0,0 radius=1200mm edge=5cm").radius);
  const auto farfield = [](const std::string& text) {
    volmesh::FarfieldOptions options;
    const OptionTable table = sterna::options_of(options);
    for (const auto& [name, value] : farfield_of_text(text)) set_option_as_typed(find_option(table, name, "test"), value);
    return options_to_json(table);
  };
  EXPECT_EQ(farfield("box -10 -5 -5 20 5 5 edge=2 x_max=outflow,edge:0.5"), farfield("box -10m -5m -5m 20m 5m 5m edge=2m x_max=outflow,edge:0.5m"));
  EXPECT_EQ(quantity_of_text("y_plus 1 speed=20 temperature=293 pressure=1e5 length=0.5").metres,
            quantity_of_text("y_plus 1 speed=20 temperature=293K pressure=1e5 length=0.5m").metres);
  EXPECT_EQ(quantity_of_text("boundary_layer mach=0.5 altitude=3000 temperature_offset=15 length=2").metres,
            quantity_of_text("boundary_layer mach=0.5 altitude=3000m temperature_offset=15K length=2m").metres);
  EXPECT_EQ(*draw::view_of("225 30"), *draw::view_of("225deg 30deg"));
  EXPECT_EQ(draw::plane_of("x=1.5")->origin, draw::plane_of("x=1500mm")->origin);
  EXPECT_EQ(draw::sphere_of("1,2,0 radius=0.5")->radius, draw::sphere_of("1m,2m,0 radius=500mm")->radius);
}

TEST_F(Units, ScriptArgumentsCountInDeclaredUnits) {
  std::ofstream(folder_ / "case.lua") << "local p = args{ alpha = number{ 1, min = -10, max = 10, unit = deg } }\nprint(string.format('%.17g', p.alpha))";
  EXPECT_EQ(sterna({"run", "case.lua", "alpha=4"}).output, sterna({"run", "case.lua", "alpha=4deg"}).output);
  EXPECT_NEAR(std::stod(sterna({"run", "case.lua", "alpha=4"}).output), 4.0 * k_degree, 1e-15);
  std::ofstream(folder_ / "set.lua") << "local t = read_surface{ 'box.stl' } print(t.patches)";
  EXPECT_EQ(sterna({"run", "set.lua", "--set", "surface.split_angle=40"}).status, k_exit_success);
  EXPECT_THAT(sterna({"run", "set.lua", "--set", "surface.split_angle=400"}).errors, HasSubstr("400 deg"));
}

TEST_F(Units, AnglesOfScriptsAreRadians) {
  volmesh::EnvelopeOptions options;
  const OptionTable table = sterna::options_of(options);
  set_option_from_text(find_option(table, "feature_angle", "test"), "0.5");
  EXPECT_EQ(options.feature_angle, 0.5);
  set_option_as_typed(find_option(table, "feature_angle", "test"), "0.5rad");
  EXPECT_EQ(options.feature_angle, 0.5);
  set_option_as_typed(find_option(table, "feature_angle", "test"), "40");
  EXPECT_EQ(options.feature_angle, 40.0 * k_degree);
}

}  // namespace
}  // namespace sterna::scripting
