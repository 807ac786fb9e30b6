#include "surfmesh/model/own_seam.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geom/base/error.h"
#include "geom/math/predicates.h"

namespace sterna::surfmesh {
namespace {

/// Relative to the greater of du and dv: a surface has a pole where its speed along the period is smaller than this.
constexpr double k_pole_speed = 1e-6;
/// Number of locations along a seam at which sizes are evaluated.
constexpr std::size_t k_seam_samples = 128;
/// Largest number of locations at which a start of the seam is tried.
constexpr std::size_t k_most_starts = 64;

[[noreturn]] void fail(const Surface& surface, const std::string& problem, const Point& location) {
  throw Error({.code = ErrorCode::geometry_failed,
               .attempted = "meshing a face",
               .problem = problem + " (" + surface.kind() + ")",
               .locations = {{location, "border of the face"}},
               .hint = "split the face along a line between its borders in CAD"});
}

struct Loop {
  std::vector<BorderPoint> points;
  std::vector<VertexId> ids;
  std::vector<EdgeId> edges;
  Uv around;  ///< whole periods between the start and the end of the loop; zero if the loop closes
};

bool do_cross(Uv a, Uv b, Uv c, Uv d) {
  const auto side = [](Uv p, Uv q, Uv r) { return orient2d({p.u, p.v}, {q.u, q.v}, {r.u, r.v}); };
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

/// Returns true if a straight seam touches no loop in any period, except at its own ends.
bool is_clear(Uv from, Uv to, const std::vector<Loop>& loops, Uv period) {
  for (const Loop& loop : loops)
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      const bool is_last = i + 1 == loop.points.size();
      const Uv a = loop.points[i].uv, b = is_last ? loop.points.front().uv + loop.around : loop.points[i + 1].uv;
      for (int k = -2; k <= 2; ++k) {
        const Uv p = a + static_cast<double>(k) * period, q = b + static_cast<double>(k) * period;
        if (p == from || p == to || q == from || q == to) continue;
        if (do_cross(from, to, p, q)) return false;
      }
    }
  return true;
}

/// Returns the points of the loop from the `start`-th on, moved by `shift`. The first point is repeated at the end, moved by the period around which the loop
/// runs, so there are n + 1 points.
Loop unrolled(const Loop& loop, std::size_t start, Uv shift) {
  Loop result;
  const std::size_t n = loop.points.size();
  for (std::size_t k = 0; k <= n; ++k) {
    const std::size_t i = (start + k) % n;
    BorderPoint p = loop.points[i];
    p.uv = p.uv + shift + (start + k >= n ? loop.around : Uv{});
    result.points.push_back(p);
    result.ids.push_back(loop.ids[i]);
    result.edges.push_back(loop.edges[i]);
  }
  return result;
}

/// Returns locations between the ends of a seam. Their distances are equal when measured in sizes.
std::vector<Uv> cut_seam(const Surface& surface, const std::function<double(Uv, const Point&)>& size, Uv from, Uv to) {
  std::vector<double> metric{0.0};
  Point before = surface.point(from);
  for (std::size_t i = 1; i <= k_seam_samples; ++i) {
    const Uv at = from + static_cast<double>(i) / k_seam_samples * (to - from);
    const Point here = surface.point(at);
    metric.push_back(metric.back() + distance(before, here) / size(at, here));
    before = here;
  }
  const auto n = static_cast<std::size_t>(std::max(1.0, std::round(metric.back())));
  std::vector<Uv> cuts;
  std::size_t i = 0;
  for (std::size_t k = 1; k < n; ++k) {
    const double target = metric.back() * static_cast<double>(k) / static_cast<double>(n);
    while (i + 2 < metric.size() && metric[i + 1] < target) ++i;
    const double step = metric[i + 1] - metric[i], share = step > 0.0 ? (target - metric[i]) / step : 0.5;
    cuts.push_back(from + (static_cast<double>(i) + share) / k_seam_samples * (to - from));
  }
  return cuts;
}

bool is_inside(const std::vector<BorderPoint>& polygon, Uv at) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Uv &a = polygon[i].uv, &b = polygon[(i + 1) % polygon.size()].uv;
    if ((a.u <= at.u) != (b.u <= at.u) && a.v + (at.u - a.u) / (b.u - a.u) * (b.v - a.v) > at.v) inside = !inside;
  }
  return inside;
}

struct Seam {
  std::size_t start = 0;        ///< position of the start on the first loop
  std::size_t other_start = 0;  ///< position of the end on the second loop, if there is one
  Uv from, to;
};

