// Predicts the layer by a short form of the first steps of the envelope, on the same walls and with the same requirements as in volume_mesh. The steps are:
// targets and directions; smoothing of directions as in the envelope, but only one round where elements are tangled; heights limited where growth lines meet
// and where elements are warped, and increased again as far as they are valid; gaps between opposing walls shared, and clearance kept. The following is left
// out: smoothing of heights and of the envelope itself (these keep 0.94 of the target), the exact tests for collisions (gaps represent most of them), and the
// optimiser, which raises heights that these steps lower too much. docs/measurements/inspect.md compares the prediction with finished meshes.
#include <array>
#include <cmath>

#include "geom/base/number_text.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/keep_distance.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/smooth.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

constexpr double k_full_share = 0.9;   ///< fraction of the target that counts as full height, as in the report of a mesh
constexpr int k_predicted_sweeps = 3;  ///< number of sweeps over all directions, as in the smoothing step of the envelope
/// Number of sweeps of the wide smoothing around concave locations. It is a third of the number in the envelope, because these sweeps take most of the time and
/// change the coverage by less than 1 % of the area.
constexpr int k_concave_sweeps = 16;
constexpr int k_tangled_rings = 6;  ///< number of rings, as in the envelope
constexpr int k_tangled_sweeps = 32;

struct Heights {
  Envelope envelope;
  std::vector<WallGap> gaps;
};

/// Makes one round of smooth_tangled_regions, which itself makes up to six.
void smooth_tangled(const LayerBase& base, const Classification& classes, Envelope& envelope, const RunContext& context) {
  const std::vector<TriangleId> bad = invalid_macros(base, envelope, context);
  if (bad.empty()) return;
  Column<VertexId, std::uint8_t> region(base.wall.n_vertices(), 0);
  for (const TriangleId t : bad)
    for (const VertexId v : base.wall.triangles[t]) region[v] = 1;
  grow_region(base, k_tangled_rings, region, context);
  smooth_directions(base, classes, k_tangled_sweeps, envelope, context, &region);
}

Heights predict(LayerDomain& layer_domain, const RunContext& context) {
  const LayerBase& base = layer_domain.base;
  const EnvelopeOptions& options = layer_domain.options.envelope;
  const Classification classes = classify_vertices(base, options, context);
  Heights heights{initial_envelope(base, options, context), {}};
  Envelope& envelope = heights.envelope;
  smooth_directions(base, classes, std::min(options.direction_sweeps, k_predicted_sweeps), envelope, context);
  const Column<VertexId, std::uint8_t> concave = concave_region(base, classes, context);
  smooth_directions(base, classes, std::min(options.direction_sweeps, k_concave_sweeps), envelope, context, &concave);
  smooth_tangled(base, classes, envelope, context);
  context.check_stop();
  untangle_edges(base, options, envelope, context);
  unwarp(base, options, HeightLimit::warp, envelope, context);
  regrow(base, envelope, context);
  context.check_stop();
  heights.gaps = share_gaps(base, options, layer_domain.collider, envelope, context);
  keep_distance(base, options, layer_domain.collider, envelope, context);
  regrow(base, envelope, context);
  return heights;
}

/// Groups of reasons, used for the advice.
enum class Cause : std::uint8_t { gap, corner, other };
Cause cause_of(HeightLimit limit) {
  switch (limit) {
    case HeightLimit::gap:
    case HeightLimit::collision: return Cause::gap;
    case HeightLimit::untangle:
    case HeightLimit::warp: return Cause::corner;
    default: return Cause::other;
  }
}

class HeightSurvey {
 public:
  HeightSurvey(const Survey& survey, const LayerDomain& layer_domain, const Heights& heights)
      : survey_(survey),
        base_(layer_domain.base),
        envelope_(heights.envelope),
        gaps_(heights.gaps),
        scale_(scale_of(layer_domain.base, layer_domain.options.envelope)),
        map_(survey.mesh, layer_domain.domain) {
    for (const double a : base_.vertex_area) all_ += a;
  }

