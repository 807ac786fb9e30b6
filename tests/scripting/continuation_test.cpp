// A run that is stopped after a step and continued, from a script or from the command line, writes the same bytes as the whole run. The domains have every
// feature possible beside bodies in a sphere.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "scripting/terminal/exit_status.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

struct Domain {
  std::string name;
  std::string wall;     ///< Lua: makes `wall`
  std::string options;  ///< options of make_envelope and volume_mesh
};

void PrintTo(const Domain& domain, std::ostream* out) { *out << domain.name; }

class Continuation : public testing::TestWithParam<Domain> {
 protected:
  Continuation() : folder_(test::scratch()) { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl"); }

  void run(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / (name + ".lua")) << text;
    expect_success({"run", name + ".lua"});
  }
  void expect_success(const std::vector<std::string>& arguments) {
    const test::ProcessResult result = test::run_process(test::sterna_program(), arguments, folder_, -1.0);
    EXPECT_EQ(result.status, k_exit_success) << result.errors;
  }
  std::string contents(const std::string& name) {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
};

TEST_P(Continuation, GivesTheBytesOfTheWholeRun) {
  const std::string wall = "local wall = read_surface 'box.stl'\n" + GetParam().wall + "\n";
  const std::string layer = "layers = 4, first_height = 2e-3, " + GetParam().options;
  run("whole", wall + "volume_mesh{ wall, " + layer + ", stages = 'all.sterna' }:write 'whole.su2'");
  run("envelope", wall + "make_envelope{ wall, " + layer + " }:write 'env.sterna'");
  std::filesystem::remove(folder_ / "room.stl");  // the stage file contains all that is needed
  run("tetrahedra", "tetrahedra{ read_stages('env.sterna').envelope }:write 'tets.sterna'");
  run("prisms", "local s = read_stages 'tets.sterna'\nfinish_mesh{ s.envelope, s.tetrahedra }:write 'script.su2'");
  run("finished", "local e = read_stages('all.sterna').envelope\nfinish_mesh{ e, tetrahedra{ e } }:write 'finished.su2'");
  run("last", "local s = read_stages 'all.sterna'\nfinish_mesh{ s.envelope, s.tetrahedra }:write 'last.su2'");
  expect_success({"mesh", "env.sterna", "-o", "command.su2"});
  expect_success({"mesh", "tets.sterna", "-o", "late.su2"});
  const std::string whole = contents("whole.su2");
  EXPECT_GT(whole.size(), 10000u);
  for (const char* name : {"script.su2", "command.su2", "late.su2", "finished.su2", "last.su2"}) EXPECT_TRUE(contents(name) == whole) << name << " differs";
}

TEST_P(Continuation, AcceptsOptionsOfRemainingSteps) {
  const std::string wall = "local wall = read_surface 'box.stl'\n" + GetParam().wall + "\n";
  const std::string layer = "layers = 4, first_height = 2e-3, " + GetParam().options;
  run("whole", wall + "volume_mesh{ wall, " + layer + ", ends_growth = 1.25, size_growth = 1.5, improve_rounds = 3 }:write 'whole.su2'");
  run("envelope", wall + "make_envelope{ wall, " + layer + " }:write 'env.sterna'");
  run("script",
      "local e = read_stages('env.sterna').envelope\nfinish_mesh{ e, tetrahedra{ e, ends_growth = 1.25, size_growth = 1.5 }, improve_rounds = 3 }:write "
      "'script.su2'");
  expect_success({"mesh", "env.sterna", "--ends-growth", "1.25", "--size-growth", "1.5", "--improve-rounds", "3", "-o", "command.su2"});
  const std::string whole = contents("whole.su2");
  EXPECT_GT(whole.size(), 10000u);
  for (const char* name : {"script.su2", "command.su2"}) EXPECT_TRUE(contents(name) == whole) << name << " differs";
}

/// A point with a target size, for size_samples.
constexpr const char* k_sizes_vtu =
    R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid><Piece NumberOfPoints="1" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="size" format="ascii">0.5</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">2 0 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0</DataArray><DataArray type="Int64" Name="offsets" format="ascii">1</DataArray><DataArray type="UInt8" Name="types" format="ascii">1</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

class ContinuationWithSources : public Continuation {};

TEST_P(ContinuationWithSources, FileHasTheSources) {
  const std::string volume = "volume_mesh{ read_surface 'box.stl', layers = 4, first_height = 2e-3, farfield = sphere{ radius = 6 }, " + GetParam().options +
                             ", stages = 'all.sterna' }:write 'whole.su2'";
  std::ofstream(folder_ / "sizes.vtu") << k_sizes_vtu;
  run("whole", volume);
  std::filesystem::remove(folder_ / "sizes.vtu");
  run("finished", "local e = read_stages('all.sterna').envelope\nfinish_mesh{ e, tetrahedra{ e } }:write 'finished.su2'");
  run("without", "local e = read_stages('all.sterna').envelope\nfinish_mesh{ e, tetrahedra{ e, sources = {} } }:write 'without.su2'");
  const std::string whole = contents("whole.su2");
  EXPECT_GT(whole.size(), 10000u);
  EXPECT_TRUE(contents("finished.su2") == whole);
  EXPECT_FALSE(contents("without.su2") == whole) << "the sources have no effect";
}

INSTANTIATE_TEST_SUITE_P(Sources, ContinuationWithSources,
                         testing::Values(Domain{"Shapes", "",
                                                "sources = { sphere{ {2, 0.5, 0.5}, radius = 0.5, size = 0.2 }, wake{ {1, 0, 0.5}, {1, 1, 0.5}, length = 2, "
                                                "height = 0.5, spread = 0.1, size = 0.2, size_end = 0.3, direction = {1, 0, 0.1} } }"},
                                         Domain{"Samples", "", "sources = { size_samples 'sizes.vtu' }"}),
                         [](const testing::TestParamInfo<Domain>& tested) { return tested.param.name; });

std::vector<Domain> domains() {
  std::vector<Domain> result;
  for (const nlohmann::json& entry : nlohmann::json::parse(std::ifstream(test::corpus() / "continued_domains.json")))
    result.push_back({entry.at("name"), entry.at("wall"), entry.at("options")});
  if (result.empty()) throw std::runtime_error("continued_domains.json lists no domain");
  return result;
}

INSTANTIATE_TEST_SUITE_P(Domains, Continuation, testing::ValuesIn(domains()), [](const testing::TestParamInfo<Domain>& tested) { return tested.param.name; });

}  // namespace
}  // namespace sterna::scripting
