// Loops in one plane are filled together; for instance two nested loops are filled by a ring. Other loops are filled one by one, and the filling continues the
// triangles around them.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "geom/base/error.h"
#include "geom/boolean/cgal_fill_hole.h"
#include "geom/math/measures.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_flat_border = 2e-3;   ///< relative to a hole's diameter: a boundary is flat if it is nearer to a plane than this
constexpr double k_same_plane = 1e-6;    ///< relative to L: loops are in one plane within this distance
constexpr double k_full_half = 0.35;     ///< relative to the longest side of the box in the plane: smallest extent of the opening of a half model
constexpr double k_origin_half = 0.1;    ///< the same limit if the plane passes through the origin
constexpr double k_covered_share = 0.1;  ///< relative to the area of the opening: largest area of facets in the plane of the opening
/// Smallest fraction of a loop's vertices in the plane: such a loop is partly the boundary of a half model, and partly another hole.
constexpr double k_in_plane_share = 0.6;
constexpr double k_sheet_share = 0.8;      ///< relative to the area of the part: a part with a larger hole does not bound a body
constexpr int k_rings = 2;                 ///< number of rings of triangles around a hole that a curved filling continues
constexpr std::size_t k_smooth_edges = 4;  ///< holes with fewer edges need no new points

using Loop = std::vector<std::uint32_t>;

struct HoleShape {
  Vec3 center, normal;    ///< normal: unit, right-handed along the loop
  double diameter = 0.0;  ///< m, diameter of the box
  double off = 0.0;       ///< m, largest distance from the plane
};

HoleShape shape_of(const RepairState& state, const Loop& loop) {
  HoleShape shape;
  Box box;
  for (const std::uint32_t v : loop) {
    shape.center += state.points[v] / static_cast<double>(loop.size());
    box.add(state.points[v]);
  }
  for (std::size_t i = 0; i < loop.size(); ++i)
    shape.normal += cross(state.points[loop[i]] - shape.center, state.points[loop[(i + 1) % loop.size()]] - shape.center);
  shape.normal = normalized(shape.normal);
  shape.diameter = norm(box.max - box.min);
  // If the boundary lies in a coordinate plane, exactly that plane is used.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.max[axis] != box.min[axis]) continue;
    Vec3 n;
    n[axis] = shape.normal[axis] < 0.0 ? -1.0 : 1.0;
    shape.normal = n;
  }
  for (const std::uint32_t v : loop) shape.off = std::max(shape.off, std::abs(dot(state.points[v] - shape.center, shape.normal)));
  return shape;
}

std::vector<std::vector<Vec3>> points_of(const RepairState& state, const std::vector<Loop>& loops) {
  std::vector<std::vector<Vec3>> result;
  for (const Loop& loop : loops) {
    auto& points = result.emplace_back();
    for (const std::uint32_t v : loop) points.push_back(state.points[v]);
  }
  return result;
}

/// Facets at each vertex, used to find neighbourhoods.
using Fans = std::vector<std::vector<std::uint32_t>>;
Fans fans_of(const RepairState& state) {
  Fans fans(state.points.size());
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const std::uint32_t v : state.facets[t]) fans[v].push_back(t);
  return fans;
}

HoleBorder hole_border_of(const RepairState& state, const Fans& fans, const Loop& loop) {
  HoleBorder border;
  border.n_loop = static_cast<std::uint32_t>(loop.size());
  std::set<std::uint32_t> facets;
  std::set<std::uint32_t> front(loop.begin(), loop.end());
  for (int ring = 0; ring < k_rings; ++ring) {
    std::set<std::uint32_t> next;
    for (const std::uint32_t v : front)
      for (const std::uint32_t t : v < fans.size() ? fans[v] : std::vector<std::uint32_t>{})
        if (facets.insert(t).second) next.insert(state.facets[t].begin(), state.facets[t].end());
    front = std::move(next);
  }
  std::map<std::uint32_t, std::uint32_t> number;
  for (const std::uint32_t v : loop) {
    number[v] = static_cast<std::uint32_t>(border.points.size());
    border.points.push_back(state.points[v]);
  }
  for (const std::uint32_t t : facets) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = state.facets[t][k];
      const auto [found, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(border.points.size()));
      if (is_new) border.points.push_back(state.points[v]);
      triangle[k] = found->second;
    }
    border.triangles.push_back(triangle);
  }
  return border;
}

