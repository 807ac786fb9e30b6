// The exception class of the project: a code, a message with location and numbers, a hint, and the geometry of the failure, which the outermost caller may
// write to a VTU file.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

enum class ErrorCode {
  bad_argument,    ///< a value of the wrong type or out of range, or a missing required value
  unknown_option,  ///< a key that is not the name of an option
  script_failed,   ///< the Lua script itself is in error
  file_not_found,
  file_malformed,      ///< the file violates the rules of its format
  unsupported_format,  ///< a format or variant of a format that this build cannot read or write
  write_failed,
  empty_surface,
  open_surface,
  non_manifold_surface,
  self_intersection,  ///< self-intersection of a wall or an envelope, or intersection between boundaries
  not_orientable,
  envelope_failed,
  geometry_failed,  ///< an operation on exact geometry failed: conversion, healing, boolean
  tetra_engine_missing,
  tetra_engine_failed,   ///< crash, error code, or time or memory limit of the helper
  tetra_result_invalid,  ///< the engine returned a result that is not a mesh of the domain
  mesh_invalid,          ///< `check` found violations
  overflow,
  cancelled,
  internal,
};

/// Stable spelling for logs, JSON and tests, e.g. "open_surface".
std::string_view to_string(ErrorCode code);

/// Location where an error occurred, with a description (patch, entity, value against limit).
struct ErrorLocation {
  Vec3 position;
  std::string what;
};

/// Geometry of a failure, small enough to be written to a VTU file for the user.
struct TroubleGeometry {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> vertices;
  bool empty() const { return triangles.empty() && edges.empty() && vertices.empty(); }
};

inline constexpr std::size_t k_max_locations = 10;    ///< maximum number of locations listed in a message
inline constexpr std::size_t k_max_geometry = 20000;  ///< maximum number of triangles in the geometry of a failure

struct ErrorInfo {
  ErrorCode code = ErrorCode::internal;
  std::string attempted;                 ///< "reading wing.stl", "filling the volume with tetrahedra"
  std::string problem;                   ///< description of the failure: value against its limit, with unit
  std::vector<ErrorLocation> locations;  ///< the first few locations; `n_locations` may be larger
  std::int64_t n_locations = 0;          ///< 0: as many as `locations`
  std::string hint;                      ///< suggested remedy; may be empty
  TroubleGeometry geometry;

  /// Counts a location and stores it if it is among the first k_max_locations.
  void add_location(const Vec3& position, std::string what);
};

/// what() returns the complete message: "attempted: problem", then the locations, then the hint.
class Error : public std::runtime_error {
 public:
  explicit Error(ErrorInfo info);
  ErrorCode code() const { return info_->code; }
  const ErrorInfo& info() const { return *info_; }
  std::int64_t n_locations() const;

 private:
  std::shared_ptr<const ErrorInfo> info_;
};

/// Throws Error(bad_argument); for errors without a location or a more specific code.
[[noreturn]] void throw_bad_argument(std::string_view attempted, std::string problem, std::vector<ErrorLocation> locations = {}, std::string hint = {});

/// Returns "(x, y, z)" with 6 significant digits, the format of coordinates in all messages.
std::string format_point(const Vec3& p);

}  // namespace sterna
