// Minimises half the squared distance f(u, v) = |S(u, v) - p|^2 / 2 in a box by Newton's method. Variables at a limit towards which the gradient points are
// held. The eigenvalues of an indefinite Hessian are replaced by their absolute values. Steps are halved until f decreases. Cells of samples, spaced by length
// and turning of the surface, give start values and lower bounds of the distance for branch and bound.
#include "geom/model/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <tuple>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"

namespace sterna {
namespace {

/// A Newton step shorter than this fraction of the extent is the last one: the remaining error is about the square of the step.
constexpr double k_last_step = 1e-7;
/// A step shorter than this fraction of the extent is rounding.
constexpr double k_no_step = 1e-15;
constexpr int k_max_steps = 60;
constexpr int k_max_halvings = 30;
/// Longest step as a fraction of the box: farther away the second derivatives are not valid.
constexpr double k_longest_step = 0.3;
/// Determinant of the Hessian relative to the product of its diagonal below which it counts as singular.
constexpr double k_singular = 1e-10;
/// Smallest trusted eigenvalue of the Hessian per metre squared; a flat surface has 1.
constexpr double k_flattest = 1e-8;
/// A speed lower than this fraction of the mean speed indicates a pole.
constexpr double k_pole_speed = 1e-7;
/// Largest turning of the surface between stations, radians, and the number of intervals for the length alone.
constexpr double k_turning = 0.35;
constexpr int k_intervals_by_length = 8;
constexpr int k_max_intervals = 128;
/// Number of fine samples along each line, and of lines in each direction, from which stations are computed.
constexpr int k_fine_samples = 256;
constexpr int k_fine_lines = 5;
/// Fraction of a cell's size by which the surface may leave its samples. (With 3 x 3 samples and a turning below 0.35 the sag is below 0.1.)
constexpr double k_cell_margin = 0.15;
/// Number of directions tried at a pole.
constexpr int k_pole_directions = 12;
/// Golden section steps for the best direction, which give 1e-8 of the spacing of directions.
constexpr int k_pole_sections = 40;
constexpr double k_golden = 0.6180339887498949;

void check_range(Interval range) {
  if (!std::isfinite(range.from) || !std::isfinite(range.to) || !(range.from < range.to))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "preparing a projection",
                 .problem = "the parameter range [" + number_text(range.from) + ", " + number_text(range.to) + "] has no length"});
}

double inside(double t, Interval range, bool wraps) {
  if (wraps && !range.contains(t)) t -= range.length() * std::floor((t - range.from) / range.length());
  return std::clamp(t, range.from, range.to);
}

bool is_whole_period(Interval range, Interval domain, bool is_periodic) { return is_periodic && range.length() >= domain.length() * (1.0 - 1e-12); }

/// Returns the accumulated fraction of length and turning of polylines over `fine`. In each interval the largest increment of all lines counts.
std::vector<double> stations_of(const std::vector<double>& fine, const std::vector<std::vector<Point>>& lines) {
  std::vector<double> density(fine.size() - 1, 0.0);
  for (const std::vector<Point>& line : lines) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) length += distance(line[i], line[i + 1]);
    if (!(length > 0.0)) continue;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Vec3 step = line[i + 1] - line[i];
      const double before = i > 0 ? angle_between(line[i] - line[i - 1], step) : 0.0;
      const double after = i + 2 < line.size() ? angle_between(step, line[i + 2] - line[i + 1]) : 0.0;
      density[i] = std::max(density[i], k_intervals_by_length * norm(step) / length + 0.5 * (before + after) / k_turning);
    }
  }
  std::vector<double> sum(fine.size(), 0.0);
  for (std::size_t i = 0; i < density.size(); ++i) sum[i + 1] = sum[i] + density[i] + 1e-3;
  const int n = std::clamp(static_cast<int>(std::ceil(sum.back())), k_intervals_by_length, k_max_intervals);
  std::vector<double> stations{fine.front()};
  std::size_t i = 0;
  for (int k = 1; k < n; ++k) {
    const double target = sum.back() * k / n;
    while (sum[i + 1] < target) ++i;
    stations.push_back(fine[i] + (fine[i + 1] - fine[i]) * (target - sum[i]) / (sum[i + 1] - sum[i]));
  }
  stations.push_back(fine.back());
  return stations;
}

std::vector<double> even(Interval range, int n) {
  std::vector<double> result;
  for (int i = 0; i < n; ++i) result.push_back(range.from + range.length() * i / n);
  result.push_back(range.to);
  return result;
}