/// Returns the patch to which most facets along the loop belong.
std::uint32_t patch_around(const RepairState& state, const Fans& fans, const Loop& loop) {
  std::map<std::uint32_t, std::size_t> votes;
  for (const std::uint32_t v : loop)
    for (const std::uint32_t t : v < fans.size() ? fans[v] : std::vector<std::uint32_t>{})
      if (state.info[t].mark != FacetMark::cap) ++votes[state.info[t].patch];
  std::uint32_t best = 0;
  std::size_t n = 0;
  for (const auto& [patch, count] : votes)
    if (count > n) {
      best = patch;
      n = count;
    }
  return best;
}

/// Adds the triangles that fill loops. The loops' vertices are numbered consecutively, and the triangles are oriented along the loops. Records the change.
void add_patch(RepairState& state, const std::vector<Loop>& loops, const HolePatch& patch, std::uint32_t of_patch, FacetMark mark, RepairKind kind,
               double size) {
  std::vector<std::uint32_t> number;
  std::set<std::array<std::uint32_t, 2>> along;
  for (const Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) along.insert({loop[i], loop[(i + 1) % loop.size()]});
    number.insert(number.end(), loop.begin(), loop.end());
  }
  for (const Vec3& p : patch.points) {
    number.push_back(static_cast<std::uint32_t>(state.points.size()));
    state.points.push_back(p);
  }
  std::int64_t balance = 0;
  for (const auto& t : patch.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      balance += along.count({number[t[k]], number[t[(k + 1) % 3]]}) ? 1 : 0;
      balance -= along.count({number[t[(k + 1) % 3]], number[t[k]]}) ? 1 : 0;
    }
  std::vector<std::uint32_t> added;
  for (const auto& t : patch.triangles) {
    added.push_back(static_cast<std::uint32_t>(state.facets.size()));
    Facet facet{number[t[0]], number[t[1]], number[t[2]]};
    if (balance < 0) std::swap(facet[1], facet[2]);
    state.add(facet, {of_patch, mark, true});
  }
  if (mark != FacetMark::cap) state.note(kind, added, size);
}

/// Returns true if the filling runs along all loops. This requires that nested loops alternate in direction, so that the area between them can be filled.
bool runs_along(const std::vector<Loop>& loops, const HolePatch& patch) {
  std::vector<std::uint32_t> next;
  for (const Loop& loop : loops) {
    const auto first = static_cast<std::uint32_t>(next.size());
    for (std::uint32_t i = 0; i < loop.size(); ++i) next.push_back(first + (i + 1) % static_cast<std::uint32_t>(loop.size()));
  }
  std::int64_t n_along = 0, n_against = 0;
  for (const auto& t : patch.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      n_along += t[k] < next.size() && next[t[k]] == t[(k + 1) % 3];
      n_against += t[(k + 1) % 3] < next.size() && next[t[(k + 1) % 3]] == t[k];
    }
  return n_against == 0 || n_along == 0;
}

bool fill_one(RepairState& state, const Fans& fans, const Loop& loop, const HoleShape& shape, FacetMark mark, RepairKind kind) {
  HolePatch patch;
  if (loop.size() == 3) patch.triangles.push_back({0, 1, 2});
  else if (shape.off <= k_flat_border * shape.diameter || mark == FacetMark::cap) patch = fill_flat(points_of(state, {loop}), shape.normal);
  if (patch.triangles.empty())
    patch = fill_curved(hole_border_of(state, fans, loop), loop.size() > k_smooth_edges && kind == RepairKind::filled && mark != FacetMark::cap);
  if (patch.triangles.empty()) return false;
  add_patch(state, {loop}, patch, patch_around(state, fans, loop), mark, kind, shape.diameter);
  return true;
}

double opening_area(const RepairState& state, const Loop& loop) {
  Vec3 sum;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += 0.5 * cross(state.points[loop[i]] - state.points[loop[0]], state.points[loop[(i + 1) % loop.size()]] - state.points[loop[0]]);
  return norm(sum);
}

