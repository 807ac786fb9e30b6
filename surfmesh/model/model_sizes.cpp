#include "surfmesh/model/model_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "surfmesh/model/estimate.h"
#include "surfmesh/model/model_topology.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {
namespace {

/// Component defaults (docs/method/surface.md, "Component defaults").
constexpr double k_of_circumference = 0.08;
constexpr double k_of_chord = 0.15;
constexpr double k_of_longest_side = 0.02;
/// Automatic longest edge, relative to the square root of a face's area.
constexpr double k_of_face = 0.25;
constexpr double k_min_of_max = 0.02;
/// Lower limits of the automatic longest and shortest edges, relative to the model's longest side. Without them tip faces of nearly zero size would require
/// edges of zero length.
constexpr double k_least_max_edge = 1e-4, k_least_min_edge = 1e-5;
/// Lower limit of the sizes from narrow regions while min_edge is automatic, relative to the longest edge of a face. Without it a strip a millionth as wide as
/// it is long would require millions of edges.
constexpr double k_least_narrow = 1e-4;
/// Rad: if triangles turn by more than about 45 degrees, the layers treat a smooth region as a ridge. Edges exceed their size by a third, hence 30 degrees.
constexpr double k_most_turn = 30.0 * std::numbers::pi / 180.0;
/// Lower limit for the reduction of the automatic min_edge, as a fraction of it. Without the limit, pointed tips and thin round trailing edges would contain
/// most of all triangles.
constexpr double k_least_of_min = 0.5;
/// The same limit on wings. The min_edge of a wing follows from its mean chord, and the nose radius at the tip of a thin tapered wing is less than half of it.
/// Longer edges would turn by 80 degrees along the whole leading edge.
constexpr double k_least_of_min_on_wings = 0.25;

double longest_side(const Box& box) { return box.empty() ? 0.0 : box.longest_side(); }

struct ComponentMeasures {
  Box box;
  double area = 0.0;
};

double default_max_edge(const Component& component, const ComponentMeasures& m) {
  const Vec3 size = m.box.max - m.box.min;
  const double longest = longest_side(m.box);
  if (!(longest > 0.0)) return 0.0;
  switch (component.kind) {
    case ComponentKind::body:
    case ComponentKind::nacelle:
    case ComponentKind::fairing:
    case ComponentKind::boom:
    case ComponentKind::sting: return k_of_circumference * m.area / longest;
    case ComponentKind::wing:
    case ComponentKind::pylon: {
      // The planform area is half of the wetted area. The span is the longer side across the flow.
      const double span = std::max(size.y, size.z);
      return k_of_chord * std::min(0.5 * m.area / std::max(span, 1e-12), longest);
    }
    default: return k_of_longest_side * longest;
  }
}

/// Computes default sizes; faces without a component share the defaults of the whole model.
Column<ComponentId, double> default_sizes(const Model& model, const ModelSizes& sizes, const Column<EdgeId, EdgeSamples>& edges, double& of_model) {
  Column<ComponentId, ComponentMeasures> measures(model.components.size());
  ComponentMeasures all;
  for (const FaceId f : model.faces.ids()) {
    Box box;
    sizes.faces[f].curvature->for_each_inside([&](const Point& p, double) { box.add(p); });
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border)
        for (const EdgeSample& s : edges[use.edge].samples) box.add(s.point);
    if (box.empty()) continue;
    const auto add = [&](ComponentMeasures& m) {
      m.box.add(box);
      m.area += sizes.faces[f].curvature->area();
    };
    add(all);
    if (model.faces[f].component.is_valid()) add(measures[model.faces[f].component]);
  }
  of_model = k_of_longest_side * longest_side(all.box);
  Column<ComponentId, double> result(model.components.size(), of_model);
  for (const ComponentId c : model.components.ids())
    if (const double size = default_max_edge(model.components[c], measures[c]); size > 0.0) result[c] = size;
  return result;
}

/// Returns the change of size per distance. Meshes of a family are similar: in a finer mesh sizes grow more slowly with the distance from a fine region.
double change_by_distance(const SurfaceMeshOptions& options) { return (options.sizes.growth - 1.0) / options.sizes.refinement; }

