#include "io/volume/sterna_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cstring>
#include <fstream>

#include "geom/base/hash.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/sanitizers.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna::io {
namespace {

using test::k_context;

/// Parts with content in every array.
struct Everything {
  TriMesh surface = test::cube(3);
  StoredEnvelope envelope;
  StoredTetrahedra tetrahedra;
  HybridMesh mesh = test::six_patch_mesh(
      " \xC3\xBC"
      "ber");

  Everything() {
    surface.patches.push_back({"lid", PatchKind::slip});
    surface.triangle_patch[TriangleId(5)] = PatchId(1);
    const std::size_t n = surface.n_vertices();
    for (std::size_t i = 0; i < n; ++i) {
      const double x = static_cast<double>(i) / 3.0;
      envelope.direction.push_back({x, -x, 0.1 * x});
      envelope.height.push_back(x * x);
      envelope.target.push_back(x + 1.0);
      envelope.eq1.push_back(x + 2.0);
      envelope.cap.push_back(x + 3.0);
      envelope.limit.push_back(static_cast<std::uint8_t>(i % 8));
    }
    tetrahedra.n_boundary_points = n;
    tetrahedra.new_points = {{0.1, 0.2, 0.3}, {1e-300, -1e300, -0.0}};
    tetrahedra.tetrahedra = {{0, 1, 2, static_cast<std::uint32_t>(n)}, {3, 2, 1, static_cast<std::uint32_t>(n + 1)}};
    mesh.request = {.first_height = 1e-6,
                    .max_growth = 1.2,
                    .target_height = std::vector<double>(mesh.layers.n_lines(), 0.01),
                    .reason = std::vector<std::uint8_t>(mesh.layers.n_lines(), 1),
                    .reasons = {"", "gap to wing"}};
  }

  SternaParts parts() const {
    return {.surface = &surface,
            .envelope = &envelope,
            .tetrahedra = &tetrahedra,
            .mesh = &mesh,
            .manifest = "{\"layers\": 4}",
            .certificate = "{}",
            .quality = "{\"worst\": 0.5}"};
  }
};

void expect_same(const HybridMesh& back, const HybridMesh& mesh) {
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.layers.n_layers, mesh.layers.n_layers);
  EXPECT_EQ(back.layers.line_layers, mesh.layers.line_layers);
  EXPECT_EQ(back.layers.base, mesh.layers.base);
  EXPECT_EQ(back.layers.first_node, mesh.layers.first_node);
  EXPECT_EQ(back.layers.is_collapsed, mesh.layers.is_collapsed);
  EXPECT_EQ(back.request.first_height, mesh.request.first_height);
  EXPECT_EQ(back.request.line_first_height, mesh.request.line_first_height);
  EXPECT_EQ(back.request.line_max_growth, mesh.request.line_max_growth);
  EXPECT_EQ(back.request.line_layers, mesh.request.line_layers);
  EXPECT_EQ(back.request.target_height, mesh.request.target_height);
  EXPECT_EQ(back.request.reason, mesh.request.reason);
  EXPECT_EQ(back.request.reasons, mesh.request.reasons);
  EXPECT_EQ(back.patches, mesh.patches);
  test::expect_same_after_reading(explicit_cells(back), mesh, test::CellOrder::same);
}