double area_of(const RepairState& state) {
  double area = 0.0;
  for (std::size_t t = 0; t < state.facets.size(); ++t) {
    const auto c = state.corners(t);
    area += triangle_area(c[0], c[1], c[2]);
  }
  return area;
}

struct HalfPlane {
  std::size_t axis = 0;
  double at = 0.0, off = 0.0;
  bool is_above = true;
  double share = 0.0;  ///< fraction of the box that the opening spans
  std::vector<std::size_t> loops;
};

/// Returns all loops near one end of the box on this axis, if they form the opening of a half model.
std::optional<HalfPlane> find_half(const RepairState& state, const std::vector<Loop>& loops, std::size_t axis, bool is_low, bool is_requested,
                                   double tolerance) {
  Box box;
  for (const Facet& f : state.facets)
    for (const std::uint32_t v : f) box.add(state.points[v]);
  const double end = is_low ? box.min[axis] : box.max[axis];
  HalfPlane plane{.axis = axis, .at = 0.0, .off = 0.0, .is_above = is_low, .share = 0.0, .loops = {}};
  Box opening;
  double sum = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Box border;
    for (const std::uint32_t v : loops[i]) border.add(state.points[v]);
    if (border.max[axis] - border.min[axis] > 2.0 * tolerance || std::abs(border.center()[axis] - end) > 2.0 * tolerance) continue;
    plane.loops.push_back(i);
    opening.add(border);
    for (const std::uint32_t v : loops[i]) {
      sum += state.points[v][axis];
      ++n;
    }
  }
  if (n == 0) return std::nullopt;
  plane.at = opening.min[axis] == opening.max[axis] ? opening.min[axis] : sum / static_cast<double>(n);
  if (std::abs(plane.at) <= tolerance) plane.at = 0.0;
  plane.off = std::max(std::abs(opening.min[axis] - plane.at), std::abs(opening.max[axis] - plane.at));
  if (plane.off > tolerance || std::abs(end - plane.at) > tolerance) return std::nullopt;
  double widest = 0.0, body = 0.0;
  for (std::size_t other = 0; other < 3; ++other) {
    if (other == axis) continue;
    widest = std::max(widest, opening.max[other] - opening.min[other]);
    body = std::max(body, box.max[other] - box.min[other]);
  }
  plane.share = widest / body;
  // A closed end with a hole is no half model. For a half model the facets in the plane must cover less than the opening.
  double covered = 0.0;
  for (const Facet& f : state.facets) {
    const bool is_in_plane = std::all_of(f.begin(), f.end(), [&](std::uint32_t v) { return std::abs(state.points[v][axis] - plane.at) <= tolerance; });
    if (is_in_plane) covered += triangle_area(state.points[f[0]], state.points[f[1]], state.points[f[2]]);
  }
  double open = 0.0;
  for (const std::size_t i : plane.loops) open += opening_area(state, loops[i]);
  if (!is_requested && open > k_sheet_share * area_of(state)) return std::nullopt;
  if (!is_requested && covered > k_covered_share * open) return std::nullopt;
  if (!is_requested && plane.share < (plane.at == 0.0 ? k_origin_half : k_full_half)) return std::nullopt;
  return plane;
}

