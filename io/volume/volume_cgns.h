// CGNS meshes, docs/method/formats.md, "CGNS": volume meshes, and the reader that surfaces share.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "io/mesh/surface_boundary.h"

namespace sterna::io {

/// Writes HDF5, or ADF for a name that ends in ".adf.cgns" (stamped 2.54, for old solvers), with one base and one zone. Sections are PENTA_6, PYRA_5, HEXA_8,
/// TETRA_4 (if there are such cells). Every patch with faces has a section of triangles named as the patch, a section of quads ("<patch>_quad" if it has both),
/// a BC_t "FamilySpecified" over both, and a family with the kind. Lengths are in metres. A mesh without cells is a surface: its base has two dimensions. Names
/// that CGNS does not accept (longer than 32 bytes, with '/', repeated) are changed with a warning; the family stores the full name. HDF5 uses 64-bit integers
/// where 32 bits do not suffice. The file is streamed, which takes less than 100 MB of memory in addition to the mesh.
/// \throws Error overflow (ADF: a number beyond 2^31-1), mesh_invalid, write_failed, cancelled.
void write_volume_cgns(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Integer width for the following overload of write_volume_cgns(). Libraries that are built for 32 bits (Debian's) do not read 64.
/// \throws Error(unsupported_format) for always_64 in ADF
enum class CgnsIntegers { as_needed, always_64 };
void write_volume_cgns(const HybridMesh& mesh, const std::filesystem::path& path, CgnsIntegers integers, const RunContext& context);

/// Reads the unstructured zones (joined) of the first base of three dimensions, HDF5 or ADF of any version: fixed-type and MIXED sections, integers of 32 or 64
/// bits, coordinates of either precision. The patch of a face is the family (else the name) of the boundary condition that lists the face by element range or
/// list, or by its nodes. Faces without a condition get the name of their section. Points and bars are left out, cells with the wrong winding are flipped, and
/// faces are turned outwards; all are counted in the log.
/// \throws Error file_malformed, unsupported_format (structured zones, polyhedra, second order, links to other files), file_not_found.
HybridMesh read_volume_cgns(const std::filesystem::path& path, const RunContext& context);

/// Reads surfaces unchanged, without turning faces. Also accepts zones of a base of two dimensions, with structured zones as quads. From structured volume
/// zones the faces of the wall conditions are read.
FileBoundary read_boundary_cgns(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
