// A real mesh, damaged on purpose in one way at a time. The corresponding gate must fail at the correct location, both in `sterna check --json` and on the page
// of `sterna report`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>

#include "geom/math/measures.h"
#include "io/file/volume_file.h"
#include "scripting/report/report_page.h"
#include "scripting/terminal/exit_status.h"
#include "tests/scripting/report/page_json.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using PlainJson = nlohmann::json;

template <std::size_t N, class Nodes>
std::array<Point, N> points_of(const HybridMesh& mesh, const Nodes& nodes) {
  std::array<Point, N> p;
  for (std::size_t k = 0; k < N; ++k) p[k] = mesh.points[nodes[k]];
  return p;
}

template <class Nodes>
Point middle_of(const HybridMesh& mesh, const Nodes& nodes) {
  Point sum{};
  for (const NodeId node : nodes) sum += mesh.points[node];
  return sum / static_cast<double>(nodes.size());
}

/// Returns 1.1 times the length of a cell's longest edge, a tolerance for locations: they are the centre of the cell, of one of its faces, or one of its nodes.
template <class Nodes>
double reach_of(const HybridMesh& mesh, const Nodes& nodes) {
  double reach = 0.0;
  for (const NodeId a : nodes)
    for (const NodeId b : nodes) reach = std::max(reach, distance(mesh.points[a], mesh.points[b]));
  return 1.1 * reach;
}

class DamagedMeshes : public testing::Test {
 protected:
  void SetUp() override {
    STERNA_NEEDS_SHARED_DATA();
    if (base()) {
      mesh_ = *base();
      return;
    }
    std::ofstream(folder_ / "case.lua")
        << "local wall = read_surface{ \"" << (test::shared_data() / "surfaces" / "clean" / "caturbs_wing_wing.stl").string() << "\", split_angle = 60*deg }\n"
        << "volume_mesh{ wall, layers = 6, first_height = 1e-4 * wall.length, farfield = sphere{ radius = 20 * wall.length } }:write(\"case.sterna\")\n";
    const test::ProcessResult run = test::run_process(test::sterna_program(), {"--quiet", "run", "case.lua"}, folder_);
    ASSERT_EQ(run.status, 0) << run.output << run.errors;
    base() = explicit_cells(io::read_volume_file(folder_ / "case.sterna", RunContext({.threads = 2})));
    mesh_ = *base();
  }

  /// Checks the mesh and its page; both must name the gate at the place, the verdict as `is_valid` says. A valid mesh warns, and FAILs by the limit \p own of a
  /// user.
  void expect_failure(const std::string& gate, const std::string& measure, const Point& location, double within, bool is_valid, const std::string& own = "") {
    io::write_volume_file(mesh_, folder_ / "damaged.sterna", RunContext({.threads = 2}));
    const test::ProcessResult check = test::run_process(test::sterna_program(), {"--quiet", "check", "damaged.sterna", "--json"}, folder_);
    EXPECT_EQ(check.status, is_valid ? k_exit_success : k_exit_invalid) << check.errors;
    std::vector<std::string> strict = {"--quiet", "check", "damaged.sterna", "--strict"};
    if (is_valid) strict.insert(strict.end(), {"--gate", measure + ":hard=" + own});
    EXPECT_EQ(test::run_process(test::sterna_program(), strict, folder_).status, k_exit_invalid);
    const PlainJson report = PlainJson::parse(check.output);
    EXPECT_EQ(report["verdict"], is_valid ? "VALID" : "INVALID");
    double nearest = std::numeric_limits<double>::infinity();
    const auto look_at = [&](const PlainJson& p) { nearest = std::min(nearest, distance(location, Point{p[0], p[1], p[2]})); };
    if (is_valid) {
      for (const PlainJson& entry : report["measures"]) {
        if (entry["measure"] != measure) continue;
        EXPECT_EQ(entry["state"], "warn") << entry.dump(1);
        for (const PlainJson& found : entry["places"]) look_at(found["position"]);
      }
    } else {
      EXPECT_EQ(report["gates"][gate]["state"], "fail") << report["gates"].dump(1);
      EXPECT_GE(report["violations"].value(measure, 0), 1) << report["violations"].dump(1);
      for (const PlainJson& finding : report["findings"])
        if (finding["violation"] == measure) look_at(finding["position"]);
    }
    EXPECT_LT(nearest, within) << gate << " " << measure;
    if (!report_page().empty()) expect_in_page(gate, measure, location, within, is_valid);
    else if (test::is_all_required()) ADD_FAILURE() << "STERNA_REQUIRE_DATA=1, but this build has no report page";
  }

  HybridMesh mesh_;
  const std::filesystem::path folder_ = test::scratch();

 private:
  static std::optional<HybridMesh>& base() {
    static std::optional<HybridMesh> mesh;
    return mesh;
  }

  void expect_in_page(const std::string& gate, const std::string& measure, const Point& location, double within, bool is_valid) {
    const test::ProcessResult made = test::run_process(test::sterna_program(), {"--quiet", "report", "damaged.sterna", "-o", "damaged.html"}, folder_);
    EXPECT_EQ(made.status, is_valid ? k_exit_success : k_exit_invalid) << made.errors;
    const PlainJson page = test::page_json(folder_ / "damaged.html");
    EXPECT_EQ(page["verdict"], is_valid ? "VALID" : "INVALID");
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlainJson& found : page["places"]) {
      if (found["gate"] != gate || found["measure"] != measure) continue;
      EXPECT_EQ(found["state"], is_valid ? "warn" : "invalid");
      nearest = std::min(nearest, distance(location, Point{found["at"][0], found["at"][1], found["at"][2]}));
    }
    EXPECT_LT(nearest, within) << gate << " " << measure << " in the page";
  }
};

