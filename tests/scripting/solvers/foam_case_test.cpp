// Cases of OpenFOAM as mesh:foam_case writes them, run by its solvers with no edit by hand.
#include <gmock/gmock.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "geom/math/constants.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "io/output/atomic_file.h"
#include "scripting/verbs/foam_case.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/openfoam_tools.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FoamCases : public ScriptFixture {
 protected:
  FoamCases() { io::write_surface_file(test::sphere(4), folder_ / "ball.off", RunContext()); }

  /// The script with a small mesh `m` around a ball.
  std::string with_mesh(const std::string& text) const {
    return "local m = volume_mesh{ read_surface 'ball.off', layers = 4, first_height = 0.02, farfield = sphere{ radius = 8 }, sources = { sphere{ {1.5, 0, 0}, "
           "radius = 0.5, size = 0.3 } } }\n" +
           text;
  }
  std::string at(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }

  /// Runs the case to its end; its log.
  std::string run_case(const std::string& name) {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);  // tests may run as root; mpirun asks twice
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    const test::ProcessResult result = test::run_process(folder_ / name / "Allrun", {}, folder_);
    EXPECT_EQ(result.status, 0) << name << ":\n" << result.output << result.errors;
    return result.output;
  }
};

std::string file_of(const FoamCase& made, const std::string& path) {
  for (const CaseFile& file : made.files)
    if (file.path == path) return file.text;
  return "no " + path;
}

bool has_openfoam() { return std::filesystem::exists("/usr/bin/simpleFoam"); }

TEST_F(FoamCases, EveryModelRunsAsItIsWritten) {
  if (!has_openfoam()) GTEST_SKIP() << "needs the Debian package openfoam";
  struct Kind {
    std::string name, options, solver, solved;
  };
  const std::string slow = "flow{ reynolds = 1e5, length = 2 }, ", fast = "flow{ mach = 0.4, altitude = 0, length = 2 }, ";
  const std::vector<Kind> kinds = {{"laminar", "flow{ reynolds = 100, length = 2 }, model = 'laminar'", "simpleFoam", "Solving for p"},
                                   {"automatic", slow + "alpha = 2*deg", "simpleFoam", "Solving for nuTilda"},
                                   {"sst", slow + "model = 'kOmegaSST', tasks = 2", "simpleFoam", "Solving for omega"},
                                   {"euler", slow + "model = 'euler', format = 'text'", "simpleFoam", "Solving for Ux"},
                                   {"in_time", slow + "steady = false, end_time = 0.004", "pimpleFoam", "Solving for nuTilda"},
                                   {"gas", fast + "alpha = 2*deg", "rhoSimpleFoam", "Solving for e"},
                                   {"gas_sst", fast + "model = 'kOmegaSST'", "rhoSimpleFoam", "Solving for k"},
                                   {"gas_in_time", fast + "steady = false, end_time = 1e-5", "rhoPimpleFoam", "Solving for e"}};
  std::string script = with_mesh("");
  for (const Kind& kind : kinds) script += "m:foam_case{ " + at(kind.name) + ", " + kind.options + ", iterations = 5, reference_area = math.pi }\n";
  run(script);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.name);
    run_case(kind.name);
    const std::string log = text_of(kind.name + "/log." + kind.solver);
    EXPECT_THAT(log, AllOf(HasSubstr(kind.solved), HasSubstr("End"), Not(HasSubstr("FATAL"))));
    EXPECT_THAT(log, AllOf(Not(HasSubstr("printStack")), Not(HasSubstr("residual = nan"))));
    EXPECT_THAT(text_of(kind.name + "/postProcessing/forceCoeffs/0/coefficient.dat"), HasSubstr("Aref"));
    if (kind.solver.starts_with("rho"))  // whose limits on the temperature show there
      EXPECT_THAT(text_of(kind.name + "/postProcessing/temperature/0/fieldMinMax.dat"), testing::ContainsRegex("\tT +\t[0-9]"));
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "sst" / "5" / "U")) << "parts are joined";
  for (const std::string name : {"laminar", "euler", "gas"}) {
    const auto log = test::run_openfoam("potentialFoam", {"-case", name, "-noFunctionObjects"}, folder_);
    EXPECT_THAT(*log, HasSubstr("End"));
    const auto checked = test::run_openfoam("checkMesh", {"-case", name, "-constant"}, folder_);
    EXPECT_THAT(*checked, AllOf(HasSubstr("layers"), HasSubstr("Mesh OK.")));
  }
  // What has results is kept; Allclean removes them.
  const std::string again = with_mesh("m:foam_case{ " + at("laminar") + ", flow{ reynolds = 100, length = 2 } }");
  EXPECT_THAT(error(again), AllOf(HasSubstr("has results"), HasSubstr("Allclean")));
  EXPECT_EQ(test::run_process(folder_ / "laminar" / "Allclean", {}, folder_).status, 0);
  EXPECT_EQ(error(again), "no error");
}

