// Patch names between sterna and the files: what a format cannot spell, and what a name says about the patch.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Names that SU2 can take, in patch order: blanks, commas, brackets, '%', '=' and control characters become '_', an empty name "patch_<n>" (from 1), a
/// repeated one and the reserved SEND_RECEIVE get a number. Each change is a warning in the log.
std::vector<std::string> su2_marker_names(const Column<PatchId, Patch>& patches, const RunContext& context);

/// The kind that a file without kinds means by a name, as CEASIOMpy reads it: contains "farfield" or "symmetry" (any case), else a wall.
PatchKind kind_of_name(std::string_view name);

/// Patch of that name, added (with kind_of_name) when there is none yet.
PatchId find_or_add_patch(Column<PatchId, Patch>& patches, std::string_view name);

}  // namespace sterna::io
