// Wake sheets behind every wing of a model that is defined by numbers, as users write it.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;
using testing::Not;

class WakeScripts : public ScriptFixture {
 protected:
  /// Returns the wall of scripts/07.
  static std::string aircraft() {
    std::ifstream file(test::source_folder() / "scripts" / "07_aircraft_to_mesh.lua");
    const std::string text(std::istreambuf_iterator<char>(file), {});
    return text.substr(0, text.find("local mesh ="));
  }
  /// Returns the part of the output of a check from "node-centred: " to the next semicolon.
  static std::string failed(const std::string& reported) {
    const std::size_t begin = reported.find("node-centred: ");
    return begin == std::string::npos ? "" : reported.substr(begin, reported.find(';', begin) - begin);
  }
};

TEST_F(WakeScripts, FiveSheetsOfAircraftLeaveNoFlatTetrahedra) {  // with this farfield our own refinement got stuck below the wing's sheet
  const std::string reported = run(
      aircraft() +
          "local mesh = volume_mesh{ wall, layers = 20, first_height = 1e-5, farfield = sphere{ radius = 200 }, wakes = 'auto', improve = { improve_rounds = 0 "
          "} "
          "} mesh:check{ cell_centred = false }",
      {}, 2);
  EXPECT_THAT(log_, HasSubstr("wake sheets behind 5 trailing edges"));
  EXPECT_THAT(log_, Not(HasSubstr("refinement stopped early")));  // refinement got stuck before cavities that would fall apart were enlarged
  EXPECT_THAT(reported, HasSubstr("VALID; cell-centred: FAIL"));
  EXPECT_THAT(reported, Not(HasSubstr("INVALID")));
  EXPECT_THAT(failed(reported) + " ", Not(HasSubstr("G5 ")));  // G5 of the nodes on the tetrahedra over the sheets: 0.6 degrees where these are flat
}

}  // namespace
}  // namespace sterna::scripting
