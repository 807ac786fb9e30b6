// The model behind a surface mesh: where points on its triangles belong. What splits the wall later puts new vertices there.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "geom/model/projection.h"
#include "surfmesh/model/face_region.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// Where the vertices and triangles of a surface mesh lie on its model: of SurfaceMesh.
struct WallPlaces {
  Column<VertexId, VertexPlace> places;
  Column<VertexId, EdgePlace> edge_places;
  Column<CornerId, VertexId> corner_vertices;
  Column<TriangleId, FaceId> triangle_face;
};

/// The nearest place of a face around a point.
struct ModelFoot {
  FaceId face;
  Uv at;
  Point point;
  double distance = std::numeric_limits<double>::infinity();  ///< m
  bool is_inside = true;                                      ///< of the face's border, or on it; false: on the surface, but beyond the border
};

/// The outward normal of a face.
struct ModelNormal {
  Vec3 normal;             ///< unit
  bool is_beside = false;  ///< the surface has none there (pole, tip): that of a place close by
};

class ModelWall {
 public:
  /// Keeps copies of what it needs.
  /// \pre `mesh` is of this model
  ModelWall(Model model, const SurfaceMesh& mesh);
  /// The same of a model that is made when it is first needed, which is seldom: in the thread that then asks, while others wait.
  ModelWall(std::function<Model()> model, WallPlaces places, Column<TriangleId, TriangleVertices> triangles);

  /// The same wall elsewhere.
  /// \pre `motion` is a rotation and a shift
  ModelWall(const ModelWall& other, const Transform& motion);

  /// The nearest point of the model around a point on a triangle: on the edge of the model that the triangle's edge lies on where the weight of the corner
  /// opposite to it is exactly zero, else on the face's surface. Thread-safe. \p weights barycentric, not negative
  Point nearest(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;

  /// The point of the surface of the triangle's face that is nearest around the triangle, and whether it belongs to the face. Thread-safe. \p weights
  /// barycentric, where on the triangle
  ModelFoot foot(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;
  /// The nearest point on the part of the model's edge that the triangle's side opposite to corner `k` lies on, as a place of the triangle's face; nothing for
  /// a side inside the face. Thread-safe.
  std::optional<ModelFoot> edge_foot(const Point& p, TriangleId triangle, std::size_t k) const;
  /// Whether a vertex is inside the triangle's face, not on its border.
  bool is_inner(TriangleId triangle, VertexId v) const;
  /// Where the vertex is on the model: on its edge where it has one, else on its face; nothing where nothing is known of it. Thread-safe.
  std::optional<Point> place_of(VertexId v) const;
  /// Nothing where the surface has no normal, not even close by. Thread-safe.
  std::optional<ModelNormal> normal(FaceId face, Uv at) const;
  /// For messages.
  /// \pre foot.face is valid
  const std::string& name_of(FaceId face) const;

  const WallPlaces& places() const { return places_; }
  const Column<TriangleId, TriangleVertices>& triangles() const { return triangles_; }

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
  struct LazyRegion {
    std::once_flag once;
    std::unique_ptr<const FaceRegion> made;
  };
  struct Knowledge {
    Model model;
    std::vector<Segment> segments;  ///< by low and high
    std::vector<LazyProjector> projectors;
    std::vector<LazyRegion> regions;
    Column<EdgeId, std::vector<EdgeUsePlace>> uses;
    Column<VertexId, CornerId> corner_of;  ///< invalid: not on a corner of the model
  };
  Knowledge& knowledge() const;
  std::vector<Segment> find_segments(const Model& model) const;
  static const Segment* segment_of(const Knowledge& known, VertexId a, VertexId b);
  static const SurfaceProjector& projector_of(Knowledge& known, FaceId f);
  static const FaceRegion& region_of(Knowledge& known, FaceId f);
  /// Places in the face's (u, v) that the vertex may have: several on a seam; none for a corner that says nothing of this face.
  std::vector<Uv> places_in(const Knowledge& known, FaceId f, VertexId v) const;

  std::function<Model()> model_;
  WallPlaces places_;
  Column<TriangleId, TriangleVertices> triangles_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<Knowledge> knowledge_;
};

}  // namespace sterna::surfmesh
