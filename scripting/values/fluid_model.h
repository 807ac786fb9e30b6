// Models that belong together: assemblies whose models are united where they touch, and the fluid around them in a wind tunnel.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/half_model.h"
#include "scripting/values/models.h"

namespace sterna::scripting {

/// Returns true if the model has a solid all of whose faces are of components of the kind tunnel: the fluid is inside this solid.
bool has_container(const Model& model);

/// Returns all models as one. Closed solids that touch are united first; solids of tunnels and open sheets are kept separate. Names are as by assemble.
/// \throws Error of unite
ModelValue assemble_united(const std::vector<ModelHandle>& models, const RunContext& context);

/// Returns the fluid of a model with a tunnel: the tunnel minus all other solids. Models without a tunnel, and tunnels alone, are returned unchanged. Stings
/// and the components allowed through the tunnel walls may extend beyond the tunnel.
/// \throws Error(bad_argument) for two tunnels; of cad::fluid_domain
ModelValue fluid_of(ModelValue all, const RunContext& context);

/// Returns the half of a model. The description, which is of the whole model, is dropped. The changes go to the log and the report.
/// \throws Error of cad::half_model
ModelValue half_of_model(const ModelValue& whole, const HalfModelOptions& options, const RunContext& context);

/// Converts the geometry to the form that OpenCASCADE requires. Deformed surfaces and curves become splines within 1e-6 of the longest side, which is reported
/// in the log; all others are unchanged.
void refit_for_cad(Model& model, const RunContext& context);

}  // namespace sterna::scripting
