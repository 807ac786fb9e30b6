#include "geom/boolean/solid_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "geom/base/disjoint_sets.h"
#include "geom/base/parallel.h"
#include "geom/boolean/union_patches.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"

namespace sterna {
namespace {

constexpr std::string_view k_parting_attempt = "uniting surfaces";

std::string part_name(const UnionPart& part, std::size_t index) { return part.name.empty() ? "part " + std::to_string(index + 1) : part.name; }

void require_closed(const TriMesh& mesh, const Topology& topology, const std::string& name) {
  if (topology.n_boundary_halfedges() == 0) return;
  ErrorInfo info{.code = ErrorCode::open_surface,
                 .attempted = std::string(k_parting_attempt),
                 .problem = name + " is open: " + std::to_string(topology.n_boundary_halfedges()) + " edges with one triangle only",
                 .n_locations = static_cast<std::int64_t>(topology.n_boundary_halfedges()),
                 .hint = "close the surface; only solids can be united"};
  for (std::uint64_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    const Point &a = mesh.points[topology.from(h)], &b = mesh.points[topology.to(h)];
    if (info.locations.size() < k_max_locations) info.locations.push_back({0.5 * (a + b), "open edge of " + name});
    if (info.geometry.edges.size() >= k_max_geometry) break;
    const auto n = static_cast<std::uint32_t>(info.geometry.points.size());
    info.geometry.points.insert(info.geometry.points.end(), {a, b});
    info.geometry.edges.push_back({n, n + 1});
  }
  throw Error(std::move(info));
}

LocalLength length_of(const std::array<Point, 3>& c) {
  const double a = distance(c[0], c[1]), b = distance(c[1], c[2]), d = distance(c[2], c[0]);
  return {.shortest = std::min({a, b, d}), .longest = std::max({a, b, d})};
}

/// Appends the components of one part, oriented outwards, to `all`.
void add_solids(const UnionPart& part, std::size_t index, const std::vector<Patch>& patches, SolidParts& all, std::int64_t& n_turned,
                const RunContext& context) {
  const Topology topology(part.mesh, context);
  const std::string name = part_name(part, index);
  require_closed(part.mesh, topology, name);
  const Components components = connected_components(part.mesh, topology);
  const std::size_t first = all.solids.size();
  all.solids.resize(first + components.count);
  // Each solid has its own vertices, even if two solids touch; numbered by first use.
  std::vector<std::map<VertexId, std::uint32_t>> numbers(components.count);
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> regions;
  for (const TriangleId t : part.mesh.triangles.ids()) {
    const std::uint32_t c = components.component[t];
    Solid& solid = all.solids[first + c];
    auto& triangle = solid.surface.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v = part.mesh.triangles[t][k];
      const auto [found, is_new] = numbers[c].try_emplace(v, static_cast<std::uint32_t>(solid.surface.points.size()));
      if (is_new) solid.surface.points.push_back(part.mesh.points[v]);
      triangle[k] = found->second;
    }
    const std::uint32_t patch = part.mesh.triangle_patch[t].value();
    const auto [region, is_new] = regions.try_emplace({c, patch}, static_cast<std::uint32_t>(all.region_patch.size()));
    if (is_new) all.region_patch.push_back(patches[patch]);
    solid.surface.tag.push_back(static_cast<std::uint32_t>(all.facets.size()));
    const auto p = corners(part.mesh, t);
    all.facets.push_back({static_cast<std::uint32_t>(first + c), region->second, normalized(area_vector(p[0], p[1], p[2])), length_of(p)});
  }
  for (std::uint32_t c = 0; c < components.count; ++c) {
    Solid& solid = all.solids[first + c];
    solid.part = index;
    solid.number = c;
    for (const Vec3& p : solid.surface.points) solid.box.add(p);
    all.names.push_back(components.count == 1 ? name
                                              : "component " + std::to_string(c + 1) + " of " + name + " (" + std::to_string(solid.surface.triangles.size()) +
                                                    " triangles near " + format_point(solid.box.center()) + ")");
    if (volume_of(solid.surface.points, solid.surface.triangles) >= 0.0) continue;
    ++n_turned;
    for (auto& triangle : solid.surface.triangles) std::swap(triangle[1], triangle[2]);
    for (const std::uint32_t tag : solid.surface.tag) all.facets[tag].normal = -all.facets[tag].normal;
  }
}

/// Processes every pair of intersecting triangles. A pair within one solid is an error, a pair of two solids links them.
void find_links(SolidParts& all, const RunContext& context) {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles(all.facets.size());
  for (const Solid& solid : all.solids) {
    const auto offset = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), solid.surface.points.begin(), solid.surface.points.end());
    for (std::size_t i = 0; i < solid.surface.triangles.size(); ++i) {
      triangles[solid.surface.tag[i]] = solid.surface.triangles[i];
      for (std::uint32_t& v : triangles[solid.surface.tag[i]]) v += offset;
    }
  }
  CrossingPairs pairs = find_crossings(points, triangles, context);
  std::vector<std::array<std::uint32_t, 2>> own;
  for (const auto& pair : pairs.pairs) (all.facets[pair[0]].solid == all.facets[pair[1]].solid ? own : all.crossings).push_back(pair);
  if (own.empty()) return;
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = std::string(k_parting_attempt),
                 .problem = all.names[all.facets[own.front()[0]].solid] + " crosses itself: " + std::to_string(own.size()) + " pairs of triangles",
                 .hint = "only different closed components may cross each other; repair this component first"};
  add_crossing_locations(info, all, own);
  throw Error(std::move(info));
}

