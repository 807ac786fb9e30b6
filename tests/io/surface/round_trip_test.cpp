// A real surface with six patches through every format that writes surfaces, through every pair of them, and into independent readers.
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "io/file/format_table.h"
#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::io {
namespace {

using test::scratch;

/// Precision of coordinates in a format, relative to the largest coordinate.
double precision_of(const Format& format, std::size_t n_patches = 6) {
  if (format.name == "STL binary" || (format.name == "STL" && n_patches == 1) || format.name == "Cart3D binary") return 1.2e-7;  // 2^-23: a float
  if (format.name == "Nastran") return 1e-9;  // 16 characters, of which at least 10 are digits
  return 0.0;
}

/// Returns the name of patch i in formats that store patch numbers only.
std::string numbered(std::size_t i) { return "patch_" + std::to_string(i + 1); }

/// Returns a glider of 1500 triangles, split into patches by location.
TriMesh glider() {
  TriMesh mesh = to_tri_mesh(test::read_surface(test::shared_data() / "surfaces" / "clean" / "meshpy_ka6d_ka-6d.ply"));
  mesh.patches = {{"left wing"},
                  {"right_wing"},
                  {"Rumpf-\xC3\xBC"
                   "bergang"},
                  {"tail", PatchKind::slip},
                  {"symmetry", PatchKind::symmetry},
                  {"a,b(c)"}};
  const Box box = bounding_box(mesh);
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto p = corners(mesh, t);
    const Vec3 c = (p[0] + p[1] + p[2]) / 3.0 - box.center();
    const Vec3 size = box.max - box.min;
    const int along = c.x < -size.x / 6 ? 0 : c.x < size.x / 6 ? 1 : 2;
    mesh.triangle_patch[t] = PatchId(2 * along + (c.y < 0.0 ? 1 : 0));
  }
  for (const PatchId patch : mesh.patches.ids()) EXPECT_GT(std::count(mesh.triangle_patch.begin(), mesh.triangle_patch.end(), patch), 0);
  return mesh;
}

std::string first_extension(const Format& format) { return std::string(format.extensions.substr(0, format.extensions.find(' '))); }

/// Writes the mesh and reads it back; collects the warnings of both steps.
TriMesh through(const TriMesh& mesh, const Format& format, const std::filesystem::path& stem, std::vector<std::string>* log = nullptr) {
  const std::filesystem::path path = stem.string() + first_extension(format);
  const RunContext context({.threads = 2, .log = [log](LogLevel level, std::string_view text) {
                              if (log && level == LogLevel::warning) log->emplace_back(text);
                            }});
  write_surface_file(mesh, path, context, format.name);
  return to_tri_mesh(test::read_surface(path, log));
}

using Row = std::array<std::size_t, 4>;

/// Returns the triangles in sorted order, each starting with its smallest vertex, with its patch.
std::vector<Row> sorted_rows(const TriMesh& mesh, const std::vector<std::size_t>& vertex, const std::vector<std::size_t>& patch) {
  std::vector<Row> rows;
  for (const TriangleId t : mesh.triangles.ids()) {
    std::array<std::size_t, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = vertex[mesh.triangles[t][k].index()];
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    rows.push_back({v[0], v[1], v[2], patch[mesh.triangle_patch[t].index()]});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<std::size_t> identity(std::size_t n) {
  std::vector<std::size_t> map(n);
  for (std::size_t i = 0; i < n; ++i) map[i] = i;
  return map;
}

/// Returns for each vertex of `back` the vertex of `mesh` at its location, or with its number if the format keeps vertices.
std::vector<std::size_t> match_vertices(const TriMesh& mesh, const TriMesh& back, double tolerance, bool keeps_vertices) {
  if (keeps_vertices) {
    for (std::size_t i = 0; i < mesh.n_vertices(); ++i) EXPECT_LE(distance(mesh.points.raw()[i], back.points.raw()[i]), tolerance);
    return identity(mesh.n_vertices());
  }
  std::vector<std::size_t> map;
  for (const Point& p : back.points) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < mesh.n_vertices(); ++i)
      if (distance(p, mesh.points.raw()[i]) < distance(p, mesh.points.raw()[nearest])) nearest = i;
    EXPECT_LE(distance(p, mesh.points.raw()[nearest]), tolerance);
    map.push_back(nearest);
  }
  return map;
}

