// sterna-tet-tetgen: one call of TetGen in a process of its own. Reads the request from file descriptor 3, writes the reply to 4 (wire.h).
//
// Why a process: TetGen's licence (AGPL), its crashes on input it does not like, its memory, and symbols that it shares with libgmsh.
// What it prints goes to the parent through stdout and stderr. It never outlives its parent.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <tetgen.h>
#include <vector>

#include "volmesh/tetra/wire.h"

namespace {

using namespace sterna::volmesh;

void write_all(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(wire::k_reply_fd, at, size);
    if (written <= 0) {
      std::perror("sterna-tet-tetgen: writing the reply");
      std::_Exit(2);
    }
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// High-water mark of this process; ru_maxrss would not do, it starts at the parent's size after a vfork.
double peak_bytes() {
  double kilobytes = 0.0;
  if (std::FILE* status = std::fopen("/proc/self/status", "r")) {
    char line[256];
    while (std::fgets(line, sizeof line, status)) {
      if (std::strncmp(line, "VmHWM:", 6) == 0) kilobytes = std::strtod(line + 6, nullptr);
    }
    std::fclose(status);
  }
  return 1024.0 * kilobytes;
}

int reply_failure(wire::Outcome outcome, int engine_code, double seconds) {
  wire::ReplyHeader reply;
  reply.outcome = outcome;
  reply.engine_code = engine_code;
  reply.engine_seconds = seconds;
  reply.peak_bytes = peak_bytes();
  std::fflush(nullptr);
  write_all(&reply, sizeof reply);
  return 1;
}

struct Request {
  const wire::RequestHeader* header = nullptr;
  double* points = nullptr;
  double* holes = nullptr;
  int* triangles = nullptr;
};

/// A private mapping: TetGen may write where it likes. No header: not a request.
Request map_request() {
  Request request;
  struct stat state {};
  if (fstat(wire::k_request_fd, &state) != 0) return request;
  const auto size = static_cast<std::uint64_t>(state.st_size);
  if (size < sizeof(wire::RequestHeader)) return request;
  void* block = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, wire::k_request_fd, 0);
  if (block == MAP_FAILED) return request;
  const auto* header = static_cast<const wire::RequestHeader*>(block);
  if (header->magic != wire::k_request_magic) return request;
  if (size != sizeof *header + 24 * (header->n_points + header->n_holes) + 12 * header->n_triangles) return request;
  request.points = reinterpret_cast<double*>(static_cast<char*>(block) + sizeof *header);
  request.holes = request.points + 3 * header->n_points;
  request.triangles = reinterpret_cast<int*>(request.holes + 3 * header->n_holes);
  request.header = header;
  return request;
}

void limit_resources(std::uint64_t memory_limit) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const rlimit memory{memory_limit, memory_limit};
  setrlimit(RLIMIT_AS, &memory);
}

/// Facets of one triangle each, made in bulk; the vertex lists point into the request.
struct Facets {
  explicit Facets(const Request& request)
      : polygons(request.header->n_triangles), facets(request.header->n_triangles), markers(request.header->n_triangles) {
    for (std::size_t t = 0; t < facets.size(); ++t) {
      polygons[t] = {request.triangles + 3 * t, 3};
      facets[t] = {&polygons[t], 1, nullptr, 0};
      markers[t] = static_cast<int>(t) + 1;  // 1-based boundary triangle: TetGen's messages name it
    }
  }
  std::vector<tetgenio::polygon> polygons;
  std::vector<tetgenio::facet> facets;
  std::vector<int> markers;
};

/// The input borrows all its arrays; they must be gone before tetgenio's destructor would delete them.
struct BorrowedInput {
  BorrowedInput(const Request& request, Facets& facets) {
    io.firstnumber = 0;
    io.pointlist = request.points;
    io.numberofpoints = static_cast<int>(request.header->n_points);
    io.holelist = request.header->n_holes > 0 ? request.holes : nullptr;
    io.numberofholes = static_cast<int>(request.header->n_holes);
    io.facetlist = facets.facets.data();
    io.facetmarkerlist = facets.markers.data();
    io.numberoffacets = static_cast<int>(facets.facets.size());
  }
  ~BorrowedInput() { io.initialize(); }
  tetgenio io;
};

int run(const Request& request) {
  Facets facets(request);
  BorrowedInput in(request, facets);
  tetgenio out;
  std::string switches = request.header->switches;
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  try {
    tetrahedralize(switches.data(), &in.io, &out);
  } catch (int code) {
    // 1 is TetGen's "out of memory"; see terminatetetgen() in tetgen.h.
    return reply_failure(code == 1 ? wire::Outcome::out_of_memory : wire::Outcome::engine_code, code, seconds());
  } catch (const std::bad_alloc&) {
    return reply_failure(wire::Outcome::out_of_memory, 0, seconds());
  } catch (...) {
    return reply_failure(wire::Outcome::exception, 0, seconds());
  }
  wire::ReplyHeader reply;
  reply.n_points = static_cast<std::uint64_t>(out.numberofpoints);
  reply.n_tetrahedra = static_cast<std::uint64_t>(out.numberoftetrahedra);
  reply.engine_seconds = seconds();
  reply.peak_bytes = peak_bytes();
  write_all(&reply, sizeof reply);
  write_all(out.pointlist, 24 * reply.n_points);
  write_all(out.tetrahedronlist, 16 * reply.n_tetrahedra);
  std::fflush(nullptr);
  std::_Exit(0);  // the kernel frees a few hundred megabytes faster than destructors do
}

}  // namespace

int main() {
  const Request request = map_request();
  if (!request.header) return reply_failure(wire::Outcome::bad_request, 0, 0.0);
  limit_resources(request.header->memory_limit);
  try {
    return run(request);
  } catch (const std::bad_alloc&) {
    return reply_failure(wire::Outcome::out_of_memory, 0, 0.0);
  }
}
