// Regions with a user-specified edge length.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/base/schema.h"
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

namespace sterna {

template <>
struct Schema<volmesh::SizeSource> {
  using O = volmesh::SizeSource;
  static constexpr std::string_view stage = "source";
  static constexpr std::array fields = {
      Field<O>{.name = "kind", .member = enum_member<O, &O::kind>(), .help = "kind of the region", .choices = "point line box sphere cylinder wake samples"},
      Field<O>{.name = "from", .member = &O::from, .unit = Unit::metre, .help = "the point, the first end or corner, or the centre"},
      Field<O>{.name = "to", .member = &O::to, .unit = Unit::metre, .help = "the second end, or the opposite corner"},
      Field<O>{.name = "direction", .member = &O::direction, .help = "direction of a wake, of any length"},
      Field<O>{.name = "radius",
               .member = &O::radius,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "distance from the point or line within which the edge length applies"},
      Field<O>{.name = "length", .member = &O::length, .unit = Unit::metre, .min = 1e-12, .help = "length of the region along its direction", .required = true},
      Field<O>{.name = "height", .member = &O::height, .unit = Unit::metre, .min = 0.0, .help = "thickness of the region at its start"},
      Field<O>{.name = "spread", .member = &O::spread, .min = 0.0, .max = 10.0, .help = "growth of half the thickness per distance from the start"},
      Field<O>{.name = "size", .member = &O::size, .unit = Unit::metre, .min = 1e-12, .help = "edge length inside the region", .required = true},
      Field<O>{.name = "size_end", .member = &O::size_end, .unit = Unit::metre, .min = 0.0, .help = "edge length at the downstream end; 0: as size"},
      Field<O>{.name = "points", .member = &O::points, .unit = Unit::metre, .help = "points with edge lengths of samples"},
      Field<O>{.name = "sizes", .member = &O::sizes, .unit = Unit::metre, .min = 1e-12, .help = "edge lengths at the points"},
  };
};

}  // namespace sterna
