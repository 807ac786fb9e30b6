// The model behind a surface mesh: where points on its triangles belong. What splits the wall later puts new vertices there.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "geom/model/projection.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// Where the vertices and triangles of a surface mesh lie on its model: of SurfaceMesh.
struct WallPlaces {
  Column<VertexId, VertexPlace> places;
  Column<VertexId, EdgePlace> edge_places;
  Column<CornerId, VertexId> corner_vertices;
  Column<TriangleId, FaceId> triangle_face;
};

class ModelWall {
 public:
  /// Keeps copies of what it needs. \pre `mesh` is of this model
  ModelWall(Model model, const SurfaceMesh& mesh);
  /// The same of a model that is made when it is first needed, which is seldom: in the thread that then asks, while others wait.
  ModelWall(std::function<Model()> model, WallPlaces places, Column<TriangleId, TriangleVertices> triangles);

  /// The same wall elsewhere. \pre `motion` is a rotation and a shift
  ModelWall(const ModelWall& other, const Transform& motion);

  /// The nearest point of the model around a point on a triangle: on the edge of the model that the triangle's edge lies on where the weight of the corner opposite
  /// to it is exactly zero, else on the face's surface. Thread-safe. \p weights barycentric, not negative
  Point nearest(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;

  const WallPlaces& places() const { return places_; }

 private:
  /// Two vertices that follow each other on an edge of the model.
  struct Segment {
    VertexId low, high;
    EdgeId edge;
    double t_low = 0.0, t_high = 0.0;
  };
  /// Made when a face is first asked for: most never are.
  struct LazyProjector {
    std::once_flag once;
    std::unique_ptr<const SurfaceProjector> made;
  };
  /// What only a few walls are asked for.
  struct Knowledge {
    Model model;
    std::vector<Segment> segments;  ///< by low and high
    std::vector<LazyProjector> projectors;
  };
  Knowledge& knowledge() const;
  std::vector<Segment> find_segments(const Model& model) const;
  static const Segment* segment_of(const Knowledge& known, VertexId a, VertexId b);
  static const SurfaceProjector& projector_of(Knowledge& known, FaceId f);

  std::function<Model()> model_;
  WallPlaces places_;
  Column<TriangleId, TriangleVertices> triangles_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<Knowledge> knowledge_;
};

}  // namespace sterna::surfmesh
