// Steps of demand_of: layers_of_patches; connected parts and their numbers of layers; groups of patches with the same settings; blending distance at each
// group's border. Then for each group: the distance to the group, and its weight at the vertices within reach.
#include "volmesh/envelope/patch_layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/unused_blends.h"
#include "volmesh/envelope/wall_distance.h"

namespace sterna::volmesh {
namespace {

constexpr int k_length_digits = 4;  ///< number of digits of lengths in the log
/// Smallest ratio of an automatic blend to the height of the taller layer; its top then rises by a third of the difference at the border.
constexpr double k_blend_heights = 3.0;
constexpr double k_blend_edges = 8.0;  ///< smallest ratio of an automatic blend to the mean edge; neighbouring growth lines then differ by at most a ninth of
                                       ///< the whole step (the largest slope is 0.86)

/// Returns true if both numbers are equal, or if both are automatic.
bool is_same(double a, double b) { return a == b || (is_automatic(a) && is_automatic(b)); }

/// Layer options that are common to all patches of a group.
struct Group {
  double first_height, max_growth, max_thickness;
  const FirstHeights* by_location;  ///< if not null, it supplies the first height at each location, and first_height is not used
  double blend;                     ///< m; automatic until decide_blends()
  double total_height;              ///< m; automatic: from the edges
  bool requests_as(const Group& other) const {
    return first_height == other.first_height && by_location == other.by_location && max_growth == other.max_growth && max_thickness == other.max_thickness &&
           is_same(total_height, other.total_height);
  }
  bool operator==(const Group& other) const { return requests_as(other) && (blend == other.blend || (is_automatic(blend) && is_automatic(other.blend))); }
};

Group group_of(const EnvelopeOptions& layers, double blend, const FirstHeights* by_location, const LayerBase& base) {
  const double max_thickness = thickness_limit(layers.max_thickness, layers.total_height, base.body_length);
  return {layers.first_height, layers.max_growth, max_thickness, by_location, blend, layers.total_height};
}

/// The layer options of all patches of a base with layers, and the rules from which they follow.
struct PatchRequests {
  std::span<const Rule> rules;
  const FirstHeights* by_location;
  Column<PatchId, EnvelopeOptions> layers;

