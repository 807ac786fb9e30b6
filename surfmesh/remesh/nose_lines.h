// Finds the smooth leading edges of a triangulation as lines of edges: the locations of largest curvature that face straight ahead.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

struct NoseCut {
  TriMesh mesh;                                ///< the wall, with edges split where noses cross them; it has the same patches
  std::vector<std::array<VertexId, 2>> edges;  ///< edges along noses
};

/// Finds noses: lines where the direction across the largest curvature has no component along x. Points of noses lie on the reference's smooth surface, or on
/// its triangles if `is_flat` is set. The result may contain lines that are not noses of wings; find_row_lines decides.
NoseCut cut_noses(const Reference& reference, bool is_flat, const RunContext& context);

/// Returns the wall with the smooth leading edges of wings as lines of edges. Returns nothing if no rule or option requires rows there.
std::optional<NoseCut> cut_noses_if_requested(const TriMesh& wall, const ReferenceOptions& reference_options, const RemeshOptions& options,
                                              std::span<const Rule> patches, const RunContext& context);

}  // namespace sterna::surfmesh
