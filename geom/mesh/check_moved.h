// Update of a layer check after some of its lines have moved.
#pragma once

#include <cstdint>
#include <span>

#include "geom/mesh/check.h"

namespace sterna {

/// Returns the same result as check_ahead() for a mesh some of whose lines have moved, to the bit. Scans only the chunks of columns and lines around these
/// lines again, and tests all crossings.
/// \param known result of check_ahead() with the same options, before nodes of `lines` moved; nothing else may have changed
LayerCheck check_moved_lines(const LayerCheck& known, const HybridMesh& mesh, std::span<const std::uint32_t> lines, const CheckOptions& options,
                             const RunContext& context);

}  // namespace sterna
