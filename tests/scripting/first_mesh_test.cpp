// From a surface file to checked mesh files, from the command line and from a script.
#include <algorithm>
#include <cstring>
#include <fstream>

#include "io/volume/sterna_file.h"
#include "scripting/terminal/exit_status.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using test::ProcessResult;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class FirstMesh : public testing::Test {
 protected:
  FirstMesh() : folder(test::scratch()) { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl"); }

  ProcessResult sterna(const std::vector<std::string>& arguments, double interrupt_after = -1.0) {
    return test::run_process(test::sterna_program(), arguments, folder, interrupt_after);
  }
  ProcessResult mesh_box(const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"mesh", "box.stl", "--layers", "8", "--first-height", "1e-3", "--farfield-radius", "10", "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return sterna(arguments);
  }

  std::filesystem::path folder;
};

TEST_F(FirstMesh, CommandLineWritesCheckedMeshAndManifest) {
  const ProcessResult result = mesh_box("box.su2", {"-o", "box.vtu", "--stats", "stats.json"});
  ASSERT_EQ(result.status, k_exit_success) << result.errors;
  for (const char* part :
       {"12 triangles", "1 unit of the file = 1 m", "prisms in 8 layers", "verdict     VALID", " in the own engine, ", "memory", "wrote box.su2"})
    EXPECT_NE(result.errors.find(part), std::string::npos) << part << " in\n" << result.errors;
  // It misses hard limits, and has layers far thinner than the tetrahedra, so there is much to report, in few lines: the worst place and what to do.
  EXPECT_LE(std::count(result.errors.begin(), result.errors.end(), '\n'), 13) << result.errors;
  for (const char* part : {" warn ", "hard limit ", "; remesh the wall there"})
    EXPECT_NE(result.errors.find(part), std::string::npos) << part << " in\n" << result.errors;
  for (const char* name : {"box.su2", "box.su2.json", "box.vtu", "box.vtu.json", "stats.json"}) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  const std::string manifest = contents(folder / "box.su2.json");
  for (const char* part : {"\"sterna-manifest-1\"", "\"first_height\": 0.001", "\"layers\": 8", "\"xxh3_128\"", "\"verdict\": \"VALID\"", "\"seed\": 1"})
    EXPECT_NE(manifest.find(part), std::string::npos) << part;
  EXPECT_EQ(manifest.find("seconds"), std::string::npos) << "wall-clock has no place in a manifest";
  const std::string stats = contents(folder / "stats.json");
  for (const char* part : {"\"sterna-stats-1\"", "\"engine_seconds\"", "\"rest_seconds\"", "\"stage_busy_share\"", "\"peak_memory_bytes\"", "\"coverage\""})
    EXPECT_NE(stats.find(part), std::string::npos) << part;

  const ProcessResult check = sterna({"check", "box.su2"});
  EXPECT_EQ(check.status, k_exit_success) << check.output << check.errors;
  EXPECT_NE(check.output.find("VALID"), std::string::npos);
  const ProcessResult json = sterna({"check", "box.su2", "--json"});
  EXPECT_EQ(json.output.front(), '{');
  // A box of 12 triangles in a wide farfield has tets that no gate lets pass: VALID still, and an error only where it is asked for.
  // No run is evidence for the limits that it misses, so they warn; a limit of the user FAILs.
  EXPECT_EQ(check.output.substr(0, 25), "VALID; node-centred: warn");
  EXPECT_EQ(check.output.find("OpenFOAM"), std::string::npos);
  EXPECT_EQ(sterna({"check", "box.su2", "--strict"}).status, k_exit_success);
  EXPECT_EQ(sterna({"check", "box.su2", "--strict", "--for", "su2,openfoam"}).status, k_exit_success);
  EXPECT_EQ(sterna({"check", "box.su2", "--strict", "--for", "su2,openfoam", "--gate", "interface_volume:hard=9"}).status, k_exit_invalid);
  EXPECT_EQ(sterna({"check", "box.su2", "--for", "openfoam"}).output.substr(0, 25), "VALID; cell-centred: warn");
  EXPECT_EQ(sterna({"check", "box.su2", "--for", "su3"}).status, k_exit_usage);
  for (const char* part : {"\"quality\"", "\"sub_volume_ratio\""}) EXPECT_NE(manifest.find(part), std::string::npos) << part;
  const ProcessResult info = sterna({"info", "box.su2"});
  EXPECT_EQ(info.status, k_exit_success) << info.errors;
  for (const char* part : {"prisms", "tetrahedra", "farfield", "longest side"})
    EXPECT_NE(info.output.find(part), std::string::npos) << part << " in\n" << info.output;
}

