// What is known of a layer, kept when some of its lines move.
#pragma once

#include <cstdint>
#include <span>

#include "geom/mesh/check.h"

namespace sterna {

/// What check_ahead() finds in a mesh some of whose lines have moved, to the bit: only chunks of columns and lines around them are looked at again, and all
/// crossings.
/// \param known of check_ahead() with the same options, before nodes of `lines` moved and nothing else changed
LayerCheck check_moved_lines(const LayerCheck& known, const HybridMesh& mesh, std::span<const std::uint32_t> lines, const CheckOptions& options,
                             const RunContext& context);

}  // namespace sterna
