// Boundary conditions of FOI Edge: the tree of .aboc (text) and .bboc (binary) files, docs/method/formats_solvers.md, "Edge boundary conditions".
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the kinds by boundary name from x.aboc or x.bboc beside the mesh x.bmsh, x.v2.bmsh or x.amsh; empty if neither exists.
/// \throws Error(file_malformed)
std::map<std::string, PatchKind> read_edge_conditions(const std::filesystem::path& mesh_path, const RunContext& context);

/// Returns the path that the writer uses: x.aboc.
std::filesystem::path edge_conditions_path(const std::filesystem::path& mesh_path);

/// Returns the text of an .aboc file. Inflow and outflow become engine exhaust and engine inlet. Their parameters must be set by the user, which is logged as a
/// warning. \param names names of all patches; patches with an empty name are left out
std::string edge_conditions_text(const Column<PatchId, Patch>& patches, const std::vector<std::string>& names, const RunContext& context);

}  // namespace sterna::io
