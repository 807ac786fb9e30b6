// What sterna and its engine helpers (sterna-tet-tetgen, sterna-tet-hxt) say to each other: two memfds, one block each, native byte order.
// It includes nothing of sterna.
//
// Request: RequestHeader; 3 doubles per point; 3 doubles per hole point; 3 int32 per triangle (indices into the points); 1 int32 per triangle (its surface);
//          1 int32 per surface (its region), 1 int32 per surface (the region on the second side of a sheet that parts two, else -1). The last triangles and the
//          last surfaces are those of sheets: inner facets of the region.
// Reply:   ReplyHeader, then (outcome ok only) 3 doubles per point, all of them, 4 int32 per tetrahedron; where the engine was allowed to split boundary
// triangles,
//          3 int32 per triangle of the new boundary and 1 int32 for each: the triangle of the request that it is a part of.
#pragma once

#include <cstdint>

namespace sterna::volmesh::wire {

inline constexpr int k_request_fd = 3;
inline constexpr int k_reply_fd = 4;
inline constexpr int k_size_fd = 5;                                   ///< the size field, once it is there
inline constexpr int k_size_ready_fd = 6;                             ///< pipe: then its length in bytes comes here, a uint64
inline constexpr std::uint64_t k_request_magic = 0x3951455254455453;  ///< "STETREQ9" in memory; the last digit is the version
inline constexpr std::uint64_t k_reply_magic = 0x3350455254455453;    ///< "STETREP3"

/// What may become of the boundary's triangles; TetGen only.
enum class Splits : std::uint64_t {
  none = 0,       ///< all are kept
  leftovers = 1,  ///< all are kept, but for points on the boundary that the engine could not take back
  recovery = 2,   ///< split where the boundary is no part of a Delaunay triangulation otherwise; what comes out is kept
  quality = 3,    ///< split where tetrahedra become better by it, or smaller as the size field asks
};

struct RequestHeader {
  std::uint64_t magic = k_request_magic;
  std::uint64_t n_points = 0;
  std::uint64_t n_holes = 0;
  std::uint64_t n_triangles = 0;
  std::uint64_t n_surfaces = 0;      ///< connected components of the boundary, then those of the sheets
  std::uint64_t has_size_field = 0;  ///< 0: the engine extends the sizes of the boundary
  std::uint64_t memory_limit = 0;    ///< address space in bytes
  double scale = 1.0;                ///< coordinates in the request over metres
  double radius_edge = 0.0;          ///< largest circumradius over shortest edge; TetGen only
  double improve_below = 0.0;        ///< the engine improves tetrahedra of a lower quality (1 = regular); 0: none; HXT only
  Splits splits = Splits::none;
  std::uint64_t is_recovery_only = 0;  ///< 1: the boundary is recovered; no points are put into the volume but those that this needs
  std::uint64_t n_sheet_surfaces = 0;  ///< of the surfaces, the last
  double processor_seconds = 0.0;      ///< the engine ends with Outcome::out_of_time after so much time of the processor; 0: never
  double seconds_per_leaf = 0.0;       ///< and more by this for each leaf of the size field, once that is there
};

enum class Outcome : std::int32_t {
  ok = 0,
  engine_code = 1,    ///< the engine says that it failed: see ReplyHeader::engine_code, and its last words
  out_of_memory = 2,  ///< an allocation failed within the memory limit
  bad_request = 3,    ///< the request is not one of this protocol's version
  exception = 4,      ///< something else was thrown
  out_of_time = 5,    ///< the time of the processor was over; ReplyHeader::engine_seconds is how much it had
};

struct ReplyHeader {
  std::uint64_t magic = k_reply_magic;
  Outcome outcome = Outcome::ok;
  std::int32_t engine_code = 0;
  std::uint64_t n_points = 0;
  std::uint64_t n_tetrahedra = 0;
  std::uint64_t n_triangles = 0;  ///< of the new boundary; 0: it is the request's
  double engine_seconds = 0.0;    ///< wall time inside the engine
  double peak_bytes = 0.0;        ///< largest resident size of the helper so far
};

static_assert(sizeof(RequestHeader) == 120 && sizeof(ReplyHeader) == 56);

}  // namespace sterna::volmesh::wire