/// Returns the location on the other loop whose parameter along the period is nearest to that of `from`.
std::optional<Seam> find_seam(const std::vector<Loop>& loops, const Loop& first, const Loop* second, double pole, Uv period) {
  const bool is_along_u = period.u != 0.0;
  const double length = is_along_u ? period.u : period.v;
  const std::size_t step = std::max<std::size_t>(1, first.points.size() / k_most_starts);
  for (std::size_t i = 0; i < first.points.size(); i += step) {
    const Uv from = first.points[i].uv;
    if (second == nullptr) {
      const Uv to = is_along_u ? Uv{from.u, pole} : Uv{pole, from.v};
      if (is_clear(from, to, loops, period)) return Seam{i, 0, from, to};
      continue;
    }
    Seam seam{i, 0, from, {}};
    double best = std::abs(length);
    for (std::size_t j = 0; j < second->points.size(); ++j) {
      const Uv at = second->points[j].uv;
      const double away = is_along_u ? from.u - at.u : from.v - at.v, periods = std::round(away / length);
      if (std::abs(away - periods * length) >= best) continue;
      best = std::abs(away - periods * length);
      seam.other_start = j;
      seam.to = at + periods * period;
    }
    if (is_clear(seam.from, seam.to, loops, period)) return seam;
  }
  return std::nullopt;
}

