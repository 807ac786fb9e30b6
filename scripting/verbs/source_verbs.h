// The verbs that make sources of the size field: box{...}, line{...}, wake{...} and so on, and reading of sources from a verb's table.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "volmesh/case/size_sources.h"

namespace sterna::scripting {

/// The verbs point, line, box, cylinder, wake, size_samples. Their values are tables with the field "shape", whose name is the verb's.
std::span<const ScriptVerb> source_verbs();
/// Makes sphere{ {x, y, z}, radius = 1, size = 0.1 }, a ball of a given size. The verb sphere also makes farfields.
ScriptValue make_sphere_source(const ScriptCall& call);

/// Reads the entry "sources" of a table: a value of the verbs above, or a list of them. Notes problems with the reader.
std::vector<volmesh::SizeSource> read_sources(TableReader& reader, const ScriptCall& call);
/// Parses a source of the command line, "line 0 0 0 8 0 0 size=0.02 radius=0.5" or "cylinder from=0,0,0 to=8,0,0 radius=1 size=0.1". The string has the verb's
/// name, its points (also as from, to, center), and its named numbers. Numbers may have units.
/// \throws Error(bad_argument, unknown_option)
volmesh::SizeSource source_of_text(const std::string& text);

/// Returns a source as the table that its verb makes.
TableHandle table_of_source(volmesh::SizeSource source);

/// Parses "length=2 size=0.05 direction=1,0,0.05"; may be empty.
/// \throws Error(bad_argument, unknown_option), also as volmesh::wake_behind
volmesh::SizeSource wake_of_text(const std::string& text, const TriMesh& wall);

}  // namespace sterna::scripting
