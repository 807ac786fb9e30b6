#include "tests/io/volume/volume_tools.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "io/file/format_table.h"
#include "io/file/volume_file.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/process.h"
#include "tests/support/reader_checks.h"

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

/// Sums of about 1e5 terms in different orders: 1e-12 is a hundred times the rounding error.
constexpr double k_volume_tolerance = 1e-12;

}  // namespace

HybridMesh read(const std::filesystem::path& path) { return io::read_volume_file(path, RunContext({.threads = 2})); }
void write(const HybridMesh& mesh, const std::filesystem::path& path, int threads) { io::write_volume_file(mesh, path, RunContext({.threads = threads})); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

double IndependentReport::number(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? 0.0 : std::stod(found->second);
}

std::optional<IndependentReport> read_independently(const std::string& reader, const std::filesystem::path& file) {
  const std::string command =
      "/usr/bin/python3 '" + test::source_folder().string() + "/tests/tools/verify_mesh.py' " + reader + " '" + file.string() + "' 2>&1";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  IndependentReport report;
  char piece[4096];
  for (std::size_t n = std::fread(piece, 1, sizeof piece, pipe); n > 0; n = std::fread(piece, 1, sizeof piece, pipe)) report.output.append(piece, n);
  const int status = ::pclose(pipe);
  const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (exit_code == k_module_missing) return std::nullopt;
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
    EXPECT_EQ(low, box.min[axis]);  // exactly equal: coordinates survive the round trip
    EXPECT_EQ(high, box.max[axis]);
  }

  std::map<std::uint32_t, double> faces;
  for (const auto& face : mesh.boundary_triangles) faces[face.patch.value()] += 1;
  for (const auto& face : mesh.boundary_quads) faces[face.patch.value()] += 1;
  for (const auto& [patch, n] : faces) EXPECT_EQ(report.number("faces." + std::to_string(patch + 1)), n) << mesh.patches[PatchId(patch)].name;
}

std::vector<std::string> warnings_of_writing(const HybridMesh& mesh, const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  io::write_volume_file(mesh, path, RunContext({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                                                  if (level == LogLevel::warning) warnings.emplace_back(line);
                                                }}));
  return warnings;
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
  // A plate of 6 x 6 squares: vertex j * 7 + i. Growth line 0 is at a corner; 24, 25, 32 form one inner triangle.
  HybridMesh mesh = plate_block(6, {.n_layers = 4, .collapsed = {0, 24, 25, 32}});
  // Coordinates that need all digits.
  for (Point& p : mesh.points) p = {p.x / 3.0, p.y / 7.0, p.z / 11.0};
  return mesh;
}

HybridMesh mesh_of_six_patches() {
  HybridMesh mesh = mixed_mesh();
  const auto add = [&](const char* name, PatchKind kind) { return mesh.patches.push_back({name, kind}); };
  const PatchId symmetry = add("symmetry", PatchKind::symmetry), inflow = add("engine_intake", PatchKind::inflow),
                outflow = add("engine_exhaust", PatchKind::outflow);
  // The sides of the plate by location: y = 0 is the symmetry plane; x = 0 and the opposite side are inflow and outflow.
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  const auto lies_at = [&](std::span<const NodeId> nodes, std::size_t axis, double location) {
    return std::all_of(nodes.begin(), nodes.end(), [&](NodeId node) { return mesh.points[node][axis] == location; });
  };
  const auto assign = [&](auto& faces) {
    for (auto& face : faces) {
      if (lies_at(face.nodes, 2, box.min.z) || lies_at(face.nodes, 2, box.max.z)) continue;
      if (lies_at(face.nodes, 1, 0.0)) face.patch = symmetry;
      else if (lies_at(face.nodes, 0, 0.0)) face.patch = inflow;
      else if (lies_at(face.nodes, 0, box.max.x)) face.patch = outflow;
    }
  };
  assign(mesh.boundary_triangles);
  assign(mesh.boundary_quads);
  return mesh;
}

