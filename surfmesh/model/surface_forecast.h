// Forecast of the number of triangles of a model's surface, and of the rules that cause most of them. It uses the sizes of the mesher, but makes no triangles.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A face with many triangles, and the rule that causes most of its triangles.
struct FaceForecast {
  FaceId face;
  std::string name;
  double n_triangles = 0.0;
  double least_edge = 0.0;  ///< m
  Point location;           ///< location of the smallest edge
  std::string rule;         ///< such as "curvature: an edge spans at most 12 degrees"
  std::string advice;       ///< such as "a larger curvature_angle or min_edge"
};

struct SurfaceForecast {
  double n_triangles = 0.0;
  std::vector<FaceForecast> largest;  ///< faces by falling number of triangles, at most k_forecast_faces
};
inline constexpr std::size_t k_forecast_faces = 3;

/// Integrates 1 / size^2 over each face, with the sizes at the start of mesh_model(). The result is within about 30 % of the number of triangles. Above k_rough
/// triangles (20 million) sizes are not carried over the surface, and the number is a lower bound. The forecast takes a fifth of the time of mesh_model(), but
/// up to twice that time for very many small faces. Rows at leading and trailing edges are not counted.
/// \throws Error(bad_argument) like mesh_model()
SurfaceForecast forecast_surface(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                                 const RunContext& context);

}  // namespace sterna::surfmesh