std::array<std::vector<double>, 2> stations_of(const Surface& surface, const ParameterBox& box) {
  const std::vector<double> fine_u = even(box.u, k_fine_samples), fine_v = even(box.v, k_fine_samples);
  std::vector<std::vector<Point>> along_u, along_v;
  std::vector<Uv> at(fine_u.size());
  for (int k = 0; k < k_fine_lines; ++k) {
    const double share = k / (k_fine_lines - 1.0);
    std::vector<Point> line(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = {fine_u[i], box.v.from + share * box.v.length()};
    surface.points(at, line);
    along_u.push_back(line);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = {box.u.from + share * box.u.length(), fine_v[i]};
    surface.points(at, line);
    along_v.push_back(line);
  }
  return {stations_of(fine_u, along_u), stations_of(fine_v, along_v)};
}

double distance_to(const Box& box, const Point& p) {
  Vec3 gap;
  for (std::size_t a = 0; a < 3; ++a) gap[a] = std::max({box.min[a] - p[a], 0.0, p[a] - box.max[a]});
  return norm(gap);
}

struct Cells {
  std::vector<Point> middles;
  std::vector<Box> boxes;
};

Cells cells_of(const Surface& surface, const std::vector<double>& stations_u, const std::vector<double>& stations_v) {
  // Stations and the middles between them.
  const auto doubled = [](const std::vector<double>& s) {
    std::vector<double> result;
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
      result.push_back(s[i]);
      result.push_back(0.5 * (s[i] + s[i + 1]));
    }
    result.push_back(s.back());
    return result;
  };
  const std::vector<double> u = doubled(stations_u), v = doubled(stations_v);
  std::vector<Uv> at;
  for (const double a : u)
    for (const double b : v) at.push_back({a, b});
  std::vector<Point> points(at.size());
  surface.points(at, points);
  Cells cells;
  for (std::size_t i = 0; i + 2 < u.size(); i += 2) {
    for (std::size_t j = 0; j + 2 < v.size(); j += 2) {
      Box box;
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) box.add(points[(i + a) * v.size() + j + b]);
      const double margin = k_cell_margin * distance(box.min, box.max);
      box.min -= {margin, margin, margin};
      box.max += {margin, margin, margin};
      cells.boxes.push_back(box);
      cells.middles.push_back(points[(i + 1) * v.size() + j + 1]);
    }
  }
  return cells;
}

/// Replaces the eigenvalues of the Hessian [a b; b c] by their absolute values, so that steps leave saddles and maxima downhill. The Hessian is scaled to
/// metres in both directions.
void make_definite(double speed_u, double speed_v, double& a, double& b, double& c) {
  const double hu = speed_u > 0.0 ? speed_u : 1.0, hv = speed_v > 0.0 ? speed_v : 1.0;
  const double p = a / (hu * hu), q = b / (hu * hv), r = c / (hv * hv);
  const double mean = 0.5 * (p + r), half = 0.5 * (p - r), radius = std::hypot(half, q);
  const double large = std::max(std::abs(mean + radius), k_flattest), small = std::max(std::abs(mean - radius), k_flattest);
  const double cosine = radius > 0.0 ? half / radius : 1.0,
               sine = radius > 0.0 ? q / radius : 0.0;  // cosine and sine of twice the angle to the first eigenvector
  a = (0.5 * (large + small) + 0.5 * (large - small) * cosine) * hu * hu;
  b = 0.5 * (large - small) * sine * hu * hv;
  c = (0.5 * (large + small) - 0.5 * (large - small) * cosine) * hv * hv;
}

}  // namespace

SurfaceProjector::SurfaceProjector(SurfacePtr surface) : SurfaceProjector(surface, surface->domain()) {}

SurfaceProjector::SurfaceProjector(SurfacePtr surface, const ParameterBox& box)
    : surface_(std::move(surface)), box_(box), cells_({}, RunContext({.threads = 1})) {
  check_range(box.u);
  check_range(box.v);
  const ParameterBox all = surface_->domain();
  wraps_u_ = is_whole_period(box.u, all.u, surface_->is_periodic_u());
  wraps_v_ = is_whole_period(box.v, all.v, surface_->is_periodic_v());
  std::array<std::vector<double>, 2> stations = stations_of(*surface_, box_);
  stations_u_ = std::move(stations[0]);
  stations_v_ = std::move(stations[1]);
  Cells cells = cells_of(*surface_, stations_u_, stations_v_);
  Box whole;
  for (const Box& b : cells.boxes) whole.add(b);
  extent_ = std::max(distance(whole.min, whole.max), std::numeric_limits<double>::min());
  middles_ = std::move(cells.middles);
  cells_ = BoxTree(cells.boxes, RunContext({.threads = 1}));
}

