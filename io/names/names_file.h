// Patch names beside meshes whose format has only patch numbers: wing.names for wing.meshb, with lines "number kind name".
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Returns wing.names for wing.mesh, wing.meshb, wing.v4.meshb, each optionally with .gz.
std::filesystem::path names_path(const std::filesystem::path& mesh_path);

/// Reads the patches by number; empty if there is no such file.
/// \throws Error(file_malformed) with its line
std::map<std::int64_t, Patch> read_names(const std::filesystem::path& mesh_path, const RunContext& context);

/// Returns the file's text; patches are numbered from 1. Warns about names that the file format cannot store.
std::string names_text(const Column<PatchId, Patch>& patches, const RunContext& context);

}  // namespace sterna::io
