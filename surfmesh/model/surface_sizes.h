// Target edge length everywhere in a model, as a field on its faces and edges. Local requirements are carried along the surface with limited growth.
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

/// size(x) = min over locations y of (size required at y + growth * distance from y to x along the surface). Refinement therefore does not propagate across
/// gaps. Faces contribute their largest edge and their curvature, and edges contribute the sizes at their samples. Sources in space apply everywhere within
/// their reach. Sizes are stored on cells of each face's (u, v), which are about two edges long (bilinear), and on stations of each edge (linear). Near an edge
/// its own stations apply as well. Away from the locations with requirements the sizes are within about 5 % of the formula. The cost is linear in the number of
/// triangles of such sizes, apart from the sorting during propagation.
class SurfaceSizes {
 public:
  /// `in_space` are sources that apply to all faces within their reach, in addition to those of `sizes`. With `keeps_grids` the nodes of grid() are kept, and
  /// no cell is longer than two edges.
  SurfaceSizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const ModelSizes& sizes,
               std::vector<SizePoint> in_space, const RunContext& context, bool keeps_grids = false);

  /// Returns the size in metres. Thread-safe.
  /// \pre the face is not absorbed
  double on_face(FaceId face, Uv at, const Point& point) const;
  /// Returns the size in metres on an edge that has faces and is not degenerate.
  double on_edge(EdgeId edge, double t) const;
  /// Returns a lower bound of the size near `point`: the same formula with distances through space.
  double least_near(const Point& point) const { return bound_(point, largest_); }
  std::size_t n_cells() const;
  /// Returns an empty grid for absorbed faces.
  const FaceGrid& grid(FaceId face) const { return faces_[face].grid; }

 private:
  struct Segment {
    Point a, b;
    float size_a = 0.0f, size_b = 0.0f;
  };
  struct Cell {
    std::array<float, 4> sizes{};             ///< sizes at the corners of the cell
    std::uint32_t first = 0, n_segments = 0;  ///< range of the edge segments that run through the cell
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
