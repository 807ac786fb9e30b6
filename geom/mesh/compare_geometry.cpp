#include "geom/mesh/compare_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"

namespace sterna {
namespace {

constexpr std::size_t k_samples = 24;        ///< facets of a part that are searched in the result
constexpr double k_near_of_length = 1e-3;    ///< the result contains a part if it is within this distance, relative to the length of the whole surface
constexpr double k_near_of_part = 0.05;      ///< the same distance, relative to the length of the part; the larger of both applies
constexpr double k_share_of_division = 0.1;  ///< a part is divided if at least this fraction of its samples lies on a second part of the result
constexpr std::uint32_t k_none = 0xffffffffu;

struct Part {
  std::vector<TriangleId> triangles;
  Box box;
  double area = 0.0;
  double volume = 0.0;  ///< signed, oriented by most of its area
  bool is_closed = true;
  bool is_turned = false;  ///< its orientation is reversed in the result
  PatchId patch;           ///< patch with most of the area
};

struct Parts {
  Column<TriangleId, std::uint32_t> part;
  Column<TriangleId, char> is_flipped;  ///< opposite to the sense of its part
  std::vector<Part> parts;
};

/// Returns one common number for all vertices at a location.
Column<VertexId, std::uint32_t> locations_of(const TriMesh& mesh) {
  std::vector<VertexId> order;
  order.reserve(mesh.n_vertices());
  for (const VertexId v : mesh.points.ids()) order.push_back(v);
  const auto key = [&](VertexId v) {
    const Point& p = mesh.points[v];
    return std::array<double, 3>{p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0 becomes 0
  };
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  Column<VertexId, std::uint32_t> location(mesh.n_vertices(), 0);
  std::uint32_t n = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && key(order[i]) != key(order[i - 1])) ++n;
    location[order[i]] = n;
  }
  return location;
}

/// Neighbour across each side, if the edge has exactly two facets.
struct Neighbours {
  std::vector<std::uint32_t> twin;  ///< half-edge 3 * triangle + corner; k_none
  std::vector<char> has_same_sense;
};

/// Joins sides without a neighbour if exactly two of them run between the same two numbers.
void match_sides(const TriMesh& mesh, const Column<VertexId, std::uint32_t>& number, Neighbours& result) {
  struct Side {
    std::uint32_t low, high, halfedge;
    bool is_upward;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.triangles[t];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = number[v[k]], b = number[v[(k + 1) % 3]];
      const auto h = static_cast<std::uint32_t>(3 * t.index() + k);
      if (a != b && result.twin[h] == k_none) sides.push_back({std::min(a, b), std::max(a, b), h, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.halfedge < b.halfedge;
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i == 2) {
      result.twin[sides[i].halfedge] = sides[i + 1].halfedge;
      result.twin[sides[i + 1].halfedge] = sides[i].halfedge;
      result.has_same_sense[sides[i].halfedge] = result.has_same_sense[sides[i + 1].halfedge] = sides[i].is_upward == sides[i + 1].is_upward;
    }
    i = end;
  }
}

/// Finds neighbours first by vertices, so that parts with separate vertices stay apart where they touch; then by locations.
Neighbours neighbours_of(const TriMesh& mesh) {
  Neighbours result{std::vector<std::uint32_t>(3 * mesh.n_triangles(), k_none), std::vector<char>(3 * mesh.n_triangles(), 0)};
  Column<VertexId, std::uint32_t> own(mesh.n_vertices(), 0);
  for (const VertexId v : mesh.points.ids()) own[v] = v.value();
  match_sides(mesh, own, result);
  if (std::ranges::find(result.twin, k_none) != result.twin.end()) match_sides(mesh, locations_of(mesh), result);
  return result;
}

/// Measures boxes, areas, volumes, senses and patches of the parts.
void measure(const TriMesh& mesh, Parts& all) {
  std::map<std::pair<std::uint32_t, PatchId>, double> of_patch;
  for (const TriangleId t : mesh.triangles.ids()) {
    Part& part = all.parts[all.part[t]];
    for (const Point& p : corners(mesh, t)) part.box.add(p);
  }
  std::vector<double> as_given(all.parts.size(), 0.0);
  for (const TriangleId t : mesh.triangles.ids()) {
    Part& part = all.parts[all.part[t]];
    const auto c = corners(mesh, t);
    const double area = triangle_area(c[0], c[1], c[2]), sign = all.is_flipped[t] ? -1.0 : 1.0;
    part.area += area;
    part.volume += sign * tet_volume(part.box.center(), c[0], c[1], c[2]);
    as_given[all.part[t]] += sign * area;
    of_patch[{all.part[t], mesh.triangle_patch[t]}] += area;
  }
  for (std::size_t i = 0; i < all.parts.size(); ++i)
    if (as_given[i] < 0.0) {
      all.parts[i].volume = -all.parts[i].volume;
      for (const TriangleId t : all.parts[i].triangles) all.is_flipped[t] = !all.is_flipped[t];
    }
  std::vector<double> most(all.parts.size(), -1.0);
  for (const auto& [key, area] : of_patch)
    if (area > most[key.first]) {
      most[key.first] = area;
      all.parts[key.first].patch = key.second;
    }
}

Parts parts_of(const TriMesh& mesh) {
  const Neighbours sides = neighbours_of(mesh);
  Parts all{Column<TriangleId, std::uint32_t>(mesh.n_triangles(), k_none), Column<TriangleId, char>(mesh.n_triangles(), 0), {}};
  std::vector<TriangleId> stack;
  for (const TriangleId start : mesh.triangles.ids()) {
    if (all.part[start] != k_none) continue;
    const auto number = static_cast<std::uint32_t>(all.parts.size());
    Part& part = all.parts.emplace_back();
    all.part[start] = number;
    stack.push_back(start);
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      part.triangles.push_back(t);
      for (std::size_t h = 3 * t.index(); h < 3 * t.index() + 3; ++h) {
        if (sides.twin[h] == k_none) {
          part.is_closed = false;
          continue;
        }
        const TriangleId u(static_cast<std::uint64_t>(sides.twin[h] / 3));
        if (all.part[u] != k_none) continue;
        all.part[u] = number;
        all.is_flipped[u] = static_cast<char>(static_cast<bool>(all.is_flipped[t]) != static_cast<bool>(sides.has_same_sense[h]));
        stack.push_back(u);
      }
    }
    std::sort(part.triangles.begin(), part.triangles.end());
  }
  measure(mesh, all);
  return all;
}

GeometryFigures figures_of(const Parts& all) {
  GeometryFigures figures;
  double volume = 0.0;
  for (const Part& part : all.parts) {
    figures.area += part.area;
    figures.n_closed += part.is_closed;
    figures.box.add(part.box);
    volume += part.is_turned ? -part.volume : part.volume;
  }
  figures.n_parts = static_cast<std::int64_t>(all.parts.size());
  if (figures.n_closed == figures.n_parts && figures.n_parts > 0) figures.volume = std::abs(volume);
  return figures;
}

std::map<std::string, double> areas_of(const TriMesh& mesh) {
  std::map<std::string, double> areas;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    areas[mesh.patches[mesh.triangle_patch[t]].name] += triangle_area(c[0], c[1], c[2]);
  }
  return areas;
}

