// Where bands stand on a face's border.
#pragma once

#include <optional>
#include <vector>

#include "surfmesh/face/face_strip.h"
#include "surfmesh/model/edge_cuts.h"
#include "surfmesh/model/mesh_faces.h"
#include "surfmesh/model/own_seam.h"

namespace sterna::surfmesh {

/// From one point of a border to the next.
struct BorderSegment {
  EdgeId edge;                                         ///< that stands for it; invalid along poles and seams of the face's own
  bool is_forward = true;                              ///< along that edge's parameter
  bool is_first = false;                               ///< of its use
  std::size_t n_rows_at_start = 0, n_rows_at_end = 0;  ///< of its use, seen along the border
};
/// As the loops' points: from each to the next.
using BorderSegments = std::vector<std::vector<BorderSegment>>;
BorderSegments segments_of(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                           const LabelledBorder& labelled);

/// Runs of the face's border beside edges of bands; columns on the border where bands go on beyond the face.
std::vector<BandRun> band_runs(FaceId f, const LabelledBorder& labelled, const BorderSegments& segments, const WingBands& bands, const CurvatureLimits& limits);

/// The base of a trailing edge as a strip. \return nothing where its border is not that of a strip, or cells would be turned over
std::optional<BandedFace> mesh_base(const Surface& surface, const LabelledBorder& labelled, const BorderSegments& segments, const BaseStrip& strip);

}  // namespace sterna::surfmesh
