#include "volmesh/improve/remaining.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

using Corners = std::array<std::uint32_t, 4>;
constexpr double k_degrees = 180.0 / std::numbers::pi;
/// Times the smallest angle allowed. Around an edge of the boundary one tetrahedron must fit, and two share the angle where connectivity wants an edge there; a triangle's
/// sharp corner is the face angle of a tetrahedron, whose dihedral angles there are small unless all its neighbours are as slender.
constexpr double k_forcing_angle = 2.0;
constexpr std::size_t k_max_listed = 10'000;

struct Remaining {
  std::uint32_t tet = 0;
  double smallest = 0.0;  ///< dihedral angles, radians
  double largest = 0.0;
  /// How far beyond its limits, for the order.
  double badness(const ImproveOptions& options) const { return std::max(options.improve_min_angle - smallest, largest - options.improve_max_angle); }
};

/// A sharp angle of the boundary.
struct Sharp {
  double angle = 4.0;
  const char* what = "no angle of the boundary";
};

class Boundary {
 public:
  Boundary(const TetraBoundary& boundary, const std::vector<std::uint8_t>& is_wanted) : boundary_(boundary), corner_(boundary.points.size(), 4.0) {
    for (std::uint32_t t = 0; t < boundary.triangles.size(); ++t) {
      const auto& v = boundary.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
        if (!is_wanted[a]) continue;
        corner_[a] = std::min(corner_[a], corner_angle(point(a), point(b), point(c)));
        if (is_wanted[b]) opposite_[{a, b}] = c;
      }
    }
  }

  /// An angle between triangles below the limit counts first: it leaves no choice at all.
  Sharp sharpest_at(const Corners& tet, double limit) const {
    Sharp sharpest;
    for (const std::uint32_t a : tet)
      for (const std::uint32_t b : tet) {
        if (a >= b) continue;
        const auto left = opposite_.find({a, b}), right = opposite_.find({b, a});
        if (left == opposite_.end() || right == opposite_.end()) continue;
        const double angle = domain_angle(a, b, left->second, right->second);
        if (angle < sharpest.angle) sharpest = {angle, "between boundary triangles"};
      }
    if (sharpest.angle < limit) return sharpest;
    for (const std::uint32_t v : tet)
      if (v < corner_.size() && corner_[v] < sharpest.angle) sharpest = {corner_[v], "corner of a boundary triangle"};
    return sharpest;
  }

 private:
  Vec3 point(std::uint32_t v) const { return boundary_.points[v]; }
  /// Angle at the edge a b through the domain, into which the normals of (a, b, c) and (b, a, d) point.
  double domain_angle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    const Vec3 n = cross(point(b) - point(a), point(c) - point(a)), m = cross(point(a) - point(b), point(d) - point(b));
    const double bend = angle_between(n, m);
    return dot(n, point(d) - point(a)) > 0.0 ? std::numbers::pi - bend : std::numbers::pi + bend;
  }

  const TetraBoundary& boundary_;
  std::vector<double> corner_;  ///< smallest at each wanted vertex
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> opposite_;
};

std::vector<Remaining> with_angles(const TetraBoundary& boundary, const TetraResult& tets, std::span<const std::uint32_t> bad_tets, ImproveReport& report) {
  const std::size_t n_fixed = boundary.points.size();
  const auto place = [&](std::uint32_t v) { return v < n_fixed ? boundary.points[v] : tets.new_points[v - n_fixed]; };
  std::vector<Remaining> bad;
  for (const std::uint32_t t : bad_tets) {
    const Corners& c = tets.tetrahedra[t];
    const auto [of_smallest, of_largest] = dihedral_cosines(place(c[0]), place(c[1]), place(c[2]), place(c[3]));
    bad.push_back({t, std::acos(of_smallest), std::acos(of_largest)});
    report.n_bad_free_after += std::ranges::all_of(c, [&](std::uint32_t v) { return v >= n_fixed; });
  }
  return bad;
}

}  // namespace

void list_remaining(const TetraBoundary& boundary, const TetraResult& tets, std::span<const std::uint32_t> bad_tets, const ImproveOptions& options, ImproveReport& report, const RunContext&) {
  const std::size_t n_fixed = boundary.points.size();
  std::vector<Remaining> bad = with_angles(boundary, tets, bad_tets, report);
  std::ranges::sort(bad, [&](const Remaining& a, const Remaining& b) {
    const double of_a = a.badness(options), of_b = b.badness(options);
    return of_a != of_b ? of_a > of_b : a.tet < b.tet;
  });
  std::vector<std::uint8_t> is_wanted(n_fixed, 0);
  for (const Remaining& r : bad)
    for (const std::uint32_t v : tets.tetrahedra[r.tet])
      if (v < n_fixed) is_wanted[v] = 1;
  const Boundary surroundings(boundary, is_wanted);
  for (const Remaining& r : bad) {
    const Corners& c = tets.tetrahedra[r.tet];
    const double limit = k_forcing_angle * options.improve_min_angle;
    const Sharp sharp = surroundings.sharpest_at(c, limit);
    report.n_forced += sharp.angle < limit;
    if (report.remaining.size() == k_max_listed) continue;
    Vec3 center;
    for (const std::uint32_t v : c) center += 0.25 * (v < n_fixed ? boundary.points[v] : tets.new_points[v - n_fixed]);
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "dihedral angles %.3g to %.4g deg; %s", k_degrees * r.smallest, k_degrees * r.largest, sharp.what);
    std::string what = text.data();
    if (sharp.angle < 4.0) {
      std::snprintf(text.data(), text.size(), ": %.3g deg", k_degrees * sharp.angle);
      what += text.data();
    }
    report.remaining.push_back({center, what});
  }
}

}  // namespace sterna::volmesh
