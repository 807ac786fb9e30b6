// Smooth leading edges of a triangulation as lines of edges: where the surface is bent most and looks straight ahead.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

struct NoseCut {
  TriMesh mesh;                                ///< the wall, edges that noses cross halved; the same patches
  std::vector<std::array<VertexId, 2>> edges;  ///< along noses
};

/// Noses are where the direction across the strongest bend has no part along x. Points of noses lie on the reference's smooth surface; where it `is_flat`, on
/// the triangles. What is no nose of a wing after all (find_row_lines decides) is among them, too.
NoseCut cut_noses(const Reference& reference, bool is_flat, const RunContext& context);

/// The wall with smooth leading edges of wings as lines of edges; nothing where no rule and no option asks for rows there.
std::optional<NoseCut> cut_noses_if_asked(const TriMesh& wall, const ReferenceOptions& reference_options, const RemeshOptions& options,
                                          std::span<const PatchSurfaceOptions> patches, const RunContext& context);

}  // namespace sterna::surfmesh
