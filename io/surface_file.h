// What a surface file holds before it becomes a TriMesh: a triangle soup with patch names. Readers do no geometry.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

/// Reads one surface file; the format follows from the extension (".gz" peeled off) and, for STL and PLY, from the contents. Polygons are split into
/// triangles. A volume mesh (SU2, UGRID, MSH) gives its boundary faces. Coordinates are as in the file (no unit applied).
/// \throws Error file_not_found, file_malformed (line or byte offset and what was expected), unsupported_format.
SurfaceSoup read_surface_file(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
