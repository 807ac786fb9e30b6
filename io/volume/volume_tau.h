// DLR TAU primary grids in NetCDF, with the boundary mapping beside them: docs/method/formats_solvers.md, "TAU".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "io/mesh/surface_boundary.h"

namespace sterna::io {

/// Writes CDF-2, which every NetCDF since 3.6 reads, or CDF-5 (with a warning) where an array exceeds the 4 GiB of CDF-2; and "<stem>.bmap" beside it with the
/// names and conditions of the markers. Markers count from 1 over the patches with faces. Streams: below 100 MB of memory beside the mesh.
/// \throws Error overflow (a node beyond 2^31-1: TAU's numbers have 32 bits), mesh_invalid, write_failed, cancelled.
void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// The same with the kind of NetCDF chosen.
enum class TauNetcdf { as_needed, cdf5 };
void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, TauNetcdf kind, const RunContext& context);

/// Reads CDF-1, -2, -5 and NetCDF-4. Names of patches come from the attributes marker_<id>, else from the .bmap beside the file, else "patch_<id>"; kinds from
/// the .bmap, else from the names; patches are in the order of `marker`. Cells in a wrong winding are flipped, faces turned outwards; both are counted in the
/// log.
/// \throws Error file_malformed (byte, variable or line), unsupported_format, file_not_found.
HybridMesh read_volume_tau(const std::filesystem::path& path, const RunContext& context);

/// The same without cells, which are counted, and with nothing turned.
FileBoundary read_boundary_tau(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