TEST(SurfaceRoundTrip, EveryWriterKeepsConnectivityCoordinatesAndNames) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh mesh = glider();
  const double size = bounding_box(mesh).longest_side();
  for (const Format& format : formats()) {
    if (!format.write_surface) continue;
    SCOPED_TRACE(format.name);
    std::vector<std::string> log;
    const TriMesh back = through(mesh, format, scratch() / "glider", &log);
    ASSERT_EQ(back.n_triangles(), mesh.n_triangles());
    ASSERT_EQ(back.n_vertices(), mesh.n_vertices());
    const bool is_stl = format.name.starts_with("STL");
    const std::vector<std::size_t> vertex = match_vertices(mesh, back, precision_of(format) * size, !is_stl);
    // Names are kept, or the log reports the new names.
    std::vector<std::size_t> patch_of_back;
    for (const Patch& patch : back.patches) {
      std::size_t found = mesh.patches.size();
      for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        const bool is_reported = std::any_of(log.begin(), log.end(), [&](const std::string& line) {
          return line.find("\"" + mesh.patches.raw()[i].name + "\"") != std::string::npos &&
                 (patch.name == numbered(i) || line.find("\"" + patch.name + "\"") != std::string::npos);
        });
        if (patch.name == mesh.patches.raw()[i].name || (is_reported && found == mesh.patches.size())) found = i;
      }
      patch_of_back.push_back(found);
    }
    const bool has_patches = back.patches.size() == mesh.patches.size();
    if (!has_patches) {
      EXPECT_EQ(back.patches.size(), 1u);
      EXPECT_FALSE(log.empty()) << "lost patches are told";
      EXPECT_EQ(sorted_rows(back, vertex, {0}), sorted_rows(mesh, identity(mesh.n_vertices()), std::vector<std::size_t>(mesh.patches.size(), 0)));
      continue;
    }
    EXPECT_EQ(sorted_rows(back, vertex, patch_of_back), sorted_rows(mesh, identity(mesh.n_vertices()), identity(mesh.patches.size())));
  }
}

TEST(SurfaceRoundTrip, EveryPairKeepsTriangles) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh mesh = glider();
  const double size = bounding_box(mesh).longest_side();
  const std::filesystem::path folder = scratch();
  for (const Format& first : formats()) {
    if (!first.write_surface) continue;
    const TriMesh once = through(mesh, first, folder / "once");
    for (const Format& second : formats()) {
      if (!second.write_surface) continue;
      SCOPED_TRACE(std::string(first.name) + " to " + std::string(second.name));
      const TriMesh twice = through(once, second, folder / "twice");
      ASSERT_EQ(twice.n_vertices(), mesh.n_vertices());
      ASSERT_EQ(twice.n_triangles(), mesh.n_triangles());
      double area = 0.0, area_once = 0.0;
      const auto area_of = [](const TriMesh& m, TriangleId t) {
        const auto p = corners(m, t);
        return norm(cross(p[1] - p[0], p[2] - p[0])) / 2.0;
      };
      for (const TriangleId t : mesh.triangles.ids()) {
        area += area_of(twice, t);
        area_once += area_of(once, t);
      }
      EXPECT_NEAR(area, area_once, (precision_of(second, once.patches.size()) + 1e-12) * size * size);  // 1e-12: sums in a different order
      EXPECT_EQ(twice.patches.size(), second.carries_patch_names ? once.patches.size() : 1u);
    }
  }
}

TEST(SurfaceRoundTrip, BytesDoNotDependOnThreads) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh mesh = to_tri_mesh(test::read_surface(test::shared_data() / "surfaces" / "clean" / "pmp_fandisk.off"));  // at least three chunks
  for (const Format& format : formats()) {
    if (!format.write_surface) continue;
    SCOPED_TRACE(format.name);
    std::string bytes;
    for (const int threads : {1, 2, 7}) {
      const std::filesystem::path path = scratch() / ("fandisk" + first_extension(format));
      write_surface_file(mesh, path, RunContext({.threads = threads}), format.name);
      const std::string now = test::bytes_of(path);
      EXPECT_TRUE(bytes.empty() || now == bytes) << threads << " threads";
      bytes = now;
    }
  }
}

TEST(SurfaceRoundTrip, EmptySurfaceIsWritten) {
  for (const Format& format : formats()) {
    if (!format.write_surface) continue;
    SCOPED_TRACE(format.name);
    write_surface_file({}, scratch() / ("empty" + first_extension(format)), RunContext({.threads = 1}), format.name);
  }
}

TEST(SurfaceRoundTrip, UnwritableSurfaceIsRefusedAndOldFileStays) {
  TriMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{VertexId(0), VertexId(1), VertexId(2)}};
  mesh.triangle_patch = {PatchId(0)};
  mesh.patches = {{"a"}};
  const std::filesystem::path folder = scratch();
  const auto refused = [&](const std::string& name, ErrorCode code, std::string_view format = {}) {
    test::write_bytes(folder / name, "old");
    try {
      write_surface_file(mesh, folder / name, RunContext({.threads = 1}), format);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
    }
    EXPECT_EQ(test::bytes_of(folder / name), "old");
  };
  mesh.points.raw()[0].x = 1e39;
  refused("a.stl", ErrorCode::overflow);
  refused("a.bin.tri", ErrorCode::overflow);
  mesh.points.raw()[0].x = std::nan("");
  refused("a.obj", ErrorCode::mesh_invalid);
  mesh.points.raw()[0].x = 0.0;
  mesh.triangle_patch = {PatchId(1)};
  refused("a.ply", ErrorCode::mesh_invalid);
  mesh.triangle_patch = {PatchId(0)};
  refused("a.zml", ErrorCode::unsupported_format);
}

