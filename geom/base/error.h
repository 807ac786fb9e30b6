// The one exception class of the project: a code, a sentence with place and numbers, what to try, and the geometry of the
// failure, which the outermost caller may write to a VTU.
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
  bad_argument,    ///< a value of the wrong type, out of range, or a missing required one
  unknown_option,  ///< a key that no option has
  script_failed,   ///< the Lua script itself is wrong
  file_not_found,
  file_malformed,      ///< the file breaks its format's rules
  unsupported_format,  ///< a format (or a variant of one) that this build does not read or write
  write_failed,
  empty_surface,
  open_surface,
  non_manifold_surface,
  self_intersection,  ///< of a wall, an envelope, or between boundaries
  not_orientable,
  envelope_failed,
  geometry_failed,  ///< an operation on exact geometry: a conversion, healing, a boolean
  tetra_engine_missing,
  tetra_engine_failed,   ///< crash, error code, time or memory limit of the helper
  tetra_result_invalid,  ///< the engine answered, but not with a mesh of the domain
  mesh_invalid,          ///< `check` found violations
  overflow,
  cancelled,
  internal,
};

/// Stable spelling for logs, JSON and tests, e.g. "open_surface".
std::string_view to_string(ErrorCode code);

/// A place of trouble: where, and what is there (patch, entity, value against limit).
struct ErrorPlace {
  Vec3 position;
  std::string what;
};

/// Geometry of a failure, small enough to be written as a VTU for the user.
struct TroubleGeometry {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> vertices;
  bool empty() const { return triangles.empty() && edges.empty() && vertices.empty(); }
};

inline constexpr std::size_t k_max_places = 10;       ///< that a message names
inline constexpr std::size_t k_max_geometry = 20000;  ///< triangles that a drawing of trouble has

struct ErrorInfo {
  ErrorCode code = ErrorCode::internal;
  std::string attempted;           ///< "reading wing.stl", "filling the volume with tetrahedra"
  std::string problem;             ///< what is wrong, value against its limit with unit
  std::vector<ErrorPlace> places;  ///< the first few places; `n_places` may be larger
  std::int64_t n_places = 0;       ///< 0: as many as `places`
  std::string hint;                ///< what to try; may be empty
  TroubleGeometry geometry;

  /// Counts a place; the first k_max_places are kept.
  void add_place(const Vec3& position, std::string what);
};

/// what() is the whole text: "attempted: problem", then the places, then the hint.
class Error : public std::runtime_error {
 public:
  explicit Error(ErrorInfo info);
  ErrorCode code() const { return info_->code; }
  const ErrorInfo& info() const { return *info_; }
  std::int64_t n_places() const;

 private:
  std::shared_ptr<const ErrorInfo> info_;
};

/// Error(bad_argument). For what has no place and no better code.
[[noreturn]] void throw_bad_argument(std::string_view attempted, std::string problem, std::vector<ErrorPlace> places = {}, std::string hint = {});

/// "(x, y, z)" with 6 significant digits, the spelling of coordinates in every message.
std::string format_point(const Vec3& p);

}  // namespace sterna
