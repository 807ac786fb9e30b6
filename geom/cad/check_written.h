// Inside geom/cad only: reads a written file again and compares it with the model, solid by solid.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/cad_format.h"
#include "geom/model/model.h"

namespace sterna::cad {

/// Returns the differences between a model and its file, read again without healing: number of faces, area and volume of each closed solid (to 1e-6, plus the
/// uncertainty from the tolerances of the model's edges; STEP and IGES: magnitude of the volume), area of all open shells and loose faces. One sentence for
/// each difference, with the solid's name; empty: the file represents the model.
/// \throws Error(cancelled)
std::vector<std::string> differences_of_file(const Model& model, const std::string& bytes, CadFormat format, const std::string& name,
                                             const RunContext& context);

/// Returns the names of closed solids whose faces point inwards, such as a tunnel around its fluid.
std::vector<std::string> solids_around_fluid(const Model& model, const RunContext& context);

}  // namespace sterna::cad
