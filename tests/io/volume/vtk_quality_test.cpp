// The cell quality written by `sterna check --cells` against VTK's MeshQuality.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/file/volume_file.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/process.h"

namespace sterna::io {
namespace {

constexpr double k_agreement = 1e-9;
constexpr int k_not_installed = 77;

void expect_agreement(const std::string& mesh, const std::filesystem::path& folder, const std::string& cells, std::int64_t at_least) {
  const test::ProcessResult check = test::run_process(test::sterna_program(), {"--quiet", "check", mesh, "--no-intersections", "--cells", "cells.vtu"}, folder);
  ASSERT_EQ(check.status, 0) << check.output << check.errors;
  const test::ProcessResult compared =
      test::run_process("/usr/bin/python3", {(test::source_folder() / "tests/tools/vtk_quality.py").string(), "cells.vtu"}, folder);
  STERNA_NEEDS(compared.status != k_not_installed, "the Debian package python3-vtk9");
  ASSERT_EQ(compared.status, 0) << compared.output << compared.errors;
  const nlohmann::json result = nlohmann::json::parse(compared.output);
  EXPECT_GE(result[cells].get<std::int64_t>(), at_least);
  for (const char* measure : {"tet_scaled_jacobian", "tet_dihedral_vtk_deg", "tet_dihedral_ours_deg", "tet_volume_relative", "hex_scaled_jacobian"})
    EXPECT_LT(result[measure].get<double>(), k_agreement) << measure;
  testing::Test::RecordProperty("compared", compared.output);
}

TEST(VtkQuality, TetrahedraOfARealMesh) {
  STERNA_NEEDS_SHARED_DATA();
  const auto folder = test::scratch();
  std::ofstream(folder / "case.lua")
      << "local wall = read_surface{ \"" << (test::shared_data() / "surfaces" / "clean" / "caturbs_wing_wing.stl").string() << "\", split_angle = 60*deg }\n"
      << "volume_mesh{ wall, layers = 6, first_height = 1e-4 * wall.length, farfield = sphere{ radius = 20 * wall.length } }:write(\"case.sterna\")\n";
  const test::ProcessResult run = test::run_process(test::sterna_program(), {"--quiet", "run", "case.lua"}, folder);
  ASSERT_EQ(run.status, 0) << run.output << run.errors;
  expect_agreement("case.sterna", folder, "tetrahedra", 10000);
}

TEST(VtkQuality, HexahedraPulledOutOfShape) {
  const auto folder = test::scratch();
  HybridMesh mesh = test::hexahedra_block(4);
  for (Point& p : mesh.points) p = {p.x + 0.1 * p.y * p.z, p.y - 0.15 * p.x * p.x, p.z + 0.2 * p.x * p.y};
  write_volume_file(mesh, folder / "block.vtu", RunContext({.threads = 2}));
  expect_agreement("block.vtu", folder, "hexahedra", 64);
}

}  // namespace
}  // namespace sterna::io