bool is_min_edge_given(const std::string& name, const SurfaceMeshOptions& options, std::span<const Rule> patches) {
  return !is_automatic(options.sizes.min_edge) || rule_for(name, patches, "min_edge");
}

/// Checks chord errors if no min_edge is given. If a chord error is far too small, the automatic min_edge would limit it, and the mesh would silently differ
/// from the request.
/// \throws Error(overflow) if the request needs more than max_triangles \post the computed curvature sizes served this check only
void require_chord_error_in_reach(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, ModelSizes& sizes) {
  double n = 0.0, least = std::numeric_limits<double>::infinity();
  for (const FaceId f : model.faces.ids()) {
    const CurvatureLimits& limits = sizes.faces[f].limits;
    if (!std::isfinite(limits.chord_error) || is_min_edge_given(model.faces[f].name, options, patches)) continue;
    sizes.faces[f].curvature->limit({.angle = std::numeric_limits<double>::infinity(), .chord_error = limits.chord_error, .growth = limits.growth});
    n += estimated_triangles(sizes, f);
    least = std::min(least, limits.chord_error);
  }
  if (n <= options.sizes.max_triangles) return;
  throw Error({.code = ErrorCode::overflow,
               .attempted = "meshing the model's surface",
               .problem = "chord_error = " + number_text(least) + " m requires about " + number_text(n, 2) + " triangles; max_triangles is " +
                          std::to_string(options.sizes.max_triangles),
               .hint = "a larger chord_error, or a min_edge that limits chord_error; check the units of the model"});
}

FaceSizes sizes_of_face(const std::string& name, double automatic_max, double automatic_least, double least_of_min, const SurfaceMeshOptions& of_all,
                        std::span<const Rule> patches) {
  const SurfaceMeshOptions options = resolve(of_all, patches, name);
  const double min_edge = options.sizes.min_edge, angle = options.sizes.curvature_angle;
  FaceSizes sizes;
  sizes.leading_factor = options.leading_edge_factor;
  sizes.trailing_factor = options.trailing_edge_factor;
  sizes.has_tip_strips = options.tip_strips;
  sizes.max_edge = is_automatic(options.sizes.max_edge) ? automatic_max : options.sizes.max_edge;
  sizes.limits.min_edge = std::min(sizes.max_edge, is_automatic(min_edge) ? std::max(k_min_of_max * sizes.max_edge, automatic_least) : min_edge);
  sizes.least_narrow = is_automatic(min_edge) ? std::min(sizes.max_edge, automatic_least) / options.sizes.refinement : 0.0;
  // An automatic min_edge must not limit a chord error. It must not cause sharp turns of the mesh where the model is smooth.
  if (is_automatic(min_edge)) {
    sizes.limits.most_turn = std::max(angle, k_most_turn);
    sizes.limits.least_edge = std::max(least_of_min * sizes.limits.min_edge, std::min(sizes.max_edge, automatic_least));
  } else {
    sizes.limits.least_edge = sizes.limits.error_edge = sizes.limits.min_edge;
  }
  sizes.limits.angle = angle;
  if (!is_automatic(options.sizes.chord_error)) sizes.limits.chord_error = options.sizes.chord_error;
  sizes.max_edge /= options.sizes.refinement;
  // The automatic lower limit for sharp turns is not enlarged in coarse members of a family. Round tips that are smooth in member 1 stay smooth.
  sizes.limits.least_edge /= is_automatic(min_edge) ? std::max(options.sizes.refinement, 1.0) : options.sizes.refinement;
  for (double* edge : {&sizes.limits.min_edge, &sizes.limits.error_edge}) *edge /= options.sizes.refinement;
  sizes.limits.angle /= options.sizes.refinement;
  // The error of a chord is proportional to the square of its length.
  sizes.limits.chord_error /= options.sizes.refinement * options.sizes.refinement;
  sizes.limits.growth = std::numeric_limits<double>::infinity();  // SurfaceSizes limits the growth when it propagates the sizes
  const BandTargets targets = band_targets(name, options.sizes, patches);
  sizes.leading = targets.leading;
  sizes.trailing = targets.trailing;
  sizes.trailing_cells = options.trailing_edge_cells * options.sizes.refinement;
  // A band determines the sizes at its edge. The factor would only shorten the cells of the band along the edge.
  if (sizes.leading.is_any()) sizes.leading_factor = 1.0;
  if (sizes.trailing.is_any()) sizes.trailing_factor = 1.0;
  return sizes;
}

