#include "geom/cad/refit.h"

#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

#include <algorithm>
#include <map>

#include "geom/base/parallel.h"
#include "geom/cad/occt_geometry.h"
#include "geom/model/sampled.h"

namespace sterna::cad {
namespace {

bool is_exact(const Surface& surface) { return !geom_of(surface).IsNull(); }
bool is_exact(const Curve& curve) { return !geom_of(curve).IsNull(); }

/// Distinct surfaces or curves without an exact form, in the order of the model, with their replacements.
template <class Geometry>
struct Refits {
  std::vector<const Geometry*> originals;
  std::vector<std::shared_ptr<const Geometry>> replacements;
  std::vector<double> errors;
  std::map<const Geometry*, std::size_t> locations;
  void note(const Geometry* geometry) {
    if (!locations.contains(geometry) && !is_exact(*geometry)) {
      locations.emplace(geometry, originals.size());
      originals.push_back(geometry);
    }
  }
  /// Replaces the handle and returns the error of the replacement.
  double replace(std::shared_ptr<const Geometry>& handle) const {
    const auto location = locations.find(handle.get());
    if (location == locations.end()) return 0.0;
    handle = replacements[location->second];
    return errors[location->second];
  }
};

template <class Geometry, class Sample>
void sample_all(Refits<Geometry>& refits, const Sample& sample, const RunContext& context) {
  refits.replacements.resize(refits.originals.size());
  refits.errors.resize(refits.originals.size());
  parallel_for(
      context, refits.originals.size(), [&](std::size_t i) { sample(*refits.originals[i], refits.replacements[i], refits.errors[i]); }, 1);
}

}  // namespace

bool needs_refit(const Model& model) {
  return std::any_of(model.faces.begin(), model.faces.end(), [](const ModelFace& face) { return !is_exact(*face.surface); }) ||
         std::any_of(model.edges.begin(), model.edges.end(), [](const ModelEdge& edge) { return !edge.is_degenerate() && !is_exact(*edge.curve); });
}

Model refitted(const Model& model, double tolerance, RefitReport& report, const RunContext& context) {
  Refits<Surface> surfaces;
  Refits<Curve> curves;
  for (const ModelFace& face : model.faces) surfaces.note(face.surface.get());
  for (const ModelEdge& edge : model.edges)
    if (!edge.is_degenerate()) curves.note(edge.curve.get());
  sample_all(
      surfaces,
      [&](const Surface& surface, SurfacePtr& replacement, double& error) {
        const SampledSurface sampled = sample_surface(surface, tolerance);
        replacement = sampled.surface;
        error = sampled.error;
      },
      context);
  sample_all(
      curves,
      [&](const Curve& curve, CurvePtr& replacement, double& error) {
        const SampledCurve sampled = sample_curve(curve, tolerance);
        replacement = sampled.curve;
        error = sampled.error;
      },
      context);

  Model result = model;
  result.shape.reset();
  Column<EdgeId, double> lost(model.edges.size(), 0.0);
  for (ModelFace& face : result.faces) {
    const double error = surfaces.replace(face.surface);
    report.error = std::max(report.error, error);
    for (const Border& border : face.borders)
      for (const EdgeUse& use : border) lost[use.edge] = std::max(lost[use.edge], error);
  }
  for (const EdgeId e : result.edges.ids()) {
    ModelEdge& edge = result.edges[e];
    if (edge.is_degenerate()) continue;
    const double error = curves.replace(edge.curve);
    report.error = std::max(report.error, error);
    if (const double both = error + lost[e]; both > 0.0) {
      edge.tolerance += both;
      for (const CornerId corner : {edge.start, edge.end}) result.corners[corner].tolerance = std::max(result.corners[corner].tolerance, edge.tolerance);
    }
  }
  report.n_surfaces = surfaces.originals.size();
  report.n_curves = curves.originals.size();
  return result;
}

}  // namespace sterna::cad
