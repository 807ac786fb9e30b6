// Conversion of patch names between sterna and files: names that a format cannot store, and patch kinds implied by names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Returns names that are valid in SU2, in patch order. Blanks, commas, brackets, '%', '=' and control characters become '_'. An empty name becomes "patch_<n>"
/// (from 1). A repeated name and the reserved SEND_RECEIVE get a number. Each change is logged as a warning.
std::vector<std::string> su2_marker_names(const Column<PatchId, Patch>& patches, const RunContext& context);

/// Returns the patch kind implied by a name in a file without kinds, as in CEASIOMpy: farfield or symmetry if the name contains that word (in any case), else a
/// wall.
PatchKind kind_of_name(std::string_view name);

/// Returns the patch of that name; adds it (with kind_of_name) if there is none yet.
PatchId find_or_add_patch(Column<PatchId, Patch>& patches, std::string_view name);

}  // namespace sterna::io
