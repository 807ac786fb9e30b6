// Layer parameters before the layer is built: members of a mesh family, and which of number of layers, growth and total height follows from the others.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Layers with first height h0, number n, largest growth r and total height H. Automatic H: from the edges of the wall, eq. (1) of docs/method/envelope.md,
/// "Heights".
struct LayerChoice {
  int layers = 0;
  double first_height = k_automatic;  ///< m
  double max_growth = 0.0;
  double total_height = k_automatic;  ///< m
};

/// Solves for the parameter named by `solve_for` ("layers": the smallest number that reaches H with growth r at most; "max_growth": the growth with which n
/// layers reach H). "none" checks that the parameters are consistent. Without H nothing changes. \p where names the patch or the walls in messages.
/// \post n h0 <= H <= the height of n layers that grow by r
/// \throws Error(bad_argument) if no such layer exists: with numbers that would work
LayerChoice solve_layers(LayerChoice asked, std::string_view solve_for, std::string_view where);

/// Returns the value of solve_for if only some of the three are given: "layers" or "max_growth"; "none" without a total height.
/// \throws Error(bad_argument) if all three or only the total height are given
std::string solved_for(bool has_layers, bool has_growth, bool has_height, std::string_view attempted);

/// Returns the options of the family member `options.family.refinement` = f; the given options describe the medium member (docs/method/quality.md, "Mesh
/// families"). First heights become h0/f, growth r^(1/f), layers n f (rounded). Sizes and the edges of sources, discs and farfield are divided by f; growth of
/// tetrahedra becomes 1 + (g - 1)/f. Total heights, angles and shapes stay. The result has refinement 1.
MeshCase refined(MeshCase options);

/// Applies refined(), then solves for the layers of all walls; the result is logged.
/// \throws as solve_layers
MeshCase effective_options(const MeshCase& options, const RunContext& context);

}  // namespace sterna::volmesh
