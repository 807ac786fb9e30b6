// Deviation of the walls of a mesh from the model they were made of: gates G17 (nodes off the model) and G18 (facets turned against it) of
// docs/method/quality.md, "Gates".
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "surfmesh/model/model_wall.h"

namespace sterna::surfmesh {

struct Deviation {
  GateResult distance;                     ///< Measure::cad_distance: distance of nodes to the model over `length`
  GateResult normal;                       ///< Measure::cad_normal: angle of facets to the model's outward normal at the point nearest to the facet's centroid
  double length = 0.0;                     ///< m: body length of the wall
  std::int64_t n_nodes = 0, n_facets = 0;  ///< numbers of measured nodes and facets
  std::int64_t n_beside = 0;               ///< facets at a pole or tip, where the model has no normal: they are compared with a normal beside it
  std::int64_t n_without = 0;              ///< facets not compared, because the model has no normal there
  std::vector<std::string> unknown;        ///< wall patches of the mesh that `wall` does not have; they are not measured
};

/// Measures the boundary faces of the mesh on patches that `wall` has by name. The triangles of `wall` serve only to find faces and start values: distances
/// are measured to the exact faces within their borders and to the exact edges. Where several faces are about as near as the nearest one (creases, edges,
/// thin tips), a facet is compared with the face that agrees best. Parallel; the result does not depend on the number of threads.
/// \pre `model` is the model of `wall`, and `wall` has at least one triangle
Deviation measure_deviation(const HybridMesh& mesh, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context);
/// Measures all patches of a surface that `wall` has. The surface may be `wall` itself.
Deviation measure_deviation(const TriMesh& surface, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context);

/// Returns distances of single points from the model that a wall was made of. They are measured to the exact faces within their borders and to the exact edges.
/// Thread-safe.
class ModelDistance {
 public:
  /// \pre the same as for measure_deviation
  ModelDistance(Borrowed<const TriMesh> wall, Borrowed<const ModelWall> model, const RunContext& context);
  ~ModelDistance();
  double operator()(const Point& p) const;            ///< returns the distance in metres
  TriangleId nearest_triangle(const Point& p) const;  ///< returns the nearest triangle of the wall
 private:
  struct Lookup;
  std::unique_ptr<const Lookup> lookup_;
};

}  // namespace sterna::surfmesh