  /// Returns the first heights by location if they apply to the patch, else null.
  const FirstHeights* by_location_on(const Patch& patch) const { return rule_for(patch.name, rules, "first_height") ? nullptr : by_location; }
  Group group(const LayerBase& base, PatchId p) const {
    const Patch& patch = base.wall.patches[p];
    return group_of(layers[p], resolve(PatchOptions{}, rules, patch.name).blend, by_location_on(patch), base);
  }
};

std::vector<std::string> names_of(const Column<PatchId, Patch>& patches) {
  std::vector<std::string> names;
  for (const Patch& patch : patches) names.push_back(patch.name);
  return names;
}

/// Returns the number of the connected part of each vertex, which is its lowest vertex. Vertices that must grow alike count as connected.
Column<VertexId, std::uint32_t> parts_of(const LayerBase& base) {
  const TriMesh& wall = base.wall;
  DisjointSets parts(wall.n_vertices());
  for (const TriangleVertices& t : wall.triangles) {
    parts.join(t[0].value(), t[1].value());
    parts.join(t[0].value(), t[2].value());
  }
  for (const std::vector<VertexId>& group : base.groups)
    for (const VertexId v : group) parts.join(group.front().value(), v.value());
  Column<VertexId, std::uint32_t> part;
  part.raw() = std::move(parts).roots();
  return part;
}

void log_part(const TriMesh& wall, const std::map<int, std::set<std::uint32_t>>& requested, const RunContext& context) {
  const auto list = [](const auto& items, const auto& text) {
    std::string joined;
    for (const auto& item : items) joined += (joined.empty() ? "" : ", ") + text(item);
    return joined;
  };
  std::string text;
  for (const auto& [n, patches] : requested)
    text += (text.empty() ? "" : "; ") + std::to_string(n) + " by " + list(patches, [&](std::uint32_t p) { return wall.patches[PatchId(p)].name; });
  context.info("connected walls have one number of layers: " + std::to_string(requested.rbegin()->first) + ", the largest requested (" + text + ")");
}

/// Returns for each vertex the largest number of layers that a patch of its connected part requests.
Column<VertexId, std::uint16_t> numbers_of_layers(const LayerBase& base, const Column<PatchId, EnvelopeOptions>& requested, int otherwise,
                                                  const RunContext& context) {
  const TriMesh& wall = base.wall;
  const Column<VertexId, std::uint32_t> part = parts_of(base);
  std::map<std::uint32_t, std::map<int, std::set<std::uint32_t>>> requested_of_part;
  for (const TriangleId t : wall.triangles.ids()) {
    const PatchId patch = wall.triangle_patch[t];
    if (carries_layers(requested[patch])) requested_of_part[part[wall.triangles[t][0]]][requested[patch].layers].insert(patch.value());
  }
  for (const auto& [number, numbers] : requested_of_part)
    if (numbers.size() > 1) log_part(wall, numbers, context);
  Column<VertexId, std::uint16_t> layers(wall.n_vertices());
  for (const VertexId v : layers.ids()) {
    const auto found = requested_of_part.find(part[v]);
    layers[v] = static_cast<std::uint16_t>(found == requested_of_part.end() ? otherwise : found->second.rbegin()->first);
  }
  return layers;
}

/// Derives the remaining option if a total height is given. Options of the patch itself are kept. If the patch sets neither layers nor growth, the option
/// that is derived for all walls is derived here; by default that is the growth, because connected walls share the number of layers.
void solve(const std::string& patch, std::span<const Rule> rules, EnvelopeOptions& layers) {
  if (!carries_layers(layers) || is_automatic(layers.total_height)) return;
  const auto has_own = [&](std::string_view option) { return rule_for(patch, rules, option) != nullptr; };
  const bool has_own_layers = has_own("layers"), has_own_growth = has_own("max_growth"), has_own_height = has_own("total_height");
  if (!has_own_layers && !has_own("first_height") && !has_own_growth && !has_own_height && layers.solve_for == "none")
    return;  // the option was derived for all walls, or is checked for consistency below
  std::string solve_for = layers.solve_for == "none" ? "max_growth" : layers.solve_for;
  if (has_own_growth && !has_own_layers) solve_for = "layers";
  if (has_own_layers && !has_own_growth) solve_for = "max_growth";
  if (has_own_layers && has_own_growth) solve_for = "none";
  if (has_own_height && !has_own_layers && !has_own_growth) solve_for = "max_growth";
  layers = solve_layers(layers, solve_for, "patch " + patch);
}

class Blender {
 public:
  Blender(const LayerBase& base, const EnvelopeOptions& options, const PatchRequests& requested, LayerDemand& demand, const RunContext& context)
      : base_(base), demand_(demand), context_(context), has_common_growth_(has_common_growth(options)), group_of_patch_(requested.layers.size(), -1) {
    std::vector<std::uint8_t> is_used(requested.layers.size(), 0);
    for (const PatchId patch : base.wall.triangle_patch) is_used[patch.index()] = 1;
    for (const PatchId patch : requested.layers.ids()) {
      if (!carries_layers(requested.layers[patch]) || !is_used[patch.index()]) continue;
      const Group group = requested.group(base, patch);
      const auto found = std::find(groups_.begin(), groups_.end(), group);
      group_of_patch_[patch.index()] = static_cast<int>(found - groups_.begin());
      if (found == groups_.end()) groups_.push_back(group);
    }
    if (groups_.empty()) groups_.push_back(group_of(options, k_automatic, requested.by_location, base));
  }

  void blend() {
    decide_blends();
    const std::size_t n = base_.wall.n_vertices();
    Column<VertexId, double> reach(n, 0.0), weight(n, 0.0);
    double farthest = 0.0;
    for (const VertexId v : reach.ids()) for_each_group_at(v, [&](std::size_t g) { reach[v] = std::max(reach[v], groups_[g].blend); });
    for (const double r : reach) farthest = std::max(farthest, r);
    for (Column<VertexId, double>* column : {&demand_.first_height, &demand_.max_growth, &demand_.max_thickness}) column->assign(n, 0.0);
    const bool has_heights = std::any_of(groups_.begin(), groups_.end(), [](const Group& group) { return !is_automatic(group.total_height); });
    if (has_heights) demand_.total_height.assign(n, 0.0);
    Column<VertexId, std::uint8_t> is_by_height(has_heights ? n : 0, 0);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Column<VertexId, double> distance = distances_to(g, farthest);
      parallel_for(context_, n, [&](std::size_t i) {
        const VertexId v(i);
        const double share = share_at(distance[v], reach[v]);
        weight[v] += share;
        demand_.first_height[v] += share * std::log(first_height_at(groups_[g], v));
        demand_.max_growth[v] += share * groups_[g].max_growth;
        demand_.max_thickness[v] += share * std::log(groups_[g].max_thickness);
        if (!has_heights || share == 0.0) return;
        demand_.total_height[v] += share * std::log(height_at(groups_[g], v));
        if (!is_automatic(groups_[g].total_height)) is_by_height[v] = 1;
      });
    }
    parallel_for(context_, n, [&](std::size_t i) {
      const VertexId v(i);
      finish(v, weight[v]);
      if (has_heights && is_by_height[v] == 0) demand_.total_height[v] = k_automatic;
    });
  }

