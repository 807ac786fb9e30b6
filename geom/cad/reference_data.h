// Measures of exact geometry: areas, volumes, boxes and centres of a model, its solids, components and faces.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna {

struct MeasureBox {
  Point min, max;
};

/// Of one face.
struct CadFaceMeasures {
  double area = 0.0;  ///< m^2
  Point centre;       ///< of the area
};

/// Of a solid, of the faces of a component, or of all.
struct BodyMeasures {
  std::string name;
  std::size_t n_faces = 0;
  double area = 0.0;    ///< wetted, m^2
  double volume = 0.0;  ///< m^3, by the divergence theorem; 0 where the faces do not close
  bool has_volume = false;
  Point centre;         ///< of the volume, else of the area
  MeasureBox box;       ///< contains all faces; a little larger than the least
};

struct ReferenceData {
  Column<FaceId, CadFaceMeasures> faces;
  std::vector<BodyMeasures> solids;      ///< in the order of model.solids
  std::vector<BodyMeasures> components;  ///< in the order of model.components
  BodyMeasures total;
};

namespace cad {

/// Relative accuracy that areas and volumes of each face are integrated to.
inline constexpr double k_measure_tolerance = 1e-8;

/// Measures by integration over the faces (OpenCASCADE's adaptive Gauss). Solids that overlap count twice. \throws Error(geometry_failed), Error(cancelled)
ReferenceData reference_data(const Model& model, const RunContext& context);

}  // namespace cad


}  // namespace sterna