TEST(Sterna, EverythingComesBackToTheBit) {
  const auto path = test::scratch() / "run.sterna";
  const Everything all;
  write_sterna(all.parts(), path, k_context);
  const SternaContent back = read_sterna(path, k_context);
  EXPECT_EQ(back.names(), "surface, envelope, tetrahedra, mesh, manifest, certificate, quality");
  ASSERT_TRUE(back.surface && back.envelope && back.tetrahedra && back.mesh);
  EXPECT_EQ(back.surface->points, all.surface.points);
  EXPECT_EQ(back.surface->triangles, all.surface.triangles);
  EXPECT_EQ(back.surface->triangle_patch, all.surface.triangle_patch);
  EXPECT_EQ(back.surface->patches, all.surface.patches);
  EXPECT_EQ(back.envelope->direction, all.envelope.direction);
  EXPECT_EQ(back.envelope->height, all.envelope.height);
  EXPECT_EQ(back.envelope->target, all.envelope.target);
  EXPECT_EQ(back.envelope->eq1, all.envelope.eq1);
  EXPECT_EQ(back.envelope->cap, all.envelope.cap);
  EXPECT_EQ(back.envelope->limit, all.envelope.limit);
  EXPECT_EQ(back.tetrahedra->n_boundary_points, all.tetrahedra.n_boundary_points);
  EXPECT_EQ(back.tetrahedra->new_points, all.tetrahedra.new_points);
  EXPECT_TRUE(std::signbit(back.tetrahedra->new_points[1].z));
  EXPECT_EQ(back.tetrahedra->tetrahedra, all.tetrahedra.tetrahedra);
  EXPECT_EQ(back.manifest, "{\"layers\": 4}");
  EXPECT_EQ(back.certificate, "{}");
  EXPECT_EQ(back.quality, "{\"worst\": 0.5}");
  expect_same(*back.mesh, all.mesh);
  for (const int threads : {1, 7}) {
    const std::string bytes = test::bytes_of(path);
    write_sterna(all.parts(), path, RunContext({.threads = threads}));
    EXPECT_EQ(test::bytes_of(path), bytes);
  }
}

TEST(Sterna, VerbsOfTheFormatTable) {
  const auto folder = test::scratch();
  for (const HybridMesh& mesh : {test::six_patch_mesh(), test::hexahedron_with_roof(), test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    write_volume_file(mesh, folder / "mesh.sterna", k_context);
    expect_same(read_volume_file(folder / "mesh.sterna", k_context), mesh);
    EXPECT_EQ(read_surface_file(folder / "mesh.sterna", k_context).triangles.size(), mesh.boundary_triangles.size() + 2 * mesh.boundary_quads.size());
  }
  const TriMesh cube = test::cube(2);
  write_surface_file(cube, folder / "cube.sterna", k_context);
  EXPECT_EQ(read_surface_file(folder / "cube.sterna", k_context).triangles.size(), cube.n_triangles());
  const HybridMesh boundary = read_volume_file(folder / "cube.sterna", k_context);  // like every volume format whose file holds only a surface
  EXPECT_EQ(boundary.boundary_triangles.size(), cube.n_triangles());
  EXPECT_EQ(boundary.tetrahedra.size() + boundary.prisms.size(), 0u);
  const Everything all;
  write_sterna({.surface = &all.surface, .envelope = &all.envelope}, folder / "envelope.sterna", k_context);
  test::expect_error(ErrorCode::file_malformed, "found surface, envelope, expected a mesh", [&] { read_volume_file(folder / "envelope.sterna", k_context); });
  write_sterna({}, folder / "empty.sterna", k_context);
  EXPECT_EQ(read_sterna(folder / "empty.sterna", k_context).names(), "nothing");
  test::expect_error(ErrorCode::file_malformed, "found nothing, expected a surface or a mesh", [&] { read_surface_file(folder / "empty.sterna", k_context); });
}

TEST(Sterna, VersionRisesOnlyWhereOldReadersFail) {
  const auto path = test::scratch() / "mesh.sterna";
  const auto version = [&] { return static_cast<int>(test::bytes_of(path)[16]); };
  write_sterna(Everything().parts(), path, k_context);
  EXPECT_EQ(version(), 1);
  HybridMesh mesh = test::two_shells(2, 3, 7, {.collapsed = {3, 50}});
  const std::size_t n = mesh.layers.n_lines();
  mesh.request = {
      .first_height = 1e-6, .max_growth = 1.3, .target_height = std::vector<double>(n, 0.01), .reason = std::vector<std::uint8_t>(n, 0), .reasons = {"none"}};
  for (std::size_t i = 0; i < n; ++i) {
    mesh.request.line_first_height.push_back(1e-6 * static_cast<double>(i + 1));
    mesh.request.line_max_growth.push_back(1.3 - 1e-4 * static_cast<double>(i));
  }
  write_sterna({.mesh = &mesh}, path, k_context);
  EXPECT_EQ(version(), 2);
  expect_same(*read_sterna(path, k_context).mesh, mesh);
  mesh.layers.line_layers[5] = 1;
  write_sterna({.mesh = &mesh}, path, k_context);
  test::expect_error(ErrorCode::file_malformed, "differ by more than one layer", [&] { read_sterna(path, k_context); });
  mesh.layers.line_layers[5] = 8;
  write_sterna({.mesh = &mesh}, path, k_context);
  test::expect_error(ErrorCode::file_malformed, "expected 1 to 7", [&] { read_sterna(path, k_context); });
  HybridMesh steps = test::stepped_sphere_shell(2);
  const std::size_t n_lines = steps.layers.n_lines();
  steps.request = {.first_height = 0.1,
                   .max_growth = 1.5,
                   .line_layers = std::vector<std::uint16_t>(n_lines, 3),
                   .target_height = std::vector<double>(n_lines, 0.4),
                   .reason = std::vector<std::uint8_t>(n_lines, 0),
                   .reasons = {"none"}};
  write_sterna({.mesh = &steps}, path, k_context);
  EXPECT_EQ(version(), 3);
  expect_same(*read_sterna(path, k_context).mesh, steps);
  write_sterna({.mesh = &steps, .opened = &mesh}, path, k_context);
  EXPECT_EQ(version(), 4);
}

TEST(Sterna, LayerOfOpenedWallIsStoredBesideMesh) {
  const auto path = test::scratch() / "run.sterna";
  const Everything all;
  const HybridMesh opened = test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}});
  SternaParts parts = all.parts();
  parts.opened = &opened;
  write_sterna(parts, path, k_context);
  const SternaContent back = read_sterna(path, k_context);
  EXPECT_EQ(back.names(), "surface, envelope, tetrahedra, mesh, opened layer, manifest, certificate, quality");
  ASSERT_TRUE(back.mesh && back.opened);
  expect_same(*back.mesh, all.mesh);
  expect_same(*back.opened, opened);
}

