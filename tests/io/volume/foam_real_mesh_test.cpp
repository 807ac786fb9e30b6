// Results of OpenFOAM's checkMesh for the mesh of a real wing, and the locations of the faces that it reports.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include "io/volume/sterna_file.h"
#include "tests/support/data.h"
#include "tests/support/openfoam_tools.h"
#include "tests/support/process.h"
#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/feature_angle.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_far = std::numeric_limits<std::size_t>::max();

/// Classifies the cells of the polyMesh: columns come first, layer by layer; then tetrahedra.
class CellPlaces {
 public:
  CellPlaces(const SternaContent& content, const std::filesystem::path& poly)
      : surface_(*content.surface), owner_(test::read_labels(poly / "owner")), neighbour_(test::read_labels(poly / "neighbour")) {
    const LayerBlock& layers = content.mesh->layers;
    for (std::size_t column = 0; column < layers.n_columns(); ++column)
      if (layers.n_collapsed(column) < 3) column_of_.insert(column_of_.end(), static_cast<std::size_t>(layers.n_layers), column);
    find_distances(layers, static_cast<std::size_t>(count_cells(*content.mesh).total()));
  }

  bool is_of_layer(std::size_t cell) const { return cell < column_of_.size(); }
  bool is_inner(std::size_t face) const { return face < neighbour_.size(); }
  std::size_t owner(std::size_t face) const { return owner_.at(face); }
  std::size_t neighbour(std::size_t face) const { return neighbour_.at(face); }
  std::size_t n_inner() const { return neighbour_.size(); }

  /// Returns the number of steps over faces from the nearest cell of a column at a ridge.
  std::size_t distance_of(std::size_t face) const { return std::min(distance_[owner(face)], is_inner(face) ? distance_[neighbour(face)] : k_far); }
  /// Returns true if the face separates two neighbouring columns of the layer.
  bool is_side(std::size_t face) const {
    return is_inner(face) && is_of_layer(owner(face)) && is_of_layer(neighbour(face)) && column_of_[owner(face)] != column_of_[neighbour(face)];
  }
  /// Returns the angle that the face of straight prisms would have: between the line of the two wall triangles' centres and their edge's normal, radians.
  double angle_on_wall(std::size_t face) const {
    const auto &a = surface_.triangles.raw()[column_of_[owner(face)]], &b = surface_.triangles.raw()[column_of_[neighbour(face)]];
    std::vector<VertexId> common;
    for (const VertexId v : a)
      if (std::find(b.begin(), b.end(), v) != b.end()) common.push_back(v);
    if (common.size() != 2) return 0.0;
    const auto centre = [&](const TriangleVertices& t) { return (surface_.points[t[0]] + surface_.points[t[1]] + surface_.points[t[2]]) / 3.0; };
    const Vec3 edge = normalized(surface_.points[common[1]] - surface_.points[common[0]]), across = centre(b) - centre(a);
    return std::atan2(std::abs(dot(across, edge)), norm(across - dot(across, edge) * edge));
  }

 private:
  void find_distances(const LayerBlock& layers, std::size_t n_cells) {
    const RunContext context({.threads = 2});
    const volmesh::LayerBase base(surface_, context);
    volmesh::EnvelopeOptions options;
    options.feature_angle = volmesh::feature_angle_of(base, options, context);
    const volmesh::Classification classes = volmesh::classify_vertices(base, options, context);
    std::vector<std::vector<std::size_t>> neighbours(n_cells);
    for (std::size_t face = 0; face < neighbour_.size(); ++face) {
      neighbours[owner_[face]].push_back(neighbour_[face]);
      neighbours[neighbour_[face]].push_back(owner_[face]);
    }
    distance_.assign(n_cells, k_far);
    std::vector<std::size_t> front;
    for (std::size_t cell = 0; cell < column_of_.size(); ++cell)
      if (std::ranges::any_of(layers.base[column_of_[cell]], [&](std::uint32_t line) { return !classes.vertex[VertexId(line)].is_smooth(); }))
        front.push_back(cell);
    for (const std::size_t cell : front) distance_[cell] = 0;
    for (std::size_t steps = 1; !front.empty(); ++steps) {
      std::vector<std::size_t> next;
      for (const std::size_t cell : front)
        for (const std::size_t other : neighbours[cell])
          if (distance_[other] == k_far) {
            distance_[other] = steps;
            next.push_back(other);
          }
      front.swap(next);
    }
  }

  const TriMesh& surface_;
  std::vector<std::size_t> owner_, neighbour_, column_of_, distance_;
};

/// Two cells from a ridge, where growth lines change direction.
constexpr std::size_t k_near = 2;

