// Target edge lengths over a model: for each face from options, patch rules and component defaults, and from curvature and narrow regions.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geom/base/glob.h"
#include "surfmesh/face/face_sizes.h"
#include "surfmesh/model/background_sizes.h"
#include "surfmesh/model/band_target.h"
#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/face_outline.h"
#include "surfmesh/model/local_sizes.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

struct FaceSizes {
  double max_edge = 0.0;
  BandTarget leading, trailing;
  double trailing_cells = k_automatic;                 ///< number of cells across a blunt trailing edge
  double leading_factor = 1.0, trailing_factor = 1.0;  ///< edge lengths at the leading and trailing edges of a wing, relative to max_edge
  bool has_tip_strips = false;
  double least_narrow = 0.0;  ///< m: lower limit of sizes from narrow regions if min_edge is automatic
  CurvatureLimits limits;
  std::unique_ptr<CurvatureSizes> curvature;  ///< sizes from the curvature of the surface within the face
};

struct ModelSizes {
  Column<FaceId, FaceOutline> outlines;
  Column<FaceId, FaceSizes> faces;
  Column<EdgeId, std::vector<double>>
      edge_sizes;  ///< m, at the samples of each edge: size required by its curvature, the curvature of adjacent faces, narrow faces and its length
  std::vector<SizePoint> sources;   ///< the same sizes as points in space, and those from the curvature of faces: locations where sizes may be small
  std::vector<SizePoint> in_space;  ///< user sources that apply to all faces
  LocalSizes local;                 ///< sizes that depend on the location; never more than max_edge
  /// True where curvature is ignored because the rows of a band determine the size; empty function: nowhere.
  std::function<bool(FaceId, const Point&)> is_covered;
  double growth = 0.2;   ///< change of length per distance
  double largest = 0.0;  ///< m, largest max_edge of all faces
};

/// \throws Error(bad_argument) for a rule that matches the name of no face
ModelSizes sizes_of_faces(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options, std::span<const Rule> patches,
                          const RunContext& context);

/// Fills `edge_sizes` and `sources`. Absorbed faces and edges, and faces and edges within a band, require no size.
struct ModelTopology;
struct WingBands;
void add_sources(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const SurfaceMeshOptions& options,
                 ModelSizes& sizes, const RunContext& context, const WingBands* bands = nullptr);

/// Sets `locations`: factors of wings, and sources of the user.
/// \pre sizes_of_faces has been called
void add_local_sizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options, const SpaceSizes& requested,
                     ModelSizes& sizes);

double distance_to_segment(const Point& p, const Point& a, const Point& b);

}  // namespace sterna::surfmesh