// ---- independent readers

/// Returns the "key value" lines of tests/tools/verify_surface.py; empty if the Python module is missing.
std::map<std::string, std::string> verify(const std::string& reader, const std::filesystem::path& file) {
  const std::string command =
      "/usr/bin/python3 '" + test::source_folder().string() + "/tests/tools/verify_surface.py' " + reader + " '" + file.string() + "' 2>&1";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  std::string output;
  char piece[4096];
  for (std::size_t n = std::fread(piece, 1, sizeof piece, pipe); n > 0; n = std::fread(piece, 1, sizeof piece, pipe)) output.append(piece, n);
  const int status = ::pclose(pipe);
  constexpr int k_module_missing = 77;
  if (WIFEXITED(status) && WEXITSTATUS(status) == k_module_missing) return {};
  EXPECT_EQ(status, 0) << command << "\n" << output;
  std::map<std::string, std::string> values;
  std::istringstream lines(output);
  for (std::string key, value; lines >> key && std::getline(lines, value);) values[key] = value;
  return values;
}

struct Independent {
  const char* reader;
  const char* format;
  const char* extension;
  bool has_markers;
};

void PrintTo(const Independent& independent, std::ostream* out) { *out << independent.reader << " " << independent.format; }

class SurfaceReaders : public ::testing::TestWithParam<Independent> {};

TEST_P(SurfaceReaders, Agree) {
  STERNA_NEEDS_SHARED_DATA();
  const Independent& independent = GetParam();
  const TriMesh mesh = glider();
  const std::filesystem::path path = scratch() / (std::string("glider") + independent.extension);
  write_surface_file(mesh, path, RunContext({.threads = 2}), independent.format);
  auto values = verify(independent.reader, path);
  STERNA_NEEDS(!values.empty(), "the Python module of " << independent.reader);
  double volume = 0.0, area = 0.0;
  std::map<std::size_t, int> n_by_patch;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto p = corners(mesh, t);
    volume += dot(p[0], cross(p[1], p[2])) / 6.0;
    area += norm(cross(p[1] - p[0], p[2] - p[0])) / 2.0;
    ++n_by_patch[mesh.triangle_patch[t].index() + 1];
  }
  EXPECT_EQ(std::stoul(values["triangles"]), mesh.n_triangles());
  const double tolerance = 1e-6;  // VTK stores points of some formats in single precision
  EXPECT_NEAR(std::stod(values["area"]), area, tolerance * area);
  EXPECT_NEAR(std::stod(values["enclosed"]), volume, 1e3 * tolerance * std::abs(volume));  // a thin body away from the origin: cancellation
  std::vector<int> expected, found;
  for (const auto& [patch, n] : n_by_patch) expected.push_back(n);
  for (const auto& [key, value] : values)
    if (key.starts_with("marker.")) found.push_back(std::stoi(value));
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, independent.has_markers ? expected : std::vector<int>());
}

// meshio cannot read SU2 files without elements; Gmsh 4.8 cannot read SU2, OFF or VTK 5.1.
INSTANTIATE_TEST_SUITE_P(Independent, SurfaceReaders,
                         ::testing::Values(Independent{"meshio", "STL text", ".stl", false}, Independent{"meshio", "STL binary", ".stl", false},
                                           Independent{"meshio", "OFF", ".off", false}, Independent{"meshio", "OBJ", ".obj", false},
                                           Independent{"meshio", "Gmsh MSH", ".msh", true}, Independent{"meshio", "Gmsh MSH 2.2", ".msh", true},
                                           Independent{"meshio", "VTU", ".vtu", true}, Independent{"meshio", "Nastran", ".nas", true},
                                           Independent{"gmsh", "STL text", ".stl", true}, Independent{"gmsh", "STL binary", ".stl", false},
                                           Independent{"gmsh", "Gmsh MSH", ".msh", true}, Independent{"gmsh", "Gmsh MSH 2.2", ".msh", true},
                                           Independent{"gmsh", "Medit", ".mesh", true}, Independent{"gmsh", "Nastran", ".bdf", true},
                                           Independent{"vtk", "STL text", ".stl", true}, Independent{"vtk", "STL binary", ".stl", false},
                                           Independent{"vtk", "OBJ", ".obj", false}, Independent{"vtk", "PLY", ".ply", false},
                                           Independent{"vtk", "VTK", ".vtk", true}, Independent{"vtk", "VTK text", ".vtk", true},
                                           Independent{"vtk", "VTP", ".vtp", true}, Independent{"vtk", "VTU", ".vtu", true}));

}  // namespace
}  // namespace sterna::io
