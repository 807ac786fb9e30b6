// The measures for cell-centred solvers against the values printed by OpenFOAM's checkMesh, on real meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/data.h"
#include "tests/support/openfoam_tools.h"
#include "tests/support/process.h"

namespace sterna::io {
namespace {

/// checkMesh prints all digits here (writePrecision 17). Sums of about ten products in another order differ by rounding, and small differences of large
/// coordinates amplify this rounding.
constexpr double k_printed = 1e-9;
constexpr double k_rounding = 1e-13;              ///< for quotients of sums of order one
constexpr double k_determinant_rounding = 1e-16;  ///< for differences of products of order one

/// Returns the number after the first label found (checkMesh words good and bad results differently), or -1 if none is found.
double number_after_one_of(const std::string& output, const std::vector<std::string>& labels) {
  for (const std::string& label : labels)
    if (output.find(label) != std::string::npos) return test::number_after(output, label);
  return -1.0;
}

double worst_of(const nlohmann::json& report, const std::string& measure) {
  for (const auto& entry : report["measures"])
    if (entry["measure"] == measure) return entry["worst"].get<double>();
  ADD_FAILURE() << "no measure " << measure;
  return std::nan("");
}

double beyond_hard(const nlohmann::json& report, const std::string& measure) {
  for (const auto& entry : report["measures"])
    if (entry["measure"] == measure) return entry["beyond_hard"].get<double>();
  ADD_FAILURE() << "no measure " << measure;
  return std::nan("");
}

/// Returns the number in "<<Writing 12 faces with ..."
double number_before(const std::string& output, const std::string& label) {
  const std::size_t end = output.find(label);
  if (end == std::string::npos) return -1.0;
  return std::stod(output.substr(output.rfind(' ', end - 1) + 1, end));
}

void expect_same_figures(const std::string& script, const std::filesystem::path& folder) {
  std::ofstream(folder / "case.lua") << script;
  test::make_foam_case(folder / "case.bin.foam");
  STERNA_NEEDS(test::run_openfoam("checkMesh", {"-help"}, folder), "the Debian package openfoam");
  const test::ProcessResult run = test::run_process(test::sterna_program(), {"--quiet", "run", "case.lua"}, folder);
  ASSERT_EQ(run.status, 0) << run.output << run.errors;
  const test::ProcessResult check = test::run_process(test::sterna_program(), {"--quiet", "check", "case.sterna", "--json"}, folder);
  ASSERT_EQ(check.status, 0) << check.output << check.errors;
  const nlohmann::json report = nlohmann::json::parse(check.output);
  const auto output = test::run_openfoam("checkMesh", {"-case", "case.bin.foam", "-allTopology", "-allGeometry"}, folder);
  STERNA_NEEDS(output, "the Debian package openfoam");
  for (const auto& [measure, label] :
       {std::pair("non_orthogonality", "Mesh non-orthogonality Max:"), std::pair("skewness", "Max skewness ="),
        std::pair("cell_aspect_ratio", "aspect ratio ="), std::pair("face_flatness", "butterfly) : min ="),
        std::pair("face_weight", "Face interpolation weight : minimum:"), std::pair("volume_ratio", "Face volume ratio : minimum:")}) {
    const double theirs = number_after_one_of(*output, {label, "***High aspect ratio cells found, Max aspect ratio:"}), ours = worst_of(report, measure);
    EXPECT_NEAR(theirs, ours, k_printed * std::abs(ours) + k_rounding) << measure << "\n" << *output;
    testing::Test::RecordProperty(measure, std::to_string(ours));
  }
  const double determinant = test::number_after(*output, "Cell determinant (wellposedness) : minimum:");
  EXPECT_NEAR(determinant, worst_of(report, "cell_determinant"), k_printed * determinant + k_determinant_rounding) << *output;
  const std::string bad_tets = "***Error in face tets: ";
  const bool has_bad_tets = output->find(bad_tets) != std::string::npos;
  EXPECT_TRUE(has_bad_tets || output->find("Face tets OK.") != std::string::npos) << *output;
  // The number of written faces is used: the line above counts a face once for each of its faults.
  EXPECT_EQ(has_bad_tets ? number_before(*output, " faces with low quality or negative volume decomposition tets to set") : 0.0,
            beyond_hard(report, "face_tets"))
      << *output;
  const double openness = number_after_one_of(*output, {"Max cell openness =", "***Open cells found, max cell openness:"});
  if (openness >= 0.0) {                                                              // not printed together with a high aspect ratio
    EXPECT_NEAR(openness, worst_of(report, "cell_openness"), k_rounding) << *output;  // both are rounding errors relative to the cell size
  }
}

TEST(FoamQuality, OfAWingAreCheckMeshs) {
  STERNA_NEEDS_SHARED_DATA();
  expect_same_figures("local wall = read_surface{ \"" + (test::shared_data() / "surfaces" / "clean" / "caturbs_wing_wing.stl").string() +
                          "\", split_angle = 60*deg }\n" +
                          "volume_mesh{ wall, layers = 6, first_height = 1e-4 * wall.length, farfield = sphere{ radius = 20 * wall.length } "
                          "}:write(\"case.bin.foam\", \"case.sterna\")\n",
                      test::scratch());
}

/// Cells as tall as wide: the determinants are not tiny.
TEST(FoamQuality, OfACoarseLayerAreCheckMeshs) {
  STERNA_NEEDS_SHARED_DATA();
  expect_same_figures("local wall = read_surface{ \"" + (test::shared_data() / "surfaces" / "clean" / "meshpy_ka6d_ka-6d.ply").string() +
                          "\", split_angle = 60*deg }\n" +
                          "volume_mesh{ wall, layers = 2, first_height = 5e-3 * wall.length, farfield = sphere{ radius = 5 * wall.length } "
                          "}:write(\"case.bin.foam\", \"case.sterna\")\n",
                      test::scratch());
}

/// Columns that end on a symmetry plane: quadrilaterals on the boundary.
TEST(FoamQuality, OfAHalfAircraftAreCheckMeshs) {
  const std::string wall = (test::source_folder() / "scripts" / "data" / "cessna.msh.gz").string();
  expect_same_figures("local wall = half{ read_surface{ \"" + wall + "\", unit = ft, split_angle = 60*deg } }\n" +
                          "volume_mesh{ wall, layers = 8, first_height = 1e-4 * wall.length, farfield = sphere{ radius = 20 * wall.length } "
                          "}:write(\"case.bin.foam\", \"case.sterna\")\n",
                      test::scratch());
}

}  // namespace
}  // namespace sterna::io
