// The model behind a surface mesh: where points on its triangles belong. What splits the wall later puts new vertices there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "geom/model/model.h"
#include "geom/model/projection.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

class ModelWall {
 public:
  /// Keeps copies of what it needs. \pre `mesh` is of this model
  ModelWall(Model model, const SurfaceMesh& mesh);

  /// The nearest point of the model around a point on a triangle: on the edge of the model that the triangle's edge lies on where the weight of the corner opposite
  /// to it is exactly zero, else on the face's surface. Thread-safe. \p weights barycentric, not negative
  Point nearest(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;

 private:
  /// Two vertices that follow each other on an edge of the model.
  struct Segment {
    VertexId low, high;
    EdgeId edge;
    double t_low = 0.0, t_high = 0.0;
  };
  const Segment* segment_of(VertexId a, VertexId b) const;
  const SurfaceProjector& projector_of(FaceId f) const;

  Model model_;
  Column<VertexId, VertexPlace> places_;
  Column<TriangleId, TriangleVertices> triangles_;
  Column<TriangleId, FaceId> triangle_face_;
  std::vector<Segment> segments_;  ///< by low and high
  /// Made when a face is first asked for: most never are.
  struct LazyProjector {
    std::once_flag once;
    std::unique_ptr<const SurfaceProjector> made;
  };
  mutable std::vector<LazyProjector> projectors_;
};

}  // namespace sterna::surfmesh
