// Fills the space between closed boundaries with tetrahedra, through a common interface to several engines, most of which run in a helper process.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/measured.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/clear_proof.h"
#include "volmesh/case/tetra_options.h"
#include "volmesh/tetra/boundary_splits.h"
#include "volmesh/tetra/boundary_traits.h"

namespace sterna::volmesh {

class SizeField;
class SizeSupply;

/// Closed boundary of the domain. The right-hand normals of its triangles point INTO the domain (on the envelope away from the body, on the farfield inwards).
struct TetraBoundary {
  std::span<const Vec3> points;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const Vec3> hole_points;                   ///< one point strictly inside each cavity that is not meshed
  ClearProof clear = {};                               ///< without a proof fill() tests that triangles meet only in shared vertices and edges
  std::span<const std::string> patch_names = {};       ///< patch names for messages; may be missing
  std::span<const std::uint32_t> triangle_patch = {};  ///< index in patch_names for each triangle; empty without patch_names
  BoundaryTraits traits = {};
  std::span<const double> layer_volumes = {};  ///< m^3, volume of the last prism below each triangle; 0 if there is no prism; may be missing
};

/// Tetrahedra inside a boundary. \post the points of the boundary come first, in order and bit-identical; every boundary triangle is a face of exactly one
/// tetrahedron; every tetrahedron is positive (exact test); there is no other outer face. With splits, all this holds for the split boundary, whose points are
/// the old points and those of the splits, and whose triangles are those of the splits.
struct TetraResult {
  /// Steiner points in the volume; the node number of a point is the number of boundary points (including those of splits) + its index.
  std::vector<Vec3> new_points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< corners in CGNS order, with positive volume
  BoundarySplits splits;                                 ///< splits of the boundary; empty: the boundary is unchanged
  std::string engine;                                    ///< engine that made the tetrahedra: "tetgen", "hxt" or "sterna"
  bool is_two_pass = false;                              ///< sizes came from a coarse mesh
  std::vector<std::string> failures;                     ///< failures of the previous attempts, in order
  bool is_reproducible = true;                           ///< false if a time or memory limit affected the choice of the engine
  Measured engine_seconds;                               ///< time inside the engine alone, for the log only
  Measured engine_peak_bytes;                            ///< peak memory of the helper process, for the log only
};

/// Error of fill() after engines have failed.
class FillError : public Error {
 public:
  FillError(ErrorInfo info, bool is_repeatable, std::vector<std::string> failures)
      : Error(std::move(info)), is_repeatable_(is_repeatable), failures_(std::make_shared<const std::vector<std::string>>(std::move(failures))) {}
  /// Returns true if a repetition with this boundary would fail again, and no time or memory limit was involved.
  bool is_repeatable() const { return is_repeatable_; }
  const std::vector<std::string>& failures() const { return *failures_; }  ///< problems of all attempts, in their order

 private:
  bool is_repeatable_;
  std::shared_ptr<const std::vector<std::string>> failures_;
};

/// Whether engines may split triangles of the boundary. A caller that permits it can apply the splits or reject the result; it does not
/// permit it for boundaries with baffles.
enum class SplitPermission : std::uint8_t { never, permitted };

/// Successive attempts to fill a boundary, until the caller accepts a result. fill() accepts the first result.
class TetraLadder {
 public:
  /// Checks the boundary. `sizes` may be null; the caller keeps it like the data of the boundary.
  /// \throws the errors of fill() for the boundary and the options
  TetraLadder(const TetraBoundary& boundary, SizeSupply* sizes, const TetraOptions& options, SplitPermission splits, const RunContext& context);
  ~TetraLadder();
  TetraLadder(const TetraLadder&) = delete;
  TetraLadder& operator=(const TetraLadder&) = delete;

