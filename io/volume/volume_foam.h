// OpenFOAM polyMesh, docs/method/formats_solvers.md, "OpenFOAM".
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"

namespace sterna::io {

/// The polyMesh folder that a name means: the folder itself when it is called polyMesh; of another folder, the case, constant/polyMesh in it; of a file in a
/// case, as the empty case.foam by which ParaView opens it, there or to be made, constant/polyMesh beside it.
std::filesystem::path polymesh_folder(const std::filesystem::path& path);

/// Its five files in the order in which they are read, each with .gz where only the packed one is there.
std::vector<std::filesystem::path> polymesh_files(const std::filesystem::path& path);

/// \throws Error(write_failed) where writing to a new case.foam would replace the mesh that another .foam file in its folder stands for.
void require_foam_output(const std::filesystem::path& path);

/// The same, and where the folder in which the case is to stand is not there: missing folders are made only for the case itself.
void require_foam_place(const std::filesystem::path& path);

/// Reads text and binary files (labels of 32 and 64, scalars of 64 and 32 bits, either byte order), each of them perhaps gzipped. Cells of 4 to 6 faces become
/// tetrahedra, pyramids, prisms, hexahedra. Kinds of patches: wall, symmetry, symmetryPlane by their type; a patch by a group of the name of a kind ("inGroups
/// 1(inflow)"), else farfield.
/// \throws Error file_malformed (line or byte), unsupported_format (polyhedra), file_not_found
HybridMesh read_volume_foam(const std::filesystem::path& path, const RunContext& context);

/// Writes points, faces, owner, neighbour, boundary, and cellZones with the zone "layers" where the mesh has columns: binary (little endian, labels of 32
/// bits), text.foam and x.text.foam as text. Of a new x.foam the empty file for ParaView, too; an existing folder x.foam is a case, as in earlier versions. A
/// case gets those of system/controlDict, fvSchemes and fvSolution that it has not, without which checkMesh does not start. Cells are numbered column by
/// column, faces are in upper-triangular order. The old folder stays until the new one is complete.
/// \throws Error overflow (2^31 faces, or nodes of faces in binary), mesh_invalid (faces that do not match), write_failed (also as require_foam_output),
/// cancelled
void write_volume_foam(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// The same with the cells in another order (MeshFaces::order_cells); nodes as they are.
void write_numbered_foam(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context);

/// Cells by their numbers in the order of for_each_cell().
struct FoamZone {
  std::string name;
  std::vector<std::uint32_t> cells;  ///< ascending
};

/// The same with more cellZones than that of the layers.
void write_numbered_foam(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, std::vector<FoamZone> zones,
                         const RunContext& context);

struct FoamMeshOptions {
  bool is_binary = true;
  Numbering numbering = Numbering::lines;  ///< of cells
  std::vector<FoamZone> zones = {};        ///< beside that of the layers
  std::vector<PeriodicSides> joined = {};  ///< sides of sheets, written as cyclic patches beside the mesh's own periodic ones
};

/// The files of a polyMesh into a folder that is there.
/// \throws as write_volume_foam
void write_polymesh(const HybridMesh& mesh, const std::filesystem::path& folder, const FoamMeshOptions& options, const RunContext& context);

/// Names as the files have them, in patch order; each change is a warning in the log.
std::vector<std::string> foam_patch_names(const Column<PatchId, Patch>& patches, const RunContext& context);

/// "wall", "patch"; symmetry that lies exactly in a coordinate plane is a "symmetryPlane", else "symmetry": OpenFOAM compares unit normals to 1e-15, and only
/// those of coordinate planes are exact. What is periodic is "cyclic" instead.
std::string foam_patch_type(const HybridMesh& mesh, PatchId patch);

/// The head of a file of text.
std::string foam_header(std::string_view object, std::string_view object_class, std::string_view location);

}  // namespace sterna::io