/// Finds loops of a half model that leave its plane and return to it, because the base is open, too. Closes each such part by a line between its ends, and
/// fills it.
void close_ways_out(RepairState& state, const RepairOptions& options) {
  const double tolerance = options.half_tolerance * state.length;
  const std::vector<Loop> loops = find_loops(state);
  const Fans fans = fans_of(state);
  Box box;
  for (const Facet& f : state.facets)
    for (const std::uint32_t v : f) box.add(state.points[v]);
  const double area = area_of(state);
  for (const Loop& loop : loops) {
    if (opening_area(state, loop) > k_sheet_share * area) continue;
    for (const std::size_t axis : {1u, 2u, 0u}) {
      if (options.half != "automatic" && options.half != std::string(1, "xyz"[axis])) continue;
      bool is_done = false;
      for (const double end : {box.min[axis], box.max[axis]}) {
        const auto is_in = [&](std::uint32_t v) { return std::abs(state.points[v][axis] - end) <= 2.0 * tolerance; };
        const auto n_in = static_cast<std::size_t>(std::count_if(loop.begin(), loop.end(), is_in));
        if (n_in == loop.size() || static_cast<double>(n_in) < k_in_plane_share * static_cast<double>(loop.size())) continue;
        const auto first_in = static_cast<std::size_t>(std::find_if(loop.begin(), loop.end(), is_in) - loop.begin());
        Loop way;
        for (std::size_t i = 0; i <= loop.size(); ++i) {
          const std::uint32_t v = loop[(first_in + i) % loop.size()];
          if (!is_in(v)) {
            if (way.empty()) way.push_back(loop[(first_in + i + loop.size() - 1) % loop.size()]);
            way.push_back(v);
          } else if (!way.empty()) {
            way.push_back(v);
            const HoleShape shape = shape_of(state, way);
            const bool is_flat = shape.off <= k_flat_border * shape.diameter;
            if (way.size() > 2 && shape.diameter <= (is_flat ? options.flat_hole : options.hole) * state.length)
              is_done |= fill_one(state, fans, way, shape, FacetMark::filled, RepairKind::filled);
            way.clear();
          }
        }
        if (is_done) break;
      }
      if (is_done) break;
    }
  }
}

}  // namespace

void cap_half(RepairState& state, const RepairOptions& options) {
  if (options.half == "off") return;
  close_ways_out(state, options);
  const std::vector<Loop> loops = find_loops(state);
  const double tolerance = options.half_tolerance * state.length;
  std::optional<HalfPlane> best;
  for (const std::size_t axis : {1u, 2u, 0u}) {  // y first, because it is normal to the usual symmetry plane of aircraft
    const bool is_requested = options.half == std::string(1, "xyz"[axis]);
    if (options.half != "automatic" && !is_requested) continue;
    for (const bool is_low : {true, false}) {
      const auto plane = find_half(state, loops, axis, is_low, is_requested, tolerance);
      if (plane && (!best || plane->share > best->share)) best = plane;
    }
  }
  if (!best) return;
  // Tubes that are open at both ends are no half models.
  if (options.half == "automatic" && find_half(state, loops, best->axis, !best->is_above, false, tolerance)) return;
  std::vector<char> is_border(state.points.size(), 0);
  HalfOpening half{std::string(1, "xyz"[best->axis]), best->at, best->is_above, best->off, 0};
  for (const std::size_t i : best->loops)
    for (const std::uint32_t v : loops[i]) {
      is_border[v] = 1;
      ++half.n_vertices;
    }
  std::vector<std::uint32_t> moved;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const std::uint32_t v : state.facets[t])
      if (is_border[v] && state.points[v][best->axis] != best->at && (moved.empty() || moved.back() != t)) moved.push_back(t);
  for (std::uint32_t v = 0; v < is_border.size(); ++v)
    if (is_border[v]) state.points[v][best->axis] = best->at;
  for (const std::uint32_t t : moved) state.info[t].is_touched = true;
  state.note(RepairKind::into_plane, moved, best->off);
  // Facets in the plane belong to the opening and are removed.
  std::vector<char> is_kept(state.facets.size(), 1), is_flat(state.facets.size(), 0);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    const Facet& f = state.facets[t];
    is_flat[t] = is_border[f[0]] && is_border[f[1]] && is_border[f[2]];
    is_kept[t] = !is_flat[t];
  }
  state.note_parts(RepairKind::removed_sheet, is_flat, state.edges());
  state.keep(is_kept);

  std::vector<Loop> borders;
  for (Loop& loop : find_loops(state)) {
    const bool is_in_plane = std::all_of(loop.begin(), loop.end(), [&](std::uint32_t v) { return state.points[v][best->axis] == best->at; });
    if (is_in_plane) borders.push_back(std::move(loop));
  }
  Vec3 normal;
  normal[best->axis] = best->is_above ? -1.0 : 1.0;
  const Fans fans = fans_of(state);
  const HolePatch patch = fill_flat(points_of(state, borders), normal);
  if (!patch.triangles.empty()) add_patch(state, borders, patch, patch_around(state, fans, borders.front()), FacetMark::cap, RepairKind::filled, 0.0);
  else
    for (const Loop& loop : borders) fill_one(state, fans, loop, shape_of(state, loop), FacetMark::cap, RepairKind::filled);
  state.report.half = half;
}

