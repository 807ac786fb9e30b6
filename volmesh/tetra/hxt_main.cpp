// sterna-tet-hxt: one call of HXT (in libgmsh) in a separate process. Reads the request from file descriptor 3, and writes the reply to file descriptor 4
// (wire.h).
//
// A separate process is used because of HXT's crashes on unsuitable input, its memory, its global state, its output, and symbols that libgmsh shares with
// TetGen. Known properties of HXT as built by Debian (Gmsh 4.8.4; all measured):
// - It identifies the region of a tetrahedron by the set of surfaces around it, so every closed component of the boundary must be a separate surface. With a
//   single surface it cannot distinguish the domain from the inside of a body, and fails.
// - Its improvement does not stop at tetrahedra that the boundary forces. pygeo_bwb takes 0.2 s without improvement, and 20 s with Gmsh's threshold of 0.3.
//   NACA0012 with strips of 1 m by 0.5 mm takes 25 s without improvement, and more than four minutes even with a threshold of 0.02. The improvement is
//   therefore off by default.
// - It does not report that there was not enough memory; it may also crash in that case.
// - With more than one thread its result differs from run to run.
// - It reads uninitialised memory: with other contents of the heap, pygeo_bwb gets other tetrahedra. Therefore all memory is initialised to zero.
// - It reads freed memory, in which the per-thread cache of glibc stores a random key. One in five runs of pygeo_bwb with ten layers differed. Therefore this
//   cache is disabled.

#include <gmsh.h>
#include <malloc.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "volmesh/tetra/helper_side.h"

// HXT reports "failed" if it gets no memory, and it reads uninitialised memory. The allocation functions below replace those of the C library: they call the
// latter, record failures and clear the memory.
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT(readability-identifier-naming): glibc's name
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(readability-identifier-naming): glibc's name
void* __libc_realloc(void* block, std::size_t size);             // NOLINT(readability-identifier-naming): glibc's name
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(readability-identifier-naming): glibc's name
}

