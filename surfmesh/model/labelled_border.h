// Borders of faces with what their points and segments are in the model.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "surfmesh/face/face_mesh.h"
#include "surfmesh/model/edge_cuts.h"
#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {

struct BorderVertices;

/// Segment from one point of a border to the next.
struct BorderSegment {
  EdgeId edge;                   ///< that stands for it; invalid along poles
  bool is_forward = true;        ///< along that edge's parameter
  std::size_t place = 0;         ///< of the use in the face's border
  bool is_first = false;         ///< of its use
  std::size_t n_rows_at_start = 0, n_rows_at_end = 0;  ///< of its use, seen along the border
};

/// A face's border as mesh_face takes it, with what each of its points (all loops in order) is in the model.
struct LabelledBorder {
  FaceBorder border;
  std::vector<VertexId> ids;     ///< of the joined mesh; invalid on a seam of the face's own
  std::vector<EdgeId> edges;     ///< corners: the edge that starts there; invalid likewise
  std::vector<std::vector<BorderSegment>> segments;  ///< as the loops' points: from each to the next; empty with a seam of the face's own
  std::vector<Uv> loop_ends;     ///< where each loop arrives: its first place, or that moved by periods
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;  ///< points that are one: the second goes
};

/// What the model says that an edge's vertices may be off its faces, metres.
double tolerance_of(const Model& model, FaceId f, EdgeId e);

LabelledBorder label_border(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers, const FaceOutline& outline);

/// Where a border passes a corner twice (a hole that touches the border), both get the same (u, v): files have them some rounding apart, and a gap of that width would
/// be meshed. Of points that follow each other there only the first stays. Poles and seams are far apart in (u, v).
LabelledBorder merge_touching(const Model& model, FaceId f, const LabelledBorder& given);

}  // namespace sterna::surfmesh
