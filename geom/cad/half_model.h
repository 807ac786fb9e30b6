// Cuts a model at a plane of symmetry. The half is open there; its boundary lies exactly in the plane, to the last bit.
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/unite.h"
#include "geom/model/model.h"

namespace sterna {

struct HalfModelOptions {
  std::string axis = "y";
  double at = 0.0;  ///< metres
  std::string keep = "+";
  double tolerance = k_automatic;  ///< metres
  double time_limit = 600.0;       ///< seconds
};
template <>
struct Schema<HalfModelOptions> {
  using O = HalfModelOptions;
  static constexpr std::string_view stage = "half";
  static constexpr std::array fields = {
      Field<O>{.name = "axis", .member = &O::axis, .help = "the coordinate that is constant in the plane", .choices = "x y z"},
      Field<O>{.name = "at", .member = &O::at, .unit = Unit::metre, .help = "the value of this coordinate in the plane"},
      Field<O>{.name = "keep", .member = &O::keep, .help = "the side that is kept: larger (+) or smaller (-) coordinates", .choices = "+ -"},
      Field<O>{.name = "tolerance",
               .member = &O::tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .max = 1.0,
               .help = "geometry closer to the plane than this counts as in the plane",
               .automatic = "1e-6 of the longest side"},
      Field<O>{.name = "time_limit",
               .member = &O::time_limit,
               .unit = Unit::second,
               .min = 1.0,
               .max = 1e6,
               .help = "time limit of each attempt; a longer attempt ends the union or the cut with an error"},
  };
};

struct HalfModelReport {
  bool was_half = false;              ///< nothing was beyond the plane
  std::size_t n_solids_left_out = 0;  ///< solids entirely beyond the plane
  bool was_united = false;
  std::size_t n_faces_cut = 0;    ///< number of faces that cross the plane; 0 if edges of the model lie along it, so that faces were only selected
  std::size_t n_faces_split = 0;  ///< closed faces that were split into halves, because their seams lie in the plane
  std::size_t n_flat_faces = 0;   ///< faces in the plane, removed
  std::size_t n_border_edges = 0;
  double border_length = 0.0;  ///< m
  double largest_shift = 0.0;  ///< m: largest displacement of the boundary into the plane
};

struct HalfModel {
  Model model;
  HalfModelReport report;
};

namespace cad {

/// Returns the half of a model on one side of a plane x, y or z = constant. Solids entirely beyond it are removed first; several remaining solids are united.
/// Faces that cross the plane are cut, faces in it are removed. The edges and corners of the boundary are moved into the plane exactly: coordinates of points
/// on them are `at` to the last bit. A model that is already open in the plane, or closed by faces in it, with nothing beyond, is used unchanged. Names,
/// components, roles, kinds and surfaces are kept.
/// \post every free edge is in the plane
/// \throws Error(bad_argument) if the model does not reach the plane or has nothing on the kept side; Error(open_surface) with locations for free edges
/// elsewhere, and for open models that cross the plane; Error(geometry_failed) if the cut fails; all errors of unite; Error(cancelled)
HalfModel half_model(const Model& model, const HalfModelOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
