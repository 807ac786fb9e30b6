#include "tests/fuzz/seeds.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>

#include "io/volume/sterna_file.h"

namespace sterna::fuzz {
namespace {

template <std::size_t N>
std::array<NodeId, N> nodes(const std::uint32_t (&numbers)[N]) {
  std::array<NodeId, N> result;
  std::transform(std::begin(numbers), std::end(numbers), result.begin(), [](std::uint32_t n) { return NodeId(n); });
  return result;
}

/// A hexahedron, a pyramid on its top, a prism at its side, and a tetrahedron between pyramid and prism (mix4 of docs/method/formats.md, "Sample meshes").
HybridMesh four_cells() {
  HybridMesh mesh;
  mesh.points.raw() = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},     {0, 1, 0},   {0, 0, 1},   {1, 0, 1},
                       {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}, {2, 0, 0.5}, {2, 1, 0.5}, {1.5, 0.5, 1.8}};
  mesh.hexahedra = {nodes({0, 1, 2, 3, 4, 5, 6, 7})};
  mesh.pyramids = {nodes({4, 5, 6, 7, 8})};
  mesh.prisms = {nodes({1, 5, 9, 2, 6, 10})};
  mesh.tetrahedra = {nodes({5, 6, 8, 11})};
  mesh.patches.raw() = {{"wall", PatchKind::wall}, {"symmetry", PatchKind::symmetry}, {"Farfield \xC3\xBC", PatchKind::farfield}};
  const PatchId wall(0), symmetry(1), farfield(2);
  mesh.boundary_quads = {{nodes({0, 3, 2, 1}), wall},     {nodes({0, 1, 5, 4}), symmetry},  {nodes({2, 3, 7, 6}), farfield},
                         {nodes({0, 4, 7, 3}), farfield}, {nodes({5, 9, 10, 6}), farfield}, {nodes({9, 1, 2, 10}), farfield}};
  mesh.boundary_triangles = {{nodes({1, 9, 5}), symmetry},  {nodes({4, 5, 8}), farfield},  {nodes({6, 7, 8}), farfield},  {nodes({7, 4, 8}), farfield},
                             {nodes({2, 6, 10}), farfield}, {nodes({5, 6, 11}), farfield}, {nodes({6, 8, 11}), farfield}, {nodes({8, 5, 11}), farfield}};
  return mesh;
}

/// A tetrahedron surface with two patches.
TriMesh four_triangles() {
  TriMesh mesh;
  mesh.points.raw() = {{0, 0, 0}, {1, 0, 0}, {0.1, 1, 0}, {0.2, 0.3, 1}};
  const VertexId a(0), b(1), c(2), d(3);
  mesh.triangles.raw() = {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
  mesh.triangle_patch.raw() = {PatchId(0), PatchId(1), PatchId(1), PatchId(1)};
  mesh.patches.raw() = {{"wing", PatchKind::wall}, {"symmetry", PatchKind::symmetry}};
  return mesh;
}

/// Writes a .sterna file with every part that the format can hold.
void write_everything(const std::filesystem::path& path, const RunContext& context) {
  const TriMesh surface = four_triangles();
  HybridMesh mesh = four_cells();
  mesh.layers = {.n_layers = 2, .base = {{0, 1, 2}}, .first_node = {0, 3, 6}, .is_collapsed = {0, 0, 1}};
  mesh.request = {.first_height = 1e-6, .max_growth = 1.2, .target_height = {0.1, 0.2, 0.3}, .reason = {0, 1, 0}, .reasons = {"", "gap"}};
  io::StoredEnvelope envelope;
  envelope.direction.raw().assign(4, {0, 0, 1});
  for (auto* const numbers : {&envelope.height, &envelope.target, &envelope.eq1, &envelope.cap}) numbers->raw().assign(4, 0.5);
  envelope.limit.raw().assign(4, 1);
  const io::StoredTetrahedra tetrahedra{.n_boundary_points = 4, .new_points = {{0.3, 0.3, 0.3}}, .tetrahedra = {{0, 1, 2, 4}}};
  io::write_sterna(
      {.surface = &surface, .envelope = &envelope, .tetrahedra = &tetrahedra, .mesh = &mesh, .manifest = "{}", .certificate = "{}", .quality = "{}"}, path,
      context);
}

class SeedFolder {
 public:
  SeedFolder(const Target& target, std::filesystem::path folder, std::size_t largest) : target_(target), folder_(std::move(folder)), largest_(largest) {}

  void add(const std::filesystem::path& path) {
    const std::string bytes = joined(target_, path);
    if (bytes.empty() || bytes.size() > largest_ || !known_.insert(bytes).second) return;
    std::ofstream(folder_ / std::to_string(known_.size()), std::ios::binary) << bytes;
  }
  int n() const { return static_cast<int>(known_.size()); }

 private:
  const Target& target_;
  std::filesystem::path folder_;
  std::size_t largest_;
  std::set<std::string> known_;
};

bool ends_with_one_of(std::string name, std::string_view extensions) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::vector<std::string_view> ends = words(extensions);
  return std::any_of(ends.begin(), ends.end(), [&](std::string_view end) { return name.ends_with(end); });
}

}  // namespace

int write_seeds(const Target& target, const std::filesystem::path& folder, std::span<const std::filesystem::path> sample_folders, std::size_t largest) {
  const RunContext context({.threads = 1});
  SeedFolder seeds(target, folder, largest);
  const std::filesystem::path scratch = folder.string() + ".scratch";
  const auto add_written = [&](const std::filesystem::path& name, const auto& write) {
    std::filesystem::create_directories(scratch);
    write(scratch / name);
    seeds.add(target.is_folder() ? scratch / "constant" / "polyMesh" : scratch / name);
    std::filesystem::remove_all(scratch);
  };
  for (const std::string_view extension : words(target.is_folder() ? ".text.foam .foam" : std::string_view(target.extensions))) {
    const std::string name = "x" + std::string(extension);
    if (target.model) break;
    for (const io::Format& format : io::formats()) {
      const std::vector<std::string_view> written = words(format.extensions);
      if (std::find(written.begin(), written.end(), extension) == written.end()) continue;
      if (format.write_volume) add_written(name, [&](const std::filesystem::path& path) { format.write_volume(four_cells(), path, context); });
      if (format.write_surface) add_written(name, [&](const std::filesystem::path& path) { format.write_surface(four_triangles(), path, context); });
    }
  }
  if (target.extension() == ".sterna") add_written("x.sterna", [&](const std::filesystem::path& path) { write_everything(path, context); });
  if (target.model)
    add_written("x" + target.extensions, [&](const std::filesystem::path& path) { std::ofstream(path, std::ios::binary) << target.model->seed; });
  for (const std::filesystem::path& samples : sample_folders) {
    if (!std::filesystem::is_directory(samples)) continue;
    std::vector<std::filesystem::path> paths;
    for (const auto& item : std::filesystem::directory_iterator(samples)) {
      if (target.is_folder() && item.path().extension() == ".foam") paths.push_back(item.path() / "constant" / "polyMesh");
      if (!target.is_folder() && item.is_regular_file() && ends_with_one_of(item.path().filename().string(), target.extensions)) paths.push_back(item.path());
    }
    std::sort(paths.begin(), paths.end());
    for (const std::filesystem::path& path : paths) seeds.add(path);
  }
  return seeds.n();
}

}  // namespace sterna::fuzz
