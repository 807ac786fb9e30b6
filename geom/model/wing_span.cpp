#include "geom/model/wing_span.h"

#include <algorithm>
#include <cmath>

#include "geom/model/nurbs_surface.h"

namespace sterna {
namespace {

/// Samples between two rows if the wing is curved along the span: the additional length relative to straight lines is accurate to 1e-4.
constexpr std::size_t k_curved_samples = 32;

}  // namespace

Point chord_middle(const std::vector<Point>& row) { return 0.25 * (row.front() + row.back()) + 0.5 * row[row.size() / 2]; }
Vec3 chord_vector(const std::vector<Point>& row) { return 0.5 * (row.front() + row.back()) - row[row.size() / 2]; }

WingSpan::WingSpan(const Wing& wing) : made_(wing_rows(wing)), panels_(wing_panels(made_)) {
  for (std::size_t p = 0; p < panels_.size(); ++p)
    for (std::size_t i = 1; i < panels_[p].v_of_row.size(); ++i) panel_of_row_.push_back(p);
  samples_.push_back({0.0, 0.0, 0.0});
  Point last = chord_middle(made_.rows.front());
  for (std::size_t i = 0; i + 1 < made_.rows.size(); ++i) {
    const std::size_t n = panels_[panel_of_row_[i]].v_of_row.size() == 2 ? 1 : k_curved_samples;
    for (std::size_t k = 1; k <= n; ++k) {
      const double location = static_cast<double>(i) + static_cast<double>(k) / static_cast<double>(n);
      const Point at = chord_middle(row(location));
      samples_.push_back({location, samples_.back().fraction + distance(last, at), samples_.back().across + std::hypot(at.y - last.y, at.z - last.z)});
      last = at;
    }
  }
  length_ = samples_.back().fraction;
  for (Sample& s : samples_) s.fraction /= length_;
  samples_.back().fraction = 1.0;
}

std::vector<double> WingSpan::fractions() const {
  std::vector<double> result;
  for (const Sample& s : samples_)
    if (s.location == std::floor(s.location)) result.push_back(s.fraction);
  return result;
}

double WingSpan::location_of(double fraction) const {
  const auto above = std::upper_bound(samples_.begin() + 1, samples_.end() - 1, fraction, [](double value, const Sample& s) { return value < s.fraction; });
  const Sample &a = *(above - 1), &b = *above;
  const double t = std::clamp((fraction - a.fraction) / (b.fraction - a.fraction), 0.0, 1.0);
  return t == 0.0 ? a.location : t == 1.0 ? b.location : a.location + t * (b.location - a.location);
}

double WingSpan::fraction_of(double location) const {
  const auto above = std::upper_bound(samples_.begin() + 1, samples_.end() - 1, location, [](double value, const Sample& s) { return value < s.location; });
  const Sample &a = *(above - 1), &b = *above;
  const double t = std::clamp((location - a.location) / (b.location - a.location), 0.0, 1.0);
  return t == 0.0 ? a.fraction : t == 1.0 ? b.fraction : a.fraction + t * (b.fraction - a.fraction);
}

std::vector<Point> WingSpan::row(double location) const {
  const auto i = static_cast<std::size_t>(location);
  if (location == std::floor(location)) return made_.rows[i];
  const WingPanel& panel = panels_[panel_of_row_[i]];
  std::vector<Point> row;
  if (panel.v_of_row.size() == 2) {
    const double t = location - std::floor(location);
    for (std::size_t k = 0; k < made_.rows[i].size(); ++k) row.push_back((1.0 - t) * made_.rows[i][k] + t * made_.rows[i + 1][k]);
    return row;
  }
  const NurbsSurface surface(panel.form);
  const double v = panel.v(location);
  for (const double u : row_parameters(made_.rows[i].size() / 2)) row.push_back(surface.point({u, v}));
  return row;
}

double WingSpan::location_from_root(const Wing& wing, double part) const {
  const double whole = samples_.back().across;
  const auto off_plane = [](const std::vector<Point>& row) { return std::abs(chord_middle(row).y); };
  const std::vector<Point>&first = made_.rows.front(), &last = made_.rows.back();
  const bool is_first = wing.has_mirror_image ? off_plane(first) < off_plane(last) : norm(chord_vector(first)) > norm(chord_vector(last));
  const double across = wing.is_symmetric ? 0.5 * whole * (1.0 - part) : is_first ? part * whole : (1.0 - part) * whole;
  const auto above = std::upper_bound(samples_.begin() + 1, samples_.end() - 1, across, [](double value, const Sample& s) { return value < s.across; });
  const Sample &a = *(above - 1), &b = *above;
  return b.across > a.across ? a.location + (across - a.across) / (b.across - a.across) * (b.location - a.location)
                             : a.location;  // beyond the ends the end parts are extrapolated
}

}  // namespace sterna