/// Where columns and tetrahedra follow one order, neighbours are near each other; the flow is the same.
TEST_F(FoamCases, NumbersOfCellsChangeNoFlow) {
  if (!has_openfoam()) GTEST_SKIP() << "needs the Debian package openfoam";
  std::string script = with_mesh("");
  for (const std::string name : {"lines", "bandwidth", "both"})
    script += "m:foam_case{ " + at(name) + ", flow{ reynolds = 100, length = 2 }, model = 'laminar', reference_area = math.pi, iterations = 40, numbering = '" +
              name + "' }\n";
  run(script);
  std::vector<double> drags;
  for (const std::string name : {"lines", "bandwidth", "both"}) {
    run_case(name);
    std::istringstream lines(text_of(name + "/postProcessing/forceCoeffs/0/coefficient.dat"));
    std::string last;
    for (std::string line; std::getline(lines, line);) last = line;
    std::istringstream words(last);
    double time = 0.0, drag = 0.0;
    words >> time >> drag;
    drags.push_back(drag);
    const auto checked = test::run_openfoam("checkMesh", {"-case", name, "-constant"}, folder_);
    EXPECT_THAT(*checked, AllOf(HasSubstr("Upper triangular ordering OK"), HasSubstr("Mesh OK.")));
  }
  EXPECT_NEAR(drags[1], drags[0], 0.02 * drags[0]);  // linear solvers stop by their residuals, in their own order
  EXPECT_NEAR(drags[2], drags[0], 0.02 * drags[0]);
}

TEST_F(FoamCases, ForcesAreThoseOfTheFlow) {
  if (!has_openfoam()) GTEST_SKIP() << "needs the Debian package openfoam";
  run(with_mesh("m:foam_case{ " + at("case") +
                ", flow{ reynolds = 100, length = 2 }, model = 'laminar', reference_area = math.pi, iterations = 60, alpha = 90*deg }"));
  run_case("case");
  std::istringstream lines(text_of("case/postProcessing/forceCoeffs/0/coefficient.dat"));
  std::string last;
  for (std::string line; std::getline(lines, line);) last = line;
  std::istringstream words(last);
  double time = 0.0, drag = 0.0;
  words >> time >> drag;
  EXPECT_EQ(time, 60.0);
  EXPECT_NEAR(drag, 1.09, 0.15);  // a ball of 320 triangles; literature 1.087 to 1.096 for a sphere
}

/// A steady run begins with first order, goes on with second order once forces have settled, and ends when they have settled again.
TEST_F(FoamCases, RunHasStagesAndEndsWhenForcesSettle) {
  if (!has_openfoam()) GTEST_SKIP() << "needs the Debian package openfoam";
  run(with_mesh("m:foam_case{ " + at("case") + ", flow{ reynolds = 100, length = 2 }, model = 'laminar', reference_area = math.pi, iterations = 1200 }"));
  const std::string reported = run_case("case");
  EXPECT_THAT(reported, AllOf(HasSubstr("running potentialFoam"), HasSubstr("second order from iteration"),
                              testing::ContainsRegex("settled at iteration|residuals are below")));
  EXPECT_THAT(text_of("case/system/stage"), HasSubstr("linearUpwind"));
  EXPECT_THAT(text_of("case/0/U"), HasSubstr("internalField uniform")) << "fluxes alone are those of potentialFoam";
  int n_results = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "case"))
    if (const std::string name = entry.path().filename(); name != "0" && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; })) ++n_results;
  EXPECT_LE(n_results, 2) << "results of earlier parts are removed";
  EXPECT_EQ(test::run_process(folder_ / "case" / "Allclean", {}, folder_).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "case/0/phi"));
}

