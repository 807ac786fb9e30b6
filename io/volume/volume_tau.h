// DLR TAU primary grids in NetCDF, with the boundary mapping file beside them: docs/method/formats_solvers.md, "TAU".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "io/mesh/surface_boundary.h"

namespace sterna::io {

/// Writes CDF-2, which every NetCDF since 3.6 reads, or CDF-5 (with a warning) if an array exceeds the 4 GiB of CDF-2. Also writes "<stem>.bmap" beside it with
/// the names and conditions of the markers. Markers count from 1 over the patches with faces. The file is streamed, which takes less than 100 MB of memory in
/// addition to the mesh.
/// \throws Error overflow (a node beyond 2^31-1: TAU's numbers have 32 bits), mesh_invalid, write_failed, cancelled.
void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// NetCDF variant for the overload of write_volume_tau() that follows.
enum class TauNetcdf { as_needed, cdf5 };
void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, TauNetcdf kind, const RunContext& context);

/// Reads CDF-1, -2, -5 and NetCDF-4. Patch names come from the attributes marker_<id>, else from the .bmap file beside the grid, else "patch_<id>"; kinds from
/// the .bmap file, else from the names; patches are in the order of `marker`. Cells with the wrong winding are flipped, faces turned outwards; both are counted
/// in the log.
/// \throws Error file_malformed (byte, variable or line), unsupported_format, file_not_found.
HybridMesh read_volume_tau(const std::filesystem::path& path, const RunContext& context);

/// Reads the boundary unchanged, without turning faces; cells are only counted.
FileBoundary read_boundary_tau(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
