// Smooth leading edges of a triangulation as lines of edges: locations of the largest curvature that face straight ahead.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

struct NoseCut {
  TriMesh mesh;                                ///< the wall with edges split where noses cross them; same patches
  std::vector<std::array<VertexId, 2>> edges;  ///< along noses
};

/// Finds noses: lines where the direction across the largest curvature has no component along x. Points of noses lie on the reference's smooth surface, or,
/// where it `is_flat`, on the triangles. The result may contain lines that are not noses of wings; find_row_lines decides.
NoseCut cut_noses(const Reference& reference, bool is_flat, const RunContext& context);

/// Returns the wall with smooth leading edges of wings as lines of edges; nothing if no rule and no option requires rows there.
std::optional<NoseCut> cut_noses_if_asked(const TriMesh& wall, const ReferenceOptions& reference_options, const RemeshOptions& options,
                                          std::span<const PatchSurfaceOptions> patches, const RunContext& context);

}  // namespace sterna::surfmesh
