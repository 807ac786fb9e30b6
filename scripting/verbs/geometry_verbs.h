// Verbs that make models: readers of CAD, sumo and CPACS files; airfoils; surfaces of functions; boxes; cylinders; unions.
#pragma once

#include <optional>
#include <span>

#include "geom/model/airfoil.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"

namespace sterna::scripting {

/// The verbs read_cad, read_smx, read_cpacs, airfoil, surface.
std::span<const ScriptVerb> geometry_verbs();
extern const ScriptVerb k_airfoil_field;
std::string describe(const Airfoil& airfoil);

/// Makes box{...} and cylinder{...} without `size`, which are solids. With `size` they are sources (source_verbs.h).
ScriptValue make_box_model(const ScriptCall& call);
ScriptValue make_cylinder_model(const ScriptCall& call);

/// Unites the arguments of union{...}: models, components and CAD files.
ScriptValue unite_models(const ScriptCall& call);

/// Returns the airfoil named by a value: an airfoil, a NACA designation, a file, or a list of points {x, z}. If there is a problem, notes it with the reader
/// and returns nothing.
std::optional<Airfoil> read_airfoil_value(const ScriptValue& value, const ScriptCall& call, TableReader& reader, const std::string& where);

}  // namespace sterna::scripting
