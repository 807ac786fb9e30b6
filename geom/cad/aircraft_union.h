// Unites an aircraft's components into one wetted surface: splits the parts, checks their contacts, then unites them.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/unite.h"
#include "geom/model/aircraft.h"
#include "geom/model/model.h"

namespace sterna {

namespace cad {

/// Returns one model for each solid, in their order; all faces keep their surfaces, and each part has only the components of its own faces.
/// \throws Error(open_surface) with locations if a face belongs to no solid
std::vector<Model> split_solids(const Model& components);

/// Unites solids that cross, touch or lie inside others; the other solids are unchanged. Each result is one solid, in the order of the first part of each.
/// \throws Error of find_contacts and unite
std::vector<Model> unite_touching(std::span<const Model> solids, const UniteOptions& options, const RunContext& context);

/// Returns the union of all solids of a model (make_components, a CAD file), as unite does. Contacts that may be difficult to unite or mesh are logged as
/// warnings before anything is united, and stored in report.doubts. A model of one solid is returned unchanged.
/// \throws Error(bad_argument) if there is no solid; else as split_solids and unite
UniteResult unite_aircraft(const Model& components, const UniteOptions& options, const RunContext& context);
/// Calls make_components, then unites as above.
UniteResult unite_aircraft(const Aircraft& aircraft, const UniteOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
