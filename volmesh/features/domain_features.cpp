// The list of the features, and the combinations that are not permitted.
#include <array>
#include <string>
#include <utility>

#include "geom/base/error.h"
#include "volmesh/features/domain_feature.h"

namespace sterna::volmesh {
namespace {

/// All features in their order. Slivers are split first. Sheets belong to walls that discs have not cut. Periodic sides are joined when no other feature
/// changes them any more. Ridges are opened on the complete wall.
constexpr std::array<FeatureMaker, 6> k_features = {sliver_splitting, wake_sheets, actuator_discs, periodic_joints, layer_edges, ridge_fans};

/// Checks that wake sheets are not combined with incompatible options.
void require_no_others(const MeshCase& options) {
  if (options.wakes.empty()) return;
  const auto refuse = [](std::string what, std::string hint) { throw_bad_argument("making wake sheets", std::move(what), {}, std::move(hint)); };
  if (opens_ridges(options))
    refuse("wake sheets cannot be combined with several normals at ridges (open_ridges)", "leave wakes out, or set open_ridges = \"never\"");
  if (!options.discs.empty()) refuse("wake sheets cannot be combined with actuator discs", "leave the wakes or the discs out");
}

/// Checks the rules for exactly these patches. A rule for "*" is ignored, because it is meant for other patches.
void require_no_layers_on_periodic_sides(const MeshCase& options) {
  for (const PatchRule& rule : options.patches)
    for (const PeriodicNames& pair : options.periodic)
      if ((rule.names == pair.first || rule.names == pair.second) && (rule.layers > 0 || rule.kind == "wall"))
        throw_bad_argument("making \"" + pair.first + "\" and \"" + pair.second + "\" periodic",
                           "patches requests kind wall or layers on \"" + rule.names + "\"", {},
                           "periodic sides carry no layers: leave out the rule or the periodic pair");
}

}  // namespace

std::vector<std::shared_ptr<DomainFeature>> domain_features(const MeshCase& options) {
  std::vector<std::shared_ptr<DomainFeature>> features;
  for (const FeatureMaker make : k_features)
    if (std::shared_ptr<DomainFeature> feature = make(options)) features.push_back(std::move(feature));
  return features;
}

void require_compatible(const MeshCase& options) {
  require_no_others(options);
  require_no_layers_on_periodic_sides(options);
}

}  // namespace sterna::volmesh
