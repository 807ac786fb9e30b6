// Writes models to CAD files: STEP, IGES, BREP; metres, names if the format supports them, the same bytes for the same model.
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/cad_format.h"
#include "geom/model/model.h"

namespace sterna {

struct WriteCadOptions {
  std::string step_schema = "ap214";
  double tolerance = k_automatic;  ///< metres
};
template <>
struct Schema<WriteCadOptions> {
  static constexpr std::string_view stage = "write_cad";
  using T = WriteCadOptions;
  static constexpr std::array fields = {
      Field<T>{.name = "tolerance",
               .member = &T::tolerance,
               .unit = Unit::metre,
               .min = 1e-9,
               .max = 1.0,
               .help = "surfaces and curves without an exact form (deformed, of functions) become splines within this distance",
               .automatic = "1e-6 of the longest side"},
      Field<T>{.name = "step_schema", .member = &T::step_schema, .help = "application protocol of STEP files", .choices = "ap203 ap214 ap242"},
  };
};

namespace cad {

/// Returns the bytes of a file. Geometry without an exact form (deformed models, functions) is refitted to options.tolerance, which is logged; everything else
/// is exact. STEP keeps names of solids and faces, colours and layers; IGES colours and layers; BREP only geometry. No date is written. `name` is written to
/// the file's header. The bytes are read again and compared: each solid must have its faces, area and volume (to 1e-6). If that fails, faces on closed surfaces
/// are written as halves.
/// \throws Error(geometry_failed) if OpenCASCADE refuses, and naming the solids that the file would lose or change; Error(bad_argument) with the location where
/// the tolerance is not reached; Error(cancelled)
std::string cad_bytes(const Model& model, CadFormat format, const std::string& name, const WriteCadOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
