// TetGen itself as an independent reader of .smesh and .poly.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"

namespace sterna::io {
namespace {

constexpr const char* k_tetgen = "/usr/bin/tetgen";

/// Returns the rows of numbers of a TetGen file, without comments; the first row has the counts.
std::vector<std::vector<double>> rows_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.is_open()) << path;
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream numbers(line.substr(0, line.find('#')));
    std::vector<double> row;
    for (double x; numbers >> x;) row.push_back(x);
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

using test::volume_of;

/// Checks that TetGen fills the unchanged surface (-Y): the tetrahedra fill the enclosed volume, and their boundary faces are the patches.
void expect_filled(const TriMesh& mesh, const std::string& extension) {
  SCOPED_TRACE(extension);
  const auto folder = test::scratch();
  write_surface_file(mesh, folder / ("body" + extension), RunContext({.threads = 2}));
  const test::ProcessResult run = test::run_process(k_tetgen, {"-pYQ", "body" + extension}, folder);
  ASSERT_EQ(run.status, 0) << run.output << run.errors;
  const auto nodes = rows_of(folder / "body.1.node"), tets = rows_of(folder / "body.1.ele"), faces = rows_of(folder / "body.1.face");
  ASSERT_GT(nodes.size(), mesh.n_vertices());
  const auto first = static_cast<std::size_t>(nodes[1][0]);
  const auto point = [&](double number) {
    const auto& row = nodes[static_cast<std::size_t>(number) - first + 1];
    return Point{row[1], row[2], row[3]};
  };
  for (const VertexId v : mesh.points.ids()) EXPECT_EQ(point(static_cast<double>(v.index() + first)), mesh.points[v]);
  double volume = 0.0;
  for (std::size_t i = 1; i < tets.size(); ++i) {
    const Point a = point(tets[i][1]);
    volume += std::abs(dot(point(tets[i][2]) - a, cross(point(tets[i][3]) - a, point(tets[i][4]) - a))) / 6.0;
  }
  EXPECT_NEAR(volume, volume_of(mesh), 1e-9 * std::abs(volume));  // TetGen writes 15 digits; cancellation in a thin body loses some of them
  std::map<int, std::int64_t> found, expected;
  for (std::size_t i = 1; i < faces.size(); ++i) ++found[static_cast<int>(faces[i][4])];
  for (const PatchId patch : mesh.triangle_patch) ++expected[static_cast<int>(patch.index()) + 1];
  EXPECT_EQ(found, expected);
}

TEST(TetGen, ReadsWhatIsWritten) {
  STERNA_NEEDS(std::filesystem::exists(k_tetgen), "the Debian package tetgen");
  TriMesh cube = test::cube(3);
  cube.patches.push_back({"lid"});
  for (std::uint64_t t = 0; t < 7; ++t) cube.triangle_patch[TriangleId(t)] = PatchId(1);
  for (const char* extension : {".smesh", ".poly"}) {
    expect_filled(cube, extension);
    STERNA_NEEDS_SHARED_DATA();
    const SurfaceSoup soup = read_surface_file(test::shared_data() / "surfaces" / "clean" / "cgal_data_couplingdown.off", RunContext({.threads = 2}));
    expect_filled(surfmesh::stitch_surface({soup}, {}, RunContext({.threads = 2})).mesh, extension);
  }
}

}  // namespace
}  // namespace sterna::io
