#include "tests/io/volume/round_trip.h"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>

#include "io/file/volume_file.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_foam.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/reader_checks.h"

namespace sterna::test {
namespace {

struct NamedFace {
  std::string patch;
  PatchKind kind;
  std::vector<NodeId> nodes;  ///< starting at the lowest node
  auto operator<=>(const NamedFace&) const = default;
};

template <class Face>
void add_faces(const HybridMesh& mesh, const std::vector<Face>& faces, std::vector<NamedFace>& result) {
  for (const Face& face : faces) {
    std::vector<NodeId> nodes(face.nodes.begin(), face.nodes.end());
    std::rotate(nodes.begin(), std::min_element(nodes.begin(), nodes.end()), nodes.end());
    result.push_back({mesh.patches[face.patch].name, mesh.patches[face.patch].kind, nodes});
  }
}

std::vector<NamedFace> named_faces(const HybridMesh& mesh) {
  std::vector<NamedFace> result;
  add_faces(mesh, mesh.boundary_triangles, result);
  add_faces(mesh, mesh.boundary_quads, result);
  std::sort(result.begin(), result.end());
  return result;
}

/// Returns the sorted faces of a cell, each starting at its lowest node: the same for all numberings of the cell's nodes.
template <std::size_t N>
std::vector<std::vector<NodeId>> outward_faces(CellKind kind, const std::array<NodeId, N>& cell) {
  std::vector<std::vector<NodeId>> result;
  for (const LocalFace& local : cell_faces(kind)) {
    std::vector<NodeId> nodes;
    for (std::size_t k = 0; k < local.size; ++k) nodes.push_back(cell[local.nodes[k]]);
    std::rotate(nodes.begin(), std::min_element(nodes.begin(), nodes.end()), nodes.end());
    result.push_back(nodes);
  }
  std::sort(result.begin(), result.end());
  return result;
}

template <std::size_t N>
void expect_same_cells(CellKind kind, const std::vector<std::array<NodeId, N>>& back, const std::vector<std::array<NodeId, N>>& cells, CellOrder order) {
  if (order == CellOrder::same) {
    EXPECT_EQ(back, cells) << to_string(kind);
    return;
  }
  ASSERT_EQ(back.size(), cells.size()) << to_string(kind);
  for (std::size_t i = 0; i < cells.size(); ++i) ASSERT_EQ(outward_faces(kind, back[i]), outward_faces(kind, cells[i])) << to_string(kind) << " " << i;
}

}  // namespace

HybridMesh six_patch_mesh(const std::string& suffix) {
  HybridMesh mesh = mixed_mesh();
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  std::vector<PatchId> sides;
  const std::pair<const char*, PatchKind> kinds[] = {
      {"west", PatchKind::outflow}, {"east", PatchKind::inflow}, {"symmetry", PatchKind::symmetry}, {"slip_north", PatchKind::slip}};
  PatchId side;
  for (const PatchId patch : mesh.patches.ids()) {
    if (mesh.patches[patch].name == "side") side = patch;
    mesh.patches[patch].name += suffix;
  }
  for (const auto& [name, kind] : kinds) {
    if (sides.empty()) {
      mesh.patches[side] = {name + suffix, kind};
      sides.push_back(side);
    } else {
      sides.push_back(mesh.patches.push_back({name + suffix, kind}));
    }
  }
  const auto assign = [&](auto& face) {
    if (face.patch != side) return;
    const auto all = [&](auto is_on) { return std::all_of(face.nodes.begin(), face.nodes.end(), [&](NodeId node) { return is_on(mesh.points[node]); }); };
    if (all([&](const Point& p) { return p.x == box.max.x; })) face.patch = sides[1];
    else if (all([&](const Point& p) { return p.y == box.min.y; })) face.patch = sides[2];
    else if (all([&](const Point& p) { return p.y == box.max.y; })) face.patch = sides[3];
  };
  for (auto& face : mesh.boundary_triangles) assign(face);
  for (auto& face : mesh.boundary_quads) assign(face);
  return mesh;
}

void expect_same_after_reading(const HybridMesh& back, const HybridMesh& mesh, CellOrder order, Kinds kinds) {
  const HybridMesh expected = explicit_cells(mesh);
  EXPECT_EQ(back.points, expected.points);
  expect_same_cells(CellKind::prism, back.prisms, expected.prisms, order);
  expect_same_cells(CellKind::pyramid, back.pyramids, expected.pyramids, order);
  expect_same_cells(CellKind::hexahedron, back.hexahedra, expected.hexahedra, order);
  expect_same_cells(CellKind::tetrahedron, back.tetrahedra, expected.tetrahedra, order);
  const auto found = named_faces(back), required = named_faces(mesh);
  ASSERT_EQ(found.size(), required.size());
  for (std::size_t i = 0; i < required.size(); ++i) {
    ASSERT_EQ(found[i].patch, required[i].patch);
    ASSERT_EQ(to_string(found[i].kind), to_string(kinds == Kinds::kept ? required[i].kind : io::kind_of_name(required[i].patch))) << required[i].patch;
    ASSERT_EQ(found[i].nodes, required[i].nodes) << required[i].patch;
  }
  EXPECT_NEAR(enclosed_volume(back), volume_of(mesh), 1e-12 * volume_of(mesh));  // rounding of sums
}

std::string all_bytes(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return path.extension() == ".foam" ? all_bytes(io::polymesh_folder(path)) : bytes_of(path);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string all;
  for (const auto& file : files) all += file.lexically_relative(path).string() + "\n" + bytes_of(file);
  return all;
}

void expect_round_trip(const HybridMesh& mesh, const std::filesystem::path& path, CellOrder order, Kinds kinds) {
  std::filesystem::remove_all(path);
  io::write_volume_file(mesh, path, RunContext({.threads = 2}));
  const std::string bytes = all_bytes(path);
  EXPECT_FALSE(bytes.empty());
  expect_same_after_reading(io::read_volume_file(path, RunContext({.threads = 2})), mesh, order, kinds);
  // Formats with sections by kind do not store columns; formats that store faces number cells as in the mesh.
  io::write_volume_file(order == CellOrder::same ? explicit_cells(mesh) : mesh, path, RunContext({.threads = 7}));
  EXPECT_TRUE(all_bytes(path) == bytes) << "other bytes with other threads, or of explicit cells";  // EXPECT_EQ would print the bytes
}

void expect_no_crash_on_damage(const std::filesystem::path& path, std::size_t k) {
  const std::string bytes = bytes_of(path);
  const RunContext context({.threads = 1});
  const auto try_to_read = [&](const std::string& damaged) {
    std::ofstream(path, std::ios::binary) << damaged;
    try {
      EXPECT_EQ(flaw_of(io::read_volume_file(path, context)), "");
    } catch (const Error& error) {
      EXPECT_TRUE(error.code() != ErrorCode::file_malformed || says_where(error, false)) << error.what();
      EXPECT_TRUE(error.code() == ErrorCode::file_malformed || error.code() == ErrorCode::unsupported_format || error.code() == ErrorCode::overflow)
          << error.what();
    }
  };
  for (std::size_t n = 0; n < bytes.size(); n += k) try_to_read(bytes.substr(0, n));
  for (const int mask : {0x55, 0x80, 0x01})
    for (std::size_t n = 0; n < bytes.size(); n += k) {
      std::string damaged = bytes;
      damaged[n] = static_cast<char>(damaged[n] ^ mask);
      try_to_read(damaged);
    }
  std::ofstream(path, std::ios::binary) << bytes;
}

FullDisk::FullDisk(std::size_t n) {
  old_handler_ = ::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  old_limit_ = limit.rlim_cur;
  limit.rlim_cur = n;
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

FullDisk::~FullDisk() {
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = old_limit_;
  ::setrlimit(RLIMIT_FSIZE, &limit);
  ::signal(SIGXFSZ, old_handler_);
}

}  // namespace sterna::test
