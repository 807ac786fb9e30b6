// Starts with four intervals along each axis. Builds the spline; compares it with the function at the middle of the intervals of each axis, at the stations of
// the other axes, and at irregular points in all cells; halves the intervals with too large errors; and repeats this.
#include "scripting/values/sampled_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/error.h"
#include "geom/model/spline.h"

namespace sterna::scripting {
namespace {

constexpr std::size_t k_first_intervals = 4;
/// Default tolerance as a fraction of the longest side.
constexpr double k_tolerance_share = 1e-6;
/// Intervals shorter than this fraction of the longest side are not halved again: no spline follows a step.
constexpr double k_least_interval = 1e-9;
/// Margin around the box, as a fraction of its longest side: geometry slightly outside (surfaces beyond their borders) is covered by the spline, too.
constexpr double k_margin = 0.02;
/// Maximum ratio of neighbouring intervals. Splines through points graded by more than (3 + sqrt 5) / 2 may oscillate without bound (Marsden, 1974); halving
/// gives 2 plus rounding.
constexpr double k_ratio = 2.1;
/// Points of a cell for the final comparison. They are no simple fractions, so that a periodic function does not pass by coincidence.
constexpr std::array<double, 3> k_crooked = {0.31, 0.43, 0.59};

using Stations = std::array<std::vector<double>, 3>;

[[noreturn]] void refuse(std::string problem, const Point& location, std::string hint = {}) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "sampling the deformation",
               .problem = std::move(problem),
               .locations = {{location, "place"}},
               .hint = std::move(hint)});
}

/// A function that stores its values.
class Kept {
 public:
  explicit Kept(const std::function<Vec3(const Point&)>& f) : f_(f) {}
  const Vec3& operator()(const Point& p) {
    const auto [location, is_new] = values_.try_emplace(std::array{p.x, p.y, p.z});
    if (is_new) {
      location->second = f_(p);
      if (!is_finite(location->second)) refuse("the function does not return finite numbers", p);
    }
    return location->second;
  }

 private:
  const std::function<Vec3(const Point&)>& f_;
  std::map<std::array<double, 3>, Vec3> values_;
};

/// Halves marked intervals.
std::vector<double> split(const std::vector<double>& at, const std::vector<char>& is_marked) {
  std::vector<double> finer;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    finer.push_back(at[i]);
    if (is_marked[i]) finer.push_back(0.5 * (at[i] + at[i + 1]));
  }
  finer.push_back(at.back());
  return finer;
}

/// Halves intervals until none is more than k_ratio times as long as its neighbour.
std::vector<double> graded(std::vector<double> at) {
  for (;;) {
    std::vector<char> is_long(at.size() - 1, 0);
    const auto length = [&](std::size_t i) { return at[i + 1] - at[i]; };
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      is_long[i] = (i > 0 && length(i) > k_ratio * length(i - 1)) || (i + 2 < at.size() && length(i) > k_ratio * length(i + 1));
    if (std::none_of(is_long.begin(), is_long.end(), [](char mark) { return mark != 0; })) return at;
    at = split(at, is_long);
  }
}

/// Converts values in a grid of sizes n, [(i * n_y + j) * n_z + k], to poles: the grid lines along an axis become splines. n is updated, since splines may have
/// more poles than points.
std::vector<Vec3> splined(const std::vector<Vec3>& values, std::array<std::size_t, 3>& n, const std::vector<double>& at, std::size_t axis,
                          std::vector<double>& knots) {
  const SplineOptions options{.tangents = SplineTangents::not_a_knot, .at = at};
  const std::array<std::size_t, 3> from = n;
  const auto stride_of = [axis](const std::array<std::size_t, 3>& size) { return axis == 0 ? size[1] * size[2] : axis == 1 ? size[2] : 1; };
  const std::size_t stride = stride_of(from), n_outer = values.size() / (from[axis] * stride);
  std::vector<Vec3> poles;
  std::vector<Point> line(from[axis]);
  for (std::size_t outer = 0; outer < n_outer; ++outer)
    for (std::size_t inner = 0; inner < stride; ++inner) {
      for (std::size_t i = 0; i < from[axis]; ++i) line[i] = values[(outer * from[axis] + i) * stride + inner];
      const NurbsCurveForm<Point> form = spline_form(line, options);
      if (poles.empty()) {
        knots = form.knots;
        n[axis] = form.poles.size();
        poles.resize(n_outer * n[axis] * stride);
      }
      for (std::size_t i = 0; i < n[axis]; ++i) poles[(outer * n[axis] + i) * stride + inner] = form.poles[i];
    }
  return poles;
}

}  // namespace

