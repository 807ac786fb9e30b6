// Files and surfaces as soups, for the verbs that accept defective surfaces (repair and wrap) and for union.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

struct SurfaceItems {
  SurfaceValue wall;                       ///< all known data except a mesh; its options include those of the manifests beside the files
  std::vector<SurfaceSoup> soups;          ///< in units of wall.options.unit
  std::map<std::string, PatchKind> kinds;  ///< kinds of patches by name
};

/// Returns the unnamed entries of a verb's table, which are surfaces and names of files; notes problems.
std::vector<UnionItem> read_surfaces_and_files(TableReader& reader, const ScriptCall& call);
/// Reads the items: files with the unit of the options; surfaces are in metres.
/// \throws Error of io
SurfaceItems read_items(std::span<const UnionItem> items, const surfmesh::StitchOptions& options, const RunContext& context);

/// Returns the wall with a mesh made of its soups.
SurfaceValue with_mesh(const SurfaceItems& items, TriMesh mesh, surfmesh::StitchReport report);

}  // namespace sterna::scripting
