// The steps are: find the closed components of all parts (find_solids), unite the groups that are connected by crossings exactly (unite_group), remove groups
// inside other solids (is_inside_another) and cavities (drop_cavities), remesh the strips along the curves (remesh_strip), and test for crossings.
#include "geom/boolean/union_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/boolean/cgal_corefine.h"
#include "geom/boolean/remesh_strip.h"
#include "geom/boolean/solid_parts.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "geom/mesh/compare_geometry.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"

namespace sterna {
namespace {

constexpr std::string_view k_attempted = "uniting surfaces";
/// Fractions of the progress, measured on Martlet2 (19 solids, 12 k triangles).
constexpr double k_find_end = 0.15, k_unite_end = 0.5, k_remesh_end = 0.85;
/// Fraction of the permitted distance that is recommended if the geometry changes by more than k_reported_change.
constexpr double k_closer = 0.1;

TriMesh tri_mesh_of(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  TriMesh mesh;
  mesh.points.raw() = points;
  mesh.triangles.reserve(triangles.size());
  for (const auto& t : triangles) mesh.triangles.push_back({VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
  return mesh;
}

void append(TaggedSolid& all, const TaggedSolid& more) {
  const auto offset = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  for (auto t : more.triangles) {
    for (std::uint32_t& v : t) v += offset;
    all.triangles.push_back(t);
  }
  all.tag.insert(all.tag.end(), more.tag.begin(), more.tag.end());
}

[[noreturn]] void throw_refused(const SolidParts& parts, const std::vector<std::uint32_t>& group, const CorefinedUnion& refused) {
  const std::uint32_t failed = group[refused.failed];
  const std::set<std::uint32_t> earlier(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(refused.failed));
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (const auto& [a, b] : parts.crossings) {
    const std::uint32_t s = parts.facets[a].solid, t = parts.facets[b].solid;
    if ((s == failed && earlier.contains(t)) || (t == failed && earlier.contains(s))) pairs.push_back({a, b});
  }
  std::string partner = "the solids before it";
  if (!pairs.empty()) {
    const std::uint32_t s = parts.facets[pairs.front()[0]].solid;
    partner = parts.names[s == failed ? parts.facets[pairs.front()[1]].solid : s];
  }
  ErrorInfo info{.code = ErrorCode::non_manifold_surface,
                 .attempted = std::string(k_attempted),
                 .problem = parts.names[failed] + " and " + partner + " cannot be united: " + refused.reason,
                 .hint = "move one of the two solids so that they overlap clearly or are clearly apart"};
  add_crossing_locations(info, parts, pairs);
  throw Error(std::move(info));
}

TaggedSolid unite_group(const SolidParts& parts, const std::vector<std::uint32_t>& group, const RunContext& context) {
  if (group.size() == 1) return parts.solids[group.front()].surface;
  std::vector<TaggedSolid> solids;
  for (const std::uint32_t s : group) solids.push_back(parts.solids[s].surface);
  CorefinedUnion united = corefine_union(solids, context);
  if (!united.is_solid) throw_refused(parts, group, united);
  return std::move(united.surface);
}

/// Winding numbers about the solids; hierarchies are built on demand.
class Insides {
 public:
  Insides(const SolidParts& parts, const RunContext& context) : parts_(parts), context_(context), trees_(parts.solids.size()) {}
  /// Returns true if the group is inside another solid. Groups do not cross, so one vertex represents the group.
  bool is_inside_another(const std::vector<std::uint32_t>& group, std::uint32_t& container) {
    const Vec3 p = parts_.solids[group.front()].surface.points.front();
    for (std::uint32_t s = 0; s < parts_.solids.size(); ++s) {
      if (std::binary_search(group.begin(), group.end(), s) || !overlap(Box{p, p}, parts_.solids[s].box)) continue;
      if (!trees_[s]) trees_[s] = std::make_unique<TriangleTree>(tri_mesh_of(parts_.solids[s].surface.points, parts_.solids[s].surface.triangles), context_);
      if (trees_[s]->winding_number(p) < 0.5) continue;
      container = s;
      return true;
    }
    return false;
  }

 private:
  const SolidParts& parts_;
  const RunContext& context_;
  std::vector<std::unique_ptr<TriangleTree>> trees_;
};

TaggedSolid unite_all(const SolidParts& parts, UnionReport& report, const RunContext& context) {
  TaggedSolid all;
  Insides insides(parts, context);
  const auto n_groups = static_cast<double>(parts.groups.size());
  for (std::size_t g = 0; g < parts.groups.size(); ++g) {
    const std::vector<std::uint32_t>& group = parts.groups[g];
    context.check_stop();
    std::uint32_t container = 0;
    if (insides.is_inside_another(group, container)) {
      report.n_vanished += static_cast<std::int64_t>(group.size());
      for (const std::uint32_t s : group) report.messages.push_back(parts.names[s] + " lies inside " + parts.names[container] + ": it is removed");
      continue;
    }
    const TaggedSolid united = unite_group(parts, group, context.part("unite", static_cast<double>(g) / n_groups, static_cast<double>(g + 1) / n_groups));
    std::set<std::uint32_t> left;
    for (const std::uint32_t tag : united.tag) left.insert(parts.facets[tag].solid);
    for (const std::uint32_t s : group)
      if (!left.contains(s)) {
        ++report.n_vanished;
        report.messages.push_back(parts.names[s] + " lies inside the others: it is removed");
      }
    append(all, united);
  }
  return all;
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

/// Removes cavities: components of the result with normals inwards.
void drop_cavities(TaggedSolid& surface, const UnionOptions& options, UnionReport& report, const RunContext& context) {
  const TriMesh mesh = tri_mesh_of(surface.points, surface.triangles);
  const Components components = connected_components(mesh, Topology(mesh, context));
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles(components.count);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) triangles[components.component[TriangleId(std::uint64_t{t})]].push_back(surface.triangles[t]);
  std::vector<char> is_dropped(components.count, 0);
  for (std::uint32_t c = 0; c < components.count; ++c) {
    const double volume = volume_of(surface.points, triangles[c]);
    if (volume >= 0.0) continue;
    ++report.n_cavities;
    is_dropped[c] = !options.keep_cavities;
    report.messages.push_back("a cavity of " + short_number(-volume) + " m^3 near " + format_point(surface.points[triangles[c].front()[0]]) +
                              (options.keep_cavities ? " is kept" : " is removed: the outer flow does not reach it"));
  }
  report.n_components = components.count - std::count(is_dropped.begin(), is_dropped.end(), 1);
  TaggedSolid kept;
  kept.points = std::move(surface.points);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (is_dropped[components.component[TriangleId(std::uint64_t{t})]]) continue;
    kept.triangles.push_back(surface.triangles[t]);
    kept.tag.push_back(surface.tag[t]);
  }
  surface = std::move(kept);
}

/// Builds the input of the remesher in the order of the input triangles, which exact cutting has changed.
StripInput strip_input(const TaggedSolid& surface, const SolidParts& parts) {
  std::vector<std::uint32_t> order(surface.triangles.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return surface.tag[a] < surface.tag[b]; });
  StripInput input;
  input.points = surface.points;
  constexpr double k_none = 1e300;
  input.length.assign(input.points.size(), {k_none, k_none});
  for (const std::uint32_t t : order) {
    const InputFacet& facet = parts.facets[surface.tag[t]];
    input.triangles.push_back({surface.triangles[t], facet.region, facet.normal});
    input.solid.push_back(facet.solid);
    for (const std::uint32_t v : surface.triangles[t]) {
      input.length[v].shortest = std::min(input.length[v].shortest, facet.length.shortest);
      input.length[v].longest = std::min(input.length[v].longest, facet.length.longest);
    }
  }
  return input;
}

void measure_curves(const StripInput& input, UnionReport& report) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> seen;  // edge -> solid
  CompensatedSum length;
  for (std::size_t t = 0; t < input.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = input.triangles[t].v[k], b = input.triangles[t].v[(k + 1) % 3];
      const auto [other, is_new] = seen.try_emplace({std::min(a, b), std::max(a, b)}, input.solid[t]);
      if (is_new || other->second == input.solid[t]) continue;
      ++report.n_curve_edges;
      length.add(distance(input.points[a], input.points[b]));
    }
  report.curve_length = length.value();
}

/// Assembles the mesh: vertices by first use, patches in the order of the parts, without patches that have no triangles.
TriMesh assemble(const std::vector<Vec3>& points, const std::vector<StripTriangle>& triangles, const SolidParts& parts) {
  std::vector<char> is_used(parts.region_patch.size(), 0);
  for (const StripTriangle& t : triangles) is_used[t.region] = 1;
  TriMesh mesh;
  std::vector<PatchId> region2patch(parts.region_patch.size());
  for (std::size_t r = 0; r < parts.region_patch.size(); ++r) {
    if (!is_used[r]) continue;
    const Patch& patch = parts.region_patch[r];
    const auto known = std::find(mesh.patches.begin(), mesh.patches.end(), patch);
    region2patch[r] = known != mesh.patches.end() ? PatchId(static_cast<std::uint64_t>(known - mesh.patches.begin())) : mesh.patches.push_back(patch);
  }
  std::vector<VertexId> number(points.size());
  for (const StripTriangle& t : triangles) {
    TriangleVertices v;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!number[t.v[k]].is_valid()) number[t.v[k]] = mesh.points.push_back(points[t.v[k]]);
      v[k] = number[t.v[k]];
    }
    mesh.triangles.push_back(v);
    mesh.triangle_patch.push_back(region2patch[t.region]);
  }
  return mesh;
}