TEST(Sterna, DamageIsFound) {
  const auto path = test::scratch() / "run.sterna";
  write_sterna(Everything().parts(), path, k_context);
  const std::string bytes = test::bytes_of(path);
  const auto damaged = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    test::expect_error(ErrorCode::file_malformed, "byte", [&] { read_sterna(path, k_context); });
  };
  for (std::size_t n = 1; n < bytes.size(); n += 97) damaged(bytes.substr(0, n));
  damaged(bytes + "x");
  for (std::size_t n = 0; n < bytes.size(); n += 97) {
    if (n >= 16 && n < 20) continue;  // the version is tested below
    std::string text = bytes;
    text[n] = static_cast<char>(text[n] ^ 0x10);
    damaged(text);
  }
  std::string later = bytes;
  later[16] = 5;
  std::ofstream(path, std::ios::binary) << later;
  test::expect_error(ErrorCode::unsupported_format, "version 5 of the container", [&] { read_sterna(path, k_context); });
}

template <class T>
T number_at(const std::string& text, std::size_t at) {
  T value;
  std::memcpy(&value, text.data() + at, sizeof value);
  return value;
}
template <class T>
void put_at(std::string& text, std::size_t at, T value) {
  std::memcpy(text.data() + at, &value, sizeof value);
}

/// Returns the text with corrected hashes of directory and head, as in a deliberate attack.
std::string with_right_hashes(std::string text) {
  const auto location = number_at<std::uint64_t>(text, 24);
  put_at(text, 40, hash_bytes(std::string_view(text).substr(location)));
  put_at(text, 56, hash_bytes(std::string_view(text).substr(0, 56)));
  return text;
}

