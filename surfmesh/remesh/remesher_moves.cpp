// Remesher: moves vertices along the reference and improves bad triangles.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "surfmesh/remesh/remesher.h"

namespace sterna::surfmesh {
namespace {

/// A vertex whose triangles are all better than this is not moved.
constexpr double k_still = 0.96;
/// Number of directions and steps (relative to the target length) of the search for a better location.
constexpr int k_search_directions = 8;
constexpr std::array<double, 3> k_search_steps = {0.25, 0.1, 0.03};
constexpr double k_search_gain = 1e-4;
/// To improve a bad triangle, edges shorter than this may be collapsed, and longer ones may be halved.
constexpr double k_short_in_trouble = 1.0;
constexpr double k_long_after_trouble = 1.7;
/// Mean ratio of a triangle with a corner of about 10 degrees. To improve worse triangles, edges of any length may be collapsed, and edges of up to
/// k_long_for_slivers target lengths may remain.
constexpr double k_sliver_ratio = 0.3;
constexpr double k_long_for_slivers = 3.0;
constexpr std::size_t k_move_chunk = 256;

}  // namespace

/// Computes a greedy colouring in the order of vertices. No two neighbours have the same colour.
std::vector<std::vector<std::uint32_t>> Remesher::colours() const {
  std::vector<std::uint8_t> colour(mesh_.vertices.size(), 255);
  std::vector<std::vector<std::uint32_t>> lists;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (mesh_.vertices[v].out == k_none || mesh_.vertices[v].kind == VertexKind::corner) continue;
    std::uint64_t used = 0;
    mesh_.for_ring(v, [&](std::uint32_t w) {
      if (colour[w] < 64) used |= std::uint64_t{1} << colour[w];
    });
    const int c = std::countr_one(used);
    if (c >= 64) continue;  // a vertex with more than 63 neighbours is not moved
    colour[v] = static_cast<std::uint8_t>(c);
    if (lists.size() <= static_cast<std::size_t>(c)) lists.resize(static_cast<std::size_t>(c) + 1);
    lists[static_cast<std::size_t>(c)].push_back(v);
  }
  return lists;
}

/// Returns the vertex moved by a fraction of the distance to a centre. On a line the centre is the middle between its neighbours, on a face the centre of the
/// adjacent triangles, each weighted by its area in units of the target length.
WorkVertex Remesher::smoothed(std::uint32_t number, double share) const {
  const WorkVertex& v = mesh_.vertices[number];
  WorkVertex moved = v;
  if (v.kind == VertexKind::line) {
    double s[2] = {0.0, 0.0}, size[2] = {0.0, 0.0};
    int n = 0;
    mesh_.for_out(number, [&](std::uint32_t h) {
      const auto take = [&](std::uint32_t w) {
        if (n < 2) {
          s[n] = s_on_line(w, v.line);
          size[n] = mesh_.vertices[w].size;
        }
        ++n;
      };
      if (mesh_.line[h] == v.line) take(mesh_.to(h));
      const std::uint32_t in = WorkMesh::prev(h);
      if (mesh_.twin[in] == k_none && mesh_.line[in] == v.line) take(mesh_.from(in));
    });
    if (n != 2) return v;
    const double target = s[0] + (s[1] - s[0]) * (size[0] + v.size) / (size[0] + 2.0 * v.size + size[1]);
    put_on_line(moved, v.line, v.s + share * (target - v.s));
    return moved;
  }
  Vec3 sum;
  double weights = 0.0;
  mesh_.for_out(number, [&](std::uint32_t h) {
    const WorkVertex &a = mesh_.vertices[mesh_.to(h)], &b = mesh_.vertices[mesh_.apex(h)];
    const double size = v.size + a.size + b.size;
    const double weight = triangle_area(v.point, a.point, b.point) / (size * size * size * size);
    sum += weight * (v.point + a.point + b.point);
    weights += weight;
  });
  if (!(weights > 0.0)) return v;
  Vec3 way = sum / (3.0 * weights) - v.point;
  const Vec3& n = v.normal;
  way = way - dot(way, n) * n;
  put_on_face(moved, v.point + share * way, v.location.triangle);
  return moved;
}