/// Returns the loops of a border, each with the periods around which it runs.
std::vector<Loop> border_loops(const Surface& surface, const LabelledBorder& labelled) {
  const ParameterBox domain = surface.domain();
  std::vector<Loop> loops;
  std::size_t n = 0;
  for (std::size_t l = 0; l < labelled.border.loops.size(); ++l) {
    Loop loop{labelled.border.loops[l], {}, {}, {}};
    const Uv open = labelled.loop_ends[l] - loop.points.front().uv;
    if (surface.is_periodic_u()) loop.around.u = std::round(open.u / domain.u.length()) * domain.u.length();
    if (surface.is_periodic_v()) loop.around.v = std::round(open.v / domain.v.length()) * domain.v.length();
    for (std::size_t i = 0; i < loop.points.size(); ++i, ++n) {
      loop.ids.push_back(labelled.ids[n]);
      loop.edges.push_back(labelled.edges[n]);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// The loops that run around the period of the surface: one, if the face contains a pole, or two.
struct LoopsAround {
  const Loop& first;
  const Loop* second;  ///< null: there is none
  Uv period;
  double pole;  ///< parameter of the pole, or of the end of the surface on the left of the first loop

  bool is_along_u() const { return period.u != 0.0; }
};

/// \param around numbers of the loops that run around the period
LoopsAround loops_around(const Surface& surface, const std::vector<Loop>& loops, const std::vector<std::size_t>& around) {
  const Loop& first = loops[around[0]];
  const Loop* second = around.size() > 1 ? &loops[around[1]] : nullptr;
  const Uv period = first.around;
  const Point location = first.points.front().point;
  if (around.size() > 2 || (period.u != 0.0 && period.v != 0.0))
    fail(surface, "the borders run around the face " + std::to_string(around.size()) + " times, or around both periods of the surface", location);
  if (second != nullptr && !(second->around + period == Uv{}))
    fail(surface, "two borders run around the period of the surface in the same direction", location);
  // The face lies to the left of the loop: at greater v of a loop along +u, at smaller u of a loop along +v.
  const ParameterBox domain = surface.domain();
  const double pole = period.u != 0.0 ? (period.u > 0.0 ? domain.v.to : domain.v.from) : (period.v > 0.0 ? domain.u.from : domain.u.to);
  return {first, second, period, pole};
}

/// \throws Error if a single loop has no pole on its left
void require_pole(const Surface& surface, const LoopsAround& loops) {
  if (loops.second != nullptr) return;
  const BorderPoint& start = loops.first.points.front();
  const SurfaceDerivatives d = surface.derivatives(loops.is_along_u() ? Uv{start.uv.u, loops.pole} : Uv{loops.pole, start.uv.v});
  const double along = loops.is_along_u() ? norm(d.du) : norm(d.dv), across = loops.is_along_u() ? norm(d.dv) : norm(d.du);
  if (!(along <= k_pole_speed * across))
    fail(surface, "one border runs around the period of the surface, and the surface has no pole on the left of the border", start.point);
}

/// Returns the loop along the first loop, the seam, the second loop or the pole, and the seam backwards. Adds the pairs of points on the seam to `pairs`.
Loop joined_loop(const Surface& surface, const LoopsAround& loops, const Seam& seam, const std::vector<Uv>& cuts,
                 std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  Loop joined = unrolled(loops.first, seam.start, {});
  const auto add_free = [&](Uv uv, Uv at) {
    joined.points.push_back({uv, surface.point(at)});
    joined.ids.push_back({});
    joined.edges.push_back({});
  };
  const auto n_first = static_cast<std::uint32_t>(joined.points.size());
  for (const Uv& at : cuts) add_free(at + loops.period, at);
  auto back = static_cast<std::uint32_t>(joined.points.size());
  if (loops.second != nullptr) {
    const Loop other = unrolled(*loops.second, seam.other_start, seam.to - loops.second->points[seam.other_start].uv + loops.period);
    joined.points.insert(joined.points.end(), other.points.begin(), other.points.end());
    joined.ids.insert(joined.ids.end(), other.ids.begin(), other.ids.end());
    joined.edges.insert(joined.edges.end(), other.edges.begin(), other.edges.end());
    back = static_cast<std::uint32_t>(joined.points.size());
  } else {
    add_free(seam.to + loops.period, seam.to);
    add_free(seam.to, seam.to);
    pairs.emplace_back(back, back + 1);
    back += 2;
  }
  for (std::size_t k = cuts.size(); k-- > 0;) add_free(cuts[k], cuts[k]);
  for (std::uint32_t k = 0; k < cuts.size(); ++k) pairs.emplace_back(n_first + k, back + static_cast<std::uint32_t>(cuts.size()) - 1 - k);
  return joined;
}

/// Moves a loop by whole periods into the outer loop.
void move_into(const std::vector<BorderPoint>& outer, Uv period, Loop& loop) {
  for (const int k : {0, 1, -1, 2, -2}) {
    const Uv shift = static_cast<double>(k) * period;
    if (!is_inside(outer, loop.points.front().uv + shift)) continue;
    for (BorderPoint& p : loop.points) p.uv = p.uv + shift;
    break;
  }
}

void append_loop(Loop loop, LabelledBorder& labelled) {
  labelled.loop_ends.push_back(loop.points.front().uv);
  labelled.ids.insert(labelled.ids.end(), loop.ids.begin(), loop.ids.end());
  labelled.edges.insert(labelled.edges.end(), loop.edges.begin(), loop.edges.end());
  labelled.border.loops.push_back(std::move(loop.points));
}

}  // namespace

void add_own_seam(const Surface& surface, const std::function<double(Uv, const Point&)>& size, LabelledBorder& labelled) {
  std::vector<Loop> loops = border_loops(surface, labelled);
  std::vector<std::size_t> around;
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (!(loops[l].around == Uv{})) around.push_back(l);
  if (around.empty()) return;
  const LoopsAround joining = loops_around(surface, loops, around);
  require_pole(surface, joining);
  const std::optional<Seam> seam = find_seam(loops, joining.first, joining.second, joining.pole, joining.period);
  if (!seam) fail(surface, "no straight line in (u, v) joins the two borders that run around the period of the surface", joining.first.points.front().point);
  LabelledBorder result;
  Loop joined = joined_loop(surface, joining, *seam, cut_seam(surface, size, seam->from, seam->to), result.seam);
  const std::vector<BorderPoint> outer = joined.points;
  append_loop(std::move(joined), result);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (std::find(around.begin(), around.end(), l) != around.end()) continue;
    move_into(outer, joining.period, loops[l]);
    append_loop(std::move(loops[l]), result);
  }
  labelled = std::move(result);
}

void free_own_seam(LabelledBorder& labelled, FaceMesh& mesh) {
  if (labelled.seam.empty()) return;
  Column<VertexId, VertexId> same_as(mesh.points.size());
  for (const VertexId v : same_as.ids()) same_as[v] = v;
  for (const auto& [kept, gone] : labelled.seam) same_as[VertexId(gone)] = VertexId(kept);
  // First the border points of the model in their order, then those of the seam, then the inner vertices.
  std::vector<VertexId> order;
  LabelledBorder left;
  for (std::uint32_t i = 0; i < mesh.n_border; ++i) {
    if (!labelled.ids[i].is_valid()) continue;
    order.push_back(VertexId(i));
    left.ids.push_back(labelled.ids[i]);
    left.edges.push_back(labelled.edges[i]);
  }
  const auto n_border = static_cast<std::uint32_t>(order.size());
  for (const VertexId v : same_as.ids())
    if (same_as[v] == v && (v.value() >= mesh.n_border || !labelled.ids[v.index()].is_valid())) order.push_back(v);
  Column<VertexId, VertexId> number(mesh.points.size());
  FaceMesh result;
  result.n_border = n_border;
  result.report = mesh.report;
  for (const VertexId v : order) {
    number[v] = VertexId(static_cast<std::uint64_t>(result.points.size()));
    result.points.push_back(mesh.points[v.index()]);
    result.uv.push_back(mesh.uv[v.index()]);
    result.normals.push_back(mesh.normals[v.index()]);
  }
  for (TriangleVertices triangle : mesh.triangles) {
    for (VertexId& v : triangle) v = number[same_as[v]];
    result.triangles.push_back(triangle);
  }
  mesh = std::move(result);
  labelled.ids = std::move(left.ids);
  labelled.edges = std::move(left.edges);
}

}  // namespace sterna::surfmesh
