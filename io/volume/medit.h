// Medit .mesh (text) and GMF .meshb (binary, versions 1 to 4), docs/method/formats_surfaces.md, "Medit": surface and volume meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Section of the format. A row consists of nodes (from 1) and a reference number; in Vertices, of coordinates and the number.
struct MeditSection {
  std::string_view keyword;
  std::int32_t code;
  std::size_t n_nodes;
};
inline constexpr MeditSection k_medit_vertices = {"Vertices", 4, 0};
inline constexpr MeditSection k_medit_triangles = {"Triangles", 6, 3};
inline constexpr MeditSection k_medit_quads = {"Quadrilaterals", 7, 4};
/// Volume cell sections in the order of writing.
inline constexpr MeditSection k_medit_tetrahedra = {"Tetrahedra", 8, 4};
inline constexpr MeditSection k_medit_prisms = {"Prisms", 9, 6};
inline constexpr MeditSection k_medit_pyramids = {"Pyramids", 49, 5};
inline constexpr MeditSection k_medit_hexahedra = {"Hexahedra", 10, 8};
inline constexpr std::int32_t k_medit_dimension = 3;  ///< code of the section
inline constexpr std::int32_t k_medit_end = 54;

/// Reads text or binary, detected from the content. Patches are the reference numbers of triangles and quads, in order of appearance; names and kinds come from
/// x.names beside the mesh, else "patch_<number>". Other sections (corners, ridges, normals) are ignored. Cells with the wrong winding are flipped, boundary
/// faces turned outwards.
/// \throws Error file_malformed (line or byte), unsupported_format (two dimensions, elements of higher order), file_not_found
HybridMesh read_volume_medit(const std::filesystem::path& path, const RunContext& context);

/// Reads the triangles and quads of such a file unchanged.
SurfaceSoup read_surface_medit(const std::filesystem::path& path, const RunContext& context);

/// Writes x.mesh as text; x.meshb in the lowest version that can hold the mesh (2: below 2 GiB; 3: 64-bit offsets; 4: 64-bit numbers); x.v2.meshb, x.v3.meshb,
/// x.v4.meshb in the named version; and x.names. Patches are numbered from 1, the fluid is 1. Streams: below 100 MB in addition to the mesh.
/// \throws Error overflow, mesh_invalid, write_failed, cancelled
void write_volume_medit(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_surface_medit(const TriMesh& surface, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