std::size_t fill_holes(RepairState& state, const RepairOptions& options, RepairKind kind, const RunContext& context) {
  std::vector<Loop> loops = find_loops(state);
  if (loops.empty()) return 0;
  const Fans fans = fans_of(state);
  const EdgeTable edges = state.edges();
  const Parts parts = connected_parts(state.facets.size(), edges);
  std::vector<HoleShape> shapes;
  for (const Loop& loop : loops) shapes.push_back(shape_of(state, loop));
  std::size_t n_open = 0;
  std::vector<char> is_done(loops.size(), 0);
  std::vector<double> part_area(parts.count, 0.0);
  double all_area = 0.0;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    const auto c = state.corners(t);
    part_area[parts.part[t]] += triangle_area(c[0], c[1], c[2]);
    all_area += triangle_area(c[0], c[1], c[2]);
  }
  std::vector<char> is_sheet(parts.count, 0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    context.progress(static_cast<double>(i) / static_cast<double>(loops.size()));
    if (is_done[i]) continue;
    is_done[i] = 1;
    const HoleShape& shape = shapes[i];
    const bool is_flat = shape.off <= k_flat_border * shape.diameter;
    const double limit = (is_flat ? options.flat_hole : options.hole) * state.length;
    if (loops[i].size() < 3 || shape.diameter > limit || loops[i].size() > static_cast<std::size_t>(options.hole_edges)) {
      ++n_open;
      context.debug("repair: a hole of " + std::to_string(loops[i].size()) + " edges, " + short_number(shape.diameter) + " m across (" +
                    short_number(shape.diameter / state.length) + " body lengths, its border " + short_number(shape.off) + " m off its plane) near " +
                    format_point(shape.center) + " exceeds the limits");
      continue;
    }
    const std::uint32_t its_part = fans[loops[i][0]].empty() ? 0 : parts.part[fans[loops[i][0]][0]];
    if (kind == RepairKind::filled && opening_area(state, loops[i]) > k_sheet_share * part_area[its_part]) {
      // The filling would be as large as the part itself, so the part is not a body but a baffle.
      if (part_area[its_part] < 0.5 * all_area) is_sheet[its_part] = 1;
      else ++n_open;
      continue;
    }
    if (is_flat) {
      // The other loops in this plane and of this part are filled together with this loop, so that a ring is filled as one.
      std::vector<Loop> group{loops[i]};
      std::vector<std::size_t> members;
      for (std::size_t j = i + 1; j < loops.size(); ++j) {
        if (is_done[j] || fans[loops[j][0]].empty() || parts.part[fans[loops[j][0]][0]] != its_part) continue;
        if (std::abs(dot(shapes[j].normal, shape.normal)) < 1.0 - 1e-6) continue;
        if (std::abs(dot(shapes[j].center - shape.center, shape.normal)) > k_same_plane * state.length + shape.off ||
            shapes[j].off > k_flat_border * shapes[j].diameter)
          continue;
        if (shapes[j].diameter > options.flat_hole * state.length) continue;
        group.push_back(loops[j]);
        members.push_back(j);
      }
      if (!members.empty()) {
        const HolePatch patch = fill_flat(points_of(state, group), shape.normal);
        if (!patch.triangles.empty() && runs_along(group, patch)) {
          for (const std::size_t j : members) is_done[j] = 1;
          add_patch(state, group, patch, patch_around(state, fans, loops[i]), FacetMark::filled, kind, shape.diameter);
          continue;
        }
      }
    }
    if (!fill_one(state, fans, loops[i], shape, FacetMark::filled, kind)) ++n_open;
  }
  std::vector<char> is_of_sheet(state.facets.size(), 0), is_kept(state.facets.size(), 1);
  for (std::uint32_t t = 0; t < parts.part.size(); ++t) {
    is_of_sheet[t] = is_sheet[parts.part[t]];
    is_kept[t] = !is_of_sheet[t];
  }
  state.note_parts(RepairKind::removed_sheet, is_of_sheet, state.edges());
  state.keep(is_kept);
  return n_open;
}

}  // namespace sterna::surfmesh
