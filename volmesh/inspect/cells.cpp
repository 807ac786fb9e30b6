// Compares the first height and the last layer with the edges of the wall, and the first height with the flow.
#include <cmath>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/flow/boundary_layer.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

constexpr double k_noticed_area = 0.01;  ///< fraction of the area above which a mismatch of the last layer is reported
constexpr double k_growth_step = 0.005;  ///< added to a recommended growth, so that the rounded value is sufficient
constexpr double k_steep_growth = 1.5;   ///< largest recommended growth; with larger growth solvers do not resolve the profile of the boundary layer
constexpr int k_most_layers = 1000;      ///< largest recommended number of layers
constexpr double k_y_plus_factor = 2.0;  ///< factor within which the y+ of a flat-plate estimate may differ from the target

/// Requested cells of the layer at a vertex by eq. (1) and the upper limits, before any reduction.
struct Cells {
  double first = 0.0, last = 0.0;  ///< m, first and last height
  double edge = 0.0;               ///< m
  double top_ratio() const { return last / (k_regular_height * edge); }
};

double height_of(const LayerBase& base, const EnvelopeScale& scale, VertexId v, int n) {
  const double requested = scale.total_height(v);
  const double height =
      is_automatic(requested) ? height_by_edge(scale.first_step(v), base.mean_edge[v], scale.max_growth(v), n, scale.has_common_growth()) : requested;
  return std::min(height, scale.max_thickness(v));
}

/// Computes the cells for n layers.
Cells cells_at(const LayerBase& base, const EnvelopeScale& scale, VertexId v, int n) {
  const double h0 = scale.h0(v), edge = base.mean_edge[v];
  const double height = height_of(base, scale, v, n);
  if (height <= n * scale.first_step(v)) return {height / n, height / n, edge};
  return {h0, last_height(scale.growth(v), height, n), edge};
}

Cells cells_at(const LayerBase& base, const EnvelopeScale& scale, VertexId v) { return cells_at(base, scale, v, scale.n(v)); }

struct Misfit {
  std::vector<Suspect<VertexId>> locations;
  double area = 0.0;  ///< fraction of the area
};

class CellSurvey {
 public:
  CellSurvey(const Survey& survey, const LayerDomain& layer_domain)
      : survey_(survey), base_(layer_domain.base), scale_(scale_of(layer_domain.base, layer_domain.options.envelope)), map_(survey.mesh, layer_domain.domain) {}

  void run() const {
    const double ratio = survey_.request.limits.top_ratio;
    Misfit thin, thick, tall;
    double all = 0.0;
    std::vector<double> top(base_.wall.n_vertices(), k_no_value);
    Column<VertexId, Cells> all_cells(base_.wall.n_vertices());
    parallel_for(survey_.context, all_cells.size(), [&](std::size_t i) {
      const VertexId v(i);
      if (base_.mean_edge[v] > 0.0) all_cells[v] = cells_at(base_, scale_, v);
    });
    for (const VertexId v : base_.wall.points.ids()) {
      const double area = base_.vertex_area[v];
      all += area;
      if (!(base_.mean_edge[v] > 0.0)) continue;
      const Cells& cells = all_cells[v];
      const double r = cells.top_ratio();
      top[v.index()] = r;
      const auto note = [&](Misfit& misfit, double badness) {
        misfit.locations.push_back({v, badness});
        misfit.area += area;
      };
      if (scale_.h0(v) > cells.edge) note(tall, scale_.h0(v) / cells.edge);
      else if (r > ratio) note(thick, r);
      else if (r * ratio < 1.0) note(thin, 1.0 / r);
    }
    for (Misfit* misfit : {&thin, &thick, &tall}) misfit->area /= all;
    survey_.add_field("top_ratio", "requested height of the last layer over 0.816 edge lengths", "", true, map_.field(top));
    if (!tall.locations.empty()) add_tall(tall);
    if (thin.area > k_noticed_area) add_thin(thin);
    if (thick.area > k_noticed_area) add_thick(thick);
  }

 private:
  void add(Finding finding, const Misfit& misfit, bool is_inverse) const {
    finding.count = static_cast<std::int64_t>(misfit.locations.size());
    finding.share = misfit.area;
    std::vector<TriangleId> where;
    for (const auto& s : misfit.locations)
      for (const HalfedgeId h : base_.topology.outgoing(s.id)) where.push_back(map_.triangle(triangle_of(h)));
    for (const auto& s : worst(misfit.locations, survey_.n_locations())) {
      const Cells cells = cells_at(base_, scale_, s.id);
      finding.locations.push_back({base_.wall.points[s.id], survey_.patch_of(map_.triangle(triangle_of(base_.topology.outgoing(s.id).front()))),
                                   is_inverse ? 1.0 / s.badness : s.badness,
                                   "vertex " + std::to_string(s.id.value()) + ": first cell " + in_metres(cells.first, k_text_digits) + ", last " +
                                       in_metres(cells.last, k_text_digits) + ", edges " + in_metres(cells.edge, k_text_digits)});
    }
    add_finding(survey_.report, std::move(finding), where);
  }

  /// Returns the vertex at which one tenth of the mismatches are worse. Recommendations are made for this vertex, so that single locations do not determine
  /// them.
  VertexId typical(const Misfit& misfit) const { return worst(misfit.locations, misfit.locations.size() / 10 + 1).back().id; }

