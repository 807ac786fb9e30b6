// Patch names beside meshes whose format only numbers them: wing.names for wing.meshb, lines "number kind name".
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// wing.names for wing.mesh, wing.meshb, wing.v4.meshb, each perhaps with .gz.
std::filesystem::path names_path(const std::filesystem::path& mesh_path);

/// Patches by number; empty when there is no such file.
/// \throws Error(file_malformed) with its line
std::map<std::int64_t, Patch> read_names(const std::filesystem::path& mesh_path, const RunContext& context);

/// The file's text; patches are numbered from 1. Warns of names that it cannot spell.
std::string names_text(const Column<PatchId, Patch>& patches, const RunContext& context);

}  // namespace sterna::io