bool is_number(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos; }

/// Returns the area of the patch with this name, or of its numbered pieces.
std::optional<double> area_under(const std::map<std::string, double>& areas, const std::string& name) {
  if (const auto found = areas.find(name); found != areas.end()) return found->second;
  std::optional<double> sum;
  const std::string prefix = name + "_";
  for (auto it = areas.lower_bound(prefix); it != areas.end() && it->first.starts_with(prefix); ++it)
    if (is_number(std::string_view(it->first).substr(prefix.size()))) sum = sum.value_or(0.0) + it->second;
  return sum;
}

bool differs(double before, double after) { return std::abs(after - before) > k_reported_change * std::max(std::abs(before), std::abs(after)); }

void compare_patches(const TriMesh& before, const TriMesh& after, GeometryChange& change) {
  const std::map<std::string, double> areas = areas_of(before), now = areas_of(after);
  for (const auto& [name, area] : areas) {
    if (!(area > 0.0)) continue;
    const std::optional<double> left = area_under(now, name);
    if (!left) change.missing_patches.push_back({name, area, 0.0});
    else if (differs(area, *left)) change.changed_patches.push_back({name, area, *left});
  }
  std::ranges::stable_sort(change.missing_patches, [](const PatchChange& a, const PatchChange& b) { return a.before > b.before; });
  std::ranges::stable_sort(change.changed_patches,
                           [](const PatchChange& a, const PatchChange& b) { return std::abs(a.after - a.before) > std::abs(b.after - b.before); });
}

/// Parts of the result on which the samples of an input part lie, with the sample counts.
struct Found {
  std::map<std::uint32_t, std::size_t> n;
  std::size_t n_turned = 0, n_near = 0, n_samples = 0;
};

