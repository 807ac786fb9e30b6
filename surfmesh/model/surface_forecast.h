// How many triangles a model's surface will have, by the sizes of the mesher itself but without its triangles, and what asks for most of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A face with many triangles, and the rule that asks for most of them.
struct FaceForecast {
  FaceId face;
  std::string name;
  double n_triangles = 0.0;
  double least_edge = 0.0;  ///< m
  Point place;              ///< where the least edge is
  std::string rule;         ///< "curvature: an edge spans at most 12 degrees"
  std::string advice;       ///< "a larger curvature_angle or min_edge"
};

struct SurfaceForecast {
  double n_triangles = 0.0;
  std::vector<FaceForecast> largest;  ///< by falling number, at most k_forecast_faces
};
inline constexpr std::size_t k_forecast_faces = 3;

/// Integrates 1 / size^2 over each face, with the sizes that mesh_model() begins with: within about 30 % of what it makes. Above k_rough triangles (20 million)
/// sizes are not carried over the surface, and the number is a lower bound. Takes a fifth of the time of mesh_model() to twice its time (very many small
/// faces). Rows at leading and trailing edges are not counted.
/// \throws Error(bad_argument) as mesh_model()
SurfaceForecast forecast_surface(const Model& model, const SurfaceMeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
                                 const RunContext& context);

}  // namespace sterna::surfmesh
