// Protocol between sterna and its engine helpers (sterna-tet-tetgen, sterna-tet-hxt). It uses two memfds with one block each, in native byte order. The file
// includes no header of sterna.
//
// Request: RequestHeader; 3 doubles per point; 3 doubles per hole point; 3 int32 per triangle (indices into the points); 1 int32 per triangle (its surface); 1
// int32 per surface (its region), 1 int32 per surface (the region on the second side of a sheet between two regions, otherwise -1). The last triangles and the
// last surfaces are those of sheets: inner facets of the region.
//
// Reply:   ReplyHeader, then (outcome ok only) 3 doubles per point, all of them, 4 int32 per tetrahedron. If the engine was allowed to split boundary
// triangles: 3 int32 per triangle of the new boundary and 1 int32 for each: its parent triangle in the request.
#pragma once

#include <cstdint>

namespace sterna::volmesh::wire {

inline constexpr int k_request_fd = 3;
inline constexpr int k_reply_fd = 4;
inline constexpr int k_size_fd = 5;        ///< file descriptor of the size field, once it is available
inline constexpr int k_size_ready_fd = 6;  ///< file descriptor of a pipe that delivers the length of the size field in bytes (uint64) once it is available
inline constexpr std::uint64_t k_request_magic = 0x3951455254455453;  ///< "STETREQ9" in memory; the last digit is the version
inline constexpr std::uint64_t k_reply_magic = 0x3350455254455453;    ///< "STETREP3" in memory

/// Permission to change the triangles of the boundary; for TetGen only.
enum class Splits : std::uint64_t {
  none = 0,       ///< all triangles are kept
  leftovers = 1,  ///< all triangles are kept, except at points on the boundary that the engine could not remove
  recovery = 2,   ///< triangles are split where the boundary would not be part of a Delaunay triangulation; splits are kept
  quality = 3,    ///< triangles are split where this improves tetrahedra, or where the size field requires smaller ones
};

struct RequestHeader {
  std::uint64_t magic = k_request_magic;
  std::uint64_t n_points = 0;
  std::uint64_t n_holes = 0;
  std::uint64_t n_triangles = 0;
  std::uint64_t n_surfaces = 0;      ///< number of connected components of the boundary and of the sheets; those of the sheets come last
  std::uint64_t has_size_field = 0;  ///< 0: there is no size field, and the engine extends the sizes of the boundary
  std::uint64_t memory_limit = 0;    ///< limit of the address space in bytes
  double scale = 1.0;                ///< ratio of coordinates in the request to metres
  double radius_edge = 0.0;          ///< largest ratio of circumradius to shortest edge; for TetGen only
  double improve_below = 0.0;        ///< the engine improves tetrahedra of a lower quality (1: regular tetrahedron); 0: it improves none; for HXT only
  Splits splits = Splits::none;
  std::uint64_t is_recovery_only = 0;   ///< 1: the engine recovers the boundary, and inserts only points that this needs into the volume
  std::uint64_t n_baffle_surfaces = 0;  ///< number of sheet surfaces, which are the last
  double processor_seconds = 0.0;       ///< the engine ends with Outcome::out_of_time after this processor time; 0: never
  double seconds_per_leaf = 0.0;        ///< additional processor time per leaf of the size field, once that is available
};

enum class Outcome : std::int32_t {
  ok = 0,
  engine_code = 1,    ///< the engine reports a failure, by ReplyHeader::engine_code and its last messages
  out_of_memory = 2,  ///< an allocation failed because of the memory limit
  bad_request = 3,    ///< the request has another version of this protocol
  exception = 4,      ///< another exception was thrown
  out_of_time = 5,    ///< the processor time was used up; ReplyHeader::engine_seconds contains the limit
};

struct ReplyHeader {
  std::uint64_t magic = k_reply_magic;
  Outcome outcome = Outcome::ok;
  std::int32_t engine_code = 0;
  std::uint64_t n_points = 0;
  std::uint64_t n_tetrahedra = 0;
  std::uint64_t n_triangles = 0;  ///< number of triangles of the new boundary; 0: the boundary is that of the request
  double engine_seconds = 0.0;    ///< elapsed time inside the engine
  double peak_bytes = 0.0;        ///< largest resident size of the helper so far
};

static_assert(sizeof(RequestHeader) == 120 && sizeof(ReplyHeader) == 56);

}  // namespace sterna::volmesh::wire
