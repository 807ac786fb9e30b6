// Models into CAD files: STEP, IGES, BREP; metres, names where the format has them, the same bytes for the same model.
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
               .help = "surfaces and curves without an exact form (deformed, of functions) become splines within it",
               .automatic = "1e-6 of the longest side"},
      Field<T>{.name = "step_schema", .member = &T::step_schema, .help = "application protocol of STEP files", .choices = "ap203 ap214 ap242"},
  };
};

namespace cad {

/// The bytes of a file. What has no exact form (deformed models, functions) is refitted to options.tolerance and told in the log; all else is exact. STEP keeps
/// names of solids and faces, colours and layers; IGES colours and layers; BREP geometry alone. No date is written. `name` stands in the file's header. The
/// bytes are read again and compared: each solid has its faces, area and volume (to 1e-6). Where that fails, faces on closed surfaces are written as halves.
/// \throws Error(geometry_failed) for what OpenCASCADE refuses, and naming the solids that the file would lose or change; Error(bad_argument) with the place where the tolerance is not reached; Error(cancelled)
std::string cad_bytes(const Model& model, CadFormat format, const std::string& name, const WriteCadOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