TEST_F(FirstMesh, TheNativeFileHoldsWhatIsKnown) {
  const ProcessResult result = mesh_box("box.sterna");
  ASSERT_EQ(result.status, k_exit_success) << result.errors;
  const io::SternaContent content = io::read_sterna(folder / "box.sterna", RunContext({.threads = 1}));
  EXPECT_EQ(content.names(), "mesh, manifest, certificate, quality");
  EXPECT_EQ(content.mesh->layers.n_layers, 8);
  EXPECT_EQ(content.mesh->request.first_height, 1e-3);
  EXPECT_NE(content.manifest.find("\"sterna-manifest-1\""), std::string::npos) << content.manifest;
  EXPECT_NE(content.quality.find("\"sterna-check-2\""), std::string::npos);
  EXPECT_EQ(sterna({"check", "box.sterna"}).status, k_exit_success);
}

TEST_F(FirstMesh, PatchRulesOfCommandAndScriptReachManifest) {
  const ProcessResult result = mesh_box("box.su2", {"--split-angle", "60deg", "--patch", "*:blend=0.2", "--patch", "*_1:layers=10,first_height=2mm"});
  ASSERT_EQ(result.status, k_exit_success) << result.errors;
  EXPECT_NE(result.errors.find("one number of layers: 10, the largest requested"), std::string::npos) << result.errors;
  const std::string manifest = contents(folder / "box.su2.json");
  for (const char* part : {"\"patch_rules\"", "\"names\": \"*_1\"", "\"first_height\": 0.002", "\"blend\": 0.2", "\"VALID\""})
    EXPECT_NE(manifest.find(part), std::string::npos) << part;

  std::ofstream(folder / "case.lua")
      << "volume_mesh{ read_surface{ 'box.stl', split_angle = 60*deg }, layers = 8, first_height = 1e-3, farfield = sphere{ radius = 10 },\n"
         "  patches = { ['*'] = { blend = 0.2 }, ['*_1'] = { layers = 10, first_height = 2*mm } }, stages = 'box.sterna' }:write 'script.su2'";
  const ProcessResult script = sterna({"run", "case.lua"});
  ASSERT_EQ(script.status, k_exit_success) << script.errors;
  EXPECT_EQ(contents(folder / "script.su2"), contents(folder / "box.su2"));
  const ProcessResult again = sterna({"mesh", "box.sterna", "-o", "again.su2"});
  ASSERT_EQ(again.status, k_exit_success) << again.errors;
  EXPECT_EQ(contents(folder / "again.su2"), contents(folder / "box.su2"));

  for (const auto& [rule, text] : std::vector<std::pair<std::string, std::string>>{{"fuselage*:layers=3", "no patch name matches \"fuselage*\""},
                                                                                   {"*:layres=3", "did you mean \"layers\"?"},
                                                                                   {"*:layers=3.5", "layers"},
                                                                                   {"*:kind=slipp", "slip"},
                                                                                   {"*", "is not NAMES:OPTION=VALUE"}}) {
    const ProcessResult refused = mesh_box("no.su2", {"--patch", rule});
    EXPECT_NE(refused.status, k_exit_success) << rule;
    EXPECT_NE(refused.errors.find(text), std::string::npos) << refused.errors;
  }
}

