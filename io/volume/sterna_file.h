// The native container .sterna: what a run holds, whole or in part, so that it can be read back and continued. Layout in docs/sterna_format.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// The envelope of a surface, vertex by vertex (volmesh::Envelope).
struct StoredEnvelope {
  Column<VertexId, Vec3> direction;       ///< unit growth direction
  Column<VertexId, double> height;        ///< m along it; 0 = collapsed
  Column<VertexId, double> target;        ///< m
  Column<VertexId, double> eq1;           ///< m
  Column<VertexId, double> cap;           ///< m
  Column<VertexId, std::uint8_t> limit;   ///< number of volmesh::HeightLimit
  std::vector<double> first_height = {};  ///< m, where it was asked for by place: one for each vertex of the surface; else empty
};

/// What an engine made between closed boundaries (volmesh::TetraResult): its own points, numbered behind those of the boundary.
struct StoredTetrahedra {
  std::uint64_t n_boundary_points = 0;
  std::vector<Vec3> new_points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  /// Nodes of the mesh's layers that were elsewhere when the tetrahedra were made, ascending, and where: improvement has moved them since.
  std::vector<std::uint32_t> moved_nodes;
  std::vector<Vec3> moved_points;  ///< m
};

/// Parts to write; those that are nullptr or empty are left out. The texts are JSON.
struct SternaParts {
  const TriMesh* surface = nullptr;
  const TriMesh* farfield = nullptr;         ///< the surface that the user gave to end the fluid
  const StoredEnvelope* envelope = nullptr;  ///< of `surface`
  const StoredTetrahedra* tetrahedra = nullptr;
  const HybridMesh* mesh = nullptr;    ///< its layers stay columns
  const HybridMesh* opened = nullptr;  ///< the layer around which `tetrahedra` were made, where `mesh` has made explicit cells of its columns
  std::string_view manifest = {};      ///< options
  std::string_view certificate = {};
  std::string_view quality = {};
};

struct SternaContent {
  std::optional<TriMesh> surface;
  std::optional<TriMesh> farfield;
  std::optional<StoredEnvelope> envelope;
  std::optional<StoredTetrahedra> tetrahedra;
  std::optional<HybridMesh> mesh, opened;
  std::string manifest, certificate, quality;

  /// "surface, mesh, manifest", or "nothing".
  std::string names() const;
};

/// Writes the parts. Streams in chunks that all threads pack: below 200 MB beside them. The same bytes for any number of threads.
/// \throws Error mesh_invalid (columns of other lengths than their mesh, coordinates that are not finite), write_failed, cancelled
void write_sterna(const SternaParts& parts, const std::filesystem::path& path, const RunContext& context);

/// Reads everything, to the bit. Every chunk is compared with its hash, every number with its range: what comes back can be used without further checks of
/// indices.
/// \throws Error file_malformed (byte offset), unsupported_format (a later version), file_not_found
SternaContent read_sterna(const std::filesystem::path& path, const RunContext& context);

/// The mesh of such a file, with its columns; of one that holds a surface and nothing made of it a mesh without cells, as of other formats.
/// \throws as read_sterna(); file_malformed when it holds neither, with what it holds
HybridMesh read_volume_sterna(const std::filesystem::path& path, const RunContext& context);
/// Its surface, or else the boundary of its mesh.
SurfaceSoup read_surface_sterna(const std::filesystem::path& path, const RunContext& context);
void write_volume_sterna(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_surface_sterna(const TriMesh& surface, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