SampledMap::SampledMap(const std::function<Vec3(const Point&)>& displacement, const Box& box, const SampledMapOptions& options) {
  const double size = box.longest_side();
  const double tolerance = is_automatic(options.tolerance) ? k_tolerance_share * size : options.tolerance;
  Kept f(displacement);
  Stations at;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double from = box.min[axis] - k_margin * size, to = box.max[axis] + k_margin * size;
    for (std::size_t i = 0; i <= k_first_intervals; ++i) at[axis].push_back(from + (to - from) * static_cast<double>(i) / k_first_intervals);
  }
  for (;;) {
    // ---- The spline through all stations
    const std::size_t n = at[0].size() * at[1].size() * at[2].size();
    std::vector<Vec3> values;
    values.reserve(n);
    for (const double x : at[0])
      for (const double y : at[1])
        for (const double z : at[2]) {
          values.push_back(f({x, y, z}));
          largest_ = std::max(largest_, norm(values.back()));
        }
    basis_.clear();
    std::array<std::size_t, 3> sizes = {at[0].size(), at[1].size(), at[2].size()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> knots;
      values = splined(values, sizes, at[axis], axis, knots);
      basis_.emplace_back(3, knots, false, "sampling the deformation");
    }
    poles_ = std::move(values);
    // ---- Errors of the spline
    error_ = 0.0;
    Point worst;
    std::array<std::vector<char>, 3> is_marked;
    for (std::size_t axis = 0; axis < 3; ++axis) is_marked[axis].assign(at[axis].size() - 1, 0);
    const auto off = [&](const Point& p) {
      const double error = norm(point(p) - p - f(p));
      if (error > error_) {
        error_ = error;
        worst = p;
      }
      return error;
    };
    bool is_any = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (std::size_t i = 0; i + 1 < at[axis].size(); ++i)
        for (const double s : at[a])
          for (const double t : at[b]) {
            Point p;
            p[axis] = 0.5 * (at[axis][i] + at[axis][i + 1]);
            p[a] = s;
            p[b] = t;
            if (off(p) > tolerance) {
              is_any = true;
              is_marked[axis][i] = 1;
            }
          }
    }
    // Errors may be small at the middles of the intervals but large beside them. The cell is then split along all axes.
    if (!is_any)
      for (std::size_t i = 0; i + 1 < at[0].size(); ++i)
        for (std::size_t j = 0; j + 1 < at[1].size(); ++j)
          for (std::size_t k = 0; k + 1 < at[2].size(); ++k) {
            const std::array<std::size_t, 3> cell = {i, j, k};
            Point p;
            for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = at[axis][cell[axis]] + k_crooked[axis] * (at[axis][cell[axis] + 1] - at[axis][cell[axis]]);
            if (off(p) > tolerance) {
              is_any = true;
              is_marked[0][i] = is_marked[1][j] = is_marked[2][k] = 1;
            }
          }
    if (!is_any) return;
    std::size_t next = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = graded(split(at[axis], is_marked[axis]));
      next *= at[axis].size();
    }
    double shortest = size;
    for (const std::vector<double>& stations : at)
      for (std::size_t i = 0; i + 1 < stations.size(); ++i) shortest = std::min(shortest, stations[i + 1] - stations[i]);
    if (next > static_cast<std::size_t>(options.max_samples) || shortest < k_least_interval * size)
      refuse(fmt::format("a spline with {} samples deviates from the function by {:.3g} m, the tolerance is {:.3g} m", n, error_, tolerance), worst,
             "if the function has a kink or step there, make it smooth; or increase tolerance or max_samples");
  }
}

std::size_t SampledMap::n_samples() const { return poles_.size(); }

Point SampledMap::point(const Point& p) const {
  std::array<BasisValues, 3> b;
  for (std::size_t axis = 0; axis < 3; ++axis) basis_[axis].evaluate<false>(p[axis], b[axis]);
  const std::size_t n_y = basis_[1].n_functions(), n_z = basis_[2].n_functions();
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      Vec3 row;
      for (std::size_t k = 0; k < 4; ++k) row += b[2].value[k] * poles_[((b[0].first + i) * n_y + b[1].first + j) * n_z + b[2].first + k];
      sum += b[0].value[i] * b[1].value[j] * row;
    }
  return p + sum;
}

SpaceMapDerivatives SampledMap::derivatives(const Point& p) const {
  std::array<BasisValues, 3> b;
  for (std::size_t axis = 0; axis < 3; ++axis) basis_[axis].evaluate<true>(p[axis], b[axis]);
  const std::size_t n_y = basis_[1].n_functions(), n_z = basis_[2].n_functions();
  SpaceMapDerivatives d{.point = p, .dx = {1.0, 0.0, 0.0}, .dy = {0.0, 1.0, 0.0}, .dz = {0.0, 0.0, 1.0}};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      Vec3 row, row_z, row_zz;
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3& pole = poles_[((b[0].first + i) * n_y + b[1].first + j) * n_z + b[2].first + k];
        row += b[2].value[k] * pole;
        row_z += b[2].d1[k] * pole;
        row_zz += b[2].d2[k] * pole;
      }
      const double x = b[0].value[i], x1 = b[0].d1[i], x2 = b[0].d2[i], y = b[1].value[j], y1 = b[1].d1[j], y2 = b[1].d2[j];
      d.point += x * y * row;
      d.dx += x1 * y * row;
      d.dy += x * y1 * row;
      d.dz += x * y * row_z;
      d.dxx += x2 * y * row;
      d.dxy += x1 * y1 * row;
      d.dxz += x1 * y * row_z;
      d.dyy += x * y2 * row;
      d.dyz += x * y1 * row_z;
      d.dzz += x * y * row_zz;
    }
  return d;
}

}  // namespace sterna::scripting
