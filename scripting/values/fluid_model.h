// Models that belong together: assemblies, united where they touch, and the fluid around them in a wind tunnel.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/half_model.h"
#include "scripting/values/models.h"

namespace sterna::scripting {

/// A solid all of whose faces are of components of the kind tunnel: the fluid is inside of it.
bool has_container(const Model& model);

/// All models as one; closed solids that touch are united first, those of tunnels and open sheets stay aside. Names as by assemble.
/// \throws Error of unite
ModelValue assemble_united(const std::vector<ModelHandle>& models, const RunContext& context);

/// The fluid of a model with a tunnel: the tunnel less all other solids. Models without a tunnel, and tunnels alone, are returned as they are.
/// Stings and what the tunnel lets through may reach out of it.
/// \throws Error(bad_argument) for two tunnels; of cad::fluid_domain
ModelValue fluid_of(ModelValue all, const RunContext& context);

/// The half of a model; its description, of the whole one, is gone. What was done goes to the log and the report.
/// \throws Error of cad::half_model
ModelValue half_of_model(const ModelValue& whole, const HalfModelOptions& options, const RunContext& context);

/// What OpenCASCADE needs: deformed surfaces and curves as splines within 1e-6 of the longest side, which is told in the log; others as they are.
void refit_for_cad(Model& model, const RunContext& context);

}  // namespace sterna::scripting