/// Stops after each step, writes, reads and continues: the files equal those of the uninterrupted run. The case is a wing whose layers meet, so heights are
/// lowered.
TEST_F(FirstMesh, StepsAreContinuedToTheSameBytes) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string wing =
      "local wall = read_surface{ '" + (test::shared_data() / "surfaces" / "clean" / "caturbs_wing_wing.stl").string() + "', split_angle = 60*deg }\n";
  const std::string layer = "layers = 8, first_height = 1e-4 * wall.length, farfield = sphere{ radius = 5 * wall.length }";
  const std::string fill = "wall_perpendicularity = 0.2, size_growth = 1.8";
  const auto run = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / (name + ".lua")) << text;
    const ProcessResult result = sterna({"run", name + ".lua"});
    EXPECT_EQ(result.status, k_exit_success) << result.errors;
    return result.output;
  };
  run("whole", wing + "volume_mesh{ wall, " + layer + ", " + fill + ", improve_rounds = 5, stages = 'all.sterna' }:write 'whole.su2'");
  run("envelope", wing + "make_envelope{ wall, " + layer + " }:write('env.sterna', 'env.vtu')");
  const std::string reported = run("tetrahedra",
                                   "local s = read_stages 'env.sterna'\nassert(not s.tetrahedra and not s.mesh)\nprint(s.envelope, s.envelope.wall)\n"
                                   "local tets = tetrahedra{ s.envelope, " +
                                       fill + " }\nprint(tets)\ntets:write 'tets.sterna'");
  EXPECT_NE(reported.find("Envelope: "), std::string::npos) << reported;
  EXPECT_NE(reported.find("880 triangles, closed, 4 patches"), std::string::npos) << reported;
  EXPECT_NE(reported.find("Tetrahedra: "), std::string::npos) << reported;
  run("prisms", "local s = read_stages 'tets.sterna'\nassert(not s.mesh)\nprisms{ s.envelope, s.tetrahedra, improve_rounds = 5 }:write 'prisms.su2'");
  run("memory", wing + "local env = make_envelope{ wall, " + layer +
                    " }\nlocal tets = tetrahedra{ env, size = { size_growth = 1.8 }, prisms = { wall_perpendicularity = 0.2 } }\nprisms{ env, tets, "
                    "improve_rounds = 5 }:write 'memory.su2'");
  run("last", "local s = read_stages 'all.sterna'\nassert(s.mesh.prisms > 0)\ns.mesh:write 'last.su2'\nprisms{ s.envelope, s.tetrahedra }:write 'again.su2'");
  const std::string whole = contents(folder / "whole.su2");
  EXPECT_GT(whole.size(), 100000u);
  for (const char* name : {"prisms.su2", "memory.su2", "last.su2", "again.su2"}) EXPECT_TRUE(contents(folder / name) == whole) << name;

  const ProcessResult continued =
      sterna({"mesh", "env.sterna", "--wall-perpendicularity", "0.2", "--size-growth", "1.8", "--improve-rounds", "5", "-o", "command.su2"});
  EXPECT_EQ(continued.status, k_exit_success) << continued.errors;
  EXPECT_NE(continued.errors.find("continuing after the envelope of env.sterna"), std::string::npos) << continued.errors;
  EXPECT_TRUE(contents(folder / "command.su2") == whole);
  const auto without_name = [&](const std::string& name) {
    std::string manifest = contents(folder / (name + ".json"));
    return manifest.erase(manifest.find(name), name.size());
  };
  EXPECT_EQ(without_name("command.su2"), without_name("whole.su2"));
  EXPECT_EQ(without_name("prisms.su2"), without_name("whole.su2"));

  const io::SternaContent content = io::read_sterna(folder / "all.sterna", RunContext({.threads = 1}));
  EXPECT_EQ(content.names(), "surface, envelope, tetrahedra, mesh, manifest, certificate, quality");
  EXPECT_EQ(sterna({"check", "all.sterna"}).status, k_exit_success);
  const ProcessResult late = sterna({"mesh", "all.sterna", "--layers", "9", "-o", "late.su2"});
  EXPECT_NE(late.status, k_exit_success);
  EXPECT_NE(late.errors.find("belongs to a step that is complete already"), std::string::npos) << late.errors;
}

