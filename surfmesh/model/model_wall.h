// The model behind a surface mesh: returns the exact model location of points on its triangles. Later splits of the wall put new vertices there.
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
struct WallPlaces {
  Column<VertexId, VertexPlace> places;
  Column<VertexId, EdgePlace> edge_places;
  Column<CornerId, VertexId> corner_vertices;
  Column<TriangleId, FaceId> triangle_face;
};

/// The nearest location of a face near a given point.
struct ModelFoot {
  FaceId face;
  Uv at;
  Point point;
  double distance = std::numeric_limits<double>::infinity();  ///< m
  bool is_inside = true;                                      ///< inside the face's border or on it; false: on the surface, but beyond the border
};

/// The outward normal of a face.
struct ModelNormal {
  Vec3 normal;             ///< unit
  bool is_beside = false;  ///< the surface has no normal there (pole, tip): taken from a location close by
};

class ModelWall {
 public:
  /// Keeps copies of all data it needs.
  /// \pre `mesh` is a mesh of this model
  ModelWall(Model model, const SurfaceMesh& mesh);
  /// Defers the making of the model until it is first needed, which is seldom. The thread that needs it first makes it while others wait.
  ModelWall(std::function<Model()> model, WallPlaces places, Column<TriangleId, TriangleVertices> triangles);

  /// Returns the same wall at another location.
  /// \pre `motion` is a rotation and a shift
  ModelWall(const ModelWall& other, const Transform& motion);

  /// Returns the model point nearest to a point on a triangle. If the weight of a corner is exactly zero and the opposite side lies on a model edge, the
  /// point lies on that edge, else on the face's surface. Thread-safe. \p weights barycentric, not negative
  Point nearest(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;

  /// Returns the nearest point on the surface of the triangle's face, searched near the triangle, and reports if the point belongs to the face. Thread-safe.
  /// \p weights barycentric coordinates on the triangle
  ModelFoot foot(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const;
  /// Returns the nearest point on the model edge segment of the triangle's side opposite to corner `k`, as a location on the triangle's face; nothing for a
  /// side inside the face. Thread-safe.
  std::optional<ModelFoot> edge_foot(const Point& p, TriangleId triangle, std::size_t k) const;
  /// Returns true if a vertex is inside the triangle's face, not on its border.
  bool is_inner(TriangleId triangle, VertexId v) const;
  /// Returns the location of the vertex on the model: on its edge if it has one, else on its face; nothing if unknown. Thread-safe.
  std::optional<Point> place_of(VertexId v) const;
  /// Returns nothing if the surface has no normal there and close by. Thread-safe.
  std::optional<ModelNormal> normal(FaceId face, Uv at) const;
  /// Returns the face's name for messages.
  /// \pre foot.face is valid
  const std::string& name_of(FaceId face) const;

  const WallPlaces& places() const { return places_; }
  const Column<TriangleId, TriangleVertices>& triangles() const { return triangles_; }

 private:
  /// Two consecutive vertices on an edge of the model.
  struct Segment {
    VertexId low, high;
    EdgeId edge;
    double t_low = 0.0, t_high = 0.0;
  };
  /// Created when a face is first queried: most faces never are.
  struct LazyProjector {
    std::once_flag once;
    std::unique_ptr<const SurfaceProjector> made;
  };
  /// Needed for only a few walls.
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
  /// Returns the possible (u, v) of the vertex in the face: several on a seam; none for a corner without data for this face.
  std::vector<Uv> places_in(const Knowledge& known, FaceId f, VertexId v) const;

  std::function<Model()> model_;
  WallPlaces places_;
  Column<TriangleId, TriangleVertices> triangles_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<Knowledge> knowledge_;
};

}  // namespace sterna::surfmesh
