// Locations of bands on the border of a face.
#pragma once

#include <optional>
#include <vector>

#include "surfmesh/face/face_strip.h"
#include "surfmesh/model/edge_cuts.h"
#include "surfmesh/model/mesh_faces.h"
#include "surfmesh/model/own_seam.h"

namespace sterna::surfmesh {

/// Segment from one point of a border to the next.
struct BorderSegment {
  EdgeId edge;                                         ///< edge on which the segment lies; invalid at poles and on seams that the mesher added to the face
  bool is_forward = true;                              ///< the segment runs in the direction of that edge's parameter
  bool is_first = false;                               ///< first segment of its edge use
  std::size_t n_rows_at_start = 0, n_rows_at_end = 0;  ///< rows at the two ends of the edge use, in the direction of the border
};
/// Segments in the order of the points of each loop: segment i runs from point i to the next point.
using BorderSegments = std::vector<std::vector<BorderSegment>>;
BorderSegments segments_of(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                           const LabelledBorder& labelled);

/// Returns the runs of the face's border beside band edges, with columns on the border where bands continue beyond the face.
std::vector<BandRun> band_runs(FaceId f, const LabelledBorder& labelled, const BorderSegments& segments, const WingBands& bands, const CurvatureLimits& limits);

/// Meshes the base of a trailing edge as a strip. \return nothing if the border is not that of a strip, or if cells would be inverted
std::optional<BandedFace> mesh_base(const Surface& surface, const LabelledBorder& labelled, const BorderSegments& segments, const BaseStrip& strip);

}  // namespace sterna::surfmesh