void find_groups(SolidParts& all) {
  DisjointSets sets(all.solids.size());
  for (const auto& [a, b] : all.crossings) sets.join(all.facets[a].solid, all.facets[b].solid);
  std::vector<std::uint32_t> group(all.solids.size());
  for (std::uint32_t s = 0; s < all.solids.size(); ++s) {
    if (sets.root(s) == s) {
      group[s] = static_cast<std::uint32_t>(all.groups.size());
      all.groups.emplace_back();
    }
    all.groups[group[sets.root(s)]].push_back(s);
  }
}

/// Returns a component's name without its description.
std::string short_name(const SolidParts& parts, std::uint32_t solid) { return parts.names[solid].substr(0, parts.names[solid].find(" (")); }

}  // namespace

std::vector<std::vector<Patch>> result_patches(const std::vector<UnionPart>& parts) {
  std::map<std::string, std::size_t> n_users;
  for (const UnionPart& part : parts)
    for (const Patch& patch : part.mesh.patches) ++n_users[patch.name];
  std::vector<std::vector<Patch>> patches(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (Patch patch : parts[i].mesh.patches) {
      if (n_users[patch.name] > 1 && !parts[i].name.empty() && parts[i].name != patch.name) patch.name = parts[i].name + "_" + patch.name;
      patches[i].push_back(std::move(patch));
    }
  return patches;
}

double volume_of(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  CompensatedSum volume;
  if (triangles.empty()) return 0.0;
  const Vec3 origin = points[triangles.front()[0]];
  for (const auto& t : triangles) volume.add(tet_volume(origin, points[t[0]], points[t[1]], points[t[2]]));
  return volume.value();
}

void add_crossing_locations(ErrorInfo& info, const SolidParts& parts, const std::vector<std::array<std::uint32_t, 2>>& crossings) {
  // Index of each facet (by tag) in its solid.
  std::vector<std::uint32_t> location_in_solid(parts.facets.size());
  for (const Solid& solid : parts.solids)
    for (std::uint32_t i = 0; i < solid.surface.tag.size(); ++i) location_in_solid[solid.surface.tag[i]] = i;
  const auto corners_of = [&](std::uint32_t tag) {
    const TaggedSolid& surface = parts.solids[parts.facets[tag].solid].surface;
    const auto& v = surface.triangles[location_in_solid[tag]];
    return std::array<Vec3, 3>{surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]};
  };
  info.n_locations = static_cast<std::int64_t>(crossings.size());
  std::set<std::uint32_t> shown;  // one location per facet, so that the list is not filled by a single one
  for (const auto& pair : crossings) {
    const std::uint32_t smaller = parts.facets[pair[0]].length.longest <= parts.facets[pair[1]].length.longest ? pair[0] : pair[1];
    const auto c = corners_of(smaller);
    const std::uint32_t one = parts.facets[pair[0]].solid, other = parts.facets[pair[1]].solid;
    if (info.locations.size() < k_max_locations && !shown.contains(pair[0]) && shown.insert(smaller).second) {
      shown.insert(pair[0]);
      info.locations.push_back(
          {(c[0] + c[1] + c[2]) / 3.0, one == other ? "triangles of " + short_name(parts, one) : short_name(parts, one) + " and " + short_name(parts, other)});
    }
    if (info.geometry.triangles.size() >= k_max_geometry) break;
    for (const std::uint32_t tag : pair) {
      const auto n = static_cast<std::uint32_t>(info.geometry.points.size());
      for (const Vec3& p : corners_of(tag)) info.geometry.points.push_back(p);
      info.geometry.triangles.push_back({n, n + 1, n + 2});
    }
  }
}

SolidParts find_solids(const std::vector<UnionPart>& parts, UnionReport& report, const RunContext& context) {
  SolidParts all;
  const std::vector<std::vector<Patch>> patches = result_patches(parts);
  std::int64_t n_turned = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    context.check_stop();
    if (parts[i].mesh.n_triangles() == 0)
      throw Error({.code = ErrorCode::empty_surface, .attempted = std::string(k_parting_attempt), .problem = part_name(parts[i], i) + " has no triangle"});
    add_solids(parts[i], i, patches[i], all, n_turned, context);
  }
  if (all.solids.empty())
    throw Error({.code = ErrorCode::empty_surface, .attempted = std::string(k_parting_attempt), .problem = "there is no surface to unite"});
  report.n_solids = static_cast<std::int64_t>(all.solids.size());
  if (n_turned > 0) report.messages.push_back(std::to_string(n_turned) + (n_turned == 1 ? " solid was" : " solids were") + " inside out: orientation reversed");
  find_links(all, context);
  find_groups(all);
  return all;
}

}  // namespace sterna
