// Volume meshes whose files list no boundary or only a part of it, or points that no cell uses.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "geom/mesh/check.h"
#include "geom/mesh/open_faces.h"
#include "io/file/format_table.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct ReadMesh {
  HybridMesh mesh;
  std::vector<std::string> warnings;
};
ReadMesh read_with_warnings(const std::filesystem::path& path, io::Incomplete incomplete = io::Incomplete::kept) {
  ReadMesh result;
  const RunContext context({.threads = 2, .log = [&result](LogLevel level, std::string_view text) {
                              if (level == LogLevel::warning) result.warnings.emplace_back(text);
                            }});
  result.mesh = io::read_volume_file(path, context, incomplete);
  return result;
}

/// Returns the boundary faces as the coordinates of their sorted nodes.
std::multiset<std::vector<std::array<double, 3>>> faces_of(const HybridMesh& mesh) {
  std::multiset<std::vector<std::array<double, 3>>> faces;
  const auto add = [&](const auto& face) {
    std::vector<std::array<double, 3>> locations;
    for (const NodeId node : face.nodes) locations.push_back({mesh.points[node].x, mesh.points[node].y, mesh.points[node].z});
    std::sort(locations.begin(), locations.end());
    faces.insert(std::move(locations));
  };
  std::ranges::for_each(mesh.boundary_triangles, add);
  std::ranges::for_each(mesh.boundary_quads, add);
  return faces;
}

TEST(IncompleteMesh, EveryFormatGetsItsMissingBoundary) {
  const HybridMesh whole = explicit_cells(mesh_of_six_patches());
  HybridMesh bare = whole;
  bare.boundary_triangles.clear();
  bare.boundary_quads.clear();
  int n = 0;
  for (const io::Format& format : io::formats()) {
    if (!format.write_volume || !format.read_volume || format.write_numbered) continue;  // face-based formats always store the boundary faces
    const std::string extension(format.extensions.substr(0, format.extensions.find(' ')));
    SCOPED_TRACE(std::string(format.name) + " " + extension);
    const auto path = scratch() / ("bare" + extension);
    io::write_volume_file(bare, path, RunContext({.threads = 2}), format.name);
    const ReadMesh back = read_with_warnings(path);
    EXPECT_EQ(faces_of(back.mesh), faces_of(whole));
    ASSERT_GE(back.mesh.patches.size(), 1u);
    EXPECT_EQ(back.mesh.patches[back.mesh.boundary_triangles.front().patch].name, "boundary");
    EXPECT_EQ(check(back.mesh, {}, RunContext({.threads = 2})).count(Violation::unmatched_face), 0);
    EXPECT_THAT(back.warnings, Contains(AllOf(HasSubstr("the file has no boundary faces"), HasSubstr("became the patch \"boundary\""))));
    if (format.read_surface) {
      const SurfaceSoup soup = io::read_surface_file(path, RunContext({.threads = 2}));
      EXPECT_EQ(soup.triangles.size(), whole.boundary_triangles.size() + 2 * whole.boundary_quads.size());
      EXPECT_GT(soup.n_cells, 0u);
    }
    ++n;
  }
  EXPECT_GE(n, 8);
}

TEST(IncompleteMesh, PartialBoundaryIsReportedAndCompletedOnRequest) {
  const HybridMesh whole = explicit_cells(mesh_of_six_patches());
  HybridMesh partial = whole;
  const PatchId lost = whole.boundary_triangles.front().patch;
  std::erase_if(partial.boundary_triangles, [&](const BoundaryTriangle& face) { return face.patch == lost; });
  std::erase_if(partial.boundary_quads, [&](const BoundaryQuad& face) { return face.patch == lost; });
  partial.points.push_back({9, 9, 9});
  const auto path = scratch() / "partial.su2";
  io::write_volume_file(partial, path, RunContext({.threads = 2}));
  const ReadMesh kept = read_with_warnings(path);
  EXPECT_EQ(faces_of(kept.mesh), faces_of(partial));
  EXPECT_THAT(kept.warnings, ElementsAre(AllOf(HasSubstr("faces belong to one cell and to no patch, the first at ("), HasSubstr("INVALID")),
                                         HasSubstr("1 of " + std::to_string(partial.points.size()) + " points belong to no cell")));
  const ReadMesh completed = read_with_warnings(path, io::Incomplete::completed);
  EXPECT_EQ(faces_of(completed.mesh), faces_of(whole));
  EXPECT_EQ(completed.mesh.points.size(), whole.points.size());
  EXPECT_THAT(completed.warnings, ElementsAre(AllOf(HasSubstr("boundary faces are missing"), HasSubstr("has a hole")), HasSubstr("are left out")));
}

TEST(IncompleteMesh, CompleteMeshesAreReadWithoutAWord) {
  const auto path = scratch() / "whole.su2";
  io::write_volume_file(mesh_of_six_patches(), path, RunContext({.threads = 2}));
  EXPECT_THAT(read_with_warnings(path).warnings, IsEmpty());
}

TEST(IncompleteMesh, PatchOfAddedFacesGetsUnusedName) {
  HybridMesh mesh = explicit_cells(mesh_of_six_patches());
  mesh.patches[PatchId(0)].name = "boundary";
  mesh.boundary_quads.clear();
  const OpenFaces open = find_open_faces(mesh, RunContext({.threads = 2}));
  ASSERT_GT(open.quads.size(), 0u);
  EXPECT_EQ(mesh.patches[add_boundary(mesh, open, "boundary")].name, "boundary_2");
  EXPECT_EQ(find_open_faces(mesh, RunContext({.threads = 1})).size(), 0u);
}

}  // namespace
}  // namespace sterna::test