  void add_tall(const Misfit& tall) const {
    Finding finding{.kind = FindingKind::tall_first, .severity = Severity::warn, .value = worst(tall.locations, 1).front().badness, .limit = 1.0};
    finding.text = "the first cell is taller than the edges of the wall on " + percent(tall.area) + " of the wall area, up to " +
                   number_text(finding.value, k_text_digits) + " times: first_height and the surface are probably not in the same unit";
    const VertexId v = worst(tall.locations, 1).front().id;
    finding.advice = "first_height = " + number_text(0.1 * base_.mean_edge[v], k_advice_digits) + " or less, or another unit of the surface (unit = mm)";
    add(std::move(finding), tall, false);
  }

  void add_thin(const Misfit& thin) const {
    Finding finding{.kind = FindingKind::thin_top,
                    .severity = Severity::warn,
                    .value = 1.0 / worst(thin.locations, 1).front().badness,
                    .limit = 1.0 / survey_.request.limits.top_ratio};
    finding.text = "on " + percent(thin.area) + " of the walls' area the last layer is thinner than " + number_text(finding.limit, k_text_digits) +
                   " of the tetrahedra above it (" + number_text(finding.value, k_text_digits) + " at the worst): a jump of cell sizes at the top of the layer";
    const VertexId v = typical(thin);
    if (const int n = enough_layers(v, 1.0 / finding.limit); n > 0)
      finding.advice = "layers = " + std::to_string(n) + " is enough with max_growth = " + number_text(scale_.max_growth(v), k_text_digits);
    else
      finding.advice = "use shorter edges on the wall (max_edge = " + number_text(cells_at(base_, scale_, v).last / k_regular_height, k_advice_digits) +
                       "), or a taller layer (total_height, max_thickness)";
    const double rise = std::log(k_regular_height * base_.mean_edge[v] / scale_.h0(v)), growth = std::exp(rise / std::max(scale_.n(v) - 1, 1)) + k_growth_step;
    if (is_automatic(scale_.total_height(v)) && growth < k_steep_growth && layer_height(scale_.h0(v), growth, scale_.n(v)) < scale_.max_thickness(v))
      finding.advice += "; or max_growth = " + number_text(growth, k_text_digits) + " with layers = " + std::to_string(scale_.n(v));
    add(std::move(finding), thin, true);
  }

  /// Returns the smallest number of layers, larger than the present one, with which the last layer is not thinner than the limit. Returns 0 if there is none,
  /// because another upper limit is reached first.
  int enough_layers(VertexId v, double ratio) const {
    if (!is_automatic(scale_.total_height(v))) return 0;  // with a given total height, more layers would be thinner
    for (int n = scale_.n(v) + 1; n <= k_most_layers; ++n)
      if (cells_at(base_, scale_, v, n).top_ratio() * ratio >= 1.0) return n;
    return 0;
  }

  void add_thick(const Misfit& thick) const {
    Finding finding{.kind = FindingKind::thick_top,
                    .severity = Severity::warn,
                    .value = worst(thick.locations, 1).front().badness,
                    .limit = survey_.request.limits.top_ratio};
    finding.text = "on " + percent(thick.area) + " of the walls' area the last layer is thicker than " + number_text(finding.limit, k_text_digits) +
                   " times the tetrahedra above it (" + number_text(finding.value, k_text_digits) +
                   " at the worst): a jump of cell sizes at the top of the layer";
    const VertexId v = typical(thick);
    finding.advice =
        "total_height = " +
        number_text(
            layer_height(scale_.h0(v), growth_for_edge(scale_.h0(v), k_regular_height * base_.mean_edge[v], scale_.max_growth(v), scale_.n(v)), scale_.n(v)),
            k_advice_digits) +
        " or no total_height, or more layers";
    add(std::move(finding), thick, false);
  }

  const Survey& survey_;
  const LayerBase& base_;
  EnvelopeScale scale_;
  WallMap map_;
};

}  // namespace

double requested_height(const LayerBase& base, const EnvelopeScale& scale, VertexId v) { return height_of(base, scale, v, scale.n(v)); }

void survey_cells(const Survey& survey, const LayerDomain& layer_domain) { CellSurvey(survey, layer_domain).run(); }

void survey_y_plus(const Survey& survey) {
  const double h0 = survey.request.volume.envelope.first_height;
  if (!survey.request.flow || is_automatic(h0)) return;
  const double target = survey.request.limits.wanted_y_plus;
  const FirstHeight first = first_height({.y_plus = target}, *survey.request.flow);
  const double y_plus = target * h0 / first.height;
  if (y_plus <= k_y_plus_factor * target && y_plus * k_y_plus_factor >= target) return;
  Finding finding{.kind = FindingKind::y_plus, .severity = y_plus > target ? Severity::warn : Severity::note, .count = 1, .value = y_plus, .limit = target};
  finding.text = "first_height = " + in_metres(h0, k_text_digits) + " is y+ " + number_text(y_plus, k_text_digits) +
                 " on a flat plate in this flow, the target is " + number_text(target, k_text_digits);
  finding.advice = "first_height = " + number_text(first.height, k_text_digits) + " (" + describe(first) + ")";
  add_finding(survey.report, std::move(finding), {});
}

}  // namespace sterna::volmesh
