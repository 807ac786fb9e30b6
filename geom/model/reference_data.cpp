#include "geom/model/reference_data.h"

#include <algorithm>
#include <cmath>

#include "geom/model/section_rows.h"

namespace sterna {
namespace {

/// Chord line of a section in aircraft axes.
struct ChordLine {
  Point leading, trailing;
};

std::vector<ChordLine> chord_lines(const Wing& wing) {
  const Transform map = transform_of(wing.placement);
  std::vector<ChordLine> lines;
  for (const WingSection& section : wing.sections) {
    const std::vector<Point> loop = section_loop(section, std::nullopt);
    const Point trailing = 0.5 * (loop.front() + loop.back());
    const Point leading =
        *std::max_element(loop.begin(), loop.end(), [&](const Point& a, const Point& b) { return distance(a, trailing) < distance(b, trailing); });
    lines.push_back({map.point(leading), map.point(trailing)});
  }
  if (wing.is_symmetric)
    for (std::size_t i = lines.size() - 1; i-- > 0;) {
      ChordLine image = lines[i];
      image.leading.y = -image.leading.y;
      image.trailing.y = -image.trailing.y;
      lines.push_back(image);
    }
  return lines;
}

double across(const Vec3& v) { return std::hypot(v.y, v.z); }

}  // namespace

WingReference wing_reference(const Wing& wing) {
  WingReference r{.name = wing.name};
  const std::vector<ChordLine> lines = chord_lines(wing);
  double extent_y = 0.0, extent_z = 0.0;
  for (const ChordLine& a : lines)
    for (const ChordLine& b : lines) {
      extent_y = std::max(extent_y, std::abs(b.leading.y - a.leading.y));
      extent_z = std::max(extent_z, std::abs(b.leading.z - a.leading.z));
    }
  const bool is_upright = !wing.is_symmetric && extent_z > extent_y;
  r.span = is_upright ? extent_z : extent_y;
  double square = 0.0;
  Vec3 moment;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const ChordLine &a = lines[i], &b = lines[i + 1];
    const double c0 = a.trailing.x - a.leading.x, c1 = b.trailing.x - b.leading.x;
    const Vec3 step = b.leading - a.leading;
    const double width = std::abs(is_upright ? step.z : step.y);
    r.area += 0.5 * (c0 + c1) * width;
    r.unrolled_area += 0.5 * (c0 + c1) * across(step);
    r.projected_area += 0.5 * (c0 + c1) * std::abs(step.y);
    square += (c0 * c0 + c0 * c1 + c1 * c1) / 3.0 * width;
    // Integral of the leading edge's position weighted with the chord: both are linear along the panel.
    moment += width * ((c0 / 2.0 + c1 / 2.0) * a.leading + (c0 / 6.0 + c1 / 3.0) * step);
  }
  if (!(r.area > 0.0)) return r;
  r.mean_geometric_chord = r.area / r.span;
  r.mean_aerodynamic_chord = square / r.area;
  r.aerodynamic_chord_start = moment / r.area;
  r.aspect_ratio = r.span * r.span / r.area;
  return r;
}

}  // namespace sterna