void check_rules(const Model& model, std::span<const Rule> patches) {
  for (const Rule& rule : patches) {
    const bool is_used = std::any_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& f) { return matches_glob(f.name, rule.names); });
    if (is_used) continue;
    ErrorInfo info{.code = ErrorCode::bad_argument, .attempted = "meshing the model's surface", .problem = "no face has a name like \"" + rule.names + "\""};
    std::vector<std::string> names;
    for (const ModelFace& f : model.faces) names.push_back(f.name);
    info.hint = names_hint(names, rule.names);
    throw Error(std::move(info));
  }
}

ParameterBox box_of(const FaceOutline& outline) {
  ParameterBox box{{1e300, -1e300}, {1e300, -1e300}};
  for (const auto& polygon : outline.polygons)
    for (const Uv& p : polygon) {
      box.u = {std::min(box.u.from, p.u), std::max(box.u.to, p.u)};
      box.v = {std::min(box.v.from, p.v), std::max(box.v.to, p.v)};
    }
  return box;
}

double distance_between(const Box& a, const Box& b) {
  Vec3 gap;
  for (std::size_t k = 0; k < 3; ++k) gap[k] = std::max({0.0, a.min[k] - b.max[k], b.min[k] - a.max[k]});
  return norm(gap);
}

/// A sample of an edge at which an adjacent face is narrow.
struct NarrowLocation {
  EdgeId edge;
  std::size_t sample = 0;
  double size = 0.0;
};

/// Adds narrow regions. Where two edges of a face run near each other, edges must not be longer than the width of the face between them. Near a corner that
/// both edges share, this applies only if their distance is less than k_narrow_corner times the distance from the corner: triangles fill wider corners without
/// refinement.
void add_narrow_locations(const Model& model, FaceId f, const Column<EdgeId, EdgeSamples>& edges, const FaceSizes& sizes, double narrow,
                          std::vector<NarrowLocation>& locations) {
  constexpr double k_narrow_corner = 0.35;
  constexpr double k_at_corner = 1e-6;  // relative to the length of the edge; at the corner itself the distance to the other edge is zero
  constexpr double k_least_of_min_edge = 0.2;
  const double reach = sizes.max_edge / narrow;
  std::vector<EdgeId> used;
  for (const Border& border : model.faces[f].borders)
    for (const EdgeUse& use : border)
      if (!edges[use.edge].samples.empty()) used.push_back(use.edge);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  double least = k_least_of_min_edge * sizes.limits.min_edge;
  if (sizes.least_narrow > 0.0) {
    least = std::max(least, sizes.least_narrow);
    for (const EdgeId e : used) least = std::max(least, k_least_narrow * edges[e].length);
  }
  std::vector<Box> boxes(used.size());
  for (std::size_t i = 0; i < used.size(); ++i)
    for (const EdgeSample& s : edges[used[i]].samples) boxes[i].add(s.point);
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = 0; j < used.size(); ++j) {
      if (i == j || distance_between(boxes[i], boxes[j]) >= reach) continue;
      const ModelEdge &a = model.edges[used[i]], &b = model.edges[used[j]];
      const auto shares = [&](CornerId c) { return c == b.start || c == b.end; };
      const std::vector<EdgeSample>& other = edges[used[j]].samples;
      for (std::size_t n = 0; n < edges[used[i]].samples.size(); ++n) {
        const EdgeSample& s = edges[used[i]].samples[n];
        double nearest = reach;
        for (std::size_t k = 0; k + 1 < other.size(); ++k) nearest = std::min(nearest, distance_to_segment(s.point, other[k].point, other[k + 1].point));
        if (nearest >= reach) continue;
        double from_corner = std::numeric_limits<double>::infinity();
        for (const CornerId c : {a.start, a.end})
          if (shares(c)) from_corner = std::min(from_corner, distance(s.point, model.corners[c].point));
        if (nearest >= k_narrow_corner * from_corner || from_corner <= k_at_corner * edges[used[i]].length) continue;
        locations.push_back({used[i], n, std::max(least, narrow * nearest)});
      }
    }
}