/// A wing from its STL file to OpenFOAM. Its triangles are up to 30 times longer than wide: at 72 % of the wall's edges, the line between centres is more than
/// 70 degrees off the edge's normal, and straight prisms on them have that angle in every layer. Beyond two cells from a ridge the layer contributes no further
/// faces; tetrahedra contribute a few.
TEST(FoamRealMesh, CheckMeshPassesExceptRidgesAndForcedFaces) {
  STERNA_NEEDS_SHARED_DATA();
  const auto folder = test::scratch();
  const std::string script = "local wall = read_surface{ \"" + (test::shared_data() / "surfaces" / "clean" / "caturbs_wing_wing.stl").string() +
                             "\", split_angle = 60*deg }\n"
                             "local mesh = volume_mesh{ wall, layers = 6, first_height = 1e-4 * wall.length, farfield = sphere{ radius = 20 * wall.length }, "
                             "stages = \"case.sterna\" }\n"
                             "mesh:write{ \"case.bin.foam\", \"text.foam\", numbering = \"lines\" }\n";  // tetrahedra are identified by their numbers
  std::ofstream(folder / "case.lua") << script;
  test::make_foam_case(folder / "case.bin.foam");
  test::make_foam_case(folder / "text.foam");
  STERNA_NEEDS(test::run_openfoam("checkMesh", {"-help"}, folder), "the Debian package openfoam");
  const test::ProcessResult run = test::run_process(test::sterna_program(), {"--quiet", "run", "case.lua"}, folder);
  ASSERT_EQ(run.status, 0) << run.output << run.errors;
  const auto binary = test::run_openfoam("checkMesh", {"-case", "case.bin.foam", "-allTopology", "-allGeometry"}, folder);
  STERNA_NEEDS(binary, "the Debian package openfoam");
  EXPECT_GT(test::number_after(*binary, "prisms:"), 4000.0);
  // The aspect ratio limit is 1000, and wide triangles under thin first cells approach it. Quality depends on the mesh; `sterna check` measures it.
  const std::vector<std::string> allowed = {"aspect ratio",         "skewness",    "face tets", "small determinant", "Concave cells",
                                            "interpolation weight", "volume ratio"};
  test::expect_clean(*binary, allowed);
  const auto output = test::run_openfoam("checkMesh", {"-case", "text.foam", "-allTopology", "-allGeometry", "-writeSets", "vtk"}, folder);
  STERNA_NEEDS(output, "the Debian package openfoam");
  test::expect_clean(*output, allowed);

  const SternaContent content = read_sterna(folder / "case.sterna", RunContext({.threads = 2}));
  ASSERT_TRUE(content.surface && content.mesh);
  const auto poly = folder / "text.foam" / "constant" / "polyMesh";
  const CellPlaces locations(content, poly);
  for (const std::size_t face : test::read_labels(poly / "sets" / "skewFaces"))
    EXPECT_LE(locations.distance_of(face), k_near) << "skewness above 4 at face " << face;

  const std::vector<std::size_t> steep = test::read_labels(poly / "sets" / "nonOrthoFaces");
  EXPECT_EQ(static_cast<double>(steep.size()), test::number_after(*output, "non-orthogonal (> 70 degrees) faces:"));
  constexpr double k_limit = 70.0 * std::numbers::pi / 180.0;
  constexpr double k_share_of_tetrahedra = 0.03;  // 1.6 % here: Delaunay tetrahedra guarantee no such angle
  std::size_t n_between_tetrahedra = 0, n_by_wall = 0, n_at_ridges = 0;
  for (const std::size_t face : steep) {
    ASSERT_TRUE(locations.is_inner(face));
    if (!locations.is_of_layer(locations.owner(face)) || !locations.is_of_layer(locations.neighbour(face))) {
      ++n_between_tetrahedra;
      continue;
    }
    if (locations.distance_of(face) <= k_near) {
      ++n_at_ridges;
      continue;
    }
    ++n_by_wall;
    EXPECT_TRUE(locations.is_side(face) && locations.angle_on_wall(face) > k_limit)
        << "face " << face << ": the layer is steep away from ridges where the wall is not";
  }
  EXPECT_LT(static_cast<double>(n_between_tetrahedra), k_share_of_tetrahedra * static_cast<double>(locations.n_inner()));
  RecordProperty("steep_at_ridges", static_cast<int>(n_at_ridges));
  RecordProperty("steep_by_wall", static_cast<int>(n_by_wall));
  RecordProperty("steep_between_tetrahedra", static_cast<int>(n_between_tetrahedra));
}

}  // namespace
}  // namespace sterna::io
