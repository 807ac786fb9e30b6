// LaWGS, the Langley Wireframe Geometry Standard (NASA TM 85767): networks of points.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

/// Reads each network as a patch of quads, transformed into the global system (rotation about x, y, z, translation, scale). Mirror images implied by a network
/// are not generated; this is reported.
/// \throws Error file_not_found, file_malformed (line), overflow, cancelled.
SurfaceSoup read_wgs(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