/// Returns the sizes required at the samples of an edge. They follow from the curvature of the edge and of the adjacent faces, from the length of a short edge,
/// and from the smaller size of its faces.
std::vector<double> sizes_along(const Model& model, const std::vector<EdgeUseLocation>& uses, const EdgeSamples& samples, const ModelSizes& sizes,
                                double intersection_factor) {
  double least = sizes.largest;
  CurvatureLimits limits = sizes.faces[uses.front().face].limits;
  for (const EdgeUseLocation& location : uses) {
    least = std::min(least, sizes.faces[location.face].max_edge);
    limits.take_less(sizes.faces[location.face].limits);
  }
  const auto component_of = [&](const EdgeUseLocation& location) { return model.faces[location.face].component; };
  if (std::any_of(uses.begin(), uses.end(), [&](const EdgeUseLocation& location) { return component_of(location) != component_of(uses.front()); }))
    least = std::max(limits.min_edge, intersection_factor * least);
  if (samples.length < least) least = std::max(limits.min_edge, samples.length);
  std::vector<double> result;
  for (const EdgeSample& s : samples.samples) {
    double size = std::min(least, limits.size_of(s.curvature));
    for (const EdgeUseLocation& location : uses) {
      const EdgeUse& use = model.faces[location.face].borders[location.border][location.location];
      const double curvature = largest_curvature(model.faces[location.face].surface->derivatives(use.parameter->point(s.t)));
      if (std::isfinite(curvature)) size = std::min(size, sizes.faces[location.face].limits.size_of(curvature));
    }
    result.push_back(size);
  }
  return result;
}

/// Adds sources at the samples. If two samples are farther apart than the sizes, sources are added between them: otherwise lengths would grow from one sample
/// and shrink towards the next.
void add_sources_along(const Curve& curve, const std::vector<EdgeSample>& samples, const std::vector<double>& size, std::vector<SizePoint>& sources) {
  constexpr double k_most_between = 4096.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sources.push_back({samples[i].point, size[i]});
    if (i + 1 == samples.size()) break;
    const double n = std::min(k_most_between, std::ceil(distance(samples[i].point, samples[i + 1].point) / std::min(size[i], size[i + 1])));
    for (double k = 1.0; k < n; k += 1.0) {
      const double share = k / n;
      sources.push_back({curve.point(samples[i].t + share * (samples[i + 1].t - samples[i].t)), size[i] + share * (size[i + 1] - size[i])});
    }
  }
}

}  // namespace

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Vec3 along = b - a;
  const double length2 = norm2(along);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return distance(p, a + t * along);
}