void SurfaceProjector::move_inside(Uv& at) const {
  at.u = inside(at.u, box_.u, wraps_u_);
  at.v = inside(at.v, box_.v, wraps_v_);
}

SurfaceProjection SurfaceProjector::descend(const Point& p, Uv at) const {
  move_inside(at);
  SurfaceDerivatives d = surface_->derivatives(at);
  for (int step = 0; step < k_max_steps; ++step) {
    const Vec3 r = d.point - p;
    const double gu = dot(r, d.du), gv = dot(r, d.dv);
    const bool holds_u = !wraps_u_ && ((at.u <= box_.u.from && gu >= 0.0) || (at.u >= box_.u.to && gu <= 0.0));
    const bool holds_v = !wraps_v_ && ((at.v <= box_.v.from && gv >= 0.0) || (at.v >= box_.v.to && gv <= 0.0));
    if (holds_u && holds_v) break;
    const double uu = norm2(d.du), uv = dot(d.du, d.dv), vv = norm2(d.dv);
    double a = uu + dot(r, d.duu), b = uv + dot(r, d.duv), c = vv + dot(r, d.dvv);
    if (holds_u || holds_v) b = 0.0;
    bool is_newton = true;
    if ((!holds_u && !(a > 0.0)) || (!holds_v && !(c > 0.0)) || (!holds_u && !holds_v && !(a * c - b * b > k_singular * a * c))) {
      is_newton = false;
      make_definite(std::sqrt(uu), std::sqrt(vv), a, b, c);
    }
    double su = 0.0, sv = 0.0;
    if (holds_v) su = -gu / a;
    else if (holds_u) sv = -gv / c;
    else {
      const double determinant = a * c - b * b;
      su = (b * gv - c * gu) / determinant;
      sv = (b * gu - a * gv) / determinant;
    }
    if (!std::isfinite(su) || !std::isfinite(sv)) break;
    const double share = std::max(std::abs(su) / box_.u.length(), std::abs(sv) / box_.v.length());
    if (share > k_longest_step) {
      su *= k_longest_step / share;
      sv *= k_longest_step / share;
    }
    const double length = std::abs(su) * std::sqrt(uu) + std::abs(sv) * std::sqrt(vv);
    if (length <= k_no_step * extent_) break;
    if (is_newton && length <= k_last_step * extent_) {
      Uv last{at.u + su, at.v + sv};
      move_inside(last);
      const Point q = surface_->point(last);
      // Rounding of f hides gains below its own size, so this last step is accepted.
      if (distance(q, p) <= norm(r) * (1.0 + 1e-15) + k_no_step * extent_) return {last, q, distance(q, p)};
    }
    const double f = norm2(r);
    bool is_better = false;
    for (int halving = 0; halving < k_max_halvings && !is_better; ++halving, su *= 0.5, sv *= 0.5) {
      Uv next{at.u + su, at.v + sv};
      move_inside(next);
      const SurfaceDerivatives e = surface_->derivatives(next);
      if (norm2(e.point - p) < f) {
        is_better = true;
        at = next;
        d = e;
      }
    }
    if (!is_better) break;
  }
  return {at, d.point, distance(d.point, p)};
}

