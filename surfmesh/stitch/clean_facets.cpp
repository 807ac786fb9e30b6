#include "surfmesh/stitch/clean_facets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "surfmesh/stitch/edge_table.h"

namespace sterna::surfmesh {
namespace {

/// For each facet the first facet with the same vertices (the facet itself if there is none), and a flag that there are several.
struct Copies {
  std::vector<std::uint32_t> first;
  std::vector<char> is_doubled;
  bool any = false;
};

Copies find_copies(const WorkingSurface& surface, const EdgeTable& edges) {
  Copies copies;
  copies.first.resize(surface.n_facets());
  for (std::uint32_t t = 0; t < surface.n_facets(); ++t) copies.first[t] = t;
  copies.is_doubled.assign(surface.n_facets(), 0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite;  // third vertex of a facet, and the facet
  for (const Edge& edge : edges.edges()) {
    if (edge.count < 2) continue;
    opposite.clear();
    for (const std::uint32_t h : edges.at(edge)) {
      const std::uint32_t third = surface.facets[h / 3][previous_halfedge(h) % 3];
      if (third > edge.high) opposite.emplace_back(third, h / 3);  // each facet is visited from its lowest edge only
    }
    std::sort(opposite.begin(), opposite.end());
    for (std::size_t i = 1; i < opposite.size(); ++i) {
      if (opposite[i].first != opposite[i - 1].first) continue;
      const std::uint32_t first = copies.first[opposite[i - 1].second];
      copies.first[opposite[i].second] = first;
      copies.is_doubled[first] = copies.is_doubled[opposite[i].second] = 1;
      copies.any = true;
    }
  }
  return copies;
}

/// First facets of a patch of doubled facets around `start`, and a flag that the rest of the surface is closed without the patch.
struct DoubledPatch {
  std::vector<std::uint32_t> facets;
  bool is_redundant = false;
};

DoubledPatch grow_doubled_patch(std::uint32_t start, const EdgeTable& edges, const Copies& copies, std::vector<char>& visited) {
  DoubledPatch patch;
  bool has_even = false, has_odd = false;
  patch.facets.push_back(start);
  visited[start] = 1;
  for (std::size_t i = 0; i < patch.facets.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::size_t n_single = 0;
      for (const std::uint32_t h : edges.at(edges.edge_of(3 * patch.facets[i] + k))) {
        const std::uint32_t other = copies.first[h / 3];
        if (!copies.is_doubled[other]) {
          ++n_single;
        } else if (!visited[other]) {
          visited[other] = 1;
          patch.facets.push_back(other);
        }
      }
      if (n_single > 0) (n_single % 2 ? has_odd : has_even) = true;
    }
  }
  patch.is_redundant = has_even && !has_odd;
  return patch;
}

}  // namespace

void drop_degenerate_facets(WorkingSurface& surface, StitchReport& report) {
  std::vector<char> is_kept(surface.n_facets());
  std::int64_t n_dropped = 0;
  for (std::size_t t = 0; t < surface.n_facets(); ++t) {
    const auto& [a, b, c] = surface.facets[t];
    is_kept[t] = a != b && b != c && c != a;
    n_dropped += !is_kept[t];
  }
  if (n_dropped == 0) return;
  surface.keep(is_kept);
  report.n_degenerate_removed += n_dropped;
  report.messages.push_back("removed " + count_of(n_dropped, "facet", "facets") + " with a repeated vertex");
}

void drop_doubled_facets(WorkingSurface& surface, StitchReport& report) {
  const EdgeTable edges(surface.facets, surface.points.size());
  const Copies copies = find_copies(surface, edges);
  if (!copies.any) return;
  std::vector<char> is_kept(surface.n_facets(), 1);
  std::vector<char> visited(surface.n_facets(), 0);
  std::int64_t n_copies = 0, n_redundant = 0;
  for (std::uint32_t t = 0; t < surface.n_facets(); ++t) {
    if (copies.first[t] != t) {
      is_kept[t] = 0;
      ++n_copies;
    } else if (copies.is_doubled[t] && !visited[t]) {
      const DoubledPatch patch = grow_doubled_patch(t, edges, copies, visited);
      if (!patch.is_redundant) continue;
      for (const std::uint32_t dropped : patch.facets) is_kept[dropped] = 0;
      n_redundant += static_cast<std::int64_t>(patch.facets.size());
    }
  }
  surface.keep(is_kept);
  report.n_duplicate_removed += n_copies + n_redundant;
  std::string message = "removed " + count_of(n_copies, "copy of a facet", "copies of facets");
  if (n_redundant > 0) message += " and " + count_of(n_redundant, "facet", "facets") + " of double-sided sheets without thickness";
  report.messages.push_back(std::move(message));
}

ThinParts find_thin_parts(const std::vector<Vec3>& points, const std::vector<Facet>& facets, const EdgeTable& edges, double length) {
  constexpr double k_least_thickness = 1e-9;  // larger than the rounding errors of coordinates and volume
  ThinParts thin{.is_thin = std::vector<char>(facets.size(), 0)};
  const Parts parts = connected_parts(facets.size(), edges);
  if (parts.count < 2) return thin;
  struct Size {
    bool is_closed = true;
    double volume = 0.0, area = 0.0;
    Vec3 origin;
    Box box;
  };
  std::vector<Size> sizes(parts.count);
  for (const Edge& edge : edges.edges())
    if (edge.count != 2) sizes[parts.part[edges.at(edge).front() / 3]].is_closed = false;
  for (std::size_t t = 0; t < facets.size(); ++t) {
    Size& size = sizes[parts.part[t]];
    const Vec3 &a = points[facets[t][0]], &b = points[facets[t][1]], &c = points[facets[t][2]];
    if (size.box.empty()) size.origin = a;
    size.volume += dot(a - size.origin, cross(b - size.origin, c - size.origin)) / 6.0;
    size.area += triangle_area(a, b, c);
    for (const Vec3& p : {a, b, c}) size.box.add(p);
  }
  // The volume of a part as thin as a line consists of rounding errors only.
  std::vector<char> is_without(parts.count);
  for (std::uint32_t p = 0; p < parts.count; ++p) {
    const Size& size = sizes[p];
    const double own_length = norm(size.box.max - size.box.min), thickness = k_least_thickness * std::max(own_length, length);
    is_without[p] = static_cast<char>(size.is_closed && (2.0 * std::abs(size.volume) <= thickness * size.area || size.area <= thickness * own_length));
  }
  const std::int64_t n = std::ranges::count(is_without, 1);
  if (n == parts.count) return thin;
  thin.count = n;
  for (std::size_t t = 0; t < facets.size(); ++t) thin.is_thin[t] = is_without[parts.part[t]];
  return thin;
}

bool drop_parts_without_thickness(WorkingSurface& surface, const EdgeTable& edges, StitchReport& report) {
  const ThinParts thin = find_thin_parts(surface.points, surface.facets, edges);
  if (thin.count == 0) return false;
  const auto first = static_cast<std::size_t>(std::ranges::find(thin.is_thin, 1) - thin.is_thin.begin());
  // Such a part is a baffle whose two sides have different triangles; the file readers compare the number of remaining facets.
  report.n_duplicate_removed += std::ranges::count(thin.is_thin, 1);
  report.messages.push_back("dropped " + count_of(thin.count, "closed part", "closed parts") + " without thickness (" +
                            count_of(std::ranges::count(thin.is_thin, 1), "facet", "facets") + "), the first at " +
                            format_point(surface.metres(surface.corners(first)[0])));
  std::vector<char> is_kept;
  for (const char is_thin : thin.is_thin) is_kept.push_back(static_cast<char>(is_thin == 0));
  surface.keep(is_kept);
  return true;
}

}  // namespace sterna::surfmesh
