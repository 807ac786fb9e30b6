#include "surfmesh/model/band_target.h"

#include <algorithm>
#include <cmath>

#include "geom/base/glob.h"

namespace sterna::surfmesh {
namespace {

/// Stretch used if only a first cell is given.
constexpr double k_default_stretch = 10.0;

double least_said(double a, double b) { return is_automatic(a) ? b : is_automatic(b) ? a : std::min(a, b); }

bool overrule(double& value, double said) {
  if (is_automatic(said)) return false;
  value = said;
  return true;
}

}  // namespace

double BandTarget::first_height(double max_edge) const { return is_automatic(chordwise) ? max_edge / stretch : chordwise; }

double BandTarget::longest(double max_edge) const { return std::min(max_edge, first_height(max_edge) * (is_automatic(stretch) ? k_default_stretch : stretch)); }

BandTarget both(const BandTarget& a, const BandTarget& b) {
  if (!a.is_any() || !b.is_any()) return a.is_any() ? a : b;
  return {least_said(a.chordwise, b.chordwise), least_said(a.stretch, b.stretch), std::min(a.growth, b.growth), a.rule};
}

BandTargets band_targets(const std::string& name, BandTargets targets, double refinement, std::span<const PatchSurfaceOptions> patches) {
  for (const PatchSurfaceOptions& rule : patches) {
    if (!matches_glob(name, rule.names)) continue;
    if (overrule(targets.leading.chordwise, rule.leading_edge_chordwise) | overrule(targets.leading.stretch, rule.leading_edge_stretch))
      targets.leading.rule = rule.names;
    if (overrule(targets.trailing.chordwise, rule.trailing_edge_chordwise) | overrule(targets.trailing.stretch, rule.trailing_edge_stretch))
      targets.trailing.rule = rule.names;
    overrule(targets.leading.growth, rule.leading_edge_growth);
    overrule(targets.trailing.growth, rule.trailing_edge_growth);
  }
  // The next mesh of a family: lengths are divided by the factor, so the number of cells is multiplied by it. Growth becomes the corresponding root
  // (docs/method/quality.md, "Mesh families").
  for (BandTarget* target : {&targets.leading, &targets.trailing}) {
    target->chordwise /= refinement;
    target->growth = std::pow(target->growth, 1.0 / refinement);
  }
  return targets;
}

}  // namespace sterna::surfmesh