TEST_F(DamagedMeshes, FlippedPrism) {
  auto& prism = mesh_.prisms[mesh_.prisms.size() / 2];
  const Point location = middle_of(mesh_, prism);
  const double within = reach_of(mesh_, prism);
  for (std::size_t k = 0; k < 3; ++k) std::swap(prism[k], prism[k + 3]);
  expect_failure("G3", "invalid_cell", location, within, false);
}

TEST_F(DamagedMeshes, Hole) {
  const std::size_t hole = mesh_.prisms.size() / 3;
  const Point location = middle_of(mesh_, mesh_.prisms[hole]);
  const double within = reach_of(mesh_, mesh_.prisms[hole]);
  mesh_.prisms.erase(mesh_.prisms.begin() + static_cast<std::ptrdiff_t>(hole));
  expect_failure("G1", "unmatched_face", location, within, false);
}

/// The faces around a node of the curved wing get the marker of a symmetry plane.
TEST_F(DamagedMeshes, WrongMarker) {
  const BoundaryTriangle face = mesh_.boundary_triangles[mesh_.boundary_triangles.size() / 4];
  mesh_.patches.push_back({.name = "symmetry", .kind = PatchKind::symmetry});
  const PatchId patch(static_cast<std::uint32_t>(mesh_.patches.size() - 1));
  std::vector<NodeId> nodes;
  for (BoundaryTriangle& other : mesh_.boundary_triangles) {
    if (std::find(other.nodes.begin(), other.nodes.end(), face.nodes[0]) == other.nodes.end()) continue;
    other.patch = patch;
    nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
  }
  expect_failure("G20", "off_symmetry_plane", mesh_.points[face.nodes[0]], reach_of(mesh_, nodes), false);
}

TEST_F(DamagedMeshes, MarkerTwice) {
  const BoundaryTriangle face = mesh_.boundary_triangles[mesh_.boundary_triangles.size() / 4];
  mesh_.boundary_triangles.push_back(face);
  expect_failure("G1", "duplicate_marker", middle_of(mesh_, face.nodes), reach_of(mesh_, face.nodes), false);
}

/// A node between two layers that nearly touches the next node: the prisms stay valid, but their heights no longer grow.
TEST_F(DamagedMeshes, PinchedLayer) {
  const auto& prism = mesh_.prisms[mesh_.prisms.size() / 2 + 1];
  const Point bottom = mesh_.points[prism[0]], top = mesh_.points[prism[3]];
  const double within = reach_of(mesh_, prism);
  const auto is_of_boundary = [&](NodeId node) {
    return std::any_of(mesh_.boundary_triangles.begin(), mesh_.boundary_triangles.end(),
                       [&](const BoundaryTriangle& t) { return std::find(t.nodes.begin(), t.nodes.end(), node) != t.nodes.end(); });
  };
  const bool is_first = is_of_boundary(prism[0]);
  constexpr double k_left = 0.1;  // of the layer height
  if (is_first) mesh_.points[prism[3]] = bottom + k_left * (top - bottom);
  else mesh_.points[prism[0]] = top + k_left * (bottom - top);
  expect_failure("G8", "stack_growth", is_first ? top : bottom, within, true, "1.6");
}

/// The apex of a tetrahedron is moved towards its base until the angles there are below a degree; all cells around the apex stay valid.
TEST_F(DamagedMeshes, Sliver) {
  std::vector<std::vector<std::uint32_t>> around(mesh_.points.size());
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
    for (const NodeId node : mesh_.tetrahedra[t]) around[node.index()].push_back(static_cast<std::uint32_t>(t));
  std::vector<bool> is_free(mesh_.points.size(), true);
  for (const auto& prism : mesh_.prisms)
    for (const NodeId node : prism) is_free[node.index()] = false;
  for (const auto& pyramid : mesh_.pyramids)
    for (const NodeId node : pyramid) is_free[node.index()] = false;
  for (const BoundaryTriangle& face : mesh_.boundary_triangles)
    for (const NodeId node : face.nodes) is_free[node.index()] = false;
  constexpr double k_left = 0.01;  // of the height
  for (std::size_t t = mesh_.tetrahedra.size() / 2; t < mesh_.tetrahedra.size(); ++t) {
    const auto& tet = mesh_.tetrahedra[t];
    for (std::size_t k = 0; k < 4; ++k) {
      if (!is_free[tet[k].index()]) continue;
      const Point before = mesh_.points[tet[k]],
                  base = (mesh_.points[tet[(k + 1) % 4]] + mesh_.points[tet[(k + 2) % 4]] + mesh_.points[tet[(k + 3) % 4]]) / 3.0;
      mesh_.points[tet[k]] = base + k_left * (before - base);
      const bool is_valid = std::all_of(around[tet[k].index()].begin(), around[tet[k].index()].end(),
                                        [&](std::uint32_t other) { return is_tet_valid(points_of<4>(mesh_, mesh_.tetrahedra[other])); });
      if (is_valid && tet_dihedral_range(points_of<4>(mesh_, tet))[0] < std::numbers::pi / 180.0)
        return expect_failure("G14", "min_dihedral", middle_of(mesh_, tet), reach_of(mesh_, tet), true, "4deg");
      mesh_.points[tet[k]] = before;
    }
  }
  FAIL() << "no tetrahedron can be flattened";
}

}  // namespace
}  // namespace sterna::scripting