namespace {

using namespace sterna::volmesh;

std::atomic<bool> is_memory_short = false;

void* noted(void* block, std::size_t size) {
  if (!block && size > 0) is_memory_short = true;
  return block;
}

/// Sets the bytes from `begin` to the end of the usable block to zero.
void* cleared(void* block, std::size_t begin) {
  if (!block) return nullptr;
  if (const std::size_t end = malloc_usable_size(block); end > begin) std::memset(static_cast<std::byte*>(block) + begin, 0, end - begin);
  return block;
}

constexpr int k_hxt = 10;      ///< value of Mesh.Algorithm3D for HXT
constexpr int k_triangle = 2;  ///< number of the element type in Gmsh
constexpr int k_tetrahedron = 4;

/// HXT uses the given size as the approximate distance of points, so edges are longer: their geometric mean is 1.44 times the size (measured in a field of
/// constant size). Therefore HXT receives this fraction of the target length.
constexpr double k_size_factor = 1.0 / 1.44;

/// Edge length that leads to no refinement; coordinates are at most 2.
constexpr double k_no_size = 1e6;

void set_options(const wire::RequestHeader& header) {
  gmsh::option::setNumber("General.Terminal", 1);
  gmsh::option::setNumber("General.Verbosity", 2);  // prints warnings and errors
  for (const char* threads : {"General.NumThreads", "Mesh.MaxNumThreads1D", "Mesh.MaxNumThreads2D", "Mesh.MaxNumThreads3D"})
    gmsh::option::setNumber(threads, 1);
  gmsh::option::setNumber("Mesh.Algorithm3D", k_hxt);
  gmsh::option::setNumber("Mesh.Optimize", header.improve_below > 0.0 ? 1 : 0);
  gmsh::option::setNumber("Mesh.OptimizeThreshold", header.improve_below);
  gmsh::option::setNumber("Mesh.Renumber", 0);  // node tags stay the point numbers of the request
}

/// Defines surfaces with their nodes and triangles, and a volume for each region. Tags start at 1.
void set_boundary(const helper::Request& request) {
  const wire::RequestHeader& header = *request.header;
  std::vector<int> point2surface(header.n_points, -1);
  std::vector<std::vector<std::size_t>> corners(header.n_surfaces);
  for (std::size_t t = 0; t < header.n_triangles; ++t) {
    const int surface = request.triangle2surface[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(request.triangles[3 * t + k]);
      if (point2surface[v] < 0) point2surface[v] = surface;  // points on the border of a sheet may belong to another surface of the boundary
      corners[static_cast<std::size_t>(surface)].push_back(v + 1);
    }
  }
  std::vector<std::vector<std::size_t>> tags(header.n_surfaces);
  std::vector<std::vector<double>> coordinates(header.n_surfaces);
  for (std::size_t v = 0; v < header.n_points; ++v) {
    const auto surface = static_cast<std::size_t>(point2surface[v]);
    tags[surface].push_back(v + 1);
    coordinates[surface].insert(coordinates[surface].end(), request.points + 3 * v, request.points + 3 * v + 3);
  }
  std::vector<std::vector<int>> region2surfaces, region2sheets;
  const std::size_t n_closed = header.n_surfaces - header.n_baffle_surfaces;
  // The surfaces on both sides of a sheet between two regions share nodes.
  const bool shares_nodes = std::any_of(request.surface2second, request.surface2second + header.n_surfaces, [](int region) { return region >= 0; });
  const auto add_triangles = [&](std::size_t s) { gmsh::model::mesh::addElementsByType(static_cast<int>(s) + 1, k_triangle, {}, corners[s]); };
  for (std::size_t s = 0; s < header.n_surfaces; ++s) {
    const int tag = static_cast<int>(s) + 1;
    gmsh::model::addDiscreteEntity(2, tag);
    gmsh::model::mesh::addNodes(2, tag, tags[s], coordinates[s]);
    if (!shares_nodes) add_triangles(s);
    const bool parts_regions = request.surface2second[s] >= 0;
    auto& of_region = s < n_closed || parts_regions ? region2surfaces : region2sheets;
    for (const int number : {request.surface2region[s], request.surface2second[s]}) {
      if (number < 0) continue;
      const auto region = static_cast<std::size_t>(number);
      if (region >= of_region.size()) of_region.resize(region + 1);
      of_region[region].push_back(tag);
    }
  }
  for (std::size_t s = 0; shares_nodes && s < header.n_surfaces; ++s) add_triangles(s);
  std::vector<int> volumes;
  for (const std::vector<int>& surfaces : region2surfaces) volumes.push_back(gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(surfaces)}));
  gmsh::model::geo::synchronize();
  for (std::size_t region = 0; region < region2sheets.size(); ++region)
    if (!region2sheets[region].empty()) gmsh::model::mesh::embed(2, region2sheets[region], 3, volumes[region]);
}

/// Sets the size field as the only source of edge lengths. Otherwise HXT would use the minimum of it and the sizes extended from the boundary.
void set_size_field(const helper::Request& request, helper::LateSizes& sizes) {
  if (request.header->is_recovery_only) {
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
    gmsh::model::mesh::setSizeCallback([](int, int, double, double, double) { return k_no_size; });
    return;
  }
  if (!request.header->has_size_field) return;
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::model::mesh::setSizeCallback([&sizes](int, int, double x, double y, double z) { return k_size_factor * sizes(x, y, z); });
}

