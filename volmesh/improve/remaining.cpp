#include "volmesh/improve/remaining.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "volmesh/improve/forcing.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

using Corners = std::array<std::uint32_t, 4>;
constexpr std::size_t k_max_listed = 10'000;

struct Remaining {
  std::uint32_t tet = 0;
  double smallest = 0.0;  ///< radians, smallest and largest dihedral angle
  double largest = 0.0;
  std::uint32_t triangle = k_unforced;  ///< boundary triangle that forces the tetrahedron
  /// Distance beyond the limits, used for sorting.
  double badness(const ImproveOptions& options) const { return std::max(options.improve_min_angle - smallest, largest - options.improve_max_angle); }
};

std::string format(const char* pattern, auto... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

/// The boundary around the vertices of bad tetrahedra.
class Surroundings {
 public:
  Surroundings(const TetraBoundary& boundary, const std::vector<std::uint8_t>& is_needed) : boundary_(boundary), corner_(boundary.points.size(), k_none) {
    for (std::uint32_t t = 0; t < boundary.triangles.size(); ++t) {
      const auto& v = boundary.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = v[k], b = v[(k + 1) % 3];
        if (!is_needed[a]) continue;
        corner_[a] = std::min(corner_[a], corner_angle(point(a), point(b), point(v[(k + 2) % 3])));
        if (is_needed[b]) triangle_[{a, b}] = t;
      }
    }
  }

  /// Returns the boundary triangle that contains this directed side, seen from the domain; k_unforced if there is none.
  std::uint32_t triangle_at(std::uint32_t a, std::uint32_t b) const {
    const auto found = triangle_.find({a, b});
    return found == triangle_.end() ? k_unforced : found->second;
  }
  /// Returns the boundary triangles that are faces of a tetrahedron.
  std::vector<std::uint32_t> faces(const Corners& c) const {
    constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    std::vector<std::uint32_t> result;
    for (const auto& f : k_faces) {
      const std::uint32_t t = triangle_at(c[f[0]], c[f[1]]);
      if (t != k_unforced && apex(t, c[f[0]], c[f[1]]) == c[f[2]]) result.push_back(t);
    }
    return result;
  }
  /// Returns the smallest angle through the domain between boundary triangles at an edge of the tetrahedron.
  double smallest_between(const Corners& tet) const {
    double smallest = k_none;
    for (const std::uint32_t a : tet)
      for (const std::uint32_t b : tet) {
        const std::uint32_t left = a < b ? triangle_at(a, b) : k_unforced, right = triangle_at(b, a);
        if (left != k_unforced && right != k_unforced) smallest = std::min(smallest, domain_angle(a, b, apex(left, a, b), apex(right, a, b)));
      }
    return smallest;
  }
  double smallest_corner(const Corners& tet) const {
    double smallest = k_none;
    for (const std::uint32_t v : tet)
      if (v < corner_.size()) smallest = std::min(smallest, corner_[v]);
    return smallest;
  }
  Vec3 center(std::uint32_t triangle) const {
    const auto& v = boundary_.triangles[triangle];
    return (point(v[0]) + point(v[1]) + point(v[2])) / 3.0;
  }
  static constexpr double k_none = 7.0;  ///< larger than any angle

 private:
  Vec3 point(std::uint32_t v) const { return boundary_.points[v]; }
  std::uint32_t apex(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) const {
    const auto& v = boundary_.triangles[triangle];
    return *std::ranges::find_if(v, [&](std::uint32_t x) { return x != a && x != b; });
  }
  /// Returns the angle through the domain at the edge a b. The normals of (a, b, c) and (b, a, d) point into the domain.
  double domain_angle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    const Vec3 n = cross(point(b) - point(a), point(c) - point(a)), m = cross(point(a) - point(b), point(d) - point(b));
    const double bend = angle_between(n, m);
    return dot(n, point(d) - point(a)) > 0.0 ? std::numbers::pi - bend : std::numbers::pi + bend;
  }

  const TetraBoundary& boundary_;
  std::vector<double> corner_;                                      ///< smallest corner angle at each requested vertex
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> triangle_;  ///< triangle at each requested side
};

