// Each command that has verbs does what a script with these verbs does: the same files, byte for byte, and the same printed results.
#include <algorithm>
#include <map>
#include <sstream>

#include "scripting/cli/command_table.h"
#include "scripting/interpreter/script_help.h"
#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

/// A command line and the script for the same work. Both run in a folder with a block as model, surface and volume meshes.
struct CommandAndScript {
  std::vector<std::string> words;  ///< after the name of the command
  std::string script;
  bool prints = false;    ///< both print the same results
  std::string only = {};  ///< the only file that is equal; empty: all files are
};

const std::map<std::string, CommandAndScript>& equivalent_scripts() {
  static const std::map<std::string, CommandAndScript> all = {
      {"mesh",
       {{"m.stl", "-o", "v.su2", "--first-height", "1cm", "--layers", "3", "--farfield", "sphere radius=6", "--source", "sphere 2 0 0 radius=0.5 size=0.3",
         "--patch", "wa*:layers=3"},
        "volume_mesh{ read_surface 'm.stl', first_height = 0.01, layers = 3, farfield = sphere{ radius = 6 }, sources = { sphere{ {2, 0, 0}, radius = 0.5, "
        "size = 0.3 } }, patches = { ['wa*'] = { layers = 3 } } }:write 'v.su2'"}},
      {"surface",
       {{"m.step", "-o", "s.stl", "--max-edge", "40cm", "--patch", "Bo*:max_edge=0.2,layers=4", "--source", "sphere 0 0 0 radius=0.5 size=0.1"},
        "surface_mesh{ read_cad 'm.step', max_edge = 0.4, patches = { ['Bo*'] = { max_edge = 0.2, layers = 4 } }, sources = { sphere{ {0, 0, 0}, radius = 0.5, "
        "size = 0.1 } } }:write 's.stl'"}},
      {"half",
       {{"m.stl", "-o", "h.vtu", "--axis", "z", "--at", "500mm", "--keep", "-", "--unit", "2"},
        "half{ read_surface{ 'm.stl', unit = 2, allow_open = true }, axis = 'z', at = 0.5, keep = '-' }:write 'h.vtu'"}},
      {"remesh",
       {{"m.stl", "-o", "r.vtu", "-o", "r.stl", "--max-edge", "30cm", "--curvature-angle", "10", "--patch", "wa*:max_edge=0.2", "--patch",
         "wa*:max_edge=automatic", "--source", "sphere 0 0 0 radius=0.5 size=0.1"},
        "remesh{ read_surface{ 'm.stl', allow_open = true }, max_edge = 0.3, curvature_angle = 10*deg, patches = { ['wa*'] = { max_edge = 0.2 } }, sources = { "
        "sphere{ {0, 0, 0}, radius = 0.5, size = 0.1 } } }:write('r.vtu', 'r.stl')"}},
      {"union", {{"m.stl", "n.stl", "-o", "u.stl", "--unit", "2", "--strip-width", "3"}, "union{ 'm.stl', 'n.stl', unit = 2, strip_width = 3 }:write 'u.stl'"}},
      {"repair",
       {{"m.stl", "n.stl", "-o", "u.stl", "--gap", "0.002", "--changes", "c.vtu", "--report", "c.json"},
        "repair{ 'm.stl', 'n.stl', gap = 0.002, changes = 'c.vtu', report = 'c.json' }:write 'u.stl'"}},
      {"wrap",
       {{"m.stl", "n.stl", "-o", "u.vtu", "--edge", "20cm", "--changes", "c.vtu", "--report", "c.json"},
        "wrap{ 'm.stl', 'n.stl', edge = 0.2, changes = 'c.vtu', report = 'c.json' }:write 'u.vtu'"}},
      {"check", {{"m.sterna", "--findings-per-kind", "2"}, "read_mesh 'm.sterna':check{ details = true, findings_per_kind = 2 }", true}},
      {"check-family",
       {{"m.su2", "fine.su2", "--nodes", "0.2", "--first-height", "0.5", "--growth", "0.5", "--tet-growth", "0.5"},
        "check_family{ 'm.su2', 'fine.su2', nodes = 0.2, first_height = 0.5, growth = 0.5, tet_growth = 0.5 }",
        true}},
      {"inspect",
       {{"m.stl", "--first-height", "1cm", "--layers", "3", "--farfield", "sphere radius=6", "--source", "sphere 0 0 0 radius=0.5 size=0.1"},
        "inspect{ 'm.stl', first_height = 0.01, layers = 3, farfield = sphere{ radius = 6 }, sources = { sphere{ {0, 0, 0}, radius = 0.5, size = 0.1 } } }",
        true}},
      {"convert",  // copies the manifest of the input, while a script writes a new one
       {{"m.su2", "c.vtu", "--numbering", "bandwidth"}, "read_mesh 'm.su2':write{ 'c.vtu', numbering = 'bandwidth' }", false, "c.vtu"}},
      {"draw", {{"m.su2", "-o", "d.png", "--view", "top", "--size", "300x200"}, "draw{ 'm.su2', 'd.png', view = 'top', width = 300, height = 200 }"}},
      {"report", {{"m.su2", "-o", "d.html", "--cut", "x=0.2"}, "report{ 'm.su2', 'd.html', cuts = { { x = 0.2 } } }"}},
      {"foam-case",
       {{"m.sterna", "-o", "case", "--mach", "0.2", "--altitude", "0", "--length", "2", "--alpha", "5deg", "--reference-area", "3", "--model", "laminar"},
        "read_mesh 'm.sterna':foam_case{ 'case', mach = 0.2, altitude = 0, length = 2, alpha = 5*deg, reference_area = 3, model = 'laminar' }"}},
      {"su2-config",
       {{"m.su2", "-o", "c.cfg", "--mach", "0.5", "--altitude", "3000", "--length", "2", "--reference-area", "3", "--moment-origin", "0.5,0,0"},
        "read_mesh 'm.su2':su2_config{ 'c.cfg', mesh = 'm.su2', mach = 0.5, altitude = 3000, length = 2, reference_area = 3, moment_origin = {0.5, 0, 0} }"}},
  };
  return all;
}

