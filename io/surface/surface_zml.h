// The native format of sumo and pentagrow: a tree of arrays in an LZ4 frame (docs/method/formats_surfaces.md, "ZML").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

/// Reads the triangles and quads of all meshes of the file. The patch of a face is the first boundary condition that lists it, else its section.
/// \throws Error file_not_found, file_malformed (byte offset of the unpacked data), unsupported_format (other variants of zml), cancelled.
SurfaceSoup read_zml(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
