// The order of nodes and cells that scripts and commands ask for.
#include <gmock/gmock.h>

#include <fstream>

#include "geom/mesh/numbering.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/error_of.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

class WrittenNumbers : public ScriptFixture {
 protected:
  WrittenNumbers() {
    io::write_surface_file(test::sphere(4), folder_ / "ball.off", RunContext());
    run("local m = volume_mesh{ read_surface 'ball.off', layers = 4, first_height = 0.02, farfield = sphere{ radius = 8 } }\nm:write(" + out("made.su2") +
        ", " + out("made.sterna") + ", " + out("made.foam") + ")\nm:write{ " + out("both.su2") + ", " + out("both.sterna") +
        ", numbering = 'both' }\nm:write{ " + out("band.cgns") + ", numbering = 'bandwidth' }\nm:write{ " + out("lines/") + ", numbering = 'lines' }");
  }
  NumberingMeasure measure(const std::string& name) const {
    return measure_numbering(node_graph(io::read_volume_file(folder_ / name, RunContext()), RunContext()));
  }
  /// Whole files.
  std::string bytes(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(WrittenNumbers, AreThoseThatAreAskedFor) {
  const NumberingMeasure made = measure("made.su2"), both = measure("both.su2"), band = measure("band.cgns");
  EXPECT_LT(both.mean_profile, 0.8 * made.mean_profile);
  EXPECT_LT(band.mean_profile, 0.8 * made.mean_profile);
  EXPECT_LT(both.bandwidth, made.bandwidth);
  EXPECT_EQ(measure("both.sterna").mean_profile, measure("made.sterna").mean_profile) << ".sterna files keep the order of the mesh";
  // OpenFOAM takes cells as they come: there it is `both` unless something else is asked for.
  EXPECT_LT(measure("made.foam").mean_profile, 0.8 * measure("lines/constant/polyMesh").mean_profile);
  EXPECT_THAT(error("read_mesh(" + out("made.su2") + "):write{ " + out("x.su2") + ", numbering = 'random' }"), HasSubstr("numbering"));
  EXPECT_THAT(error("read_mesh(" + out("made.su2") + "):write{ " + out("x.su2") + ", numbring = 'both' }"), HasSubstr("numbering"));
}

TEST_F(WrittenNumbers, AreThoseOfCommands) {
  const auto sterna = [&](const std::vector<std::string>& arguments) {
    const test::ProcessResult result = test::run_process(test::sterna_program(), arguments, folder_);
    EXPECT_EQ(result.status, 0) << result.errors;
  };
  sterna({"convert", "made.su2", "kept.cgns"});
  EXPECT_EQ(measure("kept.cgns").mean_profile, measure("made.su2").mean_profile);
  sterna({"convert", "made.su2", "both.cgns", "--numbering", "both"});
  EXPECT_EQ(measure("both.cgns").mean_profile, measure("both.su2").mean_profile) << "lines are found where the file has no columns";
  const std::vector<std::string> mesh = {"mesh", "ball.off", "--layers", "4", "--first-height", "0.02", "--farfield-radius", "8"};
  auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = mesh;
    all.insert(all.end(), more.begin(), more.end());
    sterna(all);
  };
  with({"-o", "a.su2", "--numbering", "both"});
  with({"-o", "b.su2", "--set", "write.numbering=both", "--threads", "1"});
  EXPECT_EQ(bytes("a.su2"), bytes("b.su2"));
  EXPECT_EQ(measure("a.su2").mean_profile, measure("both.su2").mean_profile);
}

}  // namespace
}  // namespace sterna::scripting
