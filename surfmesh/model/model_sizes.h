// Wanted lengths of edges over a model: what options, rules for patches and component defaults say for each face, and what curvature and narrow places ask for.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geom/base/glob.h"
#include "surfmesh/face/face_sizes.h"
#include "surfmesh/model/background_sizes.h"
#include "surfmesh/model/band_wish.h"
#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/face_outline.h"
#include "surfmesh/model/place_sizes.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

struct FaceSizes {
  double max_edge = 0.0;
  BandWish leading, trailing;
  double trailing_cells = k_automatic;                 ///< across a blunt trailing edge
  double leading_factor = 1.0, trailing_factor = 1.0;  ///< of max_edge at a wing's leading and trailing edges
  bool has_tip_strips = false;
  double least_narrow = 0.0;  ///< m: narrow places ask for no shorter edges, where min_edge is automatic
  CurvatureLimits limits;
  std::unique_ptr<CurvatureSizes> curvature;  ///< of the surface within the face
};

struct ModelSizes {
  Column<FaceId, FaceOutline> outlines;
  Column<FaceId, FaceSizes> faces;
  Column<EdgeId, std::vector<double>>
      edge_sizes;                  ///< m, at the samples of each edge: what its curvature, that of its faces beside it, narrow faces and its length ask for
  std::vector<SizeSite> sources;   ///< the same in space, and the curvature of faces: where sizes may be small
  std::vector<SizeSite> in_space;  ///< sources of the user that count on all faces
  PlaceSizes places;               ///< what is asked for by place: never more than max_edge
  std::function<bool(FaceId, const Point&)> is_covered;  ///< curvature asks for nothing there, because a band answers for it; empty: nowhere
  double growth = 0.2;                                   ///< change of length by distance
  double largest = 0.0;                                  ///< max_edge of all faces
};

/// \throws Error(bad_argument) for a rule that no face's name matches
ModelSizes sizes_of_faces(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options,
                          std::span<const PatchSurfaceOptions> patches, const RunContext& context);

/// Fills `edge_sizes` and `sources`; what is absorbed, or within a band, asks for nothing.
struct ModelTopology;
struct WingBands;
void add_sources(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const SurfaceMeshOptions& options,
                 ModelSizes& sizes, const RunContext& context, const WingBands* bands = nullptr);

/// Sets `places`: factors of wings, sources of the user.
/// \pre sizes_of_faces
void add_place_sizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options, const SpaceSizes& asked,
                     ModelSizes& sizes);

double distance_to_segment(const Point& p, const Point& a, const Point& b);

}  // namespace sterna::surfmesh
