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

/// Returns the polyMesh folder for a path: the folder itself if it is called polyMesh; constant/polyMesh in any other folder, which is taken as the case;
/// constant/polyMesh beside a file in a case, such as the empty case.foam by which ParaView opens it. The file need not exist yet.
std::filesystem::path polymesh_folder(const std::filesystem::path& path);

/// Returns the five files in reading order, each with .gz if only the packed file exists.
std::vector<std::filesystem::path> polymesh_files(const std::filesystem::path& path);

/// Tests the output path.
/// \throws Error(write_failed) if writing to a new case.foam would replace the mesh of another .foam file in its folder.
void require_foam_output(const std::filesystem::path& path);

/// Tests as require_foam_output(); also throws if the parent folder of the case does not exist: missing folders are created only for the case itself.
void require_foam_location(const std::filesystem::path& path);

/// Reads text and binary files (labels of 32 and 64, scalars of 64 and 32 bits, either byte order), each optionally gzipped. Cells of 4 to 6 faces become
/// tetrahedra, pyramids, prisms, hexahedra. The type of a patch (wall, symmetry, symmetryPlane) determines its kind. For the type `patch`, the kind is that of
/// a group with the name of a kind ("inGroups 1(inflow)"), or farfield if there is no such group.
/// \throws Error file_malformed (line or byte), unsupported_format (polyhedra), file_not_found
HybridMesh read_volume_foam(const std::filesystem::path& path, const RunContext& context);

/// Writes points, faces, owner, neighbour, boundary, and cellZones with the zone "layers" if the mesh has columns. Files are binary (little endian, labels of
/// 32 bits); text.foam and x.text.foam give text. For a new x.foam the empty file for ParaView is written, too; an existing folder x.foam is a case, as in
/// earlier versions. Missing files among system/controlDict, fvSchemes and fvSolution are added to the case, because checkMesh does not start without them.
/// Cells are numbered column by column, faces are in upper-triangular order. The old folder is kept until the new one is complete.
/// \throws Error overflow (2^31 faces, or nodes of faces in binary), mesh_invalid (faces that do not match), write_failed (also as require_foam_output),
/// cancelled
void write_volume_foam(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Writes the mesh with another cell order (MeshFaces::order_cells); node numbers are unchanged.
void write_numbered_foam(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context);

/// A cell zone. Cells are given by their numbers in the order of for_each_cell().
struct FoamZone {
  std::string name;
  std::vector<std::uint32_t> cells;  ///< ascending
};

/// Writes the mesh with further cellZones in addition to the layer zone.
void write_numbered_foam(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, std::vector<FoamZone> zones,
                         const RunContext& context);

struct FoamMeshOptions {
  bool is_binary = true;
  Numbering numbering = Numbering::lines;  ///< numbering of the cells
  std::vector<FoamZone> zones = {};        ///< in addition to the layer zone
  std::vector<PeriodicSides> joined = {};  ///< sides of baffles, written as cyclic patches in addition to the mesh's own periodic patches
};

/// Writes the files of a polyMesh into an existing folder.
/// \throws as write_volume_foam
void write_polymesh(const HybridMesh& mesh, const std::filesystem::path& folder, const FoamMeshOptions& options, const RunContext& context);

/// Returns the patch names used in the files, in patch order; each change is a warning in the log.
std::vector<std::string> foam_patch_names(const Column<PatchId, Patch>& patches, const RunContext& context);

/// Returns "wall" or "patch". A symmetry patch exactly in a coordinate plane is a "symmetryPlane", else "symmetry": OpenFOAM compares unit normals to 1e-15,
/// and only normals of coordinate planes are exact. Periodic patches are "cyclic" instead.
std::string foam_patch_type(const HybridMesh& mesh, PatchId patch);

/// Returns the header of a text file.
std::string foam_header(std::string_view object, std::string_view object_class, std::string_view location);

}  // namespace sterna::io