double farthest_from(const TriangleTree& tree, const std::vector<Vec3>& samples, const RunContext& context) {
  return parallel_reduce(
      context, samples.size(), 0.0,
      [&](std::size_t begin, std::size_t end) {
        double farthest = 0.0;
        for (std::size_t i = begin; i < end; ++i) farthest = std::max(farthest, tree.nearest(samples[i]).distance);
        return farthest;
      },
      [](double a, double b) { return std::max(a, b); });
}

std::vector<Vec3> samples_of(const TriMesh& mesh) {
  std::vector<Vec3> samples(mesh.points.begin(), mesh.points.end());
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    samples.push_back((c[0] + c[1] + c[2]) / 3.0);
    for (std::size_t k = 0; k < 3; ++k) samples.push_back(0.5 * (c[k] + c[(k + 1) % 3]));
  }
  return samples;
}

/// Tests for crossings that rounding of the exact points left and no step removed.
void require_free_of_crossings(const TriMesh& mesh, const RunContext& context) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  const CrossingPairs crossings = find_crossings(mesh.points.raw(), triangles, context, k_max_geometry);
  if (crossings.total == 0) return;
  ErrorInfo info{
      .code = ErrorCode::self_intersection,
      .attempted = std::string(k_attempted),
      .problem = "after rounding to doubles " + std::to_string(crossings.total) + " pairs of triangles of the result cross or touch",
      .n_locations = crossings.total,
      .hint = "parts that nearly touch, or nearly share a face, cannot be separated there: move them so that they overlap clearly or are clearly apart"};
  for (const auto& pair : crossings.pairs) {
    std::vector<std::array<Vec3, 3>> both;
    for (const std::uint32_t t : pair) both.push_back(corners(mesh, TriangleId(t)));
    const auto name = [&](std::uint32_t t) { return mesh.patches[mesh.triangle_patch[TriangleId(t)]].name; };
    const auto& small = bounding_box({.points = {both[0][0], both[0][1], both[0][2]}}).longest_side() <
                                bounding_box({.points = {both[1][0], both[1][1], both[1][2]}}).longest_side()
                            ? both[0]
                            : both[1];
    if (info.locations.size() < k_max_locations)
      info.locations.push_back({(small[0] + small[1] + small[2]) / 3.0, "patches " + name(pair[0]) + " and " + name(pair[1])});
    for (const auto& c : both) {
      const auto n = static_cast<std::uint32_t>(info.geometry.points.size());
      info.geometry.points.insert(info.geometry.points.end(), c.begin(), c.end());
      info.geometry.triangles.push_back({n, n + 1, n + 2});
    }
  }
  throw Error(std::move(info));
}

