// Finds blunt bases: strips between two nearly parallel sharp convex edges, such as the base of a trailing edge. A layer much taller than the thickness of the
// strip leans outwards over both edges. The sides of its prisms then deviate far from the lines between cell centres (non-orthogonality). From the middle of
// each sharp convex edge, a straight line across the adjacent facet and over smooth edges is followed to the next sharp edge, or to the largest relevant
// distance. The strip is a base if that edge is nearly parallel to the first one.
#include <cmath>

#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

/// Sine of the angle between the two edges of a base: with a larger angle the facet tapers to a point, which no thickness can correct.
constexpr double k_taper = 0.05;
constexpr double k_enough = 0.1;    ///< recommended ratio of thickness to height, with which hardly any face leans (docs/measurements/inspect.md)
constexpr int k_most_steps = 1000;  ///< largest number of crossed triangles; a wider strip is a surface, not a base

struct Base {
  HalfedgeId edge;         ///< half-edge of the triangle on the strip, at its border
  double thickness = 0.0;  ///< m
  double height = 0.0;     ///< m, requested height of the layer
};

class BaseSurvey {
 public:
  BaseSurvey(const Survey& survey, const LayerDomain& layer_domain)
      : survey_(survey),
        base_(layer_domain.base),
        wall_(layer_domain.base.wall),
        topology_(layer_domain.base.topology),
        scale_(scale_of(layer_domain.base, layer_domain.options.envelope)),
        map_(survey.mesh, layer_domain.domain),
        sharp_cosine_(std::cos(layer_domain.options.envelope.feature_angle)) {}

  void run() const {
    const double ratio = survey_.request.limits.base_ratio;
    std::vector<Base> bases = parallel_reduce(
        survey_.context, topology_.n_halfedges(), std::vector<Base>{},
        [&](std::size_t begin, std::size_t end) {
          std::vector<Base> part;
          for (std::size_t i = begin; i < end; ++i) {
            const HalfedgeId h(static_cast<std::uint64_t>(i));
            if (!is_ridge(h)) continue;
            const double height = std::max(requested_height(base_, scale_, topology_.from(h)), requested_height(base_, scale_, topology_.to(h)));
            if (const double t = thickness_behind(h, height / ratio); t > 0.0) part.push_back({h, t, height});
          }
          return part;
        },
        joined_lists<Base>);
    if (!bases.empty()) add(bases);
  }

 private:
  Vec3 normal(HalfedgeId h) const {
    const auto [a, b, c] = corners(wall_, triangle_of(h));
    return normalized(area_vector(a, b, c));
  }
  Vec3 along(HalfedgeId h) const { return wall_.points[topology_.to(h)] - wall_.points[topology_.from(h)]; }

  bool is_sharp(HalfedgeId h) const { return dot(normal(h), normal(topology_.twin(h))) < sharp_cosine_; }
  /// Returns true for a sharp convex edge between walls with layers.
  bool is_ridge(HalfedgeId h) const { return !topology_.is_boundary(h) && is_sharp(h) && dot(cross(normal(h), normal(topology_.twin(h))), along(h)) > 0.0; }

  /// Returns the thickness of the strip beside the half-edge, at its middle; 0 if there is no strip or it is thicker than `most`.
  double thickness_behind(HalfedgeId first, double most) const {
    const Vec3 edge = normalized(along(first));
    Point location = 0.5 * (wall_.points[topology_.from(first)] + wall_.points[topology_.to(first)]);
    Vec3 direction = cross(normal(first), edge);
    double walked = 0.0;
    HalfedgeId h = first;
    for (int step = 0; step < k_most_steps; ++step) {
      const auto [exit, to] = across(h, location, direction);
      if (!exit.is_valid()) return 0.0;
      walked += distance(location, to);
      if (walked > most || topology_.is_boundary(exit)) return 0.0;
      if (is_sharp(exit)) return is_ridge(exit) && norm(cross(edge, normalized(along(exit)))) < k_taper ? walked : 0.0;
      location = to;
      h = topology_.twin(exit);
      const Vec3 n = normal(h);
      direction = normalized(direction - dot(direction, n) * n);
    }
    return 0.0;
  }

  /// Returns the point at which a straight line leaves the triangle that it entered across the half-edge `h`; invalid if the line runs along an edge.
  std::pair<HalfedgeId, Point> across(HalfedgeId h, const Point& location, const Vec3& direction) const {
    const Vec3 side = cross(normal(h), direction);  // direction to the left of the line
    const HalfedgeId second = next(h), third = next(second);
    const Point& corner = wall_.points[topology_.to(second)];  // corner opposite to the edge of entry
    const HalfedgeId exit = dot(side, corner - location) > 0.0 ? second : third;
    const Point &a = wall_.points[topology_.from(exit)], &b = wall_.points[topology_.to(exit)];
    const double left = dot(side, a - location), right = dot(side, b - location);
    if (left == right) return {HalfedgeId(), location};
    return {exit, a + std::clamp(left / (left - right), 0.0, 1.0) * (b - a)};
  }

  void add(const std::vector<Base>& bases) const {
    Finding finding{.kind = FindingKind::thin_base, .severity = Severity::warn, .limit = survey_.request.limits.base_ratio};
    finding.count = static_cast<std::int64_t>(bases.size());
    std::vector<Suspect<HalfedgeId>> suspects;
    std::vector<TriangleId> where;
    for (const Base& base : bases) {
      suspects.push_back({base.edge, base.height / base.thickness});
      where.push_back(map_.triangle(triangle_of(base.edge)));
    }
    const auto of = [&](HalfedgeId h) { return *std::ranges::find_if(bases, [&](const Base& base) { return base.edge == h; }); };
    const auto listed = worst(suspects, std::max<std::size_t>(survey_.n_locations(), 1));
    for (const auto& s : listed) {
      if (finding.locations.size() >= survey_.n_locations()) break;
      const Base base = of(s.id);
      finding.locations.push_back({0.5 * (wall_.points[topology_.from(s.id)] + wall_.points[topology_.to(s.id)]),
                                   survey_.patch_of(map_.triangle(triangle_of(s.id))), s.badness,
                                   in_metres(base.thickness, k_text_digits) + " thick under a layer of " + in_metres(base.height, k_text_digits)});
    }
    const Base worst_base = of(listed.front().id);
    finding.value = listed.front().badness;
    finding.text = "the layer on a blunt base is up to " + number_text(finding.value, k_text_digits) + " times as high as the base is thick, along " +
                   count_of(finding.count, "edge", "edges") + ": " + in_metres(worst_base.thickness, k_text_digits) + " thick under a layer of " +
                   in_metres(worst_base.height, k_text_digits) + "; prism sides behind the base are too skewed for cell-centred solvers";
    finding.advice = "in the CAD model, make the base at least " + in_metres(k_enough * worst_base.height, k_advice_digits) +
                     " thick, or make the edge sharp; a lower layer changes little";
    add_finding(survey_.report, std::move(finding), where);
  }

  const Survey& survey_;
  const LayerBase& base_;
  const TriMesh& wall_;
  const Topology& topology_;
  EnvelopeScale scale_;
  WallMap map_;
  double sharp_cosine_;
};

}  // namespace

void survey_bases(const Survey& survey, const LayerDomain& layer_domain) { BaseSurvey(survey, layer_domain).run(); }

}  // namespace sterna::volmesh
