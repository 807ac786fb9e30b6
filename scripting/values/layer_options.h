// Completion of layer options after reading: derives the omitted option among layers and max_growth when a total height is given, and sets up the members of a
// mesh family.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// Completes the options of layers after reading:
/// - solve_for: the option to be derived if a total height is given;
/// - boundary_layer: the thickness that the layers have to cover, from the flow conditions of first_height, if neither the thickness nor a total height
///   is given and the flow has a turbulent layer;
/// - family_wake: "on" if it is automatic and the mesh is a member of a family. All members have a wake, including the medium one, whose refinement
///   of 1 is given explicitly.
/// `given`: the options of the command line. \throws Error(bad_argument) of volmesh::solved_for
void complete_layers(volmesh::MeshCase& options, const OptionOverrides& given, std::string_view attempted);
/// The same for a verb's table and the overrides of the command line. Notes problems.
/// \pre the options are read
void complete_layers(volmesh::MeshCase& options, TableReader& reader, const ScriptCall& call);

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
