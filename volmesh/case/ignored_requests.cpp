#include "volmesh/case/ignored_requests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/mesh/bvh.h"
#include "volmesh/case/layer_rules.h"

namespace sterna::volmesh {
namespace {

std::string joined(const std::vector<std::string>& texts, const char* between) {
  std::string text;
  for (const std::string& part : texts) text += (text.empty() ? "" : between) + part;
  return text;
}

/// Returns the layer options that the rule sets, as the user writes them. Returns an empty list if it sets none.
std::vector<std::string> layer_requests(const Rule& given) {
  Rule rule = given;
  std::vector<std::string> requests;
  for (const Option& option : layer_rule_options(rule)) {
    if (!is_set(rule, option.name) || option.name == "kind") continue;
    const OptionValue value = option.get();
    const auto add = [&](const std::string& text) { requests.push_back(std::string(option.name) + " = " + text); };
    if (const auto* number = std::get_if<double>(&value)) add(number_text(*number));
    else if (const auto* count = std::get_if<std::int64_t>(&value); count && *count > 0) add(std::to_string(*count));
    else if (const auto* word = std::get_if<std::string>(&value); word && *word != "never") add('"' + *word + '"');
  }
  return requests;
}

/// Returns true if the rule removes the layers of its patches, whatever other rules set.
bool ends_layers(const Rule& rule) { return value_or(rule, "layers", k_automatic_count) == 0 || value_or(rule, "kind", std::string("wall")) != "wall"; }

/// Returns true if the program derived the rule from the length of a placed part, so the user has not given it.
bool is_of_part(const Rule& rule, std::size_t n_requests, const MeshCase& options) {
  return !options.parts.empty() && n_requests == 1 && is_set(rule, "max_thickness");
}

/// A rule and its effect on the patches whose names match it.
struct RuleUse {
  std::vector<std::string> without;  ///< names of matching patches without layers, each with the reason
  bool is_used = false;              ///< a patch with layers uses the rule
  bool is_replaced = true;           ///< a later rule removes the layers of all other matching patches
  bool is_no_wall = false;           ///< one of the matching patches is not of kind wall
};

RuleUse use_of(std::size_t i, const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, std::span<const Rule> rules) {
  RuleUse use;
  for (const PatchId p : patches.ids()) {
    const Patch& patch = patches[p];
    if (!matches_glob(patch.name, rules[i].names)) continue;
    if (has_layer[p] != 0) {
      use.is_used = true;
      continue;
    }
    const bool is_later = std::any_of(rules.begin() + static_cast<std::ptrdiff_t>(i) + 1, rules.end(),
                                      [&](const Rule& later) { return ends_layers(later) && matches_glob(patch.name, later.names); });
    use.is_replaced = use.is_replaced && is_later && !ends_layers(rules[i]);
    const bool is_wall = patch.kind == PatchKind::wall;
    use.is_no_wall = use.is_no_wall || !is_wall;
    use.without.push_back("\"" + patch.name + "\" (" + (is_wall ? "no layers are requested there" : "of kind " + std::string(to_string(patch.kind))) + ")");
  }
  return use;
}

/// Warns of wall options that no patch with layers uses.
void warn_of_unused_options(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                            const RunContext& context) {
  const EnvelopeOptions& all = options.envelope;
  const auto is_used = [&](const char* name) {
    for (const PatchId p : patches.ids())
      if (has_layer[p] != 0 && !rule_for(patches[p].name, options.patches, name)) return true;
    return false;
  };
  const bool has_layers = std::ranges::find(has_layer.raw(), 1) != has_layer.raw().end();
  const std::string why = has_layers ? "patch rules replace this value on each patch with layers; leave out the value or the rules" : "no patch carries layers";
  const auto warn_unless_used = [&](const char* name, double value) {
    if (!is_automatic(value) && !is_used(name)) context.warn(std::string(name) + " = " + number_text(value) + " of all walls has no effect: " + why);
  };
  if (!options.first_heights) warn_unless_used("first_height", all.first_height);
  warn_unless_used("total_height", all.total_height);
  warn_unless_used("max_thickness", all.max_thickness);
}

/// A group of options and the farfield shape it belongs to.
struct FarfieldGroup {
  std::string given;  ///< option as given, such as "farfield_radius = 5"; empty if none is given
  bool is_used;
  const char* shapes;
};

/// Locations with a larger winding number are in the fluid or on its boundary.
constexpr double k_in_fluid = 0.25;
/// Number of samples of a region along each side of its bounding box.
constexpr int k_region_samples = 5;
/// Factor on the longest edge at a boundary vertex. A source that requests longer edges there refines nothing near the vertex.
constexpr double k_of_edge = 2.0;

/// Returns the distance of a location from the region of a source in metres.
double distance_from(const SizeSource& source, const Point& p) { return size_of(source, p, 1.0) - size_of(source, p, 0.0); }

/// Returns a bounding box of the region of a source.
Box box_of(const SizeSource& source) {
  Box box;
  if (source.kind == SourceKind::samples) {
    for (const Vec3& p : source.points) box.add(p);
    return box;
  }
  const bool has_one_point = source.kind == SourceKind::point || source.kind == SourceKind::sphere;
  Vec3 margin;
  if (source.kind != SourceKind::point && source.kind != SourceKind::box && source.kind != SourceKind::wake)
    margin = {source.radius, source.radius, source.radius};
  std::vector<Vec3> ends = {source.from};
  if (!has_one_point) ends.push_back(source.to);
  if (source.kind == SourceKind::wake) {
    const double half = 0.5 * source.height + source.spread * source.length;
    margin = {half, half, half};
    for (const Vec3& end : {source.from, source.to}) ends.push_back(end + source.length * normalized(source.direction));
  }
  for (const Vec3& end : ends) {
    box.add(end - margin);
    box.add(end + margin);
  }
  return box;
}

/// Returns sample points of the region: those points of a grid in its box that lie inside, its ends and its middle.
std::vector<Point> samples_of(const SizeSource& source) {
  if (source.kind == SourceKind::samples) return source.points;
  std::vector<Point> samples = {source.from};
  if (source.kind == SourceKind::point) return samples;
  const Box box = box_of(source);
  const double tolerance = 1e-9 * box.longest_side();
  const auto add = [&](const Point& p) {
    if (distance_from(source, p) <= tolerance) samples.push_back(p);
  };
  add(source.to);
  add(0.5 * (source.from + source.to));
  for (int i = 0; i < k_region_samples; ++i)
    for (int j = 0; j < k_region_samples; ++j)
      for (int k = 0; k < k_region_samples; ++k) {
        const std::array<int, 3> at = {i, j, k};
        Point p;
        for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = box.min[axis] + (box.max[axis] - box.min[axis]) * at[axis] / (k_region_samples - 1);
        add(p);
      }
  return samples;
}

std::string text_of(const SizeSource& source, std::size_t number) {
  const Vec3 at = source.kind == SourceKind::point || source.kind == SourceKind::sphere ? source.from : box_of(source).center();
  return "source " + std::to_string(number) + " (" + std::string(to_string(source.kind)) + " about " + format_point(at) + ", size " +
         (source.kind == SourceKind::samples ? "by location" : in_metres(source.size, 4)) + ")";
}

/// Returns the longest edge at each vertex in metres.
Column<VertexId, double> longest_edges(const TriMesh& boundary) {
  Column<VertexId, double> longest(boundary.n_vertices(), 0.0);
  for (const TriangleVertices& t : boundary.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = distance(boundary.points[t[k]], boundary.points[t[(k + 1) % 3]]);
      for (const VertexId v : {t[k], t[(k + 1) % 3]}) longest[v] = std::max(longest[v], length);
    }
  return longest;
}

double requested_at(const SizeSource& source, const Point& p, double slope) {
  double size = size_of(source, p, slope);
  for (std::size_t i = 0; i < source.points.size(); ++i) size = std::min(size, source.sizes[i] + slope * distance(source.points[i], p));
  return size;
}

}  // namespace

void require_used_farfield(const FarfieldOptions& options) {
  const std::string& shape = options.farfield_shape;
  const auto given = [](std::initializer_list<std::pair<const char*, double>> members) {
    std::vector<std::string> texts;
    for (const auto& [name, value] : members)
      if (!is_automatic(value) && !(std::string_view(name) == "farfield_edge" && value <= 0.0))  // a negative value was set by the mesh family
        texts.push_back(std::string(name) + " = " + number_text(value));
    return joined(texts, ", ");
  };
  const bool is_sphere = shape == "sphere" || shape == "automatic", is_cylinder = shape == "cylinder", is_box = shape == "box";
  const FarfieldOptions& o = options;
  const std::array groups = {
      FarfieldGroup{given({{"farfield_radius", o.farfield_radius}}), is_sphere || is_cylinder, "sphere, cylinder"},
      FarfieldGroup{given({{"farfield_edge", o.farfield_edge}}), is_sphere || is_cylinder || is_box, "sphere, box, cylinder"},
      FarfieldGroup{given({{"farfield_center_x", o.farfield_center_x}, {"farfield_center_y", o.farfield_center_y}, {"farfield_center_z", o.farfield_center_z}}),
                    is_sphere, "sphere"},
      FarfieldGroup{given({{"farfield_from_x", o.farfield_from_x},
                           {"farfield_from_y", o.farfield_from_y},
                           {"farfield_from_z", o.farfield_from_z},
                           {"farfield_to_x", o.farfield_to_x},
                           {"farfield_to_y", o.farfield_to_y},
                           {"farfield_to_z", o.farfield_to_z}}),
                    is_box || is_cylinder, "box, cylinder"},
      FarfieldGroup{o.farfield_surface.empty() ? "" : "farfield_surface = \"" + o.farfield_surface + "\"", shape == "surface", "surface"},
  };
  std::vector<std::string> problems;
  for (const FarfieldGroup& group : groups)
    if (!group.given.empty() && !group.is_used) problems.push_back(group.given + " (of the shapes " + group.shapes + ")");
  if (problems.empty()) return;
  const std::string made = shape == "automatic" ? "\"automatic\", a sphere," : "\"" + shape + "\"";
  throw_bad_argument("making the farfield", "the shape " + made + " does not have " + joined(problems, ", "), {},
                     "leave these options out, or set farfield_shape to one of these shapes");
}

void warn_of_sources_outside(const TriMesh& boundary, const MeshCase& options, const RunContext& context) {
  if (options.sources.empty()) return;
  const TriangleTree tree(boundary, context);
  const Box domain = bounding_box(boundary);
  const double slope = options.size.size_growth - 1.0;
  Column<VertexId, double> longest;
  for (std::size_t i = 0; i < options.sources.size(); ++i) {
    const SizeSource& source = options.sources[i];
    if (!problem_of(source, options.size.size_growth).empty()) continue;  // such a source is rejected later, when the size field is built
    const std::vector<Point> samples = samples_of(source);
    if (std::ranges::any_of(samples, [&](const Point& p) { return std::abs(tree.winding_number(p)) > k_in_fluid; })) continue;
    NearestHit nearest;
    for (const Point& p : samples)
      if (const NearestHit hit = tree.nearest(p); hit.distance < nearest.distance) nearest = hit;
    if (source.kind != SourceKind::samples && distance_from(source, nearest.point) <= 0.0) continue;
    if (longest.empty()) longest = longest_edges(boundary);
    bool meets = false, refines = false;
    for (const VertexId v : boundary.points.ids()) {
      meets = meets || (source.kind != SourceKind::samples && distance_from(source, boundary.points[v]) <= 0.0);
      refines = refines || requested_at(source, boundary.points[v], slope) < k_of_edge * longest[v];
    }
    const Patch& patch = boundary.patches[boundary.triangle_patch[nearest.triangle]];
    if (meets || (refines && patch.kind == PatchKind::wall && overlap(box_of(source), domain))) continue;
    context.warn(text_of(source, i + 1) + " lies completely outside the fluid" +
                 (refines ? ": the source refines at most the cells at the boundary" : " and has no effect") + ". The nearest point of the boundary is " +
                 in_metres(nearest.distance, 3) + " away, at " + format_point(nearest.point) + " on patch \"" + patch.name + "\"; the fluid extends from " +
                 format_point(domain.min) + " to " + format_point(domain.max) + ". Move the source (are its lengths in metres?), or leave out the source");
  }
}

void warn_of_unused_end_options(const EndOptions& given, const RunContext& context) {
  const EndOptions defaults;
  std::vector<std::string> changed;
  if (given.size_growth != defaults.size_growth) changed.push_back("ends_growth = " + number_text(given.size_growth));
  if (given.min_angle != defaults.min_angle) changed.push_back("ends_min_angle = " + number_text(given.min_angle * 180.0 / std::numbers::pi) + " degrees");
  if (given.max_triangles != defaults.max_triangles) changed.push_back("ends_max_triangles = " + std::to_string(given.max_triangles));
  if (changed.empty()) return;
  context.warn(joined(changed, ", ") + (changed.size() == 1 ? " has" : " have") +
               " no effect: no layer ends on another patch, and no plane of a half model is added. Leave " + (changed.size() == 1 ? "it" : "them") + " out");
}

void require_used_requests(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                           const RunContext& context) {
  std::vector<std::string> problems;
  bool is_no_wall = false;
  for (std::size_t i = 0; i < options.patches.size(); ++i) {
    const std::vector<std::string> requests = layer_requests(options.patches[i]);
    if (requests.empty() || is_of_part(options.patches[i], requests.size(), options)) continue;
    const RuleUse use = use_of(i, patches, has_layer, options.patches);
    if (use.is_used || use.without.empty() || use.is_replaced) continue;
    is_no_wall = is_no_wall || use.is_no_wall;
    problems.push_back("patches[\"" + options.patches[i].names + "\"] requests " + joined(requests, ", ") +
                       ", but its patches carry no layers: " + joined(use.without, ", "));
  }
  if (!problems.empty())
    throw_bad_argument("setting the layers of patches", joined(problems, "; "), {},
                       is_no_wall ? "only walls carry layers: add kind = \"wall\" to the rule, or leave its layer options out"
                                  : "give these patches layers = 1 or more, or leave the other layer options out");
  warn_of_unused_options(patches, has_layer, options, context);
}

}  // namespace sterna::volmesh