/// The last iteration has its results also where parts and intervals do not divide it; what has run is not run again.
TEST_F(FoamCases, EndIsWrittenAndSecondRunContinues) {
  if (!has_openfoam()) GTEST_SKIP() << "needs the Debian package openfoam";
  run(with_mesh("m:foam_case{ " + at("case") +
                ", flow{ reynolds = 100, length = 2 }, model = 'laminar', iterations = 170, write_interval = 20, residual = 1e-12 }"));
  EXPECT_THAT(run_case("case"), HasSubstr("170 iterations are over: residuals are above their limits"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "case/170/U"));
  std::filesystem::remove_all(folder_ / "case/170");
  const std::string again = run_case("case");
  EXPECT_THAT(again, AllOf(Not(HasSubstr("potentialFoam")), Not(HasSubstr("second order from")), HasSubstr("170 iterations are over")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "case/170/U"));
  EXPECT_THAT(text_of("case/system/runControl"), HasSubstr("writeInterval 10;")) << "divides the parts and what was asked for";
}

/// A force that accelerates the flow without bounds at one place: the run stops soon, fails, and names the place. The larger one stops the solver itself, by an
/// overflow, before velocities are judged.
class DivergingRuns : public FoamCases, public testing::WithParamInterface<const char*> {};

TEST_P(DivergingRuns, StopAndNameThePlace) {
  if (!has_openfoam()) GTEST_SKIP() << "needs the Debian package openfoam";
  run(with_mesh("m:foam_case{ " + at("case") + ", flow{ reynolds = 100, length = 2 }, model = 'laminar', iterations = 1000 }"));
  std::ofstream(folder_ / "case/system/fvOptions")
      << "FoamFile { version 2.0; format ascii; class dictionary; object fvOptions; }\n"
         "push { type vectorSemiImplicitSource; active yes; selectionMode cellZone; cellZone source_1_sphere; volumeMode specific; "
         "injectionRateSuSp { U ((0 0 "
      << GetParam() << ") 0); } }\n";
  const test::ProcessResult result = test::run_process(folder_ / "case" / "Allrun", {}, folder_);
  EXPECT_NE(result.status, 0);
  std::smatch found;
  const std::string reported = result.output;
  ASSERT_TRUE(
      std::regex_search(reported, found, std::regex(R"(diverged: the largest velocity is \S+ m/s at iteration (\d+).*first at \((\S+), (\S+), (\S+)\) m)")))
      << reported;
  EXPECT_LE(std::stoi(found[1]), 20);
  if (std::string(GetParam()) == "1e100") EXPECT_LT(std::stoi(found[1]), 15) << "judged from the first iteration on, because the solver failed";
  const Vec3 off{std::stod(found[2]) - 1.5, std::stod(found[3]), std::stod(found[4])};
  EXPECT_LT(norm(off), 1.0) << reported;  // the zone's radius is 0.5 m, and what is pushed flows out of it
  EXPECT_THAT(reported, HasSubstr("sterna draw"));
}

INSTANTIATE_TEST_SUITE_P(Forces, DivergingRuns, testing::Values("1e4", "1e100"));

