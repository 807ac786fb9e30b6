// The outer boundary of the fluid, in scripts and on the command line: the values of sphere{}, box{} and cylinder{} as farfields, and `farfield = ...` of
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

/// Makes sphere{ radius = 100 }: a table of options of stage "farfield". With unnamed entries or a size it is a source (source_verbs.h).
ScriptValue make_sphere(const ScriptCall& call);
/// Makes box{ {-10, -5, -5}, {20, 5, 5}, edge = 2, sides = { x_min = "inflow" } } and cylinder{ {-10, 0, 0}, {20, 0, 0}, radius = 5, edge = 1 }: such tables,
/// too.
ScriptValue make_farfield_box(const ScriptCall& call);
ScriptValue make_farfield_cylinder(const ScriptCall& call);
/// Returns true if box{} or cylinder{} is a farfield: with `edge`, `sides` or `floor`. With `size` they are sources, else solids.
bool is_farfield(const ScriptCall& call);
std::string sphere_help();

/// Returns the table with "farfield" converted to options of its stage. A surface goes to `surface`, its files to `inputs`. The entry may be a shape, a
/// surface, or a model, whose surface is meshed; or a string: "none", "box -10 -5 -5 20 5 5 edge=2", the name of a file.
ScriptTable with_farfield(const ScriptCall& call, ScriptTable table, std::shared_ptr<const TriMesh>& surface, std::vector<InputFile>& inputs);

/// Returns the options of a string: "none", "sphere radius=100 edge=20", "box -10 -5 -5 20 5 5 edge=2 x_min=inflow x_max=outflow,edge:0.5", "cylinder -10 0 0
/// 20 0 0 radius=5", a file.
/// \throws Error(bad_argument)
OptionOverrides farfield_of_text(const std::string& text);
/// Returns the surface in the file of the shape "surface", if the options name one, with its file.
/// \throws Error of read_wall, of meshing a model
SurfaceHandle read_farfield(const volmesh::FarfieldOptions& options, const std::function<InputPath(const std::string&)>& find, const RunContext& context);

}  // namespace sterna::scripting