  void add_prediction() const {
    LayerPrediction& layer = survey_.report.layer;
    layer.is_known = true;
    std::array<double, k_height_limits> lost{};
    std::vector<LayerPrediction::OfPatch> patches(base_.wall.patches.size());
    for (const VertexId v : base_.wall.points.ids()) {
      const double a = base_.vertex_area[v];
      if (is_full(v)) layer.coverage += a;
      else lost[static_cast<std::size_t>(envelope_.limit[v])] += a;
      if (is_compressed(v)) layer.compressed += a;
      if (envelope_.is_collapsed(v)) layer.collapsed += a;
    }
    for (double* share : {&layer.coverage, &layer.compressed, &layer.collapsed}) *share /= all_;
    for (const TriangleId t : base_.wall.triangles.ids()) {
      LayerPrediction::OfPatch& patch = patches[base_.wall.triangle_patch[t].index()];
      patch.area += base_.area[t];
      for (const VertexId v : base_.wall.triangles[t]) {
        const double a = base_.area[t] / 3.0;
        if (is_full(v)) patch.coverage += a;
        if (is_compressed(v)) patch.compressed += a;
        if (envelope_.is_collapsed(v)) patch.collapsed += a;
      }
    }
    for (std::size_t i = 0; i < lost.size(); ++i)
      if (lost[i] > 0.0) layer.lost_area.emplace_back(to_string(static_cast<HeightLimit>(i)), lost[i] / all_);
    std::stable_sort(layer.lost_area.begin(), layer.lost_area.end(), [](const auto& x, const auto& y) { return x.second > y.second; });
    for (const PatchId p : base_.wall.patches.ids()) {
      LayerPrediction::OfPatch& patch = patches[p.index()];
      if (patch.area <= 0.0) continue;
      patch.name = base_.wall.patches[p].name;
      for (double* share : {&patch.coverage, &patch.compressed, &patch.collapsed}) *share /= patch.area;
      layer.patches.push_back(std::move(patch));
    }
  }

  void add_fields() const {
    std::vector<double> share(base_.wall.n_vertices()), target(base_.wall.n_vertices()), gap(base_.wall.n_vertices(), k_no_value);
    for (const VertexId v : base_.wall.points.ids()) {
      share[v.index()] = share_of(v);
      target[v.index()] = envelope_.target[v];
    }
    for (const WallGap& hit : gaps_) gap[hit.vertex.index()] = hit.gap;
    survey_.add_field("height_share", "predicted height of the layer over its target", "", true, map_.field(share));
    survey_.add_field("target_height", "target height of the layer", "m", true, map_.field(target));
    survey_.add_field("gap", "distance to the opposite wall where the two layers do not fit", "m", true, map_.field(gap));
  }

  void add_findings() const {
    std::vector<Suspect<VertexId>> lowered, compressed, collapsed;
    for (const VertexId v : base_.wall.points.ids()) {
      if (base_.topology.outgoing(v).empty() || base_.constraint[v].freedom == Freedom::fixed) continue;
      if (envelope_.is_collapsed(v)) collapsed.push_back({v, 1.0});
      else if (is_compressed(v)) compressed.push_back({v, -envelope_.height[v] / room(v)});
      if (!is_full(v)) lowered.push_back({v, -share_of(v)});
    }
    if (!lowered.empty()) add_lowered(lowered);
    if (!compressed.empty()) add_compressed(compressed);
    if (!collapsed.empty()) add_collapsed(collapsed);
  }

 private:
  /// Returns true if the length of the growth line is sufficient. The length is tested, because the optimiser later turns inclined growth lines to the normal.
  bool is_full(VertexId v) const { return envelope_.height[v] >= k_full_share * envelope_.target[v]; }
  bool is_compressed(VertexId v) const { return !envelope_.is_collapsed(v) && envelope_.height[v] < room(v); }
  /// Returns the space in metres that the first cell of the growth line needs (EnvelopeScale::room_for_first_cell).
  double room(VertexId v) const { return scale_.room_for_first_cell(v, scale_.n(v)); }
  double share_of(VertexId v) const { return envelope_.target[v] > 0.0 ? envelope_.height[v] / envelope_.target[v] : k_no_value; }
  const std::string& patch_of(VertexId v) const { return survey_.patch_of(map_.triangle(triangle_of(base_.topology.outgoing(v).front()))); }

  double area_of(const std::vector<Suspect<VertexId>>& suspects) const {
    double area = 0.0;
    for (const auto& s : suspects) area += base_.vertex_area[s.id];
    return area / all_;
  }
  void add(Finding finding, const std::vector<Suspect<VertexId>>& suspects, double scale) const {
    finding.count = static_cast<std::int64_t>(suspects.size());
    finding.share = area_of(suspects);
    std::vector<TriangleId> where;
    for (const auto& s : suspects)
      for (const HalfedgeId h : base_.topology.outgoing(s.id)) where.push_back(map_.triangle(triangle_of(h)));
    for (const auto& s : worst(suspects, survey_.n_locations()))
      finding.locations.push_back({base_.wall.points[s.id], patch_of(s.id), scale * s.badness,
                                   "vertex " + std::to_string(s.id.value()) + ": " + in_metres(envelope_.height[s.id], k_text_digits) + " of " +
                                       in_metres(envelope_.target[s.id], k_text_digits) + ", " + std::string(to_string(envelope_.limit[s.id])) +
                                       gap_text(s.id)});
    add_finding(survey_.report, std::move(finding), where);
  }
  std::string gap_text(VertexId v) const {
    const auto hit = std::lower_bound(gaps_.begin(), gaps_.end(), v, [](const WallGap& g, VertexId searched) { return g.vertex < searched; });
    return hit != gaps_.end() && hit->vertex == v ? ", " + in_metres(hit->gap, k_text_digits) + " wide" : "";
  }