TEST(FoamRun, SettledForcesAreDistinguishedFromMovingForces) {
  const std::string judge = file_of(foam_case(test::box_of_patches({{"body", PatchKind::wall}, {"far", PatchKind::farfield}}), {}, {},
                                              volmesh::flow_state({.length = 1.0, .mach = 0.2, .altitude = 0.0}), {.area = 1.0}, {}, RunContext()),
                                    "system/judge.awk");
  const std::filesystem::path folder = test::scratch() / "foam_judge";
  std::filesystem::create_directories(folder);
  io::write_whole(folder / "judge.awk", judge);
  const auto reported = [&](const std::string& values, const std::vector<std::string>& options) {
    io::write_whole(folder / "values.dat", "# Time\n" + values);
    std::vector<std::string> arguments = {"-f", "judge.awk"};
    for (const std::string& option : options) arguments.insert(arguments.end(), {"-v", option});
    arguments.push_back("values.dat");
    return test::run_process("/usr/bin/awk", arguments, folder).output;
  };
  std::string still, moving, thrown;
  for (int i = 1; i <= 60; ++i) {
    const double drift = i < 15 ? 5.0 : 0.0;
    still += std::to_string(i) + "\t(" + std::to_string(100.0 + drift + 0.3 * (i % 2)) + " 1 2)\t(1 1 1)\t(1 1 1)\n";
    moving += std::to_string(i) + "\t(" + std::to_string(100.0 + i) + " 1 2)\t(1 1 1)\t(1 1 1)\n";
    thrown += std::to_string(i) + "\tmag(U)\t0\t(0 0 0)\t" + std::to_string(i < 30 ? 70.0 : 70.0 * i) + "\t(1.5 " + std::to_string(i) + " 3)\n";
  }
  const std::vector<std::string> settled = {"what=settled", "window=40", "share=0.01"};
  EXPECT_THAT(reported(still, settled), testing::StartsWith("settled 0.1"));
  EXPECT_THAT(reported(moving, settled), testing::StartsWith("moving"));
  EXPECT_THAT(reported(still.substr(0, 200), settled), testing::StartsWith("short"));
  // Drag that moves by 2 % beside a lift ten times as large, and a side force (half models have one) that does not count.
  std::string drifting, pushed;
  for (int i = 1; i <= 60; ++i) {
    drifting += std::to_string(i) + "\t(" + std::to_string(10.0 + 0.01 * i) + " 1 100)\t(1 1 1)\t(1 1 1)\n";
    pushed += std::to_string(i) + "\t(10 " + std::to_string(1000.0 + 10.0 * i) + " 100)\t(1 1 1)\t(1 1 1)\n";
  }
  const std::vector<std::string> of_wings = {"what=settled", "window=40", "share=0.01", "drag=1 0 0", "lift=0 0 1"};
  EXPECT_THAT(reported(drifting, of_wings), testing::StartsWith("moving 1.8"));
  EXPECT_THAT(reported(pushed, of_wings), testing::StartsWith("settled 0"));
  EXPECT_THAT(reported(still, of_wings), testing::StartsWith("settled 0.1"));
  EXPECT_EQ(reported(thrown, {"what=bounded", "limit=4000", "first=2000", "from=5"}), "diverged 58 4060.000000 30 1.5 30 3\n");
  EXPECT_EQ(reported(thrown, {"what=bounded", "limit=1e9", "first=1e8", "from=5"}), "bounded\n");
  const std::vector<std::string> of_gas = {"what=bounded", "limit=4000", "first=2000", "from=5", "many=25"};
  EXPECT_EQ(reported(thrown, of_gas), "touched 3 1.5 60 3\n") << "3 of the last 50 iterations exceed the limit";
  std::string stuck;
  for (int i = 1; i <= 80; ++i) stuck += std::to_string(i) + "\tmag(U)\t0\t(0 0 0)\t" + std::to_string(i < 40 ? 70.0 : 5000.0) + "\t(1 2 3)\n";
  EXPECT_EQ(reported(stuck, of_gas), "diverged 40 5000.000000 40 1 2 3\n");
  // A run in parts: with the processor behind each place, and a value that is no number.
  EXPECT_EQ(
      reported("7\tmag(U)\t0\t(0 0 0)\t3\t68\t(1 2 3)\t0\n8\tmag(U)\t0\t(0 0 0)\t3\tnan\t(4 5 6)\t1\n", {"what=bounded", "limit=700", "first=350", "from=0"}),
      "diverged 8 nan 8 4 5 6\n");
}

/// A run that was stopped while potentialFoam had its own fields in 0/: the next Allrun and Allclean put back those of the case first.
TEST_F(FoamCases, FieldsOfAStoppedStartArePutBack) {
  run(with_mesh("m:foam_case{ " + at("case") + ", flow{ mach = 0.5, altitude = 0, length = 2 }, reference_area = 1 }"));
  const std::filesystem::path at_case = folder_ / "case";
  const std::string velocity = text_of("case/0/U");
  const auto stop = [&] {
    std::filesystem::copy_file(at_case / "0/U", at_case / "U.start");
    io::write_whole(at_case / "0/U", "of potentialFoam");
  };
  stop();
  EXPECT_EQ(test::run_process(at_case / "Allclean", {}, folder_).status, 0);
  EXPECT_EQ(text_of("case/0/U"), velocity);
  EXPECT_FALSE(std::filesystem::exists(at_case / "U.start"));
  // Programs that do nothing: the solver's failure ends the run.
  std::filesystem::create_directories(folder_ / "bin");
  for (const auto& [name, status] : {std::pair("potentialFoam", "0"), std::pair("rhoSimpleFoam", "1")}) {
    io::write_whole(folder_ / "bin" / name, std::string("#!/bin/sh\nexit ") + status + "\n");
    std::filesystem::permissions(folder_ / "bin" / name, std::filesystem::perms::owner_all);
  }
  stop();
  EXPECT_NE(test::run_process("/usr/bin/env", {"PATH=" + (folder_ / "bin").string() + ":/usr/bin:/bin", (at_case / "Allrun").string()}, folder_).status, 0);
  EXPECT_EQ(text_of("case/0/U"), velocity);
}

