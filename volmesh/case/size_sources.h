// Regions with a user-specified edge length.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

enum class SourceKind {
  point,     ///< a point at `from`
  line,      ///< all locations within `radius` of the segment from `from` to `to`
  box,       ///< axis-parallel box with the opposite corners `from` and `to`
  sphere,    ///< sphere with the centre `from` and the radius `radius`
  cylinder,  ///< cylinder with the axis from `from` to `to` and the radius `radius`, with flat ends
  wake,      ///< the slab that the segment from `from` to `to` (a trailing edge) sweeps over `length` along `direction`; it is `height` thick at its start, and
             ///< wider by 2 `spread` times the distance from its start
  samples,   ///< the lengths `sizes` at `points`, as read from a file
};
/// Returns the name of the kind, such as "point" or "line".
std::string_view to_string(SourceKind kind);

/// A source of sizes. Inside its region the edge length is `size`; in a wake it grows linearly to `size_end` at the end. Outside, the edge length grows with
/// the distance from the region.
struct SizeSource {
  SourceKind kind = SourceKind::point;
  Vec3 from;                      ///< m
  Vec3 to;                        ///< m
  Vec3 direction{1.0, 0.0, 0.0};  ///< for a wake only; any length
  double radius = 0.0;            ///< m
  double length = 0.0;            ///< m, for a wake only
  double height = 0.0;            ///< m, for a wake only
  double spread = 0.0;            ///< for a wake only: tangent of half the opening angle
  double size = 0.0;              ///< m
  double size_end = 0.0;          ///< m, for a wake only; 0: same as size
  std::vector<Vec3> points;       ///< m, for samples only
  std::vector<double> sizes;      ///< m, one per point, for samples only
};

/// Returns a description of the error in a source, in terms of the user's options; empty if there is none. \p growth growth limit of the size field
std::string problem_of(const SizeSource& source, double growth);

/// Returns the volume of the region in m^3 (approximate for a swept or growing wake); 0 for points and samples.
double volume_of(const SizeSource& source);

/// Returns the edge length that the source requires at a location if sizes grow by `slope` per length. Returns infinity for samples, because the tree of the
/// size field contains them.
/// \pre problem_of() is empty. \post the result is Lipschitz-continuous with the constant `slope`
double size_of(const SizeSource& source, const Vec3& p, double slope);

}  // namespace sterna::volmesh