  void log() const {
    if (groups_.size() < 2) return;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::string names;
      for (const PatchId patch : base_.wall.patches.ids())
        if (group_of_patch_[patch.index()] == static_cast<int>(g)) names += (names.empty() ? "" : ", ") + base_.wall.patches[patch].name;
      context_.info("layers of " + names + ": first height " + (groups_[g].by_location ? "by location" : in_metres(groups_[g].first_height, k_length_digits)) +
                    (groups_[g].blend > 0.0 ? ", blended with neighbouring patches over " + in_metres(groups_[g].blend, k_length_digits) : ""));
    }
  }

 private:
  /// Calls f(g) for each group that has a triangle at v. Some groups may be visited more than once.
  template <class F>
  void for_each_group_at(VertexId v, const F& f) const {
    for (const HalfedgeId h : base_.topology.outgoing(v)) {
      const int g = group_of_patch_[base_.wall.triangle_patch[triangle_of(h)].index()];
      if (g >= 0) f(static_cast<std::size_t>(g));
    }
  }

  /// Computes automatic blends from the layers and edges along each group's border.
  void decide_blends() {
    std::vector<double> heights(groups_.size(), 0.0), edges(groups_.size(), 0.0), n(groups_.size(), 0.0);
    for (const VertexId v : base_.wall.points.ids()) {
      std::set<std::size_t> here;
      for_each_group_at(v, [&](std::size_t g) { here.insert(g); });
      if (here.size() < 2) continue;
      double tallest = 0.0;
      for (const std::size_t g : here) tallest = std::max(tallest, height_at(groups_[g], v));
      for (const std::size_t g : here) {
        if (std::all_of(here.begin(), here.end(), [&](std::size_t other) { return groups_[g].requests_as(groups_[other]); })) continue;
        heights[g] += tallest;
        edges[g] += base_.layer_edge[v];
        n[g] += 1.0;
      }
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (n[g] == 0.0) groups_[g].blend = 0.0;
      else if (is_automatic(groups_[g].blend)) groups_[g].blend = std::max(k_blend_heights * heights[g] / n[g], k_blend_edges * edges[g] / n[g]);
    }
  }

  double first_height_at(const Group& group, VertexId v) const { return group.by_location ? group.by_location->at(base_.wall.points[v]) : group.first_height; }

  double height_at(const Group& group, VertexId v) const {
    if (!is_automatic(group.total_height)) return std::min(group.total_height, group.max_thickness);
    const int n = demand_.layers[v];
    const double h0 = first_height_at(group, v);
    return std::min(height_by_edge(h0, base_.layer_edge[v], group.max_growth, n, has_common_growth_), group.max_thickness);
  }

  Column<VertexId, double> distances_to(std::size_t group, double reach) const {
    constexpr double k_beyond = 1.0;  // distance of vertices out of reach, if the reach is zero
    Column<VertexId, double> distance(base_.wall.n_vertices(), reach > 0.0 ? reach : k_beyond);
    for (const VertexId v : distance.ids())
      for_each_group_at(v, [&](std::size_t g) {
        if (g == group) distance[v] = 0.0;
      });
    limit_gradient(base_, 1.0, distance);
    return distance;
  }

  /// Returns the weight of a group: 1 on the group's own patches, and 0 from `reach` on. The slope is zero at both ends, so that the blended field has no kink.
  static double share_at(double distance, double reach) {
    if (distance == 0.0) return 1.0;
    if (distance >= reach) return 0.0;
    const double x = distance / reach;
    return (1.0 - x) * (1.0 - x) * (1.0 + 2.0 * x);
  }

