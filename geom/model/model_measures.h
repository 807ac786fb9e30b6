// Areas, volumes, centroids and boxes of models, their solids, components and faces, by quadrature over the faces (trimmed or not), without a mesh.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna {

struct MeasureBox {
  Point min, max;
};

struct FaceMeasures {
  double area = 0.0;         ///< m2
  double volume = 0.0;       ///< contribution to the solid's volume by the divergence theorem, m3: one third of the integral of (x - about) . n, n outwards
  Vec3 vector_area;          ///< integral of n; zero in sum over a closed solid
  double projected_z = 0.0;  ///< area as seen from above: half the integral of |n_z|
  Vec3 area_moment;          ///< integral of x - about over the area, m3
  Vec3 volume_moment;        ///< contribution to the integral of x - about over the solid, m4
  double error = 0.0;        ///< m2: change by the last refinement of the quadrature
  MeasureBox box;            ///< box of samples of face and border: smaller than the face by the sagitta between samples, about 1e-3 of a curved face's size
};
/// Computes the measures by Gauss quadrature over the knots of the surface within the face's border, for any kind of surface. The quadrature is refined until
/// it changes by less than 1e-8; the error is then about 1e-11. If kinks that are not at knots prevent this, `error` holds the accuracy reached. Seams, poles
/// and parameters beyond a period are as in Model; the surface outside the border has no influence.
FaceMeasures face_measures(const Model& model, FaceId face, const Point& about = {});

struct SolidMeasures {
  double area = 0.0;
  double volume = 0.0;
  double open = 0.0;  ///< |sum of vector areas| / area: zero for a closed, consistently oriented solid
};
SolidMeasures solid_measures(const Model& model, SolidId solid);

/// Measures of a solid, of the faces of a component, or of the whole model.
struct BodyMeasures {
  std::string name;
  std::size_t n_faces = 0;
  double area = 0.0;    ///< wetted area, m2
  double volume = 0.0;  ///< m3; 0 if the faces are not closed
  bool has_volume = false;
  Point centre;  ///< centroid of the volume, else of the area
  MeasureBox box;
};

struct ModelMeasures {
  Column<FaceId, FaceMeasures> faces;  ///< relative to the middle of the model's box
  Point about;
  std::vector<BodyMeasures> solids;      ///< in the order of model.solids
  std::vector<BodyMeasures> components;  ///< in the order of model.components
  BodyMeasures total;
};
/// Computes all measures of a model, its faces in parallel. Overlapping solids count twice. The parts of a closed solid that consists of several components
/// have no volume.
/// \throws Error(cancelled)
ModelMeasures model_measures(const Model& model, const RunContext& context);

}  // namespace sterna
