// Integrals over a trimmed face, for model_measures.
#pragma once

#include <functional>

#include "geom/model/model.h"

namespace sterna {

/// Sums of the quantities integrated by model_measures, with du x dv as the normal.
struct FaceSums {
  double area = 0.0, volume = 0.0, projected = 0.0;
  Vec3 normal, area_moment, volume_moment;
  void add(double w, const FaceSums& s) {
    area += w * s.area;
    volume += w * s.volume;
    projected += w * s.projected;
    normal += w * s.normal;
    area_moment += w * s.area_moment;
    volume_moment += w * s.volume_moment;
  }
};

struct FaceQuadrature {
  FaceSums sums;
  Point low, high;     ///< box of the samples inside and on the border
  double error = 0.0;  ///< m2: last change of the area (or of the volume divided by the largest distance); exceeds the error of a smooth face
};
/// Integrates over a face. \pre the face has a border
FaceQuadrature integrate_face(const Model& model, FaceId face, const Point& about);

/// Integrates with few samples, at a hundredth of the cost; `error` stays 0, since it is not estimated.
/// \pre the face has a border
FaceQuadrature integrate_face_roughly(const Model& model, FaceId face, const Point& about);

}  // namespace sterna
