// TetGen input: .smesh and .poly, with the .node file to which they may refer (docs/method/formats_surfaces.md, "TetGen").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the facets, with markers as patches. A facet of .poly is one polygon; further polygons of one or two points, which only constrain it, are ignored.
/// \throws Error file_not_found, file_malformed (line), unsupported_format (facets with holes, plane files of Triangle), cancelled.
SurfaceSoup read_tetgen(const std::filesystem::path& path, const RunContext& context);

/// Writes nodes and facets counted from 1, in full precision; markers are patch numbers from 1. No holes and no regions.
/// \throws Error write_failed, overflow, cancelled.
void write_smesh(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_poly(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