  void finish(VertexId v, double weight) {
    if (weight == 1.0 || weight == 0.0) {
      // The requested values are used exactly, without conversion to logarithms.
      const Group* own = &groups_.front();
      for_each_group_at(v, [&](std::size_t g) { own = &groups_[g]; });
      demand_.first_height[v] = first_height_at(*own, v);
      demand_.max_growth[v] = own->max_growth;
      demand_.max_thickness[v] = own->max_thickness;
      if (!demand_.total_height.empty()) demand_.total_height[v] = own->total_height;
      return;
    }
    demand_.first_height[v] = std::exp(demand_.first_height[v] / weight);
    demand_.max_growth[v] /= weight;
    demand_.max_thickness[v] = std::exp(demand_.max_thickness[v] / weight);
    if (!demand_.total_height.empty()) demand_.total_height[v] = std::exp(demand_.total_height[v] / weight);
  }

  const LayerBase& base_;
  LayerDemand& demand_;
  const RunContext& context_;
  bool has_common_growth_;
  std::vector<Group> groups_;
  std::vector<int> group_of_patch_;  ///< group of each patch; -1: no layers, or no triangles
};

}  // namespace

void apply_patch_kinds(TriMesh& surface, std::span<const Rule> rules) {
  for (const Rule& rule : rules)
    if (std::ranges::none_of(surface.patches, [&](const Patch& patch) { return matches_glob(patch.name, rule.names); }))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "applying patch rules",
                   .problem = "no patch name matches \"" + rule.names + "\"",
                   .hint = names_hint(names_of(surface.patches), rule.names)});
  for (Patch& patch : surface.patches) patch = with_kind(std::move(patch), rules);
}

EnvelopeOptions request_of(const Patch& patch, const EnvelopeOptions& options, std::span<const Rule> rules) {
  EnvelopeOptions layers = resolve(options, rules, patch.name);
  if (patch.kind != PatchKind::wall) layers.layers = 0;
  return layers;
}

Column<PatchId, EnvelopeOptions> layers_of_patches(const Column<PatchId, Patch>& patches, const EnvelopeOptions& options, std::span<const Rule> rules) {
  Column<PatchId, EnvelopeOptions> result;
  std::string without;
  for (const Patch& patch : patches) {
    EnvelopeOptions layers = request_of(patch, options, rules);
    if (carries_layers(layers) && is_automatic(layers.first_height)) without += (without.empty() ? "" : ", ") + patch.name;
    solve(patch.name, rules, layers);
    result.push_back(std::move(layers));
  }
  if (!without.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "setting the layer options",
                 .problem = "first_height is not given for " + without,
                 .hint = "give first_height for all walls, or for each wall patch"});
  return result;
}

/// Returns the layer options of the patches of a base with layers. Patches of other kinds than wall (such as a nozzle at the end of its nacelle) get the
/// options of a wall of the same name.
PatchRequests requests_of_base(const LayerBase& base, const EnvelopeOptions& options, std::span<const Rule> rules, const FirstHeights* by_location) {
  Column<PatchId, Patch> patches = base.wall.patches;
  for (Patch& patch : patches) patch.kind = PatchKind::wall;
  return {rules, by_location, layers_of_patches(patches, options, rules)};
}

/// Gives vertices that must grow alike the smallest of their requested values. Automatic values are not compared.
template <class T>
void take_least_of_groups(const std::vector<std::vector<VertexId>>& groups, Column<VertexId, T>& column) {
  if (column.empty()) return;
  const auto requests_less = [](T a, T b) { return a < b || (b != b && a == a); };  // a number counts as smaller than NaN (k_automatic)
  for (const std::vector<VertexId>& group : groups) {
    T least = column[group.front()];
    for (const VertexId v : group)
      if (requests_less(column[v], least)) least = column[v];
    for (const VertexId v : group) column[v] = least;
  }
}

