// The wanted length of edges all over a model, as a field on its faces and edges: what places ask for, carried along the surface with limited growth.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/model.h"
#include "surfmesh/model/background_sizes.h"
#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/face_grid.h"
#include "surfmesh/model/model_topology.h"

namespace sterna::surfmesh {

/// size(x) = min over places y of (what y asks for + growth * distance from y to x along the surface): a fine leading edge asks nothing of a part across a gap.
/// Faces ask by their largest edge and curvature, edges by the sizes at their samples, sources in space everywhere within their reach. Kept on cells of
/// each face's (u, v) about two edges long (bilinear) and on stations of each edge (linear); beside an edge its own stations count too.
/// Away from where it is asked for within about 5 % of the formula. Linear in the number of triangles that such sizes make, but for the order of the carrying.
class SurfaceSizes {
 public:
  /// `in_space`: sources that count on all faces within their reach, besides those of `sizes`. With `keeps_grids` the nodes of grid() stay, and cells are no
  /// longer than two edges everywhere.
  SurfaceSizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const ModelSizes& sizes,
               std::vector<SizeSite> in_space, const RunContext& context, bool keeps_grids = false);

  /// Metres, from many threads.
  /// \pre the face is not absorbed
  double on_face(FaceId face, Uv at, const Point& point) const;
  /// Metres, on an edge that has faces and is no point.
  double on_edge(EdgeId edge, double t) const;
  /// No place near `point` is wanted finer: the same formula with distances through space.
  double least_near(const Point& point) const { return bound_(point, largest_); }
  std::size_t n_cells() const;
  /// Empty for absorbed faces.
  const FaceGrid& grid(FaceId face) const { return faces_[face].grid; }

 private:
  struct Segment {
    Point a, b;
    float size_a = 0.0f, size_b = 0.0f;
  };
  struct Cell {
    std::array<float, 4> sizes{};             ///< at the corners
    std::uint32_t first = 0, n_segments = 0;  ///< of edges through the cell
  };
  struct FaceField {
    FaceGrid grid;
    std::vector<Cell> cells;
    std::vector<Segment> segments;
  };
  struct Station {
    double t = 0.0;
    double size = 0.0;
  };
  struct Builder;

  BackgroundSizes bound_;
  double growth_ = 0.0, largest_ = 0.0;
  Column<FaceId, FaceField> faces_;
  Column<EdgeId, std::vector<Station>> edges_;
};

}  // namespace sterna::surfmesh
