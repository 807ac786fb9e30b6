// Areas and volumes of models, by quadrature over the faces themselves (trimmed or not), without a mesh.
#pragma once

#include "geom/model/model.h"

namespace sterna {

struct FaceMeasures {
  double area = 0.0;      ///< m2
  double volume = 0.0;    ///< share of the solid's volume by the divergence theorem, m3: one third of the integral of x . n, n outwards
  Vec3 vector_area;       ///< integral of n; sums to nothing over a closed solid
  double projected_z = 0.0;  ///< area as seen from above: half the integral of |n_z|
};
/// Gauss quadrature over the knots of the surface, along the border by Green's theorem: about 1e-10 relative on smooth faces.
FaceMeasures face_measures(const Model& model, FaceId face);

struct SolidMeasures {
  double area = 0.0;
  double volume = 0.0;
  double open = 0.0;  ///< |sum of vector areas| / area: nothing for a closed, well oriented solid
};
SolidMeasures solid_measures(const Model& model, SolidId solid);

}  // namespace sterna