LayerDemand demand_of(const LayerBase& base, const EnvelopeOptions& options, std::span<const Rule> rules, const FirstHeights* by_location,
                      const RunContext& context) {
  const PatchRequests requested = requests_of_base(base, options, rules, by_location);
  const auto is_as_all = [&](PatchId p) {
    const EnvelopeOptions& layers = requested.layers[p];
    return !carries_layers(layers) || (!requested.by_location_on(base.wall.patches[p]) && layers.layers == options.layers &&
                                       layers.first_height == options.first_height && layers.max_growth == options.max_growth &&
                                       is_same(layers.max_thickness, options.max_thickness) && is_same(layers.total_height, options.total_height));
  };
  Column<PatchId, std::uint8_t> is_other(base.wall.patches.size(), 0);
  for (const PatchId p : base.wall.patches.ids()) is_other[p] = is_as_all(p) ? 0 : 1;
  LayerDemand demand;
  if (std::ranges::none_of(base.wall.triangle_patch, [&](PatchId p) { return is_other[p] != 0; })) return demand;
  demand.layers = numbers_of_layers(base, requested.layers, options.layers, context);
  Blender blender(base, options, requested, demand, context);
  blender.blend();
  blender.log();
  for_each_column([&](auto& column) { take_least_of_groups(base.groups, column); }, demand);
  return demand;
}

void warn_of_unused_blends(const LayerBase& base, const EnvelopeOptions& options, std::span<const Rule> rules, const FirstHeights* by_location,
                           const RunContext& context) {
  if (std::ranges::none_of(rules, [](const Rule& rule) { return is_set(rule, "blend"); })) return;
  const Column<PatchId, Patch>& patches = base.wall.patches;
  const PatchRequests requested = requests_of_base(base, options, rules, by_location);
  Column<PatchId, Group> groups;
  for (const PatchId p : patches.ids()) groups.push_back(requested.group(base, p));
  // Finds patches that are adjacent to a patch with other layers.
  Column<PatchId, std::uint8_t> differs(patches.size(), 0), is_there(patches.size(), 0);
  for (const VertexId v : base.wall.points.ids()) {
    std::set<PatchId> here;
    for (const HalfedgeId h : base.topology.outgoing(v))
      if (const PatchId p = base.wall.triangle_patch[triangle_of(h)]; carries_layers(requested.layers[p])) here.insert(p);
    for (const PatchId p : here) {
      is_there[p] = 1;
      if (std::ranges::any_of(here, [&](PatchId other) { return other != p && !groups[p].requests_as(groups[other]); })) differs[p] = 1;
    }
  }
  for (const Rule& rule : rules) {
    const double blend = value_or(rule, "blend", k_automatic);
    if (is_automatic(blend)) continue;
    std::string names;
    bool is_used = false;
    for (const PatchId p : patches.ids()) {
      if (is_there[p] == 0 || groups[p].blend != blend || !matches_glob(patches[p].name, rule.names)) continue;
      is_used = is_used || differs[p] != 0;
      names += (names.empty() ? "\"" : ", \"") + patches[p].name + "\"";
    }
    if (is_used || names.empty()) continue;  // a rule that matches no patch with layers is already an error (ignored_requests.h)
    context.warn("blend = " + in_metres(blend, k_length_digits) + " of patches[\"" + rule.names + "\"] has no effect: no wall that meets " + names +
                 " has layers with another first height, growth, height or thickness. Leave blend out, or give the neighbouring walls other layers");
  }
}

Column<PatchId, std::uint8_t> patches_with_open_ridges(const Column<PatchId, Patch>& patches, const RidgeOptions& options, std::span<const Rule> rules) {
  Column<PatchId, std::uint8_t> result;
  for (const Patch& patch : patches) result.push_back(resolve(options, rules, patch.name).is_on() ? 1 : 0);
  return result;
}

Column<VertexId, Truncation> truncation_by_patches(const TriMesh& wall, const PrismOptions& options, std::span<const Rule> rules) {
  const Truncation of_all = truncation_of(options.truncate);
  Column<PatchId, Truncation> of_patch;
  for (const Patch& patch : wall.patches) of_patch.push_back(truncation_of(resolve(options, rules, patch.name).truncate));
  if (std::ranges::all_of(wall.triangle_patch, [&](PatchId patch) { return of_patch[patch] == of_all; })) return {};
  Column<VertexId, Truncation> result(wall.n_vertices(), Truncation::always);
  for (const TriangleId t : wall.triangles.ids())
    for (const VertexId v : wall.triangles[t]) result[v] = std::min(result[v], of_patch[wall.triangle_patch[t]]);
  return result;
}

}  // namespace sterna::volmesh
