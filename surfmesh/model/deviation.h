// How far the walls of a mesh are from the model they were made of: gates G17 (nodes off the model) and G18 (facets turned against it) of
// docs/method/quality.md, "Gates".
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "surfmesh/model/model_wall.h"

namespace sterna::surfmesh {

struct Deviation {
  GateResult distance;                     ///< Measure::cad_distance: nodes, distance to the model over `length`
  GateResult normal;                       ///< Measure::cad_normal: facets, angle to the model's outward normal at the place nearest to the facet's centroid
  double length = 0.0;                     ///< m: body length of the wall
  std::int64_t n_nodes = 0, n_facets = 0;  ///< measured
  std::int64_t n_beside = 0;               ///< facets whose normal of the model was taken beside a pole or tip, where there is none
  std::int64_t n_without = 0;              ///< facets that were not compared: the model has no normal there at all
  std::vector<std::string> unknown;        ///< wall patches of the mesh that the wall has not: not measured
};

/// Measures the boundary faces of the mesh on patches that `wall` has by name. The triangles of `wall` are looked up only to find faces and seeds: the distance
/// is that to the exact faces within their borders and to the exact edges. Where several faces are about as near as the nearest (creases, edges, thin tips) a
/// facet is compared with the one that agrees best. Parallel, the same for any number of threads.
/// \pre `model` is of `wall`, and `wall` has a triangle
Deviation measure_deviation(const HybridMesh& mesh, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context);
/// The same of a surface, all of its patches that `wall` has; it may be `wall` itself.
Deviation measure_deviation(const TriMesh& surface, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context);

/// Distances of single points from the model behind a wall: to the exact faces within their borders and to the exact edges. From many threads.
class ModelDistance {
 public:
  /// All must outlive it.
  /// \pre as measure_deviation
  ModelDistance(const TriMesh& wall, const ModelWall& model, const RunContext& context);
  ~ModelDistance();
  double operator()(const Point& p) const;            ///< m
  TriangleId nearest_triangle(const Point& p) const;  ///< of the wall
 private:
  struct Lookup;
  std::unique_ptr<const Lookup> lookup_;
};

}  // namespace sterna::surfmesh