bool Remesher::move(std::uint32_t v, double good) {
  if (mesh_.vertices[v].is_fixed) return false;
  const double before = fan_quality(v);
  if (before > k_still) return false;
  const WorkVertex kept = mesh_.vertices[v];
  const double floor = std::min(before, good);
  for (const double share : {1.0, 0.4}) {
    const WorkVertex moved = smoothed(v, share);
    mesh_.vertices[v] = moved;
    if (fan_quality_now(v, floor) >= floor) {
      update_fan(v);
      return true;
    }
    mesh_.vertices[v] = kept;
  }
  return false;
}

void Remesher::smooth(int rounds, double floor) {
  const auto lists = colours();
  for (int round = 0; round < rounds; ++round)
    for (const auto& list : lists) {
      if (sizes_.is_serial()) std::for_each(list.begin(), list.end(), [&](std::uint32_t v) { move(v, floor); });
      else
        parallel_for(
            context_, list.size(), [&](std::size_t i) { move(list[i], floor); }, k_move_chunk);
    }
}

/// Searches around the vertex for a location where its worst triangle is better.
bool Remesher::search(std::uint32_t number) {
  if (mesh_.vertices[number].kind == VertexKind::corner || mesh_.vertices[number].is_fixed) return false;
  bool has_moved = false;
  double best = fan_quality(number);
  for (const double step : k_search_steps) {
    const WorkVertex start = mesh_.vertices[number];
    WorkVertex found = start;
    const double length = step * start.size;
    const auto look = [&](const WorkVertex& moved) {
      mesh_.vertices[number] = moved;
      if (const double q = fan_quality_now(number, best + k_search_gain); q > best + k_search_gain) {
        best = q;
        found = moved;
        has_moved = true;
      }
    };
    if (start.kind == VertexKind::line) {
      for (const double way : {-length, length}) {
        WorkVertex moved = start;
        put_on_line(moved, start.line, std::clamp(start.s + way, 0.0, r_.lines[static_cast<std::size_t>(start.line)].length()));
        look(moved);
      }
    } else {
      const Vec3 n = start.normal;
      const Vec3 u = normalized(std::abs(n.x) < 0.6 ? cross(n, Vec3{1.0, 0.0, 0.0}) : cross(n, Vec3{0.0, 1.0, 0.0})), w = cross(n, u);
      for (int k = 0; k < k_search_directions; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / k_search_directions;
        WorkVertex moved = start;
        put_on_face(moved, start.point + length * (std::cos(angle) * u + std::sin(angle) * w), start.location.triangle);
        look(moved);
      }
    }
    mesh_.vertices[number] = found;
  }
  if (has_moved) update_fan(number);
  return has_moved;
}

std::int64_t Remesher::improve(double target_quality) {
  std::vector<std::pair<double, std::uint32_t>> bad;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (mesh_.is_gone(t) || is_kept(t)) continue;
    if (const double q = quality(t); q < target_quality) bad.emplace_back(q, t);
  }
  std::sort(bad.begin(), bad.end());
  std::int64_t n = 0;
  const auto length2 = [&](std::uint32_t h) { return norm2(mesh_.at(mesh_.to(h)) - mesh_.at(mesh_.from(h))); };
  for (const auto& [was, t] : bad) {
    if (mesh_.is_gone(t)) continue;
    const double q = quality(t);
    if (q >= target_quality) continue;
    std::array<std::uint32_t, 3> edges{3 * t, 3 * t + 1, 3 * t + 2};
    std::sort(edges.begin(), edges.end(), [&](std::uint32_t a, std::uint32_t b) { return std::pair(length2(a), a) < std::pair(length2(b), b); });
    bool is_done = false;
    for (std::size_t k = 3; k-- > 0 && !is_done;) is_done = try_flip(edges[k], k_search_gain);
    const bool is_sliver = q < k_sliver_ratio;
    for (std::size_t k = 0; k < (is_sliver ? 3 : 2) && !is_done; ++k)
      is_done = !is_locked(edges[k]) && (is_sliver || length_ratio(edges[k]) < k_short_in_trouble) &&
                try_collapse(edges[k], q + k_search_gain, is_sliver ? k_long_for_slivers : k_long_after_trouble);
    for (std::size_t k = 0; k < 3 && !is_done; ++k) is_done = search(mesh_.triangles[t][k]);
    if (is_done) ++n;
  }
  context_.check_stop();
  return n;
}

}  // namespace sterna::surfmesh
