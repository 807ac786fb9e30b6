// Common code of the main programs of the engine helpers: reads the request, writes the reply, and sets limits. All code of a helper process is here or in its
// main program.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "volmesh/tetra/size_field_view.h"
#include "volmesh/tetra/wire.h"

namespace sterna::volmesh::helper {

/// Writes a final message. The parent process quotes it.
inline void say(std::string_view text) {
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) std::_Exit(3);
}

inline void write_all(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(wire::k_reply_fd, at, size);
    if (written <= 0) {
      say("the reply cannot be written\n");
      std::_Exit(2);
    }
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// Returns the peak memory of this process. ru_maxrss is not suitable, because after a vfork it starts at the size of the parent.
inline double peak_bytes() {
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

/// Measures the elapsed time since its construction.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Writes a reply without a mesh. Returns the corresponding exit status.
inline int reply_failure(wire::Outcome outcome, int engine_code, double seconds) {
  wire::ReplyHeader reply;
  reply.outcome = outcome;
  reply.engine_code = engine_code;
  reply.engine_seconds = seconds;
  reply.peak_bytes = peak_bytes();
  std::fflush(nullptr);
  write_all(&reply, sizeof reply);
  return 1;
}

/// A boundary with split triangles, as sent in the reply.
struct SplitBoundary {
  const int* triangles = nullptr;
  const int* parents = nullptr;  ///< parent of each triangle in the request, counted from 0
  std::size_t n_triangles = 0;
};

/// Writes the mesh and ends the process. The process ends without destructors, because the kernel frees a few hundred megabytes faster.
[[noreturn]] inline void reply_mesh(const double* points, std::size_t n_points, const int* tetrahedra, std::size_t n_tetrahedra, double seconds,
                                    const SplitBoundary& boundary = {}) {
  wire::ReplyHeader reply;
  reply.n_points = n_points;
  reply.n_tetrahedra = n_tetrahedra;
  reply.n_triangles = boundary.n_triangles;
  reply.engine_seconds = seconds;
  reply.peak_bytes = peak_bytes();
  write_all(&reply, sizeof reply);
  write_all(points, 24 * n_points);
  write_all(tetrahedra, 16 * n_tetrahedra);
  write_all(boundary.triangles, 12 * boundary.n_triangles);
  write_all(boundary.parents, 4 * boundary.n_triangles);
  std::fflush(nullptr);
  std::_Exit(0);
}

/// A private mapping of the request, which the engine may modify.
struct Request {
  const wire::RequestHeader* header = nullptr;  ///< nullptr: the data is no request
  double* points = nullptr;
  double* holes = nullptr;
  int* triangles = nullptr;
  const int* triangle2surface = nullptr;
  const int* surface2region = nullptr;
  const int* surface2second = nullptr;
};

inline Request map_request() {
  Request request;
  struct stat state {};
  if (fstat(wire::k_request_fd, &state) != 0) return request;
  const auto size = static_cast<std::uint64_t>(state.st_size);
  if (size < sizeof(wire::RequestHeader)) return request;
  void* block = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, wire::k_request_fd, 0);
  if (block == MAP_FAILED) return request;
  const auto* header = static_cast<const wire::RequestHeader*>(block);
  if (header->magic != wire::k_request_magic) return request;
  if (size != sizeof *header + 24 * (header->n_points + header->n_holes) + 16 * header->n_triangles + 8 * header->n_surfaces) return request;
  request.points = reinterpret_cast<double*>(static_cast<std::byte*>(block) + sizeof *header);
  request.holes = request.points + 3 * header->n_points;
  request.triangles = reinterpret_cast<int*>(request.holes + 3 * header->n_holes);
  request.triangle2surface = request.triangles + 3 * header->n_triangles;
  request.surface2region = request.triangle2surface + header->n_triangles;
  request.surface2second = request.surface2region + header->n_surfaces;
  request.header = header;
  return request;
}

/// The processor time limit of the process in s. It is static because the signal handler needs it.
inline double& processor_limit() {
  static double seconds = 0.0;
  return seconds;
}

inline void on_out_of_time(int) {
  wire::ReplyHeader reply;
  reply.outcome = wire::Outcome::out_of_time;
  reply.engine_seconds = processor_limit();
  write_all(&reply, sizeof reply);
  std::_Exit(1);
}

/// Limits the processor time since the start of the process, so that the same work has the same limit on a busy machine. The kernel counts whole seconds. A
/// lower limit that was set before the process started is kept.
inline void limit_processor(double seconds) {
  static const rlimit before = [] {
    rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
    getrlimit(RLIMIT_CPU, &limit);
    return limit;
  }();
  const rlimit limit{std::min(static_cast<rlim_t>(std::ceil(seconds)), before.rlim_cur), before.rlim_max};
  processor_limit() = static_cast<double>(limit.rlim_cur);
  std::signal(SIGXCPU, on_out_of_time);
  setrlimit(RLIMIT_CPU, &limit);
}

/// The size field, which the parent may still be building. The first evaluation waits for it.
class LateSizes {
 public:
  /// Sizes are returned in the units of the request.
  explicit LateSizes(const wire::RequestHeader& header) : header_(header), scale_(header.scale) {}
  double operator()(double x, double y, double z) {
    if (!view_.is_valid()) wait();
    return scale_ * view_(x / scale_, y / scale_, z / scale_);
  }
  double waited_seconds() const { return waited_; }

 private:
  void wait() {
    const Stopwatch watch;
    std::uint64_t size = 0;
    const void* block = MAP_FAILED;
    if (read(wire::k_size_ready_fd, &size, sizeof size) == sizeof size) block = mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, wire::k_size_fd, 0);
    if (block != MAP_FAILED) view_ = SizeFieldView(static_cast<const std::byte*>(block), size);
    waited_ = watch.seconds();
    if (view_.is_valid()) {
      if (header_.processor_seconds > 0.0) limit_processor(header_.processor_seconds + header_.seconds_per_leaf * static_cast<double>(view_.header().n_leaves));
      return;
    }
    say("the size field cannot be read\n");
    std::_Exit(3);
  }

  const wire::RequestHeader& header_;
  double scale_;
  SizeFieldView view_;
  double waited_ = 0.0;
};

/// Ensures that the helper does not outlive its parent process, writes no core file, and stays within its memory and time limits.
inline void limit_resources(const wire::RequestHeader& header) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const rlimit memory{header.memory_limit, header.memory_limit};
  setrlimit(RLIMIT_AS, &memory);
  if (header.processor_seconds > 0.0) limit_processor(header.processor_seconds);
}

}  // namespace sterna::volmesh::helper