void expect_equal_meshes(const HybridMesh& back, const HybridMesh& mesh) {
  const HybridMesh expected = explicit_cells(mesh);
  EXPECT_EQ(back.points, expected.points);
  EXPECT_EQ(back.prisms, expected.prisms);
  EXPECT_EQ(back.pyramids, expected.pyramids);
  EXPECT_EQ(back.hexahedra, expected.hexahedra);
  EXPECT_EQ(back.tetrahedra, expected.tetrahedra);
  EXPECT_EQ(back.patches, expected.patches);
  const auto sorted = [](const auto& faces, const Column<PatchId, Patch>& patches) {
    std::map<std::string, std::vector<std::vector<NodeId>>> by_patch;
    for (const auto& face : faces) by_patch[patches[face.patch].name].emplace_back(face.nodes.begin(), face.nodes.end());
    return by_patch;
  };
  EXPECT_EQ(sorted(back.boundary_triangles, back.patches), sorted(mesh.boundary_triangles, mesh.patches));
  EXPECT_EQ(sorted(back.boundary_quads, back.patches), sorted(mesh.boundary_quads, mesh.patches));
  EXPECT_NEAR(enclosed_volume(back), volume_of(mesh), 1e-12 * volume_of(mesh));  // rounding of sums
}

std::optional<std::string> output_of_tool(const std::string& program, const std::vector<std::string>& arguments) {
  const std::filesystem::path path = std::filesystem::path("/usr/bin") / program;
  if (!std::filesystem::exists(path)) return std::nullopt;
  const ProcessResult result = run_process(path, arguments, std::filesystem::temp_directory_path());
  EXPECT_EQ(result.status, 0) << program << "\n" << result.output << result.errors;
  return result.output + result.errors;
}

void expect_survives_damage(const std::filesystem::path& victim, const std::string& name, std::size_t n_attempts) {
  // Files are written to memory if possible: there are some thousand of them.
  const std::filesystem::path folder = std::filesystem::is_directory("/dev/shm")
                                           ? std::filesystem::path("/dev/shm") / ("sterna_volume_test_" + std::to_string(::getpid()))
                                           : scratch() / "damaged";
  std::filesystem::create_directories(folder);
  const std::string bytes = bytes_of(victim);
  const std::string format(io::format_of(victim).name);
  const bool is_container = format == "CGNS" || format == "TAU" || format == "VTKHDF";
  int n_refused = 0;
  const auto attempt = [&](const std::string& damaged, const std::string& damage) {
    SCOPED_TRACE(victim.filename().string() + ", " + damage);
    std::ofstream(folder / name, std::ios::binary) << damaged;
    try {
      EXPECT_EQ(flaw_of(io::read_volume_file(folder / name, RunContext({.threads = 1}))), "");
    } catch (const Error& error) {
      ++n_refused;
      EXPECT_TRUE(error.code() != ErrorCode::file_malformed || says_where(error, is_container)) << error.what();
      EXPECT_TRUE(error.code() == ErrorCode::file_malformed || error.code() == ErrorCode::unsupported_format) << error.what();
    }
  };
  const std::size_t step = std::max<std::size_t>(1, bytes.size() / n_attempts),
                    step_of_changes = std::max<std::size_t>(1 + step / 8, bytes.size() / (4 * n_attempts));
  for (std::size_t n = 0; n < bytes.size(); n += step) attempt(bytes.substr(0, n), "cut to " + std::to_string(n) + " bytes");
  EXPECT_GT(n_refused, 0);
  constexpr std::string_view k_changes = "\x01\x80\xff\x10\x55";
  std::size_t n = 0;
  for (std::size_t i = 0; i < bytes.size(); i += step_of_changes) {
    if (bytes[i] == ' ') continue;  // mostly padding
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ k_changes[n++ % k_changes.size()]);
    attempt(damaged, "byte " + std::to_string(i) + " changed");
  }
  std::error_code ignored;  // a few kB may remain in memory; this is not a test failure
  std::filesystem::remove_all(folder, ignored);
}

}  // namespace sterna::test
