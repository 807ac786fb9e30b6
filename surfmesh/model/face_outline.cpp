#include "surfmesh/model/face_outline.h"

#include <algorithm>
#include <cmath>

namespace sterna::surfmesh {
namespace {

/// Number of polygon points of an edge use. Straight parameter curves need only two.
constexpr int k_polygon_points = 24;

const EdgeUse& use_at(const Model& model, const EdgeUseLocation& location) { return model.faces[location.face].borders[location.border][location.location]; }

/// Returns the whole number of periods nearest to `jump`, times the period.
double whole_periods(double jump, double period) { return std::round(jump / period) * period; }

bool is_inside(const std::vector<Uv>& polygon, Uv at) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Uv &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.u <= at.u) != (b.u <= at.u) && a.v + (at.u - a.u) / (b.u - a.u) * (b.v - a.v) > at.v) inside = !inside;
  }
  return inside;
}

/// Merges loops that run around the period into one polygon that runs there and back. A single loop is closed at the border of the domain on its left. The
/// polygons of the other merged loops become empty.
void close_around(const Surface& surface, const std::vector<Uv>& ends, FaceOutline& outline) {
  const std::size_t first = outline.winding.front();
  std::vector<Uv>& polygon = outline.polygons[first];
  const Uv start = polygon.front(), end = ends[first];
  polygon.push_back(end);
  if (outline.winding.size() == 1) {
    const ParameterBox domain = surface.domain();
    const bool is_along_u = std::abs(end.u - start.u) > std::abs(end.v - start.v);
    const double pole = is_along_u ? (end.u > start.u ? domain.v.to : domain.v.from) : (end.v > start.v ? domain.u.from : domain.u.to);
    polygon.push_back(is_along_u ? Uv{end.u, pole} : Uv{pole, end.v});
    polygon.push_back(is_along_u ? Uv{start.u, pole} : Uv{pole, start.v});
  }
  for (std::size_t k = 1; k < outline.winding.size(); ++k) {
    std::vector<Uv>& other = outline.polygons[outline.winding[k]];
    const Uv around = end - start;
    const Uv away = end - other.front();
    const double periods = std::round((away.u * around.u + away.v * around.v) / (around.u * around.u + around.v * around.v));
    for (const Uv& p : other) polygon.push_back(p + periods * around);
    polygon.push_back(ends[outline.winding[k]] + periods * around);
    other.clear();
  }
}

/// Moves holes into the period of the outer border.
void move_holes_inside(FaceOutline& outline, double period_u, double period_v) {
  const std::size_t outer = outline.winding.empty() ? 0 : outline.winding.front();
  for (std::size_t b = 0; b < outline.polygons.size(); ++b) {
    std::vector<Uv>& polygon = outline.polygons[b];
    if (b == outer || polygon.empty() || is_inside(outline.polygons[outer], polygon.front())) continue;
    bool is_found = false;
    for (int i = -1; i <= 1 && !is_found; ++i)
      for (int j = -1; j <= 1 && !is_found; ++j) {
        const Uv shift{i * period_u, j * period_v};
        if (!is_inside(outline.polygons[outer], polygon.front() + shift)) continue;
        for (Uv& p : polygon) p = p + shift;
        for (OutlineUse& use : outline.borders[b]) use.shift = use.shift + shift;
        is_found = true;
      }
  }
}

}  // namespace

Uv parameters_at(const Model& model, const OutlineUse& use, double t) { return use_at(model, use.location).parameter->point(t) + use.shift; }

FaceOutline outline_of(const Model& model, FaceId id) {
  const ModelFace& face = model.faces[id];
  const Surface& surface = *face.surface;
  const ParameterBox domain = surface.domain();
  const double period_u = surface.is_periodic_u() ? domain.u.length() : 0.0, period_v = surface.is_periodic_v() ? domain.v.length() : 0.0;
  const auto moved_near = [&](Uv from, Uv to) {
    return Uv{period_u > 0.0 ? whole_periods(to.u - from.u, period_u) : 0.0, period_v > 0.0 ? whole_periods(to.v - from.v, period_v) : 0.0};
  };
  FaceOutline outline;
  std::vector<Uv> ends;
  for (std::uint32_t b = 0; b < face.borders.size(); ++b) {
    std::vector<OutlineUse> uses;
    std::vector<Uv> polygon;
    Uv end;
    for (std::uint32_t i = 0; i < face.borders[b].size(); ++i) {
      const EdgeUse& use = face.borders[b][i];
      const Interval range = model.edges[use.edge].range;  // the domain of the curve may be larger than the range of the edge
      const auto at = [&](double share) {
        return use.parameter->point(use.is_reversed ? range.to - share * range.length() : range.from + share * range.length());
      };
      OutlineUse entry{{id, b, i}, {}, 0.0};
      const Uv start = at(0.0);
      if (i > 0) {
        entry.shift = moved_near(start, end);
        entry.gap = std::max(std::abs(start.u + entry.shift.u - end.u), std::abs(start.v + entry.shift.v - end.v));
      }
      for (int k = 0; k < k_polygon_points; ++k) polygon.push_back(at(static_cast<double>(k) / k_polygon_points) + entry.shift);
      end = at(1.0) + entry.shift;
      uses.push_back(entry);
    }
    if (!polygon.empty()) {
      const Uv open = moved_near(end, polygon.front());
      if (open.u != 0.0 || open.v != 0.0) outline.winding.push_back(b);
    }
    ends.push_back(end);
    outline.borders.push_back(std::move(uses));
    outline.polygons.push_back(std::move(polygon));
  }
  if (!outline.winding.empty()) close_around(surface, ends, outline);
  if (period_u > 0.0 || period_v > 0.0) move_holes_inside(outline, period_u, period_v);
  return outline;
}

}  // namespace sterna::surfmesh
