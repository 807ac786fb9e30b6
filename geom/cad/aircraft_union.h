// An aircraft's components made one wetted surface: parts taken apart, contacts looked at, then united.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/unite.h"
#include "geom/model/aircraft.h"
#include "geom/model/model.h"

namespace sterna {

namespace cad {

/// One model for each solid, in their order; all faces keep their surfaces, each part has the components of its own faces alone.
/// \throws Error(open_surface) with places when a face belongs to no solid
std::vector<Model> split_solids(const Model& components);

/// Solids that cross, touch or lie inside others are united; those that stay apart stay as they are. Each result is one solid, in the order of the first part
/// of each.
/// \throws Error of find_contacts and unite
std::vector<Model> unite_touching(std::span<const Model> solids, const UniteOptions& options, const RunContext& context);

/// The union of all solids of a model (make_components, a CAD file), as unite does it. What looks hard about the contacts of the parts goes to the log as
/// warnings before anything is united, and into report.doubts. A model of one solid is returned as it is.
/// \throws Error(bad_argument) for no solid at all; else as split_solids and unite
UniteResult unite_aircraft(const Model& components, const UniteOptions& options, const RunContext& context);
/// The same after make_components.
UniteResult unite_aircraft(const Aircraft& aircraft, const UniteOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
