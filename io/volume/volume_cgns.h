// CGNS meshes, docs/method/formats.md, "CGNS": volumes, and the reader that surfaces share.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "io/mesh/surface_boundary.h"

namespace sterna::io {

/// Writes HDF5, or ADF for a name that ends in ".adf.cgns" (stamped 2.54: for old solvers), with one base and one zone: sections PENTA_6, PYRA_5, HEXA_8,
/// TETRA_4 (as far as there are such cells), then for every patch with faces a section of its triangles named as the patch, one of its quads ("<patch>_quad"
/// where it has both), a BC_t "FamilySpecified" over them, and a family with the kind. Lengths are metres. Without cells it is a surface: its base has two
/// dimensions. Names that CGNS cannot take (longer than 32 bytes, with '/', repeated) are changed with a warning; the family notes the whole name. HDF5 takes
/// 64-bit integers where 32 bits do not suffice. Streams: below 100 MB of memory beside the mesh.
/// \throws Error overflow (ADF: a number beyond 2^31-1), mesh_invalid, write_failed, cancelled.
void write_volume_cgns(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// The same with the width of integers chosen: libraries built for 32 bits (Debian's) do not read 64.
/// \throws Error(unsupported_format) for always_64 in ADF
enum class CgnsIntegers { as_needed, always_64 };
void write_volume_cgns(const HybridMesh& mesh, const std::filesystem::path& path, CgnsIntegers integers, const RunContext& context);

/// Reads the unstructured zones (joined) of the first base of three dimensions, HDF5 or ADF of any version: fixed-type and MIXED sections, integers of 32 or 64
/// bits, coordinates of either precision. A face belongs to the family (else the name) of the boundary condition that lists it, by element range or list, or by
/// its nodes; else to the patch of its section's name. Points and bars are left out; cells in a wrong winding are flipped, faces turned outwards; all is
/// counted in the log.
/// \throws Error file_malformed, unsupported_format (structured zones, polyhedra, second order, links to other files), file_not_found.
HybridMesh read_volume_cgns(const std::filesystem::path& path, const RunContext& context);

/// The same for surfaces: as they are in the file, nothing turned; zones of a base of two dimensions too, structured ones as quads. Of structured volume zones
/// the faces of the wall conditions.
FileBoundary read_boundary_cgns(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
