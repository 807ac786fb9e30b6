// Regions with a user-specified edge length.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

enum class SourceKind {
  point,     ///< at `from`
  line,      ///< everything within `radius` of the segment from `from` to `to`
  box,       ///< axis-parallel, opposite corners `from` and `to`
  sphere,    ///< centre `from`, `radius`
  cylinder,  ///< axis from `from` to `to`, `radius`, flat ends
  wake,      ///< the slab that the segment `from` to `to` (a trailing edge) sweeps over `length` along `direction`, `height` thick at its start, wider by 2
             ///< `spread` times the distance from there
  samples,   ///< `size` at each of `points`, as read from a file
};
/// "point", "line", ...
std::string_view to_string(SourceKind kind);

/// A source with edge length `size` inside its region (for a wake, growing linearly to `size_end` at its end); outside, the edge length grows with the distance
/// from the region.
struct SizeSource {
  SourceKind kind = SourceKind::point;
  Vec3 from;                      ///< m
  Vec3 to;                        ///< m
  Vec3 direction{1.0, 0.0, 0.0};  ///< wake only; any length
  double radius = 0.0;            ///< m
  double length = 0.0;            ///< m, wake only
  double height = 0.0;            ///< m, wake only
  double spread = 0.0;            ///< wake only: tangent of half the opening angle
  double size = 0.0;              ///< m
  double size_end = 0.0;          ///< m, wake only; 0: same as size
  std::vector<Vec3> points;       ///< m, samples only
  std::vector<double> sizes;      ///< m, one per point
};

/// Returns a description of the error in a source, in the user's terms; empty if there is none. \p growth: growth limit of the size field.
std::string problem_of(const SizeSource& source, double growth);

/// Volume of the region, m^3 (approximate for a swept or growing wake); 0 for points and samples.
double volume_of(const SizeSource& source);

/// Returns the edge length that the source requests at a location if sizes grow by `slope` per length; infinite for samples, which the field's tree handles.
/// \pre problem_of() is empty. Lipschitz with constant `slope`.
double size_of(const SizeSource& source, const Vec3& p, double slope);

}  // namespace sterna::volmesh