TEST_F(FirstMesh, StepsThatDoNotFitAreRefused) {
  const auto error_of = [&](const std::string& text) {
    std::ofstream(folder / "case.lua") << text;
    const ProcessResult result = sterna({"run", "case.lua"});
    EXPECT_NE(result.status, k_exit_success);
    return result.errors;
  };
  const std::string env =
      "local wall = read_surface 'box.stl'\nlocal env = make_envelope{ wall, layers = 4, first_height = 1e-3, farfield = sphere{ radius = 10 } }\n";
  const auto expect_reported = [&](const std::string& text, const std::string& part) {
    const std::string errors = error_of(text);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  expect_reported(env + "tetrahedra{ wall }", "case.lua:3: tetrahedra: entry 1: expected an envelope (from make_envelope or read_stages), not a surface");
  expect_reported(env + "tetrahedra{ env, layers = 3 }", "unknown key \"layers\"");
  expect_reported(env + "prisms{ env }", "entry 2: expected tetrahedra (from tetrahedra{...} or read_stages), not nothing");
  expect_reported(env + "prisms{ env, tetrahedra{ env }, wall_perpendicularity = 0.3 }", "belongs to tetrahedra{ env, wall_perpendicularity = ... }");
  expect_reported(env + "prisms{ make_envelope{ wall, layers = 4, first_height = 1e-3 }, tetrahedra{ read_stages('env.sterna').envelope } }", "env.sterna");
  expect_reported(env + "env:write 'env.sterna'\nprisms{ env, tetrahedra{ read_stages('env.sterna').envelope } }",
                  "these tetrahedra were made around another envelope");
  expect_reported(env + "tetrahedra{ env }:write 'tets.vtu'", "written to .sterna files only");
  expect_reported(env + "print(env.hight)", "there is no \"hight\"");
  expect_reported("volume_mesh{ read_surface 'box.stl', first_height = 1e-3, stages = 'a.su2' }", "written to .sterna files only");
}

TEST_F(FirstMesh, AnyThreadCountWritesTheSameBytes) {
  std::vector<std::string> meshes, manifests;
  for (const char* threads : {"1", "2", "7"}) {
    ASSERT_EQ(mesh_box("box.su2", {"--threads", threads}).status, k_exit_success);
    meshes.push_back(contents(folder / "box.su2"));
    manifests.push_back(contents(folder / "box.su2.json"));
  }
  EXPECT_EQ(meshes[0], meshes[1]);
  EXPECT_EQ(meshes[0], meshes[2]);
  EXPECT_EQ(manifests[0], manifests[1]);
  EXPECT_EQ(manifests[0], manifests[2]);
}

TEST_F(FirstMesh, ScriptAndCommandLineMakeTheSameMesh) {
  ASSERT_EQ(mesh_box("a.su2").status, k_exit_success);
  std::ofstream(folder / "case.lua") << "local m = volume_mesh{ read_surface 'box.stl', layers = 8, first_height = 1*mm, farfield = sphere{ radius = 10 } }\n"
                                        "print(m)  m:check():write 'b.su2'\n"
                                        "read_mesh('b.su2'):check{}\n";
  const ProcessResult result = sterna({"run", "case.lua"});
  ASSERT_EQ(result.status, k_exit_success) << result.errors;
  EXPECT_NE(result.output.find("VALID"), std::string::npos);
  EXPECT_EQ(contents(folder / "a.su2"), contents(folder / "b.su2"));
}

TEST_F(FirstMesh, FlippedCellIsInvalidWithItsStatus) {
  ASSERT_EQ(mesh_box("box.su2").status, k_exit_success);
  // The wall marker loses its last face; the cell behind that face then has an unmatched face.
  std::string text = contents(folder / "box.su2");
  const std::size_t count = text.find("MARKER_ELEMS=");
  ASSERT_NE(count, std::string::npos);
  const std::size_t number = text.find_first_of("0123456789", count), line_end = text.find('\n', number);
  const int n = std::stoi(text.substr(number, line_end - number));
  const std::size_t next_line = text.find('\n', line_end + 1);
  text.replace(number, next_line - number, std::to_string(n - 1));
  std::ofstream(folder / "broken.su2") << text;
  const ProcessResult check = sterna({"check", "broken.su2"});
  EXPECT_EQ(check.status, k_exit_invalid) << check.output << check.errors;
  EXPECT_NE(check.output.find("INVALID"), std::string::npos) << check.output;
  std::ofstream(folder / "case.lua") << "read_mesh('broken.su2'):check()";
  const ProcessResult script = sterna({"run", "case.lua"});
  EXPECT_EQ(script.status, k_exit_invalid) << script.errors;
  EXPECT_NE(script.errors.find("case.lua:1: mesh:check: the mesh is INVALID"), std::string::npos) << script.errors;
}

TEST_F(FirstMesh, CtrlCLeavesNothingHalfWritten) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string surface = (test::shared_data() / "surfaces" / "clean" / "dlr_f6_184k.stl").string();
  for (const double seconds : {0.2, 1.0, 3.0}) {
    const ProcessResult result = sterna({"mesh", surface, "--unit", "mm", "--first-height", "1e-6", "-o", "m.su2"}, seconds);
    EXPECT_EQ(result.status, k_exit_interrupted) << result.errors;
    EXPECT_LT(result.seconds_after_interrupt, 1.0);
    for (const auto& entry : std::filesystem::directory_iterator(folder)) EXPECT_EQ(entry.path().filename(), "box.stl");
  }
}

}  // namespace
}  // namespace sterna::scripting