std::string strip_text(const UnionReport& report) {
  const auto figures = [](const StripQuality& q) {
    return std::to_string(q.n_triangles) + " triangles, " + std::to_string(q.n_slivers) + " below 5 deg, smallest angle " +
           short_number(k_degrees * q.min_angle) + " deg, shortest edge " + short_number(q.shortest_edge) + " m";
  };
  return "strips along " + short_number(report.curve_length) + " m of curves remeshed: before " + figures(report.before) + "; after " + figures(report.after) +
         "; at most " + short_number(report.max_deviation) + " m from the exact union";
}

/// Area and enclosed volume of a closed surface.
struct Extent {
  double area = 0.0, volume = 0.0;
};

Extent extent_of(const TriMesh& mesh) {
  CompensatedSum area, volume;
  const Vec3 origin = bounding_box(mesh).center();
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    area.add(triangle_area(c[0], c[1], c[2]));
    volume.add(tet_volume(origin, c[0], c[1], c[2]));
  }
  return {area.value(), volume.value()};
}

double relative_change(double before, double after) { return before != 0.0 ? (after - before) / std::abs(before) : 0.0; }

double largest_change(const Extent& before, const Extent& after) {
  return std::max(std::abs(relative_change(before.area, after.area)), std::abs(relative_change(before.volume, after.volume)));
}

