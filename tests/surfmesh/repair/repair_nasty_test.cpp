// Real surfaces with real defects: accepted repairs are proved; refusals state the reason and a remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <set>

#include "geom/base/error.h"
#include "geom/mesh/topology.h"
#include "io/file/surface_file.h"
#include "surfmesh/repair/repair_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"

namespace sterna::test {
namespace {

namespace fs = std::filesystem;

TEST(RepairNasty, WhatIsNotASheetIsRepaired) {
  STERNA_NEEDS_SHARED_DATA();
  // Open surfaces and shells whose openings are as large as the surface itself: they enclose nothing.
  const std::set<std::string> beyond = {"cgal_data_b9_mesh.off", "cgal_data_degtri_sliding.off", "nasty_meshlab_non_manif_hole.ply"};
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(shared_data() / "surfaces" / "nasty")) files.insert(entry.path().filename().string());
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const std::vector<SurfaceSoup> soups{io::read_surface_file(shared_data() / "surfaces" / "nasty" / file, k_context)};
    try {
      const surfmesh::RepairResult result = surfmesh::repair_surface(soups, {}, {}, k_context);
      EXPECT_FALSE(beyond.count(file));
      const Topology topology(result.mesh, k_context);
      EXPECT_EQ(topology.n_boundary_halfedges() > 0, result.report.half.has_value());
      EXPECT_LE(result.report.moved, 0.01 * result.report.length);
      std::cout << file << ": " << result.report.changes.size() << " changes\n";
    } catch (const Error& error) {
      EXPECT_TRUE(beyond.count(file)) << error.what();
      EXPECT_THAT(error.what(), testing::HasSubstr("wrap"));
      EXPECT_FALSE(error.info().locations.empty());
    }
  }
}

TEST(RepairNasty, CleanSurfacesComeBackWithTheSameBytes) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"wing_body_79k.stl", "cgal_data_anchor_dense.off", "meshpy_ka6d_ka-6d.ply"}) {
    const std::vector<SurfaceSoup> soups{io::read_surface_file(shared_data() / "surfaces" / "clean" / file, k_context)};
    const surfmesh::RepairResult result = surfmesh::repair_surface(soups, {}, {}, k_context);
    const TriMesh expected = surfmesh::stitch_surface(soups, {}, k_context).mesh;
    EXPECT_EQ(result.mesh.points, expected.points);
    EXPECT_EQ(result.mesh.triangles, expected.triangles);
    EXPECT_TRUE(result.report.changes.empty());
  }
}

}  // namespace
}  // namespace sterna::test