  /// Returns the proof that the boundary is clear: the given one, or that of the check.
  ClearProof proof() const;
  /// Returns true if the first attempt uses sterna's own engine, which runs on all threads of the caller. The other engines run in a separate process.
  bool begins_here() const;
  /// Returns the next candidate, which is verified. A candidate with splits fills the split boundary.
  /// \throws FillError if no attempt is left
  TetraResult next();
  /// Rejects the latest candidate because the owner of the boundary cannot apply its splits. This counts as a failure of the engine.
  /// \throws `reason` if it is a stop
  void reject(const Error& reason);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs an engine and verifies its result (verify.h). TetGen and HXT run in a helper process, whose executable is searched beside the running executable and
/// one folder above it.
///
/// Engines: "tetgen" is TetGen 1.5 with its radius-edge ratio; "hxt" is HXT of Gmsh; "sterna" is sterna's own engine (own_engine.h), then the others;
/// "automatic" is sterna's own engine if there is a size field and few boundary triangles are slivers, else hxt, or tetgen if hxt is not built in
/// (docs/tetrahedra.md). All engines keep the boundary and make edges of about the length that the size field requires. Without a size field (nullptr),
/// TetGen's sizes follow from the radius-edge ratio, and HXT's sizes from the boundary. Coordinates are first scaled by a power of two, so a mesh in other
/// units is the same mesh.
///
/// The boundary is checked before any engine runs, by exact tests where necessary (preflight.h). Defects that are difficult for engines are logged. If the
/// boundary is known to be clear, these are searched while the first engine runs.
///
/// Sequence of attempts: if the engine fails in a repeatable way (exit code, signal, failed verification, too many new points), the other engine is tried. Then
/// TetGen is tried with permission to split triangles of the boundary that it cannot keep (if `boundary_splits` is "ladder", and the caller of TetraLadder
/// permits splits). The few points on edges that TetGen could not remove after recovering the boundary then count as splits, not as a failed verification. With
/// "always" TetGen comes first, and also splits triangles where this improves tetrahedra. If a time or memory limit of the user is reached, the call ends
/// unless `fall_back_on_limits` is set. If the engine's default limit of processor time is reached, which is proportional to boundary and sizes, the other
/// engine is tried; splits follow only with `fall_back_on_limits`. Every step is logged as a warning and stored in the result.
///
/// For the engines, sheets are a single layer of facets (tetra_baffles.h). The result is separated into both sides, and no engine may split triangles. With
/// `two_pass` TetGen comes first and runs twice. The first run makes a coarse mesh without sizes. The second run uses the smaller of the smoothed sizes at its
/// nodes and the size field. A stop of the context or the time limit kills the helper process immediately; it never outlives the call.
/// \throws FillError if the engines have failed; Error bad_argument (index, coordinate, unused point, repeated or collinear corners), open_surface,
/// non_manifold_surface, self_intersection, not_orientable for the boundary; tetra_engine_missing; tetra_engine_failed (crash, its own error, time or memory
/// limit); tetra_result_invalid; cancelled. Errors contain locations if available. After several failures the error of the first is thrown.
TetraResult fill(const TetraBoundary& boundary, const SizeField* size_field, const TetraOptions& options, const RunContext& context);
/// Fills the boundary. Engines start with the boundary, and wait for the sizes when they need them.
/// \throws also the errors of building the size field
TetraResult fill(const TetraBoundary& boundary, SizeSupply& sizes, const TetraOptions& options, const RunContext& context);

/// Returns one point strictly inside each cavity of a wall, that is, in each connected solid region. (An inverted shell bounds a hole of the solid around it
/// and is no separate solid.) Each point lies behind one of the region's largest triangles, is centred along the axes, and is verified by exact ray crossings.
/// Points are in the order of the regions' first triangles.
/// \pre the wall is closed, manifold and without self-intersection; its normals point out of the body
/// \throws Error(not_orientable) if the region behind a shell is not a bounded solid (normals point into the body, or bodies are nested in bodies)
std::vector<Point> find_cavity_points(const TriMesh& wall, const RunContext& context);

}  // namespace sterna::volmesh