TEST(Sterna, DirectoriesThatLieAreRefused) {
  const auto path = test::scratch() / "run.sterna";
  write_sterna(Everything().parts(), path, k_context);
  const std::string bytes = test::bytes_of(path);
  const auto location = number_at<std::uint64_t>(bytes, 24);
  for (std::size_t at = location; at < bytes.size(); at += 3) {
    std::string text = bytes;
    text[at] = static_cast<char>(text[at] ^ (at % 2 == 0 ? 0x01 : 0x80));
    std::ofstream(path, std::ios::binary) << with_right_hashes(text);
    try {
      read_sterna(path, k_context);
    } catch (const Error& error) {
      EXPECT_EQ(to_string(error.code()), "file_malformed") << error.what();
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  if (!test::k_is_sanitized) EXPECT_LT(usage.ru_maxrss, 1 << 20) << "kB: no lie may cost memory";
}

TEST(Sterna, NumbersOutOfRangeAreRefused) {
  const auto path = test::scratch() / "run.sterna";
  const auto wrong = [&](const std::string& message, const auto& spoil) {
    SCOPED_TRACE(message);
    Everything all;
    spoil(all);
    write_sterna(all.parts(), path, k_context);
    test::expect_error(ErrorCode::file_malformed, message, [&] { read_sterna(path, k_context); });
  };
  wrong("\"mesh/tetrahedra\": value 0 is 99999", [](Everything& e) { e.mesh.tetrahedra[0][0] = NodeId(99999); });
  wrong("\"mesh/boundary_quads\": value", [](Everything& e) { e.mesh.boundary_quads[3].nodes[2] = NodeId(99999); });
  wrong("\"mesh/layers/base\": value 4 is 1000", [](Everything& e) { e.mesh.layers.base[1][1] = 1000; });
  wrong("ends at node", [](Everything& e) { e.mesh.layers.first_node[7] = 4000000000; });
  wrong("\"mesh/layers/n_layers\": found -1", [](Everything& e) { e.mesh.layers.n_layers = -1; });
  wrong("\"mesh/layers/is_collapsed\": value 2 is 7", [](Everything& e) { e.mesh.layers.is_collapsed[2] = 7; });
  wrong("\"mesh/request/target_height\": found 3 items", [](Everything& e) { e.mesh.request.target_height.resize(3); });
  wrong("\"mesh/request/reason\": value 0 is 9", [](Everything& e) { e.mesh.request.reason[0] = 9; });
  wrong("\"surface/triangles\": value 0", [](Everything& e) { e.surface.triangles[TriangleId(0)][0] = VertexId(12345); });
  wrong("\"envelope/height\": value 2 is not finite", [](Everything& e) { e.envelope.height[VertexId(2)] = std::numeric_limits<double>::quiet_NaN(); });
  wrong("\"tetrahedra/tetrahedra\": value 3", [](Everything& e) { e.tetrahedra.new_points.clear(); });
  Everything all;
  all.envelope.cap.clear();
  test::expect_error(ErrorCode::mesh_invalid, "values of an envelope", [&] { write_sterna(all.parts(), path, k_context); });
  all = Everything();
  all.mesh.points[NodeId(3)].z = std::numeric_limits<double>::infinity();
  test::expect_error(ErrorCode::mesh_invalid, "node 3 are not finite", [&] { write_sterna(all.parts(), path, k_context); });
  test::expect_error(ErrorCode::bad_argument, "without its surface", [&] { write_sterna({.envelope = &all.envelope}, path, k_context); });
}

TEST(Sterna, FullDiskLeavesTheOldFile) {
  const auto path = test::scratch() / "run.sterna";
  write_sterna({.manifest = "{}"}, path, k_context);
  const std::string bytes = test::bytes_of(path);
  {
    const test::FullDisk full(2000);
    test::expect_error(ErrorCode::write_failed, "", [&] { write_sterna(Everything().parts(), path, k_context); });
  }
  EXPECT_EQ(test::bytes_of(path), bytes);
  EXPECT_EQ(test::files_in(path.parent_path()), std::vector<std::string>{"run.sterna"});
}

}  // namespace
}  // namespace sterna::io