class CommandRows : public ScriptFixture {
 protected:
  CommandRows() {
    const std::filesystem::path inputs = folder_ / "inputs";
    std::filesystem::create_directory(inputs);
    std::ofstream(inputs / "make.lua") << R"(
      local model = box{ {0, 0, 0}, {1, 1, 1}, name = "Body" }
      model:write "m.step"
      local wall = surface_mesh{ model, max_edge = 0.5 }
      wall:write "m.stl"
      surface_mesh{ box{ {0.5, 0.5, 0.5}, {2, 1.5, 1.5}, name = "other" }, max_edge = 0.5 }:write "n.stl"
      volume_mesh{ wall, layers = 3, first_height = 0.01, farfield = sphere{ radius = 6 } }:write("m.sterna", "m.su2")
      volume_mesh{ surface_mesh{ model, max_edge = 0.3 }, layers = 5, first_height = 0.006, farfield = sphere{ radius = 6 } }:write "fine.su2"
    )";
    const test::ProcessResult made = test::run_process(test::sterna_program(), {"run", "make.lua"}, inputs);
    EXPECT_EQ(made.status, k_exit_success) << made.errors;
    std::filesystem::remove(inputs / "make.lua");
  }

  /// Runs the program in a new copy of the inputs; returns its files with their bytes.
  std::map<std::string, std::string> files_of(const std::string& name, const std::vector<std::string>& words, std::string& printed) {
    const std::filesystem::path folder = folder_ / name;
    std::filesystem::copy(folder_ / "inputs", folder);
    const test::ProcessResult result = test::run_process(test::sterna_program(), words, folder);
    EXPECT_EQ(result.status, k_exit_success) << name << ": " << result.errors;
    printed = result.output;
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.is_regular_file())
        files[std::filesystem::relative(entry.path(), folder).string()] = text_of(std::filesystem::relative(entry.path(), folder_).string());
    return files;
  }
};

TEST_F(CommandRows, DoWhatTheirScriptsDo) {
  for (const auto& [name, both] : equivalent_scripts()) {
    SCOPED_TRACE(name);
    std::vector<std::string> words = {name};
    words.insert(words.end(), both.words.begin(), both.words.end());
    std::ofstream(folder_ / (name + ".lua")) << both.script;
    std::string printed, printed_by_script;
    const auto files = files_of(name + "_command", words, printed);
    const auto files_of_script = files_of(name + "_script", {"run", (folder_ / (name + ".lua")).string()}, printed_by_script);
    for (const auto& [file, bytes] : files) {
      if (!both.only.empty() && file != both.only) continue;
      const auto same = files_of_script.find(file);
      EXPECT_TRUE(same != files_of_script.end() && same->second == bytes) << file;
    }
    EXPECT_TRUE(both.only.empty() || files.contains(both.only)) << both.only << " is not written";
    EXPECT_EQ(files.size(), files_of_script.size());
    EXPECT_TRUE(!both.prints || printed == printed_by_script) << printed << printed_by_script;
  }
}

TEST(CommandTable, RowsWithVerbsHaveAnEquivalentScript) {
  std::size_t n_verbs = 0;
  for (const CommandRow& row : command_rows()) {
    EXPECT_EQ(row.verbs.empty(), !equivalent_scripts().contains(std::string(row.name))) << row.name;
    n_verbs += row.verbs.empty() ? 0 : 1;
    for (const std::string_view verb : row.verbs) {
      EXPECT_NE(find_verb(verb), nullptr) << verb;
      const std::string_view call = verb.substr(std::min(verb.find(':'), verb.size()) % verb.size());  // of a method, the part behind the object
      EXPECT_NE(equivalent_scripts().at(std::string(row.name)).script.find(call), std::string::npos) << row.name << " without " << verb;
    }
  }
  EXPECT_EQ(n_verbs, equivalent_scripts().size());
}

}  // namespace
}  // namespace sterna::scripting