SurfaceProjection SurfaceProjector::leave_pole(const Point& p, const SurfaceProjection& projection) const {
  const SurfaceDerivatives d = surface_->derivatives(projection.at);
  const bool is_pole_u = norm(d.du) * box_.u.length() <= k_pole_speed * extent_;
  const bool is_pole_v = norm(d.dv) * box_.v.length() <= k_pole_speed * extent_;
  if (is_pole_u == is_pole_v) return projection;
  // The whole degenerate direction is one point: find the direction of steepest descent, and start slightly inside.
  const Interval along = is_pole_u ? box_.u : box_.v, across = is_pole_u ? box_.v : box_.u;
  const double at_pole = is_pole_u ? projection.at.v : projection.at.u;
  const double inward = at_pole - across.from < across.to - at_pole ? 1.0 : -1.0;
  const auto derivatives_at = [&](double t) {
    SurfaceDerivatives e = surface_->derivatives(is_pole_u ? Uv{t, at_pole} : Uv{at_pole, t});
    if (!is_pole_u) {
      std::swap(e.du, e.dv);
      std::swap(e.duu, e.dvv);
    }
    return e;
  };
  const auto slope = [&](double t) {
    const SurfaceDerivatives e = derivatives_at(t);
    return inward * dot(e.point - p, e.dv) / std::max(norm(e.dv), std::numeric_limits<double>::min());
  };
  double steepest = 0.0, best = along.from;
  for (int k = 0; k < k_pole_directions; ++k) {
    const double t = along.from + along.length() * (k + 0.5) / k_pole_directions;
    if (const double here = slope(t); here < steepest) {
      steepest = here;
      best = t;
    }
  }
  if (!(steepest < -k_no_step * extent_)) return projection;
  double low = std::max(along.from, best - along.length() / k_pole_directions), high = std::min(along.to, best + along.length() / k_pole_directions);
  for (int k = 0; k < k_pole_sections; ++k) {  // golden section
    const double a = high - k_golden * (high - low), b = low + k_golden * (high - low);
    (slope(a) < slope(b) ? high : low) = slope(a) < slope(b) ? b : a;
  }
  const double t = 0.5 * (low + high);
  const SurfaceDerivatives e = derivatives_at(t);
  const double curvature = norm2(e.dv) + dot(e.point - p, e.dvv);
  const double farthest = k_longest_step * across.length();
  const double reach = curvature > 0.0 ? std::min(farthest, -inward * dot(e.point - p, e.dv) / curvature) : farthest;
  const double inner = at_pole + inward * reach;
  const SurfaceProjection other = descend(p, is_pole_u ? Uv{t, inner} : Uv{inner, t});
  return other.distance < projection.distance ? other : projection;
}

SurfaceProjection SurfaceProjector::seeded(const Point& p, Uv seed) const {
  const SurfaceProjection projection = descend(p, seed);
  const bool is_at_limit = projection.at.u == box_.u.from || projection.at.u == box_.u.to || projection.at.v == box_.v.from || projection.at.v == box_.v.to;
  return is_at_limit ? leave_pole(p, projection) : projection;
}

SurfaceProjection SurfaceProjector::nearest(const Point& p) const {
  const std::span<const BoxTree::Node> nodes = cells_.nodes();
  const std::size_t n_v = stations_v_.size() - 1;
  const auto middle_uv = [&](std::uint32_t cell) {
    const std::size_t i = cell / n_v, j = cell % n_v;
    return Uv{0.5 * (stations_u_[i] + stations_u_[i + 1]), 0.5 * (stations_v_[j] + stations_v_[j + 1])};
  };
  // Entries are ordered by lower bound. They are nodes of the tree or, numbered after them, cells. Ties are resolved by number, so that the order is unique.
  struct Entry {
    double bound;
    std::uint32_t index;
    bool is_cell;
  };
  const auto later = [](const Entry& a, const Entry& b) { return std::tie(a.bound, a.is_cell, a.index) > std::tie(b.bound, b.is_cell, b.index); };
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
  queue.push({distance_to(nodes[0].box, p), 0, false});
  SurfaceProjection best;
  best.distance = std::numeric_limits<double>::infinity();
  double best_sample = std::numeric_limits<double>::infinity();
  struct Candidate {
    double to_middle;
    std::uint32_t cell;
  };
  std::vector<Candidate> candidates;
  while (!queue.empty() && queue.top().bound <= best_sample) {
    const Entry entry = queue.top();
    queue.pop();
    if (entry.is_cell) {
      candidates.push_back({distance(middles_[entry.index], p), entry.index});
      best_sample = std::min(best_sample, candidates.back().to_middle);
      continue;
    }
    const BoxTree::Node& node = nodes[entry.index];
    if (node.count == 0) {
      for (const std::uint32_t child : {node.first, node.first + 1}) queue.push({distance_to(nodes[child].box, p), child, false});
    } else {
      for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        const std::uint32_t cell = cells_.order()[k];
        queue.push({distance_to(cells_.boxes()[cell], p), cell, true});
      }
    }
  }
  // The nearest samples come first. A cell beside an earlier one leads to the same base point, so only local minima of the samples are start values.
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return std::tie(a.to_middle, a.cell) < std::tie(b.to_middle, b.cell); });
  const std::size_t n_u = stations_u_.size() - 1;
  std::vector<char> is_passed(n_u * n_v, 0);
  for (const Candidate& candidate : candidates) {
    const std::size_t i = candidate.cell / n_v, j = candidate.cell % n_v;
    bool is_minimum = true;
    for (std::size_t a = i - std::min<std::size_t>(i, 1); a <= std::min(i + 1, n_u - 1); ++a)
      for (std::size_t b = j - std::min<std::size_t>(j, 1); b <= std::min(j + 1, n_v - 1); ++b) is_minimum = is_minimum && is_passed[a * n_v + b] == 0;
    is_passed[candidate.cell] = 1;
    if (!is_minimum || distance_to(cells_.boxes()[candidate.cell], p) > best.distance) continue;
    const SurfaceProjection projection = seeded(p, middle_uv(candidate.cell));
    if (projection.distance < best.distance) best = projection;
  }
  return best;
}

