// TAU's boundary mapping file (.bmap), which assigns a condition to each marker. Format: docs/method/formats_solvers.md, "TAU boundary mapping".
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

struct TauMarker {
  std::int64_t number = 0;
  std::string name;
  std::string condition;  ///< "viscous wall"; may be empty
};

/// Returns mesh.bmap for mesh.taumesh, mesh.grid.
std::filesystem::path bmap_path(const std::filesystem::path& mesh_path);
/// Reads the markers by number; empty if there is no such file beside the mesh. Keys other than Markers, Type and Name are ignored.
/// \throws Error(file_malformed) with the line.
std::map<std::int64_t, TauMarker> read_bmap(const std::filesystem::path& mesh_path, const RunContext& context);
std::string bmap_text(const std::vector<TauMarker>& markers);

std::string tau_condition(PatchKind kind);
/// Returns the kind implied by the condition, if any, else by the name.
PatchKind kind_of_tau(const TauMarker& marker);

}  // namespace sterna::io
