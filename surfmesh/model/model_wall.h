// The model of a surface mesh. Returns the exact location on the model for points on triangles. Later splits of the wall put new vertices there.
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

/// Model locations of the vertices and triangles of a surface mesh, copied from SurfaceMesh.
struct WallLocations {
  Column<VertexId, VertexLocation> locations;
  Column<VertexId, EdgeLocation> edge_locations;
  Column<CornerId, VertexId> corner_vertices;
  Column<TriangleId, FaceId> triangle_face;
};

/// The nearest location of a face near a given point.
struct ModelProjection {
  FaceId face;
  Uv at;
  Point point;
  double distance = std::numeric_limits<double>::infinity();  ///< m
  bool is_inside = true;                                      ///< inside the face's border or on it; false: on the surface of the face, but outside its border
};

/// The outward normal of a face.
struct ModelNormal {
  Vec3 normal;             ///< unit
  bool is_beside = false;  ///< the surface has no normal there (pole, tip); the normal comes from a location close by
};

class ModelWall {
 public:
  /// Keeps copies of all data it needs.
  /// \pre `mesh` is a mesh of this model
  ModelWall(Model model, const SurfaceMesh& mesh);
  /// Defers the construction of the model until it is first needed, which is seldom. The first thread that needs the model constructs it while other threads
  /// wait.
  ModelWall(std::function<Model()> model, WallLocations locations, Column<TriangleId, TriangleVertices> triangles);

  /// Creates the same wall at another location.
  /// \pre `motion` is a rotation and a shift
  ModelWall(const ModelWall& other, const Transform& motion);

  /// Returns the model point nearest to a point on a triangle. If the weight of a corner is exactly zero and the opposite side lies on a model edge, the
  /// point lies on that edge, else on the face's surface. Thread-safe. \p weights barycentric, not negative
  Point nearest(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;

  /// Returns the nearest point on the surface of the triangle's face, searched near the triangle, and whether the point belongs to the face. Thread-safe. \p
  /// weights barycentric coordinates on the triangle
  ModelProjection projection(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;
  /// Returns the nearest point on the model edge along the side of the triangle opposite to corner `k`, as a location on the triangle's face. Returns nothing
  /// if this side lies inside the face. Thread-safe.
  std::optional<ModelProjection> edge_projection(const Point& p, TriangleId triangle, std::size_t k) const;
  /// Returns true if a vertex is inside the triangle's face, not on its border.
  bool is_inner(TriangleId triangle, VertexId v) const;
  /// Returns the location of the vertex on the model: on its edge if it has one, else on its face; nothing if unknown. Thread-safe.
  std::optional<Point> location_of(VertexId v) const;
  /// Returns nothing if the surface has no normal at this location or close to it. Thread-safe.
  std::optional<ModelNormal> normal(FaceId face, Uv at) const;
  /// Returns the face's name for messages.
  /// \pre projection.face is valid
  const std::string& name_of(FaceId face) const;

  const WallLocations& locations() const { return locations_; }
  const Column<TriangleId, TriangleVertices>& triangles() const { return triangles_; }

 private:
  /// Two consecutive vertices on an edge of the model.
  struct Segment {
    VertexId low, high;
    EdgeId edge;
    double t_low = 0.0, t_high = 0.0;
  };
  /// Created at the first query of a face, because most faces are never queried.
  struct LazyProjector {
    std::once_flag once;
    std::unique_ptr<const SurfaceProjector> made;
  };
  /// Created on demand, because few walls need it.
  struct LazyRegion {
    std::once_flag once;
    std::unique_ptr<const FaceRegion> made;
  };
  struct Knowledge {
    Model model;
    std::vector<Segment> segments;  ///< sorted by low, then high
    std::vector<LazyProjector> projectors;
    std::vector<LazyRegion> regions;
    Column<EdgeId, std::vector<EdgeUseLocation>> uses;
    Column<VertexId, CornerId> corner_of;  ///< invalid: the vertex is not on a corner of the model
  };
  Knowledge& knowledge() const;
  std::vector<Segment> find_segments(const Model& model) const;
  static const Segment* segment_of(const Knowledge& known, VertexId a, VertexId b);
  static const SurfaceProjector& projector_of(Knowledge& known, FaceId f);
  static const FaceRegion& region_of(Knowledge& known, FaceId f);
  /// Returns the possible (u, v) of the vertex in the face: several on a seam, none for a corner without data for this face.
  std::vector<Uv> locations_in(const Knowledge& known, FaceId f, VertexId v) const;

  std::function<Model()> model_;
  WallLocations locations_;
  Column<TriangleId, TriangleVertices> triangles_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<Knowledge> knowledge_;
};

}  // namespace sterna::surfmesh
