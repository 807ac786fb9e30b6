// What sterna and the helper sterna-tet-tetgen say to each other: two memfds, one block each, native byte order. This header is the
// only code that the two programs share; it includes nothing of sterna.
//
// Request: RequestHeader, 3 doubles per point, 3 doubles per hole point, 3 int32 per triangle (indices into the points).
// Reply:   ReplyHeader, then (outcome ok only) 3 doubles per point, all of them, 4 int32 per tetrahedron.
#pragma once

#include <cstdint>

namespace sterna::volmesh::wire {

inline constexpr int k_request_fd = 3;
inline constexpr int k_reply_fd = 4;
inline constexpr std::uint64_t k_request_magic = 0x3151455254455453;  ///< "STETREQ1" in memory; the last digit is the version
inline constexpr std::uint64_t k_reply_magic = 0x3150455254455453;    ///< "STETREP1"

struct RequestHeader {
  std::uint64_t magic = k_request_magic;
  std::uint64_t n_points = 0;
  std::uint64_t n_holes = 0;
  std::uint64_t n_triangles = 0;
  std::uint64_t memory_limit = 0;  ///< address space in bytes
  char switches[64] = {};          ///< TetGen's own, without the dash
};

enum class Outcome : std::int32_t {
  ok = 0,
  engine_code = 1,    ///< TetGen threw an int: see ReplyHeader::engine_code
  out_of_memory = 2,  ///< an allocation failed within the memory limit
  bad_request = 3,    ///< the request is not one of this protocol's version
  exception = 4,      ///< something else was thrown
};

struct ReplyHeader {
  std::uint64_t magic = k_reply_magic;
  Outcome outcome = Outcome::ok;
  std::int32_t engine_code = 0;
  std::uint64_t n_points = 0;
  std::uint64_t n_tetrahedra = 0;
  double engine_seconds = 0.0;  ///< wall time inside tetrahedralize()
  double peak_bytes = 0.0;      ///< largest resident size of the helper so far
};

static_assert(sizeof(RequestHeader) == 104 && sizeof(ReplyHeader) == 48);

}  // namespace sterna::volmesh::wire
