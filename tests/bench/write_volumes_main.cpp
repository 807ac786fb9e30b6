// Writes a mesh of columns and tetrahedra in each format named: speed against a plain write of as many bytes in the same run, and memory beside the mesh.
//   write_volumes N FOLDER EXTENSION...      N^2 squares of the plate, 30 layers, 4 shells of tetrahedra: N = 870 has 45 M prisms
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "io/atomic_file.h"
#include "io/volume_file.h"
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

/// "VmHWM", "VmRSS" of this process, bytes.
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return 1024.0 * std::atof(line.c_str() + key.size() + 1);
  return 0.0;
}

/// The peak begins anew.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

double write_plain(const std::filesystem::path& path, std::uint64_t n) {
  const double begin = now();
  const std::string piece(1 << 20, 'x');
  sterna::io::AtomicFile file(path);
  for (std::uint64_t i = 0; i < n; i += piece.size()) file.append(piece);
  file.commit();
  return now() - begin;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: write_volumes N FOLDER EXTENSION...\n");
    return 2;
  }
  const std::filesystem::path folder = argv[2];
  const sterna::HybridMesh mesh = sterna::test::plate_block(std::atoi(argv[1]), {.n_layers = 30, .n_shells = 4});
  const sterna::CellCounts counts = sterna::count_cells(mesh);
  std::printf("%zu nodes, %lld prisms, %lld tetrahedra, %.2f GB in memory\n", mesh.points.size(), static_cast<long long>(counts.prisms), static_cast<long long>(counts.tetrahedra), memory("VmRSS") / 1e9);
  const sterna::RunContext context({.threads = 0});
  for (int i = 3; i < argc; ++i) {
    const std::filesystem::path path = folder / (std::string("bench") + argv[i]);
    reset_peak();
    const double before = memory("VmRSS"), begin = now();
    sterna::io::write_volume_file(mesh, path, context);
    const double seconds = now() - begin, extra = memory("VmHWM") - before;
    const std::uint64_t n = size_of(path);
    std::filesystem::remove_all(path);
    const double plain = write_plain(folder / "bench.plain", n);
    std::filesystem::remove(folder / "bench.plain");
    std::printf("%-14s %7.3f GB %7.2f s %6.3f GB/s  plain write %6.2f s (%3.0f %%)  extra memory %6.3f GB\n", argv[i], static_cast<double>(n) / 1e9, seconds, static_cast<double>(n) / 1e9 / seconds, plain,
                100.0 * plain / seconds, extra / 1e9);
    std::fflush(stdout);
  }
  return 0;
}
