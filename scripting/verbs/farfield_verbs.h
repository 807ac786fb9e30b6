// The outer boundary of the fluid, in scripts and on the command line: sphere{}, box{} and cylinder{} as farfields, and the entry `farfield = ...` of
// volume_mesh.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Makes sphere{ radius = 100 }, which is a table of options of the stage "farfield". With unnamed entries or a size it is a source (source_verbs.h).
ScriptValue make_sphere(const ScriptCall& call);
/// Makes the tables of box{ {-10, -5, -5}, {20, 5, 5}, edge = 2, sides = { x_min = "inflow" } } and cylinder{ {-10, 0, 0}, {20, 0, 0}, radius = 5, edge = 1 }.
ScriptValue make_farfield_box(const ScriptCall& call);
ScriptValue make_farfield_cylinder(const ScriptCall& call);
/// Returns true if box{} or cylinder{} is a farfield, that is, if it has `edge`, `sides` or `floor`. With `size` it is a source, otherwise a solid.
bool is_farfield(const ScriptCall& call);
std::string sphere_help();

/// Returns the table with "farfield" converted to options of its stage. The entry may be a shape; a surface; a model, whose surface is meshed; or a string:
/// "none", "box -10 -5 -5 20 5 5 edge=2", the name of a file. A surface goes to `surface`, its files to `inputs`.
ScriptTable with_farfield(const ScriptCall& call, ScriptTable table, std::shared_ptr<const TriMesh>& surface, std::vector<InputFile>& inputs);

/// Returns the options of a string: "none", "sphere radius=100 edge=20", "box -10 -5 -5 20 5 5 edge=2 x_min=inflow x_max=outflow,edge:0.5", "cylinder -10 0 0
/// 20 0 0 radius=5", or the name of a file.
/// \throws Error(bad_argument)
OptionOverrides farfield_of_text(const std::string& text);
/// Returns the surface in the file that the options name for the shape "surface", with the file; null if they name none.
/// \throws Error of read_wall, of meshing a model
SurfaceHandle read_farfield(const volmesh::FarfieldOptions& options, const std::function<InputPath(const std::string&)>& find, const RunContext& context);

}  // namespace sterna::scripting
