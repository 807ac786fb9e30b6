// Layer parameters before the layer is built. Computes them for members of a mesh family. Computes the number of layers, the growth or the total height from
// the other two.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Solves for the parameter named by `solve_for` among the number n of layers, the largest growth r and the total height H of layers with first height h0.
/// "layers" gives the smallest number that reaches H with growth of at most r. "max_growth" gives the growth with which n layers reach H. "none" only checks
/// that the parameters are consistent. Nothing changes if H is automatic: then H follows from the edges of the wall, eq. (1) of docs/method/envelope.md,
/// "Heights". \p where names the patch or the walls in messages. \post n h0 <= H <= the height of n layers that grow by r
/// \throws Error(bad_argument) if no such layer exists; the message contains numbers that would work
EnvelopeOptions solve_layers(EnvelopeOptions requested, std::string_view solve_for, std::string_view where);

/// Returns the value of solve_for if only some of the three parameters are given: "layers" or "max_growth", or "none" if the total height is not given.
/// \throws Error(bad_argument) if all three or only the total height are given
std::string solved_for(bool has_layers, bool has_growth, bool has_height, std::string_view attempted);

/// Returns the options of the family member with the refinement factor f = `options.family.refinement`. The given options describe the medium member
/// (docs/method/quality.md, "Mesh families"). First heights become h0/f, the growth becomes r^(1/f), and the number of layers n f (rounded). Sizes and the
/// edges of sources, discs and farfield are divided by f; growth of tetrahedra becomes 1 + (g - 1)/f. Total heights, angles and shapes stay. The result has
/// refinement 1.
MeshCase refined(MeshCase options);

/// Applies refined(), then solves for the layers of all walls. The result is logged.
/// \throws the errors of solve_layers
MeshCase effective_options(const MeshCase& options, const RunContext& context);

}  // namespace sterna::volmesh