/// Gases below Mach 1 start from fluxes of mass: potentialFoam gets velocities times the density.
TEST_F(FoamCases, FluxesOfAGasAreOfMass) {
  run(with_mesh("m:foam_case{ " + at("case") + ", flow{ mach = 0.5, altitude = 0, length = 2 }, reference_area = 1 }"));
  const std::string scaled = test::run_process("/usr/bin/awk", {"-v", "density=2", "-f", "case/system/scale.awk", "case/0/U"}, folder_).output;
  const auto speed = [](const std::string& field) { return std::stod(field.substr(field.find("internalField uniform (") + 23)); };
  EXPECT_NEAR(speed(scaled), 2.0 * speed(text_of("case/0/U")), 1e-9 * speed(scaled));
  EXPECT_EQ(std::ranges::count(scaled, '\n'), std::ranges::count(text_of("case/0/U"), '\n'));
  EXPECT_THAT(text_of("case/Allrun"), AllOf(HasSubstr("has_potential='yes'"), HasSubstr("density='1.2")));
  EXPECT_THAT(text_of("case/system/fvOptions"), testing::ContainsRegex("limitVelocity;[^}]*max 680\\.")) << "four times the free stream's 170.1 m/s";
  EXPECT_THAT(text_of("case/Allrun"), AllOf(testing::ContainsRegex("limit='612\\."), HasSubstr("watched='30'"), HasSubstr("many='25'")))
      << "nine tenths of that bound";
  run(with_mesh("m:foam_case{ " + at("fast") + ", flow{ mach = 1.2, altitude = 0, length = 2 }, reference_area = 1 }"));
  EXPECT_THAT(text_of("fast/Allrun"), AllOf(HasSubstr("has_potential='no'"), HasSubstr("density=''")));
}

/// Corrections of normal gradients by the largest angle that was measured, with the figure in the file.
TEST(FoamRun, CorrectionsFollowFromTheMesh) {
  const HybridMesh mesh = test::box_of_patches({{"body", PatchKind::wall}, {"far", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.2, .altitude = 0.0});
  const auto made = [&](double degrees) {
    return foam_case(mesh, {.model = "SpalartAllmaras"}, {}, flow, {.area = 1.0}, {}, RunContext(), {.worst = degrees * k_degree, .location = Point{1, 2, 3}});
  };
  EXPECT_THAT(file_of(made(60), "system/stage.final"), HasSubstr("correction corrected;"));
  EXPECT_THAT(file_of(made(75), "system/stage.final"), HasSubstr("correction limited corrected 0.5;"));
  EXPECT_THAT(file_of(made(89), "system/stage.final"), HasSubstr("correction limited corrected 0.33;"));
  EXPECT_THAT(file_of(made(89), "system/fvSchemes"), AllOf(HasSubstr("is 89 degrees at (1, 2, 3)"), HasSubstr("$correction")));
}

/// Found on the D150 of CPACS, which diverged within 15 iterations in the crevice between fin and fuselage.
TEST(FoamRun, AWarningNamesVerticesWithoutALayer) {
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.2, .altitude = 0.0});
  const auto warnings = [&](const HybridMesh& mesh, const char* model) {
    std::vector<std::string> said;
    RunSettings settings;
    settings.log = [&](LogLevel level, std::string_view text) {
      if (level == LogLevel::warning) said.emplace_back(text);
    };
    const RunContext context(settings);
    foam_case(mesh, {.model = model}, {}, flow, {.area = 1.0}, {}, context);
    return said;
  };
  const auto named = testing::Contains(HasSubstr("the layer has no height at a vertex of the walls, the first at ("));
  EXPECT_THAT(warnings(test::sphere_shell(2, {.collapsed = {3}}), "SpalartAllmaras"), named);
  EXPECT_THAT(warnings(test::sphere_shell(2, {.collapsed = {3}}), "euler"), testing::Not(named));
  EXPECT_THAT(warnings(test::sphere_shell(2), "SpalartAllmaras"), testing::Not(named));
}

