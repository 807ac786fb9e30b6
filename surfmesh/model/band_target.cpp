#include "surfmesh/model/band_target.h"

#include <algorithm>
#include <cmath>

namespace sterna::surfmesh {
namespace {

/// Stretch used if only a first cell is given.
constexpr double k_default_stretch = 10.0;

double least_said(double a, double b) { return is_automatic(a) ? b : is_automatic(b) ? a : std::min(a, b); }

/// Returns the pattern of the last rule that sets the first cell or the stretch; empty: no rule sets one of them.
std::string deciding_rule(const std::string& name, std::span<const Rule> patches, const std::string& edge) {
  const Rule* first = rule_for(name, patches, edge + "_chordwise");
  const Rule* stretch = rule_for(name, patches, edge + "_stretch");
  const Rule* last = !first || (stretch && stretch > first) ? stretch : first;
  return last ? last->names : std::string();
}

}  // namespace

double BandTarget::first_height(double max_edge) const { return is_automatic(chordwise) ? max_edge / stretch : chordwise; }

double BandTarget::longest(double max_edge) const { return std::min(max_edge, first_height(max_edge) * (is_automatic(stretch) ? k_default_stretch : stretch)); }

BandTarget both(const BandTarget& a, const BandTarget& b) {
  if (!a.is_any() || !b.is_any()) return a.is_any() ? a : b;
  return {least_said(a.chordwise, b.chordwise), least_said(a.stretch, b.stretch), std::min(a.growth, b.growth), a.rule};
}

BandTargets band_targets(const std::string& name, const SurfaceSizeOptions& of_patch, std::span<const Rule> patches) {
  const SurfaceSizeOptions& o = of_patch;
  BandTargets targets{.leading = {o.leading_edge_chordwise, o.leading_edge_stretch, o.leading_edge_growth, deciding_rule(name, patches, "leading_edge")},
                      .trailing = {o.trailing_edge_chordwise, o.trailing_edge_stretch, o.trailing_edge_growth, deciding_rule(name, patches, "trailing_edge")}};
  // The next mesh of a family: lengths are divided by the factor, so the number of cells is multiplied by it. Growth becomes the corresponding root
  // (docs/method/quality.md, "Mesh families").
  for (BandTarget* target : {&targets.leading, &targets.trailing}) {
    target->chordwise /= o.refinement;
    target->growth = std::pow(target->growth, 1.0 / o.refinement);
  }
  return targets;
}

}  // namespace sterna::surfmesh
