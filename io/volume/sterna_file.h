// The native container .sterna. It stores the data of a run, complete or in part, so that they can be read back and the run continued. The layout is in
// docs/sterna_format.md.
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

/// The envelope of a surface, per vertex (volmesh::Envelope).
struct StoredEnvelope {
  Column<VertexId, Vec3> direction;       ///< unit growth direction
  Column<VertexId, double> height;        ///< m along the direction; 0 = collapsed
  Column<VertexId, double> target;        ///< m, target height
  Column<VertexId, double> eq1;           ///< m, height by eq. (1) without caps
  Column<VertexId, double> cap;           ///< m, largest height allowed by the stages so far
  Column<VertexId, std::uint8_t> limit;   ///< number of volmesh::HeightLimit
  std::vector<double> first_height = {};  ///< m, if requested as a field: one value per vertex of the surface; else empty
};

/// Result of a tetrahedral engine inside closed boundaries (volmesh::TetraResult). The points of the result itself are numbered after the boundary points.
struct StoredTetrahedra {
  std::uint64_t n_boundary_points = 0;
  std::vector<Vec3> new_points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  /// Nodes of the mesh's layers that improvement has moved since the tetrahedra were generated, ascending.
  std::vector<std::uint32_t> moved_nodes;
  std::vector<Vec3> moved_points;  ///< m, coordinates of these nodes when the tetrahedra were generated
};

/// Parts to write; parts that are nullptr or empty are left out. The strings are JSON.
struct SternaParts {
  const TriMesh* surface = nullptr;
  const TriMesh* farfield = nullptr;         ///< the user's surface that bounds the fluid
  const StoredEnvelope* envelope = nullptr;  ///< envelope of `surface`
  const StoredTetrahedra* tetrahedra = nullptr;
  const HybridMesh* mesh = nullptr;    ///< its layers are kept as columns
  const HybridMesh* opened = nullptr;  ///< the layer around which `tetrahedra` were generated, if `mesh` has converted its columns to explicit cells
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

  /// Returns "surface, mesh, manifest", or "nothing".
  std::string names() const;
};

/// Writes the parts. Packs chunks in parallel and streams them, which takes less than 200 MB in addition to the parts. The bytes do not depend on the number of
/// threads.
/// \throws Error mesh_invalid (columns whose lengths differ from their mesh, coordinates that are not finite), write_failed, cancelled
void write_sterna(const SternaParts& parts, const std::filesystem::path& path, const RunContext& context);

/// Reads all parts, bit by bit identical. Every chunk is compared with its hash and every number with its range, so that no further index checks are needed.
/// \throws Error file_malformed (byte offset), unsupported_format (a later version), file_not_found
SternaContent read_sterna(const std::filesystem::path& path, const RunContext& context);

/// Reads the mesh of such a file, with its columns. A file with a surface but no mesh gives a mesh without cells, as in other formats.
/// \throws as read_sterna(); file_malformed if it has neither, with its contents listed
HybridMesh read_volume_sterna(const std::filesystem::path& path, const RunContext& context);
/// Reads the surface, or else the boundary of the mesh.
SurfaceSoup read_surface_sterna(const std::filesystem::path& path, const RunContext& context);
void write_volume_sterna(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_surface_sterna(const TriMesh& surface, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
