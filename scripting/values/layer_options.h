// Completion of layer options after reading: derives the omitted option among layers and max_growth when a total height is given, and sets up the members of a
// mesh family.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// Sets solve_for from the given options. \p is_given: returns true if an option of the stage "envelope", by name, is given.
/// \throws Error(bad_argument) of volmesh::solved_for
void choose_solve_for(volmesh::MeshCase& options, const std::function<bool(std::string_view)>& is_given, std::string_view attempted);
/// The same for a verb's table and the overrides of the command line. Notes problems.
/// \pre the options are read
void choose_solve_for(volmesh::MeshCase& options, TableReader& reader, const ScriptCall& call);

/// Sets the boundary layer thickness that the layers have to cover from the flow conditions of first_height, if neither the thickness nor a total height is
/// given. Does nothing without a flow, or if its Reynolds number has no turbulent layer. \p text: first_height as given on the command line; empty: nothing.
void choose_boundary_layer(volmesh::MeshCase& options, std::string_view text);
/// The same for a verb's table and the overrides of the command line.
/// \pre the options are read
void choose_boundary_layer(volmesh::MeshCase& options, const TableReader& reader, const ScriptCall& call);

/// Sets family_wake to "on" if it is automatic and the mesh is a member of a family: all members have a wake, including the medium one, whose refinement of 1
/// is given explicitly.
void choose_family_wake(volmesh::MeshCase& options, bool is_refinement_given);
/// The same for a verb's table and the overrides of the command line.
/// \pre the options are read
void choose_family_wake(volmesh::MeshCase& options, const TableReader& reader, const ScriptCall& call);

/// Returns the function that the table has as first_height, unless the command line gives a number; null if there is none.
/// \pre the options are not read yet
FunctionHandle read_first_heights(TableReader& reader, const ScriptCall& call);
/// Evaluates the function f(x, y, z), in metres, at every vertex of the wall, in the order of the vertices. First heights then vary by location. Does nothing
/// without a function.
/// \throws Error(script_failed) of the function, Error(bad_argument) with locations for values that are no valid height
void set_first_heights(const FunctionHandle& function, const SurfaceValue& wall, volmesh::MeshCase& options, const RunContext& context);

/// Warns if surface and volume belong to different members of a family.
void warn_of_other_member(const SurfaceValue& wall, const volmesh::MeshCase& options, const RunContext& context);

/// The verb family{}.
std::span<const ScriptVerb> family_verbs();

}  // namespace sterna::scripting
