// The .msh of sumo (dwfs): XML with one or more triangulations (docs/method/formats_surfaces.md, "DWFS").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads all triangulations. Tags are patches, named by the TagNameMap.
/// \throws Error file_not_found, file_malformed (byte offset), cancelled.
SurfaceSoup read_dwfs(const std::filesystem::path& path, const RunContext& context);

/// Writes numbers in full precision; tags are patch numbers from 1.
/// \throws Error write_failed, cancelled.
void write_dwfs(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