  void add_lowered(const std::vector<Suspect<VertexId>>& lowered) const {
    std::array<double, 3> area{};
    double least = 0.0;  // m, space that the gaps leave at the worst location
    std::string patch;
    double least_share = 2.0;
    for (const auto& s : lowered) {
      const Cause cause = cause_of(envelope_.limit[s.id]);
      area[static_cast<std::size_t>(cause)] += base_.vertex_area[s.id];
      if (cause != Cause::gap || envelope_.is_collapsed(s.id) || share_of(s.id) >= least_share) continue;
      least_share = share_of(s.id);
      least = envelope_.height[s.id];
      patch = patch_of(s.id);
    }
    const double share = area_of(lowered);
    Finding finding{
        .kind = FindingKind::lowered, .severity = share > survey_.request.limits.lowered_area ? Severity::warn : Severity::note, .limit = k_full_share};
    finding.value = -worst(lowered, 1).front().badness;
    finding.text = "the layer will be lower than " + number_text(k_full_share, k_text_digits) + " of its target on about " + percent(share) +
                   " of the walls' area: " + percent(area[0] / all_) + " in gaps between walls, " + percent(area[1] / all_) +
                   " in corners and where the surface turns within the layer's height";
    if (area[0] >= area[1] && least > 0.0)
      finding.advice = "no action if lower layers are acceptable in the gaps; otherwise limit the height there: patches = { [\"" + patch +
                       "\"] = { max_thickness = " + number_text(least, k_advice_digits) + " } }";
    else
      finding.advice =
          "no action if lower layers are acceptable there; otherwise request lower layers (total_height, or fewer layers), round concave corners, or refine "
          "the wall where it turns";
    add(std::move(finding), lowered, -1.0);
  }

  void add_compressed(const std::vector<Suspect<VertexId>>& compressed) const {
    const VertexId v = worst(compressed, 1).front().id;
    const double h = envelope_.height[v];
    Finding finding{.kind = FindingKind::compressed, .severity = Severity::warn, .limit = 1.0};
    const int all = scale_.n(v);
    finding.value = h / room(v);
    const std::string area = percent(area_of(compressed));
    finding.text = h < scale_.compressed(v)
                       ? "the layer will be lower than its cells at constant first height (" + std::to_string(all) + " of " +
                             in_metres(scale_.h0(v), k_text_digits) + ") on about " + area + " of the walls' area: first_height is not met there"
                       : "first_height is not met on about " + area + " of the walls' area: the layer will be lower there than " + std::to_string(all) +
                             " layers of uniform growth require";
    int layers = all - 1;
    while (layers > 1 && scale_.room_for_first_cell(v, layers) > h) --layers;
    const std::string first = "first_height = " + number_text(scale_.h0(v) * finding.value, k_advice_digits);
    finding.advice = layers > 1 ? "layers = " + std::to_string(layers) + ", or " + first + ", would fit at the worst location"
                                : first + " would fit at the worst location; is first_height in the unit of the surface?";
    add(std::move(finding), compressed, -1.0);
  }

  void add_collapsed(const std::vector<Suspect<VertexId>>& collapsed) const {
    const double share = area_of(collapsed);
    Finding finding{.kind = FindingKind::collapsed, .severity = Severity::warn, .value = 0.0, .limit = 0.2};
    std::string patch = patch_of(collapsed.front().id);
    finding.text = "there will be no layer on about " + percent(share) +
                   " of the walls' area: the free height is less than 1/5 of its cells at constant first height, or there is no growth direction";
    finding.advice = "layers need a height of " + in_metres(0.2 * scale_.compressed(collapsed.front().id), k_advice_digits) +
                     ": open the gap, lower first_height, or remove the layers there: patches = { [\"" + patch + "\"] = { layers = 0 } }";
    add(std::move(finding), collapsed, 0.0);
  }

  const Survey& survey_;
  const LayerBase& base_;
  const Envelope& envelope_;
  const std::vector<WallGap>& gaps_;
  EnvelopeScale scale_;
  WallMap map_;
  double all_ = 0.0;  ///< m^2, total area
};

}  // namespace

void survey_heights(const Survey& survey, LayerDomain& layer_domain) {
  const Heights heights = predict(layer_domain, survey.context);
  const HeightSurvey result(survey, layer_domain, heights);
  result.add_prediction();
  result.add_fields();
  result.add_findings();
}

}  // namespace sterna::volmesh
