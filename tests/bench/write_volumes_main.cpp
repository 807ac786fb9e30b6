// Writes a mesh of columns and tetrahedra in each format named, and reads it back. Compares the speed with a plain write of as many bytes in the same run (SU2:
// with fprintf of the same content), and the memory with that of the mesh.
//   write_volumes N FOLDER EXTENSION...      N^2 squares of the plate, 30 layers, 4 shells of tetrahedra:
//                                            N = 870 has 26.5 M nodes, 45.4 M prisms, 18.2 M tetrahedra
//   write_volumes --write N FOLDER EXTENSION...      without reading
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/file/format_table.h"
#include "io/file/volume_file.h"
#include "io/grammar/vtk_cells.h"
#include "io/output/atomic_file.h"
#include "tests/support/hybrid_shapes.h"

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::uint64_t size_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return std::filesystem::file_size(path);
  std::uint64_t n = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) n += entry.file_size();
  return n;
}

/// Returns "VmHWM" or "VmRSS" of this process, in bytes.
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return 1024.0 * std::atof(line.c_str() + key.size() + 1);
  return 0.0;
}

/// Resets the peak resident memory.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

double write_plain(const std::filesystem::path& path, std::uint64_t n) {
  const double begin = now();
  const std::string piece(1 << 20, 'x');
  sterna::io::AtomicFile file(path);
  for (std::uint64_t i = 0; i < n; i += piece.size()) file.append(piece);
  file.commit();
  return now() - begin;
}

/// Bends the plate so that no two coordinates are equal, as on a real body; otherwise compression would appear too good.
void bend(sterna::HybridMesh& mesh) {
  for (sterna::Point& p : mesh.points) {
    const double x = p.x, y = p.y;
    p.x += 0.05 * std::sin(3.0 * y + p.z);
    p.y += 0.05 * std::sin(2.0 * x - p.z);
    p.z += 0.1 * std::sin(3.0 * x + 2.0 * y);
  }
}

/// Size of the uncompressed content of a .sterna file: coordinates, columns, tetrahedra, boundary.
std::uint64_t unpacked_bytes(const sterna::HybridMesh& mesh) {
  return 24 * mesh.points.size() + 12 * mesh.layers.n_columns() + 5 * mesh.layers.n_lines() + 16 * mesh.tetrahedra.size() +
         16 * mesh.boundary_triangles.size() + 20 * mesh.boundary_quads.size();
}

/// The straightforward SU2 writer: fprintf, one call per line, 17 digits.
double write_with_fprintf(const sterna::HybridMesh& mesh, const std::filesystem::path& path) {
  const double begin = now();
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (!file) throw std::runtime_error("cannot write " + path.string());
  std::fprintf(file, "NDIME= 3\nNPOIN= %zu\n", mesh.points.size());
  for (const sterna::Point& p : mesh.points) std::fprintf(file, "%.17g %.17g %.17g\n", p.x, p.y, p.z);
  std::fprintf(file, "NELEM= %lld\n", static_cast<long long>(sterna::count_cells(mesh).total()));
  sterna::for_each_cell(mesh, [&](const sterna::Cell& cell) {
    const auto order = sterna::io::vtk_order(cell.kind);
    const auto n = [&](std::size_t i) { return cell.nodes[order[i]].value(); };
    const int type = sterna::io::vtk_type(cell.kind);
    if (cell.kind == sterna::CellKind::prism) std::fprintf(file, "%d %u %u %u %u %u %u\n", type, n(0), n(1), n(2), n(3), n(4), n(5));
    else if (cell.kind == sterna::CellKind::pyramid) std::fprintf(file, "%d %u %u %u %u %u\n", type, n(0), n(1), n(2), n(3), n(4));
    else std::fprintf(file, "%d %u %u %u %u\n", type, n(0), n(1), n(2), n(3));
  });
  for (const sterna::PatchId patch : mesh.patches.ids()) {
    std::fprintf(file, "MARKER_TAG= %s\n", mesh.patches[patch].name.c_str());
    for (const auto& face : mesh.boundary_triangles)
      if (face.patch == patch) std::fprintf(file, "5 %u %u %u\n", face.nodes[0].value(), face.nodes[1].value(), face.nodes[2].value());
    for (const auto& face : mesh.boundary_quads)
      if (face.patch == patch)
        std::fprintf(file, "9 %u %u %u %u\n", face.nodes[0].value(), face.nodes[1].value(), face.nodes[2].value(), face.nodes[3].value());
  }
  std::fflush(file);
  ::fsync(::fileno(file));
  std::fclose(file);
  return now() - begin;
}

