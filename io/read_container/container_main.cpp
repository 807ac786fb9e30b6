// sterna-read-container: reads an HDF5, NetCDF or ADF file with its library in a separate process, because these libraries crash, loop and allocate without
// bound on damaged or hostile files. The protocol is container_wire.h. Steps: set limits; read the nodes of the file with their extents, and check these
// against the file size; write the image with the values of the nodes.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <string>

#include "io/read_container/image_layout.h"

namespace {

using namespace sterna::io;

/// The same file by path, for libraries that require a path; the descriptor limit keeps other files from being opened.
constexpr const char* k_path = "/proc/self/fd/3";
constexpr std::uint64_t k_cpu_seconds = 10;                ///< for any file: only endless loops need more
constexpr std::uint64_t k_bytes_per_cpu_second = 1 << 20;  ///< additional time is the file size over this number; unpacking produces 50 times as much
/// One file may be open in addition to the five descriptors: links to other files, data in other files and library plug-ins cannot be opened.
constexpr rlim_t k_descriptors = wire::k_image_fd + 2;

void limit_process(std::uint64_t file_size) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  close_range(wire::k_image_fd + 1, ~0u, 0);  // descriptors that the parent inherited from its own parent
  const rlimit descriptors{k_descriptors, k_descriptors};
  setrlimit(RLIMIT_NOFILE, &descriptors);
  const std::uint64_t seconds = k_cpu_seconds + file_size / k_bytes_per_cpu_second;
  const rlimit cpu{seconds, seconds + 1};
  setrlimit(RLIMIT_CPU, &cpu);
  reader::limit_memory(reader::k_library_memory + 4 * file_size);
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);  // some network disks refuse locks; this process only reads
}

std::string_view map_file(std::uint64_t size) {
  if (size == 0) return {};
  void* const block = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, wire::k_file_fd, 0);
  if (block == MAP_FAILED) throw std::bad_alloc();
  return {static_cast<const char*>(block), size};
}

void read(const std::string& library, const reader::Limits& limits) {
  reader::Image image(limits);
  if (library == "hdf5") reader::add_hdf5_nodes(k_path, limits, image);
  else if (library == "adf") reader::add_adf_nodes(k_path, limits, image);
  else if (library == "netcdf") reader::add_netcdf_nodes(k_path, map_file(limits.file_size), limits, image);
  else throw reader::Failure{.outcome = wire::Outcome::unsupported, .where = "the file", .problem = "there is no library \"" + library + "\"", .hint = {}};
  image.write();
}

}  // namespace

int main(int argc, char** argv) {
  struct stat state {};
  if (argc < 2 || fstat(wire::k_file_fd, &state) != 0) return 2;
  reader::Limits limits{.file_size = static_cast<std::uint64_t>(state.st_size), .left_out = {argv + 2, argv + argc}};
  limit_process(limits.file_size);
  try {
    read(argv[1], limits);
  } catch (const reader::Failure& failure) {
    reader::write_failure(failure);
  } catch (const std::bad_alloc&) {
    reader::write_failure({.outcome = wire::Outcome::out_of_memory,
                           .where = "the file",
                           .problem = "reading it needs more memory than a file of " + std::to_string(limits.file_size) + " bytes justifies",
                           .hint = {}});
  }
  std::_Exit(0);  // skips the libraries' exit handlers, which may fail on a damaged file
}
