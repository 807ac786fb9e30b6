// Regions where the user wants a given edge length.
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

/// Edge length `size` inside of the region (a wake: growing linearly to `size_end` at its end); outside it grows with the distance from there.
struct SizeSource {
  SourceKind kind = SourceKind::point;
  Vec3 from;                      ///< m
  Vec3 to;                        ///< m
  Vec3 direction{1.0, 0.0, 0.0};  ///< of a wake; any length
  double radius = 0.0;            ///< m
  double length = 0.0;            ///< m, of a wake
  double height = 0.0;            ///< m, of a wake
  double spread = 0.0;            ///< of a wake: tangent of half its opening angle
  double size = 0.0;              ///< m
  double size_end = 0.0;          ///< m, of a wake; 0: the same as size
  std::vector<Vec3> points;       ///< m, of samples
  std::vector<double> sizes;      ///< m, one for each point
};

/// What is wrong with a source, in the user's words; empty when nothing is. \p growth: limit of the field that it goes into.
std::string problem_of(const SizeSource& source, double growth);

/// Volume of the region, m^3 (of a swept or growing wake about); 0 for points and samples.
double volume_of(const SizeSource& source);

/// Edge length that the source asks for at a place when sizes grow by `slope` per length; infinite for samples, which the field's tree handles.
/// \pre problem_of() is empty. Lipschitz with constant `slope`.
double size_of(const SizeSource& source, const Vec3& p, double slope);

}  // namespace sterna::volmesh
