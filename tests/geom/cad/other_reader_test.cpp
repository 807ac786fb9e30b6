// CAD files written by sterna, read by another program: gmsh's own import with its own settings.
#include <gmock/gmock.h>

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>

#include "io/file/cad_file.h"
#include "tests/geom/cad/cylinder.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

/// Returns a line of read_with_gmsh.py, or nothing if that Python module is missing.
std::optional<std::string> read_with_gmsh(const std::filesystem::path& file) {
  const std::string command = "/usr/bin/python3 '" + test::source_folder().string() + "/tests/geom/cad/read_with_gmsh.py' '" + file.string() +
                              "' 2>&1";  // Debian's own Python: another one on PATH lacks gmsh
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  std::string output;
  char piece[4096];
  for (std::size_t n = std::fread(piece, 1, sizeof piece, pipe); n > 0; n = std::fread(piece, 1, sizeof piece, pipe)) output.append(piece, n);
  const int status = ::pclose(pipe);
  constexpr int k_module_missing = 77;
  if (WIFEXITED(status) && WEXITSTATUS(status) == k_module_missing) {
    const char* const required = std::getenv("STERNA_REQUIRE_DATA");
    if (required && std::string(required) == "1") ADD_FAILURE() << "STERNA_REQUIRE_DATA=1, but " << output;
    return std::nullopt;
  }
  EXPECT_EQ(status, 0) << command << "\n" << output;
  return output;
}

TEST(OtherReader, GmshReadsSolidWithMeasuresAndNames) {
  const double r = 0.3, h = 2.0;
  for (const char* extension : {"brep", "step", "iges"}) {
    SCOPED_TRACE(extension);
    const auto path = test::scratch() / (std::string("can.") + extension);
    io::write_cad(test::cylinder(r, h), path, {}, RunContext());
    const std::optional<std::string> output = read_with_gmsh(path);
    STERNA_NEEDS(output, "python3-gmsh (tools/packages-test.txt)");
    const std::size_t at = output->find("result ");
    ASSERT_NE(at, std::string::npos) << *output;
    std::istringstream line(output->substr(at + std::string("result ").size()));
    const double unit = std::string(extension) == "brep" ? 1.0 : 1e-3;  // gmsh reads files with a length unit in millimetres
    std::size_t n_solids = 0, n_faces = 0;
    double volume = 0.0, area = 0.0;
    std::string names;
    line >> n_solids >> n_faces >> volume >> area;
    std::getline(line, names);
    EXPECT_EQ(n_solids, 1u);
    EXPECT_EQ(n_faces, 3u);
    EXPECT_NEAR(volume * unit * unit * unit, std::numbers::pi * r * r * h, 1e-6);
    EXPECT_NEAR(area * unit * unit, 2.0 * std::numbers::pi * r * (h + r), 1e-6);
    if (std::string(extension) != "step") continue;
    EXPECT_THAT(names, testing::HasSubstr("can"));
    // gmsh 4.8 reports names of solids only; names of faces are in the file itself.
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    for (const char* name : {"can side", "can top", "can bottom"}) EXPECT_THAT(text.str(), testing::HasSubstr("ADVANCED_FACE('" + std::string(name) + "'"));
  }
}

}  // namespace
}  // namespace sterna