TEST_F(FoamCases, AFolderIsWholeAndHoldsEverything) {
  run(with_mesh("m:foam_case{ " + at("case/") + ", flow{ mach = 0.2, altitude = 0, length = 2 }, alpha = 5*deg, model = 'kOmegaSST', tasks = 12 }"));
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "case"))
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder_ / "case").string());
  std::ranges::sort(files);
  EXPECT_THAT(files, testing::ElementsAre("0/Phi", "0/U", "0/k", "0/nut", "0/omega", "0/p", "Allclean", "Allrun", "case.foam", "constant/polyMesh/boundary",
                                          "constant/polyMesh/cellZones", "constant/polyMesh/faces", "constant/polyMesh/neighbour", "constant/polyMesh/owner",
                                          "constant/polyMesh/points", "constant/transportProperties", "constant/turbulenceProperties", "mesh.json",
                                          "system/controlDict", "system/decomposeParDict", "system/fvSchemes", "system/fvSolution", "system/judge.awk",
                                          "system/runControl", "system/stage", "system/stage.final", "system/stage.start"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) EXPECT_FALSE(entry.path().filename().string().starts_with(".sterna")) << entry.path();
  EXPECT_THAT(text_of("case/constant/polyMesh/boundary"), AllOf(HasSubstr("inGroups 1(farfield)"), HasSubstr("type wall")));
  EXPECT_THAT(text_of("case/constant/polyMesh/cellZones"), AllOf(HasSubstr("layers"), HasSubstr("source_1_sphere"), HasSubstr("format binary")));
  EXPECT_THAT(text_of("case/0/U"), HasSubstr("internalField uniform (67.7998"));  // 68.0588 cos 5 deg
  EXPECT_THAT(text_of("case/system/decomposeParDict"), AllOf(HasSubstr("numberOfSubdomains 12"), HasSubstr("n (3 2 2)")));
  EXPECT_THAT(text_of("case/system/fvSchemes"), AllOf(HasSubstr("pointCellsLeastSquares"), HasSubstr("3 % of the drag")));
  EXPECT_THAT(text_of("case/system/controlDict"), AllOf(Not(HasSubstr("forceCoeffs")), HasSubstr("type yPlus")));
  EXPECT_THAT(log_, HasSubstr("no reference area is given, so forces are in N, without coefficients"));
  // Without results it is replaced; what is no case is not.
  EXPECT_EQ(error(with_mesh("m:foam_case{ " + at("case") + ", flow{ reynolds = 100, length = 2 } }")), "no error");
  std::filesystem::create_directories(folder_ / "photos" / "holiday");
  EXPECT_THAT(error(with_mesh("m:foam_case{ " + at("photos") + ", flow{ reynolds = 100, length = 2 } }")), HasSubstr("something else"));
}

TEST_F(FoamCases, MeshesAloneHaveTheZonesOfSources) {
  for (const char* numbering : {"both", "lines"}) {
    run(with_mesh("m:write{ " + at("zoned/") + ", numbering = '" + numbering + "' }"));
    EXPECT_THAT(text_of("zoned/constant/polyMesh/cellZones"), AllOf(HasSubstr("layers"), HasSubstr("source_1_sphere"))) << numbering;
    EXPECT_THAT(log_, HasSubstr("zoned.json"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "zoned.json"));
  }
}

TEST_F(FoamCases, MistakesAreToldTogetherAtTheirLine) {
  const std::string reported = error(with_mesh("m:foam_case{ " + at("case") + ", reynolds = 1e6, length = 1, model = 'kEpsilon', taks = 3 }"));
  EXPECT_THAT(reported, AllOf(HasSubstr("case.lua:2: mesh:foam_case"), HasSubstr("kOmegaSST"), HasSubstr("did you mean \"tasks\"?")));
  EXPECT_THAT(error(with_mesh("m:foam_case{ " + at("case") + ", reynolds = 1e6, length = 1, compressible = 'yes' }")), HasSubstr("state of the gas"));
  EXPECT_THAT(error(with_mesh("m:foam_case{ " + at("case") + ", reynolds = 1e6, length = 1, boundaries = { prop = { thrust = 3 } } }")),
              HasSubstr("is called \"prop\""));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "case"));
}

