// What is asked of the layer before it is built: members of a mesh family, and which of number of layers, growth and total height follows from the others.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Layers of first height h0, number n, largest growth r and total height H; H automatic: by the edges of the wall, eq. (1) of docs/method/envelope.md,
/// "Heights".
struct LayerChoice {
  int layers = 0;
  double first_height = k_automatic;  ///< m
  double max_growth = 0.0;
  double total_height = k_automatic;  ///< m
};

/// Solves for what `solve_for` names ("layers": the fewest that reach H with growth r at most, "max_growth": the growth with which n layers reach H); "none":
/// proves that they agree. Without H nothing changes. \p where names the patch or the walls in messages.
/// \post n h0 <= H <= the height of n layers that grow by r
/// \throws Error(bad_argument) where no such layer exists: with the numbers that would do
LayerChoice solve_layers(LayerChoice asked, std::string_view solve_for, std::string_view where);

/// What solve_for becomes where only some of the three are given: "layers" or "max_growth"; "none" without a total height.
/// \throws Error(bad_argument) when all three or only the total height are given
std::string solved_for(bool has_layers, bool has_growth, bool has_height, std::string_view attempted);

/// The member `options.family.refinement` of the family of which the options describe the medium one (docs/method/quality.md, "Mesh families"): first heights
/// h0/f, growth r^(1/f), n f layers (rounded), sizes, edges of sources, discs and farfield divided by f, growth of tetrahedra 1 + (g - 1)/f. Total heights,
/// angles and shapes stay. Its own refinement is 1.
MeshCase refined(MeshCase options);

/// refined(), then the layers of all walls solved for; what was found goes to the log.
/// \throws as solve_layers
MeshCase effective_options(const MeshCase& options, const RunContext& context);

}  // namespace sterna::volmesh
