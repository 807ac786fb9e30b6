// Every real surface: defective files get the verdict of tests/data/nasty_surfaces.tsv; clean files are accepted with their triangles unchanged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

#include "io/file/surface_file.h"
#include "tests/support/data.h"
#include "tests/surfmesh/soups.h"

namespace sterna::test {
namespace {

namespace fs = std::filesystem;

struct Expected {
  std::string file, verdict, reason;
  std::int64_t n_locations = 0;
};

std::vector<Expected> expectations() {
  std::ifstream table(corpus() / "nasty_surfaces.tsv");
  EXPECT_TRUE(table.good());
  std::vector<Expected> rows;
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    Expected row;
    std::string n;
    std::getline(fields, row.file, '\t');
    std::getline(fields, row.verdict, '\t');
    std::getline(fields, n, '\t');
    std::getline(fields, row.reason);
    row.n_locations = std::stoll(n);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Prints one row of the final table to the test's output.
void print_row(const std::string& file, const std::string& verdict, std::int64_t n_locations, double seconds, const surfmesh::StitchResult& result) {
  std::cout << "| " << file << " | " << verdict << " | " << n_locations << " | " << result.mesh.n_triangles() << " | " << result.mesh.n_vertices() << " | "
            << result.report.n_components << " | " << result.report.n_flipped << " | " << seconds << " |\n";
}

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

TEST(StitchNasty, EveryFileHasItsRow) {
  STERNA_NEEDS_SHARED_DATA();
  std::set<std::string> listed, present;
  for (const Expected& row : expectations()) EXPECT_TRUE(listed.insert(row.file).second) << row.file << " is listed twice";
  for (const auto& entry : fs::directory_iterator(shared_data() / "surfaces" / "nasty")) present.insert(entry.path().filename().string());
  EXPECT_EQ(listed, present);
}

TEST(StitchNasty, EveryFileGetsItsVerdict) {
  STERNA_NEEDS_SHARED_DATA();
  const RunContext context = quiet();
  for (const Expected& row : expectations()) {
    SCOPED_TRACE(row.file + ": " + row.reason);
    const Stopwatch watch;
    surfmesh::StitchResult result;
    std::string verdict = "valid";
    std::int64_t n_locations = 0;
    try {
      result = surfmesh::stitch_surface({io::read_surface_file(shared_data() / "surfaces" / "nasty" / row.file, context)}, {}, context);
      expect_stitched(result.mesh);
    } catch (const Error& error) {
      verdict = std::string(to_string(error.code()));
      if (error.code() != ErrorCode::unsupported_format) {
        n_locations = error.n_locations();
        EXPECT_FALSE(error.info().locations.empty());
        EXPECT_LE(error.info().locations.size(), 10u);
        EXPECT_FALSE(error.info().geometry.empty());
        EXPECT_FALSE(error.info().hint.empty());
        EXPECT_THAT(error.what(), testing::HasSubstr(row.file));
        std::cout << error.what() << "\n";
      }
    }
    EXPECT_EQ(verdict, row.verdict);
    EXPECT_EQ(n_locations, row.n_locations);
    for (const std::string& message : result.report.messages) std::cout << row.file << ": " << message << "\n";
    print_row(row.file, verdict, n_locations, watch.seconds(), result);
  }
}

struct Clean {
  std::vector<std::string> files;
  std::size_t n_triangles;  ///< tests/data/shared/README.md
  int n_components;         ///< tests/tools/surface_verdict.py
};

const std::vector<Clean>& clean_surfaces() {
  static const std::vector<Clean> surfaces = {
      {{"caturbs_wing_wing.stl"}, 880, 1},
      {{"cgal_data_anchor_dense.off"}, 7598, 1},
      {{"cgal_data_couplingdown.off"}, 3714, 1},
      {{"derived_crm_wb_dpw_coarse_full.off"}, 44736, 1},
      {{"dlr_f6_184k.stl"}, 184050, 1},
      {{"drivaer_frontWheels.obj.gz"}, 78164, 2},
      {{"f1_rear_wing_f1_rw_drs.stl", "f1_rear_wing_f1_rw_end_plates.stl", "f1_rear_wing_f1_rw_main_plane.stl"}, 41888, 1},
      {{"flow360_airplane_airplaneGeometry.stl"}, 79868, 1},
      {{"flow360_airplane_airplane_simple.lb8.ugrid"}, 32756, 1},
      {{"flowpanel_cessna_cessna.msh"}, 23536, 1},
      {{"flowpanel_duct_duct_remeshed_refined.msh"}, 8754, 1},
      {{"flowpanel_sweptwing_sweptwing-openvsp.msh"}, 12792, 1},
      {{"gmsh_stl_TwoObjects.stl.gz"}, 1492, 2},
      {{"meshpy_ka6d_ka-6d.ply"}, 1818, 1},
      {{"pmp_fandisk.off"}, 12946, 1},
      {{"pygeo_bwb.stl"}, 4464, 1},
      {{"pymeshlab_airplane_airplane.obj"}, 10796, 1},
      {{"vspgeom_geom2_geom2.stl"}, 13744, 1},
      {{"wing_body_79k.stl"}, 79218, 1},
  };
  return surfaces;
}

TEST(StitchClean, EveryFileIsAccepted) {
  STERNA_NEEDS_SHARED_DATA();
  const RunContext context = quiet();
  std::set<std::string> listed, present;
  for (const Clean& surface : clean_surfaces()) {
    SCOPED_TRACE(surface.files[0]);
    std::vector<SurfaceSoup> soups;
    for (const std::string& file : surface.files) {
      listed.insert(file);
      soups.push_back(io::read_surface_file(shared_data() / "surfaces" / "clean" / file, context));
    }
    const Stopwatch watch;
    const auto result = surfmesh::stitch_surface(soups, {}, context);
    const double seconds = watch.seconds();
    expect_stitched(result.mesh);
    EXPECT_EQ(result.mesh.n_triangles(), surface.n_triangles);
    EXPECT_EQ(result.report.n_components, surface.n_components);
    EXPECT_EQ(result.report.n_degenerate_removed + result.report.n_duplicate_removed + result.report.n_welded_near, 0);
    for (const std::string& message : result.report.messages) std::cout << surface.files[0] << ": " << message << "\n";
    print_row(surface.files[0], "valid", 0, seconds, result);
  }
  for (const auto& entry : fs::directory_iterator(shared_data() / "surfaces" / "clean")) present.insert(entry.path().filename().string());
  EXPECT_EQ(listed, present);
}

TEST(StitchClean, ThreadsDoNotChangeRealSurfaces) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = io::read_surface_file(shared_data() / "surfaces" / "clean" / "derived_crm_wb_dpw_coarse_full.off", quiet());
  const auto first = stitch({soup}, {.split_angle = 0.7}, 1);
  for (const int threads : {2, 7}) {
    const auto other = stitch({soup}, {.split_angle = 0.7}, threads);
    EXPECT_EQ(other.mesh.points, first.mesh.points);
    EXPECT_EQ(other.mesh.triangles, first.mesh.triangles);
    EXPECT_EQ(other.mesh.triangle_patch, first.mesh.triangle_patch);
  }
}

TEST(StitchClean, EachRearWingPartAloneIsOpen) {
  STERNA_NEEDS_SHARED_DATA();
  for (const std::string& file : clean_surfaces()[6].files) {
    const ErrorInfo info = stitch_error({io::read_surface_file(shared_data() / "surfaces" / "clean" / file, quiet())});
    EXPECT_EQ(info.code, ErrorCode::open_surface) << file;
  }
}

}  // namespace
}  // namespace sterna::test
