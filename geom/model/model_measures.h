// Areas, volumes, centres and boxes of models, their solids, components and faces: by quadrature over the faces themselves (trimmed or not), without a mesh.
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
  double volume = 0.0;       ///< share of the solid's volume by the divergence theorem, m3: one third of the integral of (x - about) . n, n outwards
  Vec3 vector_area;          ///< integral of n; sums to nothing over a closed solid
  double projected_z = 0.0;  ///< area as seen from above: half the integral of |n_z|
  Vec3 area_moment;          ///< integral of x - about over the area, m3
  Vec3 volume_moment;        ///< share of the integral of x - about over the solid, m4
  double error = 0.0;        ///< m2: what the last refinement of the quadrature changed
  MeasureBox box;            ///< of samples of face and border: short of the face by the sagitta between samples, about 1e-3 of a curved face's size
};
/// Gauss quadrature over the knots of the surface within the face's border, any kind of surface, refined until it changes by less than 1e-8, about 1e-11 then;
/// where kinks that no knot tells of hinder that, `error` says how far it came. Seams, poles and parameters beyond a period are as in Model; what the surface
/// does outside of the border does not count.
FaceMeasures face_measures(const Model& model, FaceId face, const Point& about = {});

struct SolidMeasures {
  double area = 0.0;
  double volume = 0.0;
  double open = 0.0;  ///< |sum of vector areas| / area: nothing for a closed, well oriented solid
};
SolidMeasures solid_measures(const Model& model, SolidId solid);

/// Of a solid, of the faces of a component, or of all.
struct BodyMeasures {
  std::string name;
  std::size_t n_faces = 0;
  double area = 0.0;    ///< wetted, m2
  double volume = 0.0;  ///< m3; 0 where the faces do not close
  bool has_volume = false;
  Point centre;  ///< of the volume, else of the area
  MeasureBox box;
};

struct ModelMeasures {
  Column<FaceId, FaceMeasures> faces;  ///< about the middle of the model's box
  Point about;
  std::vector<BodyMeasures> solids;      ///< in the order of model.solids
  std::vector<BodyMeasures> components;  ///< in the order of model.components
  BodyMeasures total;
};
/// All of a model, its faces in parallel. Solids that overlap count twice. The parts of a closed solid of several components have no volume of their own.
/// \throws Error(cancelled)
ModelMeasures model_measures(const Model& model, const RunContext& context);

}  // namespace sterna