Found find_part(const TriMesh& before, const Parts& all, const Part& part, const TriMesh& after, const Parts& now, const TriangleTree& tree, double near) {
  Found found;
  const std::size_t step = std::max<std::size_t>(1, part.triangles.size() / k_samples);
  for (std::size_t i = 0; i < part.triangles.size(); i += step) {
    const TriangleId t = part.triangles[i];
    const auto c = corners(before, t);
    ++found.n_samples;
    const NearestHit hit = tree.nearest((c[0] + c[1] + c[2]) / 3.0, near);
    if (!hit.triangle.is_valid()) continue;
    ++found.n_near;
    ++found.n[now.part[hit.triangle]];
    const auto d = corners(after, hit.triangle);
    const double sign = all.is_flipped[t] ? -1.0 : 1.0;
    found.n_turned += sign * dot(area_vector(c[0], c[1], c[2]), area_vector(d[0], d[1], d[2])) < 0.0;
  }
  return found;
}

class PartNames {
 public:
  PartNames(const TriMesh& mesh, const Parts& all) : mesh_(mesh) {
    for (const Part& part : all.parts) ++n_[part.patch];
  }
  PartChange describe(const Part& part) const {
    PartChange change{mesh_.patches[part.patch].name, part.box.center(), part.area, part.is_closed ? std::abs(part.volume) : 0.0};
    if (n_.at(part.patch) > 1) change.name += " about " + format_point(change.location);
    return change;
  }

 private:
  const TriMesh& mesh_;
  std::map<PatchId, int> n_;
};

void compare_parts(const TriMesh& before, Parts& all, const TriMesh& after, const Parts& now, GeometryChange& change, const RunContext& context) {
  if (all.parts.size() < 2 && now.parts.size() < 2) return;
  if (after.n_triangles() == 0) return;
  const TriangleTree tree(after, context);
  const PartNames names(before, all);
  Box box;
  for (const Part& part : all.parts) box.add(part.box);
  const double length = box.longest_side();
  std::map<std::uint32_t, std::vector<std::size_t>> closed_in;  // per part of the result
  for (std::size_t i = 0; i < all.parts.size(); ++i) {
    context.check_stop();
    Part& part = all.parts[i];
    const Found found = find_part(before, all, part, after, now, tree, std::max(k_near_of_length * length, k_near_of_part * part.box.longest_side()));
    if (found.n_near == 0) {
      change.missing_parts.push_back(names.describe(part));
      continue;
    }
    part.is_turned = 2 * found.n_turned > found.n_near;
    if (!part.is_closed) continue;
    std::size_t most = 0, n_many = 0;
    std::uint32_t main = k_none;
    for (const auto& [number, n] : found.n) {
      if (n > most) most = n, main = number;
      n_many += static_cast<double>(n) > k_share_of_division * static_cast<double>(found.n_near);
    }
    closed_in[main].push_back(i);
    if (n_many > 1) change.divided_parts.push_back(names.describe(part));
  }
  for (const auto& [number, parts] : closed_in) {
    if (parts.size() < 2) continue;
    std::vector<PartChange>& joined = change.joined_parts.emplace_back();
    for (const std::size_t i : parts) joined.push_back(names.describe(all.parts[i]));
  }
  // A part that is near several parts of the result may only touch them. It is divided only if the result has more parts.
  if (now.parts.size() <= all.parts.size()) change.divided_parts.clear();
  std::ranges::stable_sort(change.missing_parts, [](const PartChange& a, const PartChange& b) { return a.area > b.area; });
}

}  // namespace

bool GeometryChange::is_area_changed() const { return differs(before.area, after.area); }
bool GeometryChange::is_volume_changed() const { return before.volume && after.volume && differs(*before.volume, *after.volume); }
bool GeometryChange::is_box_changed() const {
  if (before.box.empty() || after.box.empty()) return before.box.empty() != after.box.empty();
  const double most = k_reported_change * before.box.longest_side();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(before.box.min[axis] - after.box.min[axis]) > most || std::abs(before.box.max[axis] - after.box.max[axis]) > most) return true;
  return false;
}
bool GeometryChange::is_small() const {
  return missing_patches.empty() && changed_patches.empty() && missing_parts.empty() && joined_parts.empty() && divided_parts.empty() && !is_area_changed() &&
         !is_volume_changed() && !is_box_changed();
}

GeometryChange compare_geometry(const TriMesh& before, const TriMesh& after, std::string by, const RunContext& context) {
  GeometryChange change;
  change.by = std::move(by);
  Parts all = parts_of(before);
  const Parts now = parts_of(after);
  compare_parts(before, all, after, now, change, context);
  change.before = figures_of(all);
  change.after = figures_of(now);
  compare_patches(before, after, change);
  return change;
}

}  // namespace sterna
