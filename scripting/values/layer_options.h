// What verbs and commands do with the options of layers once they are read: which of layers and max_growth was left out beside a total height, and the members
// of a mesh family.
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

/// Sets solve_for by what was given. \p is_given: of options of the stage "envelope", by name.
/// \throws Error(bad_argument) of volmesh::solved_for
void choose_solve_for(volmesh::MeshCase& options, const std::function<bool(std::string_view)>& is_given, std::string_view attempted);
/// The same for a verb's table and the overrides of the command line; notes problems.
/// \pre the options are read
void choose_solve_for(volmesh::MeshCase& options, TableReader& reader, const ScriptCall& call);

/// The boundary layer that the layers have to cover is that of the flow conditions that first_height is of, where neither it nor a total height is given.
/// Nothing without a flow, or where its Reynolds number has no turbulent layer. \p text: what the command line gives as first_height; empty: nothing.
void choose_boundary_layer(volmesh::MeshCase& options, std::string_view text);
/// The same for a verb's table and the overrides of the command line.
/// \pre the options are read
void choose_boundary_layer(volmesh::MeshCase& options, const TableReader& reader, const ScriptCall& call);

/// Members of a family have a wake, the medium one, too, whose refinement of 1 is given: sets family_wake to "on" where it is left to us.
void choose_family_wake(volmesh::MeshCase& options, bool is_refinement_given);
/// The same for a verb's table and the overrides of the command line.
/// \pre the options are read
void choose_family_wake(volmesh::MeshCase& options, const TableReader& reader, const ScriptCall& call);

/// The function that the table has as first_height, unless the command line gives a number; null: none.
/// \pre the options are not read yet
FunctionHandle read_first_heights(TableReader& reader, const ScriptCall& call);
/// Asks the function, f(x, y, z) in metres, at every vertex of the wall, in their order: then first heights are by place. Nothing without a function.
/// \throws Error(script_failed) of the function, Error(bad_argument) with places for what is no height
void set_first_heights(const FunctionHandle& function, const SurfaceValue& wall, volmesh::MeshCase& options, const RunContext& context);

/// Warns where surface and volume belong to different members of a family.
void warn_of_other_member(const SurfaceValue& wall, const volmesh::MeshCase& options, const RunContext& context);

/// family{}
std::span<const ScriptVerb> family_verbs();

}  // namespace sterna::scripting