struct Settings {
  bool is_read_back = true;
  int n = 0;
  std::filesystem::path folder;
  std::vector<std::string> extensions;
};

void run(const sterna::HybridMesh& mesh, const std::string& extension, const Settings& settings, const sterna::RunContext& context) {
  const std::filesystem::path path = settings.folder / ("bench" + extension), plain_path = settings.folder / "bench.plain";
  reset_peak();
  const double before = memory("VmRSS"), begin = now();
  sterna::io::write_volume_file(mesh, path, context);
  const double seconds = now() - begin, extra = memory("VmHWM") - before;
  const std::uint64_t n = size_of(path);
  const double plain = write_plain(plain_path, n);
  std::filesystem::remove(plain_path);
  std::printf("%-14s write %7.3f GB %7.2f s %6.3f GB/s  plain write %6.2f s: %4.0f %%  extra memory %6.3f GB\n", extension.c_str(),
              static_cast<double>(n) / 1e9, seconds, static_cast<double>(n) / 1e9 / seconds, plain, 100.0 * plain / seconds, extra / 1e9);
  std::fflush(stdout);
  if (extension == ".sterna") {
    const std::uint64_t n_unpacked = unpacked_bytes(mesh);
    const double plain_unpacked = write_plain(plain_path, n_unpacked);
    std::filesystem::remove(plain_path);
    std::printf("%-14s unpacked %4.3f GB %17.3f GB/s  plain write %6.2f s: %4.0f %%\n", "", static_cast<double>(n_unpacked) / 1e9,
                static_cast<double>(n_unpacked) / 1e9 / seconds, plain_unpacked, 100.0 * plain_unpacked / seconds);
  }
  if (extension == ".su2") {
    const double with_fprintf = write_with_fprintf(mesh, plain_path);
    std::filesystem::remove(plain_path);
    std::printf("%-14s fprintf %38.2f s: %.1f times as long\n", "", with_fprintf, with_fprintf / seconds);
    std::fflush(stdout);
  }
  if (settings.is_read_back && sterna::io::format_of(path).read_volume) {
    reset_peak();
    const double before_reading = memory("VmRSS"), begin_reading = now();
    const sterna::HybridMesh back = sterna::io::read_volume_file(path, context);
    const double reading = now() - begin_reading, held = memory("VmRSS") - before_reading;
    std::printf("%-14s read  %18.2f s %6.3f GB/s  peak memory %6.3f GB, of it the mesh %6.3f GB%s\n", "", reading, static_cast<double>(n) / 1e9 / reading,
                (memory("VmHWM") - before_reading) / 1e9, held / 1e9, back.points.size() == mesh.points.size() ? "" : "  OTHER MESH");
    std::fflush(stdout);
  }
  std::filesystem::remove_all(path);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  int at = 1;
  if (argc > 1 && std::string(argv[1]) == "--write") {
    settings.is_read_back = false;
    ++at;
  }
  if (argc < at + 3) {
    std::fprintf(stderr, "usage: write_volumes [--write] N FOLDER EXTENSION...\n");
    return 2;
  }
  settings.n = std::atoi(argv[at]);
  settings.folder = argv[at + 1];
  settings.extensions.assign(argv + at + 2, argv + argc);
  sterna::HybridMesh mesh = sterna::test::plate_block(settings.n, {.n_layers = 30, .n_shells = 4});
  bend(mesh);
  const sterna::CellCounts counts = sterna::count_cells(mesh);
  std::printf("%zu nodes, %lld prisms, %lld tetrahedra, %.2f GB in memory\n", mesh.points.size(), static_cast<long long>(counts.prisms),
              static_cast<long long>(counts.tetrahedra), memory("VmRSS") / 1e9);
  const sterna::RunContext context({.threads = 0});
  for (const std::string& extension : settings.extensions) run(mesh, extension, settings, context);
  return 0;
}
