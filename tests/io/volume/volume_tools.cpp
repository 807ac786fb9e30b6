#include "tests/io/volume/volume_tools.h"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::test {
namespace {

constexpr int k_module_missing = 77;

double fan_flux(const HybridMesh& mesh, std::span<const NodeId> face, const Point& origin) {
  Vec3 centre;
  for (const NodeId node : face) centre += (1.0 / static_cast<double>(face.size())) * (mesh.points[node] - origin);
  double flux = 0.0;
  for (std::size_t i = 0; i < face.size(); ++i)
    flux += dot(cross(mesh.points[face[i]] - origin, mesh.points[face[(i + 1) % face.size()]] - origin), centre) / 6.0;
  return flux;
}

double cell_volume(const HybridMesh& mesh, const Cell& cell) {
  double volume = 0.0;
  for (const LocalFace& face : cell_faces(cell.kind)) {
    std::array<NodeId, 4> nodes;
    for (std::size_t i = 0; i < face.size; ++i) nodes[i] = cell.nodes[face.nodes[i]];
    volume += fan_flux(mesh, {nodes.data(), face.size}, mesh.points[cell.nodes[0]]);
  }
  return volume;
}

/// Sums of some 1e5 terms, in other orders than ours: 1e-12 is a hundred times what rounding leaves.
constexpr double k_volume_tolerance = 1e-12;

}  // namespace

double IndependentReport::number(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? 0.0 : std::stod(found->second);
}

std::optional<IndependentReport> read_independently(const std::string& reader, const std::filesystem::path& file) {
  const std::string command = "/usr/bin/python3 '" STERNA_SOURCE_DIR "/tests/tools/verify_mesh.py' " + reader + " '" + file.string() + "' 2>&1";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  IndependentReport report;
  char piece[4096];
  for (std::size_t n = std::fread(piece, 1, sizeof piece, pipe); n > 0; n = std::fread(piece, 1, sizeof piece, pipe)) report.output.append(piece, n);
  const int status = ::pclose(pipe);
  const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  const char* const required = std::getenv("STERNA_REQUIRE_DATA");
  if (exit_code == k_module_missing) {
    if (required && std::string(required) == "1") ADD_FAILURE() << "STERNA_REQUIRE_DATA=1, but " << report.output;
    return std::nullopt;
  }
  EXPECT_EQ(exit_code, 0) << command << "\n" << report.output;
  std::istringstream lines(report.output);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = line.find(' ');
    if (blank != std::string::npos) report.values[line.substr(0, blank)] = line.substr(blank + 1);
  }
  return report;
}

void expect_same_mesh(const IndependentReport& report, const HybridMesh& mesh) {
  EXPECT_EQ(report.number("points"), static_cast<double>(mesh.points.size()));
  const CellCounts counts = count_cells(mesh);
  EXPECT_EQ(report.number("cells.tetra"), static_cast<double>(counts.tetrahedra));
  EXPECT_EQ(report.number("cells.pyramid"), static_cast<double>(counts.pyramids));
  EXPECT_EQ(report.number("cells.wedge"), static_cast<double>(counts.prisms));
  EXPECT_EQ(report.number("cells.hexahedron"), static_cast<double>(counts.hexahedra));
  EXPECT_EQ(report.number("cells.triangle"), static_cast<double>(mesh.boundary_triangles.size()));
  EXPECT_EQ(report.number("cells.quad"), static_cast<double>(mesh.boundary_quads.size()));

  std::array<double, 4> volumes{};
  for_each_cell(mesh, [&](const Cell& cell) { volumes[static_cast<std::size_t>(cell.kind)] += cell_volume(mesh, cell); });
  const double total = volume_of(mesh);
  const auto volume = [&](CellKind kind) { return volumes[static_cast<std::size_t>(kind)]; };
  EXPECT_NEAR(report.number("volume.tetra"), volume(CellKind::tetrahedron), k_volume_tolerance * total);
  EXPECT_NEAR(report.number("volume.pyramid"), volume(CellKind::pyramid), k_volume_tolerance * total);
  EXPECT_NEAR(report.number("volume.wedge"), volume(CellKind::prism), k_volume_tolerance * total);
  EXPECT_NEAR(report.number("volume.hexahedron"), volume(CellKind::hexahedron), k_volume_tolerance * total);
  EXPECT_NEAR(report.number("enclosed"), total, k_volume_tolerance * total);

  Box box;
  for (const Point& p : mesh.points) box.add(p);
  std::istringstream bounds(report.values.count("bounds") ? report.values.at("bounds") : "");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = NAN, high = NAN;
    bounds >> low >> high;
    EXPECT_EQ(low, box.min[axis]);  // to the bit: coordinates survive the round trip
    EXPECT_EQ(high, box.max[axis]);
  }

  std::map<std::uint32_t, double> faces;
  for (const auto& face : mesh.boundary_triangles) faces[face.patch.value()] += 1;
  for (const auto& face : mesh.boundary_quads) faces[face.patch.value()] += 1;
  for (const auto& [patch, n] : faces) EXPECT_EQ(report.number("faces." + std::to_string(patch + 1)), n) << mesh.patches[PatchId(patch)].name;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::filesystem::path write_text(const std::string& name, const std::string& text) {
  const std::filesystem::path path = scratch() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

double volume_of(const HybridMesh& mesh) {
  double volume = 0.0;
  for_each_cell(mesh, [&](const Cell& cell) { volume += cell_volume(mesh, cell); });
  return volume;
}

double enclosed_volume(const HybridMesh& mesh) {
  double volume = 0.0;
  for (const auto& face : mesh.boundary_triangles) volume += fan_flux(mesh, face.nodes, {});
  for (const auto& face : mesh.boundary_quads) volume += fan_flux(mesh, face.nodes, {});
  return volume;
}

HybridMesh mixed_mesh() {
  // A plate of 6 x 6 squares: vertex j * 7 + i. Line 0 is a corner; 24, 25, 32 are one triangle inside.
  HybridMesh mesh = plate_block(6, {.n_layers = 4, .collapsed = {0, 24, 25, 32}});
  // Coordinates that are no short decimals.
  for (Point& p : mesh.points) p = {p.x / 3.0, p.y / 7.0, p.z / 11.0};
  return mesh;
}

}  // namespace sterna::test