void SurfaceProjector::project(std::span<const Point> points, std::span<const Uv> seeds, std::span<SurfaceProjection> projections,
                               const RunContext& context) const {
  parallel_for(
      context, points.size(), [&](std::size_t i) { projections[i] = seeds.empty() ? nearest(points[i]) : seeded(points[i], seeds[i]); }, 512);
}

// ---------------------------------------------------------------- curves

CurveProjector::CurveProjector(CurvePtr curve) : CurveProjector(curve, curve->domain()) {}

CurveProjector::CurveProjector(CurvePtr curve, Interval range) : curve_(std::move(curve)), range_(range) {
  check_range(range);
  wraps_ = is_whole_period(range, curve_->domain(), curve_->is_periodic());
  const std::vector<double> fine = even(range, 2 * k_fine_samples);
  std::vector<Point> line;
  for (const double t : fine) line.push_back(curve_->point(t));
  stations_ = stations_of(fine, {line});
  Box whole;
  for (const double t : stations_) {
    points_.push_back(curve_->point(t));
    whole.add(points_.back());
  }
  extent_ = std::max(distance(whole.min, whole.max), std::numeric_limits<double>::min());
  for (std::size_t i = 0; i + 1 < stations_.size(); ++i) {
    const Point centre = 0.5 * (points_[i] + points_[i + 1]);
    const Point middle = curve_->point(0.5 * (stations_[i] + stations_[i + 1]));
    reach_.push_back((1.0 + k_cell_margin) * std::max(distance(centre, middle), distance(centre, points_[i])));
  }
}

CurveProjection CurveProjector::seeded(const Point& p, double seed) const {
  double t = inside(seed, range_, wraps_);
  CurveDerivatives d = curve_->derivatives(t);
  for (int step = 0; step < k_max_steps; ++step) {
    const Vec3 r = d.point - p;
    const double g = dot(r, d.first);
    if (!wraps_ && ((t <= range_.from && g >= 0.0) || (t >= range_.to && g <= 0.0))) break;
    const double speed2 = norm2(d.first);
    double h = speed2 + dot(r, d.second);
    const bool is_newton = h > k_singular * speed2;
    if (!is_newton) h = std::max(speed2, std::numeric_limits<double>::min());
    double s = std::clamp(-g / h, -k_longest_step * range_.length(), k_longest_step * range_.length());
    const double length = std::abs(s) * std::sqrt(speed2);
    if (!std::isfinite(s) || length <= k_no_step * extent_) break;
    if (is_newton && length <= k_last_step * extent_) {
      const double last = inside(t + s, range_, wraps_);
      const Point q = curve_->point(last);
      if (distance(q, p) <= norm(r) * (1.0 + 1e-15) + k_no_step * extent_) return {last, q, distance(q, p)};
    }
    const double f = norm2(r);
    bool is_better = false;
    for (int halving = 0; halving < k_max_halvings && !is_better; ++halving, s *= 0.5) {
      const double next = inside(t + s, range_, wraps_);
      const CurveDerivatives e = curve_->derivatives(next);
      if (norm2(e.point - p) < f) {
        is_better = true;
        t = next;
        d = e;
      }
    }
    if (!is_better) break;
  }
  return {t, d.point, distance(d.point, p)};
}

CurveProjection CurveProjector::nearest(const Point& p) const {
  struct Candidate {
    double bound;
    std::size_t interval;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < reach_.size(); ++i) candidates.push_back({distance(0.5 * (points_[i] + points_[i + 1]), p) - reach_[i], i});
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return std::tie(a.bound, a.interval) < std::tie(b.bound, b.interval); });
  CurveProjection best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    if (candidate.bound >= best.distance) break;
    const CurveProjection projection = seeded(p, 0.5 * (stations_[candidate.interval] + stations_[candidate.interval + 1]));
    if (projection.distance < best.distance) best = projection;
  }
  return best;
}

}  // namespace sterna