TEST(FoamConditions, TunnelsHaveTheConditionsOfTheirFlow) {
  const HybridMesh mesh =
      test::box_of_patches({{"inlet", PatchKind::inflow}, {"outlet", PatchKind::outflow}, {"floor", PatchKind::wall}, {"side", PatchKind::slip}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .speed = 60.0, .temperature = 293.0, .pressure = 1e5});
  const FoamCase made = foam_case(mesh, {.model = "SpalartAllmaras"}, {.monitor = "floor"}, flow, {.area = 1.0}, {}, RunContext());
  EXPECT_THAT(file_of(made, "0/U"), AllOf(HasSubstr("value uniform (60 0 0)"), HasSubstr("type slip"), HasSubstr("type noSlip")));
  EXPECT_THAT(file_of(made, "0/p"), HasSubstr("outlet\n    {\n        type fixedValue;\n        value uniform 0;"));
  EXPECT_THAT(file_of(made, "0/nut"), HasSubstr("nutUSpaldingWallFunction"));
  const FoamCase gas = foam_case(mesh, {.compressible = "yes"}, {.monitor = "floor"}, flow, {.area = 1.0}, {}, RunContext());
  EXPECT_EQ(gas.application, "rhoSimpleFoam");
  EXPECT_THAT(file_of(gas, "0/p"), HasSubstr("value uniform 100000"));
  EXPECT_THAT(file_of(gas, "0/T"), HasSubstr("internalField uniform 293"));
}

TEST(FoamConditions, FansAndNozzlesNeedTheirPressures) {
  const HybridMesh mesh =
      test::box_of_patches({{"nozzle", PatchKind::inflow}, {"fan", PatchKind::outflow}, {"body", PatchKind::wall}, {"far", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.5, .altitude = 0.0});
  test::expect_error(ErrorCode::bad_argument, "the condition at the outflow \"fan\" is unknown",
                     [&] { (void)foam_case(mesh, {}, {}, flow, {.area = 1.0}, {}, RunContext()); });
  const CaseBoundaries boundaries = {{"nozzle", {.total_pressure = 1.5e5, .total_temperature = 600.0}}, {"fan", {.pressure = 9e4}}};
  const FoamCase made = foam_case(mesh, {}, {}, flow, {.area = 1.0}, boundaries, RunContext());
  EXPECT_THAT(file_of(made, "0/p"), AllOf(HasSubstr("type totalPressure"), HasSubstr("p0 uniform 150000"), HasSubstr("value uniform 90000")));
  EXPECT_THAT(file_of(made, "0/T"), HasSubstr("T0 uniform 600"));
}

TEST(FoamConditions, DiscsBecomeCyclicWithAJump) {
  const HybridMesh mesh =
      test::box_of_patches({{"prop", PatchKind::interface}, {"prop.back", PatchKind::interface}, {"body", PatchKind::wall}, {"far", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.2, .altitude = 0.0});
  test::expect_error(ErrorCode::bad_argument, "the pressure jump of the actuator disc \"prop\" is unknown",
                     [&] { (void)foam_case(mesh, {}, {}, flow, {.area = 1.0}, {}, RunContext()); });
  const FoamCase made = foam_case(mesh, {}, {}, flow, {.area = 1.0}, {{"prop", {.thrust = 1225.0}}}, RunContext());
  ASSERT_EQ(made.joined.size(), 1u);
  EXPECT_EQ(made.joined.front().second, PatchId(1));
  EXPECT_THAT(file_of(made, "0/p"),
              AllOf(HasSubstr("jump uniform 999.9"), HasSubstr("jump uniform -999.9"), HasSubstr("patchType cyclic")));  // over 1.225 kg/m^3
  EXPECT_THAT(file_of(made, "0/U"), HasSubstr("prop.back\n    {\n        type cyclic;"));
}

TEST(FoamConditions, HalfModelsCountHalfTheArea) {
  const HybridMesh mesh = test::box_of_patches({{"wing", PatchKind::wall}, {"plane", PatchKind::symmetry}, {"far", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.2, .altitude = 0.0});
  const FoamCase made = foam_case(mesh, {}, {}, flow, {.area = 30.0}, {}, RunContext());
  EXPECT_THAT(file_of(made, "system/controlDict"), HasSubstr("Aref 15;"));
  EXPECT_THAT(file_of(made, "0/U"), HasSubstr("type symmetryPlane"));
  EXPECT_THAT(file_of(made, "constant/turbulenceProperties"), HasSubstr("laminar"));  // no layers: no viscosity
}

}  // namespace
}  // namespace sterna::scripting