/// Returns "enclosed volume 0.32 -> 0.318 m3 (-0.6 %), area ...".
std::string change_text(const Extent& before, const Extent& after) {
  const auto text = [](double a, double b, const char* unit) {
    return short_number(a) + " -> " + short_number(b) + " " + unit + " (" + short_number(100.0 * relative_change(a, b)) + " %)";
  };
  return "enclosed volume " + text(before.volume, after.volume, "m3") + ", area " + text(before.area, after.area, "m2");
}

/// Warns if the geometry changed noticeably: on coarse curved surfaces the permitted distance from the input can be a significant part of the volume.
void warn_of_changed_geometry(const TriMesh& exact, const TriMesh& remeshed, const UnionOptions& options, const RunContext& context) {
  const Extent before = extent_of(exact), after = extent_of(remeshed);
  if (largest_change(before, after) <= k_reported_change) return;
  context.warn("union: remeshing along the intersection curves changed the geometry: " + change_text(before, after) + ". Remeshed triangles may lie up to " +
               short_number(options.deviation) +
               " local edge lengths from the input (deviation); that is a large distance where the input is coarse. A smaller deviation, such as " +
               short_number(k_closer * options.deviation) + ", changes the geometry less and leaves more slivers; remesh = false keeps the exact union");
}

}  // namespace

UnionResult unite_meshes(const std::vector<UnionPart>& parts, const UnionOptions& options, const RunContext& context) {
  UnionResult result;
  UnionReport& report = result.report;
  const SolidParts solids = find_solids(parts, report, context.part("find solids", 0.0, k_find_end));
  TaggedSolid surface = unite_all(solids, report, context.part("unite", k_find_end, k_unite_end));
  drop_cavities(surface, options, report, context);
  StripInput strip = strip_input(surface, solids);
  measure_curves(strip, report);

  if (options.remesh && report.n_curve_edges > 0) {
    const TriMesh exact = assemble(strip.points, strip.triangles, solids);
    const StripOutput remeshed = remesh_strip(std::move(strip), options, report, context.part("remesh", k_unite_end, k_remesh_end));
    result.mesh = assemble(remeshed.points, remeshed.triangles, solids);
    warn_of_changed_geometry(exact, result.mesh, options, context);
    report.max_deviation = std::max(farthest_from(TriangleTree(exact, context), samples_of(result.mesh), context),
                                    farthest_from(TriangleTree(result.mesh, context), samples_of(exact), context));
    report.messages.push_back(strip_text(report));
  } else {
    result.mesh = assemble(strip.points, strip.triangles, solids);
  }
  require_free_of_crossings(result.mesh, context.part("prove", k_remesh_end, 1.0));
  for (const std::string& message : report.messages) context.info("union: " + message);
  context.info("union of " + std::to_string(report.n_solids) + " solids: " + std::to_string(result.mesh.n_triangles()) + " triangles, " +
               std::to_string(report.n_components) + (report.n_components == 1 ? " component" : " components"));
  return result;
}

}  // namespace sterna
