// Inside geom/cad only: a written file read again and compared with the model, solid by solid.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/cad_format.h"
#include "geom/model/model.h"

namespace sterna::cad {

/// What differs between a model and its file, read again without healing: faces, area and volume of each closed solid (to 1e-6, and what the tolerances of the
/// model's edges leave open; STEP and IGES: its magnitude), area of all open shells and loose faces. One sentence for each, with the solid's name; empty: the
/// file holds the model.
/// \throws Error(cancelled)
std::vector<std::string> differences_of_file(const Model& model, const std::string& bytes, CadFormat format, const std::string& name,
                                             const RunContext& context);

/// Names of closed solids whose faces point inwards, as of a tunnel around its fluid.
std::vector<std::string> solids_around_fluid(const Model& model, const RunContext& context);

}  // namespace sterna::cad