/// Sends the mesh. Boundary points come first, then the new points in the order of their tags.
[[noreturn]] void send_mesh(const helper::Request& request, double seconds) {
  const std::size_t n_boundary = request.header->n_points;
  std::vector<std::size_t> tags, element_tags, corners;
  std::vector<double> coordinates, unused;
  gmsh::model::mesh::getNodes(tags, coordinates, unused, -1, -1, false, false);
  gmsh::model::mesh::getElementsByType(k_tetrahedron, element_tags, corners);
  std::size_t last_tag = n_boundary;
  for (const std::size_t tag : tags) last_tag = std::max(last_tag, tag);

  // The tags have gaps where HXT has removed points again.
  std::vector<int> tag2point(last_tag + 1, -1);
  for (const std::size_t tag : tags) tag2point[tag] = 0;
  int n_points = 0;
  for (std::size_t tag = 1; tag <= last_tag; ++tag) {
    if (tag2point[tag] == 0 || tag <= n_boundary) tag2point[tag] = n_points++;
  }
  std::vector<double> points(3 * static_cast<std::size_t>(n_points), std::nan(""));  // the parent process detects missing boundary points by the NaN
  for (std::size_t i = 0; i < tags.size(); ++i) std::memcpy(points.data() + 3 * tag2point[tags[i]], coordinates.data() + 3 * i, 24);
  std::vector<int> tetrahedra(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) tetrahedra[i] = tag2point[corners[i]];
  helper::reply_mesh(points.data(), static_cast<std::size_t>(n_points), tetrahedra.data(), tetrahedra.size() / 4, seconds);
}

/// Reports a crash after a failed allocation as lack of memory.
void on_crash(int signal) {
  if (is_memory_short) {
    wire::ReplyHeader reply;
    reply.outcome = wire::Outcome::out_of_memory;
    helper::write_all(&reply, sizeof reply);
    std::_Exit(1);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

int run(const helper::Request& request) {
  const helper::Stopwatch watch;
  helper::LateSizes sizes(*request.header);
  try {
    gmsh::initialize(0, nullptr, false);
    set_options(*request.header);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) std::signal(signal, on_crash);
    gmsh::model::add("sterna");
    set_boundary(request);
    set_size_field(request, sizes);
    gmsh::model::mesh::generate(3);
    send_mesh(request, watch.seconds() - sizes.waited_seconds());
  } catch (const std::bad_alloc&) {
    return helper::reply_failure(wire::Outcome::out_of_memory, 0, watch.seconds());
  } catch (const std::exception& error) {
    helper::say(error.what());
  } catch (const std::string& error) {
    helper::say(error);
  } catch (...) {
    return helper::reply_failure(wire::Outcome::exception, 0, watch.seconds());
  }
  return helper::reply_failure(is_memory_short ? wire::Outcome::out_of_memory : wire::Outcome::engine_code, 0, watch.seconds());
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) { return noted(__libc_calloc(1, size), size); }
void* calloc(std::size_t count, std::size_t size) { return noted(__libc_calloc(count, size), count * size); }
void* realloc(void* block, std::size_t size) {
  const std::size_t kept = block ? malloc_usable_size(block) : 0;
  return cleared(noted(__libc_realloc(block, size), size), kept);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return cleared(noted(__libc_memalign(alignment, size), size), 0); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  *block = aligned_alloc(alignment, size);
  return *block || size == 0 ? 0 : ENOMEM;
}
}

/// Restarts the process if the tunable of glibc has another value, because glibc reads it before main() begins. Also removes settings that would fill freed
/// blocks.
void require_no_thread_cache() {
  constexpr const char *k_name = "GLIBC_TUNABLES", *k_value = "glibc.malloc.tcache_count=0";
  if (const char* now = std::getenv(k_name); now && std::strcmp(now, k_value) == 0) return;
  char path[] = "/proc/self/exe";
  char* arguments[] = {path, nullptr};
  if (unsetenv("MALLOC_PERTURB_") == 0 && setenv(k_name, k_value, 1) == 0) execv(path, arguments);
  helper::say("HXT helper: the memory settings cannot be changed; results may differ from run to run\n");
}

int main() {
  require_no_thread_cache();
  const helper::Request request = helper::map_request();
  if (!request.header) return helper::reply_failure(wire::Outcome::bad_request, 0, 0.0);
  helper::limit_resources(*request.header);
  return run(request);
}