ModelSizes sizes_of_faces(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options, std::span<const Rule> patches,
                          const RunContext& context) {
  check_rules(model, patches);
  ModelSizes sizes;
  sizes.growth = change_by_distance(options);
  sizes.outlines.resize(model.faces.size());
  sizes.faces.resize(model.faces.size());
  parallel_for(
      context, model.faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        sizes.outlines[f] = outline_of(model, f);
        sizes.faces[f].curvature = std::make_unique<CurvatureSizes>(*model.faces[f].surface, box_of(sizes.outlines[f]), sizes.outlines[f].polygons);
      },
      1);
  double of_model = 0.0;
  const Column<ComponentId, double> automatic = default_sizes(model, sizes, edges, of_model);
  for (const FaceId f : model.faces.ids()) {
    const ModelFace& face = model.faces[f];
    std::unique_ptr<CurvatureSizes> curvature = std::move(sizes.faces[f].curvature);
    double by_default = face.component.is_valid() ? automatic[face.component] : of_model;
    // In a component of unknown kind only the faces show which regions are large and which are small, because a farfield and a wing may be one part.
    const bool is_unknown = !face.component.is_valid() || model.components[face.component].kind == ComponentKind::unknown;
    const double length = of_model / k_of_longest_side;
    if (const double side = std::sqrt(curvature->area()); is_unknown && side > 0.0)
      by_default = std::min(by_default, std::max(k_of_face * side, k_least_max_edge * length));
    const bool is_wing = face.component.is_valid() && model.components[face.component].kind == ComponentKind::wing;
    sizes.faces[f] = sizes_of_face(face.name, by_default, k_least_min_edge * length, is_wing ? k_least_of_min_on_wings : k_least_of_min, options, patches);
    sizes.faces[f].curvature = std::move(curvature);
    sizes.largest = std::max(sizes.largest, sizes.faces[f].max_edge);
  }
  require_chord_error_in_reach(model, options, patches, sizes);
  parallel_for(
      context, model.faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        sizes.faces[f].curvature->limit(sizes.faces[f].limits);
      },
      1);
  return sizes;
}

void add_local_sizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options, const SpaceSizes& requested,
                     ModelSizes& sizes) {
  sizes.local = LocalSizes(model, edges, sizes, requested, options.sizes.refinement);
  for (const SizePoint& s : requested.samples) sizes.in_space.push_back({s.point, s.size / options.sizes.refinement});
}

void add_sources(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const SurfaceMeshOptions& options,
                 ModelSizes& sizes, const RunContext& context, const WingBands* bands) {
  std::vector<std::vector<SizePoint>> of_faces(model.faces.size());
  parallel_for(
      context, model.faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        if (topology.is_absorbed[f] != 0) return;
        sizes.faces[f].curvature->for_each_inside([&](const Point& p, double size) {
          if (size < sizes.faces[f].max_edge && !(sizes.is_covered && sizes.is_covered(f, p))) of_faces[i].push_back({p, size});
        });
      },
      1);
  for (const auto& list : of_faces) sizes.sources.insert(sizes.sources.end(), list.begin(), list.end());
  std::vector<std::vector<NarrowLocation>> narrow(model.faces.size());
  parallel_for(
      context, model.faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        if (topology.is_absorbed[f] == 0 && !(bands && bands->is_strip_in_band(f)))
          add_narrow_locations(model, f, edges, sizes.faces[f], options.sizes.narrow / options.sizes.refinement, narrow[i]);
      },
      1);
  Column<EdgeId, std::vector<NarrowLocation>> narrow_of_edge(model.edges.size());
  for (const auto& list : narrow)
    for (const NarrowLocation& location : list) narrow_of_edge[location.edge].push_back(location);
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  std::vector<std::vector<SizePoint>> of_edges(model.edges.size());
  sizes.edge_sizes.resize(model.edges.size());
  const auto request_along = [&](EdgeId e, std::vector<double> size, std::vector<SizePoint>& list) {
    add_sources_along(*model.edges[e].curve, edges[e].samples, size, list);
    sizes.edge_sizes[e] = std::move(size);
  };
  parallel_for(
      context, model.edges.size(),
      [&](std::size_t i) {
        const EdgeId e(static_cast<std::uint64_t>(i));
        if (uses[e].empty() || edges[e].samples.empty() || topology.is_point[e] != 0) return;
        std::vector<double> size = sizes_along(model, uses[e], edges[e], sizes, options.intersection_factor);
        for (const NarrowLocation& location : narrow_of_edge[e]) size[location.sample] = std::min(size[location.sample], location.size);
        if (bands) bands->overrule(edges, uses[e], e, sizes.largest, size);
        request_along(e, std::move(size), of_edges[i]);
      },
      16);
  for (const auto& list : of_edges) sizes.sources.insert(sizes.sources.end(), list.begin(), list.end());
}

}  // namespace sterna::surfmesh