/// Finds the boundary triangle that forces each bad tetrahedron among the boundary triangles that are faces of the tetrahedron.
void find_forcing(const TetraBoundary& boundary, const TetraResult& tets, const Surroundings& surroundings, const ImproveOptions& options,
                  std::vector<Remaining>& bad, const RunContext& context) {
  std::vector<std::uint32_t> target;
  for (const Remaining& r : bad)
    for (const std::uint32_t t : surroundings.faces(tets.tetrahedra[r.tet])) target.push_back(t);
  std::ranges::sort(target);
  target.erase(std::unique(target.begin(), target.end()), target.end());
  const std::vector<std::uint32_t> forcing = forcing_triangles(boundary, target, options.improve_min_angle, options.improve_max_angle, context);
  for (Remaining& r : bad)
    for (const std::uint32_t t : surroundings.faces(tets.tetrahedra[r.tet]))
      r.triangle = std::min(r.triangle, forcing[static_cast<std::size_t>(std::ranges::lower_bound(target, t) - target.begin())]);
}

}  // namespace

void list_remaining(const TetraBoundary& boundary, const TetraResult& tets, std::span<const std::uint32_t> bad_tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context) {
  if (bad_tets.empty()) return;
  const std::size_t n_fixed = boundary.points.size();
  const auto location = [&](std::uint32_t v) { return v < n_fixed ? boundary.points[v] : tets.new_points[v - n_fixed]; };
  std::vector<Remaining> bad;
  std::vector<std::uint8_t> is_needed(n_fixed, 0);
  for (const std::uint32_t t : bad_tets) {
    const Corners& c = tets.tetrahedra[t];
    const auto [of_smallest, of_largest] = dihedral_cosines(location(c[0]), location(c[1]), location(c[2]), location(c[3]));
    bad.push_back({t, std::acos(of_smallest), std::acos(of_largest)});
    bool is_free = true;
    for (const std::uint32_t v : c)
      if (v < n_fixed) {
        is_needed[v] = 1;
        is_free = false;
      }
    report.n_bad_free_after += is_free;
  }
  const Surroundings surroundings(boundary, is_needed);
  find_forcing(boundary, tets, surroundings, options, bad, context);
  std::ranges::sort(bad, [&](const Remaining& a, const Remaining& b) {
    const double of_a = a.badness(options), of_b = b.badness(options);
    return of_a != of_b ? of_a > of_b : a.tet < b.tet;
  });
  for (const Remaining& r : bad) {
    const Corners& c = tets.tetrahedra[r.tet];
    const double between = surroundings.smallest_between(c);
    const bool is_wedge = between < options.improve_min_angle;
    report.n_forced += is_wedge || r.triangle != k_unforced;
    if (report.remaining.size() == k_max_listed) continue;
    std::string what = format("dihedral angles %.3g to %.4g deg; ", k_degrees * r.smallest, k_degrees * r.largest);
    const double corner = surroundings.smallest_corner(c);
    if (is_wedge) {
      what += format("forced: boundary triangles meet at %.3g deg", k_degrees * between);
    } else if (r.triangle != k_unforced) {
      const Vec3 other = surroundings.center(r.triangle);
      what += format("forced: no room beside the boundary triangle at (%.6g, %.6g, %.6g)", other.x, other.y, other.z);
    } else if (corner < Surroundings::k_none) {
      what += format("not forced; sharpest corner of a boundary triangle here: %.3g deg", k_degrees * corner);
    } else {
      what += "not forced, away from the boundary";
    }
    report.remaining.push_back({0.25 * (location(c[0]) + location(c[1]) + location(c[2]) + location(c[3])), what});
  }
}

}  // namespace sterna::volmesh
