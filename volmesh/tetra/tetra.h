// Fills the space between closed boundaries with tetrahedra: a common interface to several engines, each in a helper process.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/tetra_options.h"
#include "volmesh/tetra/boundary_splits.h"

namespace sterna::volmesh {

class SizeField;
class SizeSupply;

/// Closed boundary of the domain: triangles whose right-hand normals point INTO the domain (envelope outwards of the body, farfield inwards).
struct TetraBoundary {
  std::span<const Vec3> points;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const Vec3> hole_points;  ///< one strictly inside each cavity that is not meshed
  bool is_clear = false;              ///< the caller has verified that the triangles meet in shared vertices and edges only; otherwise fill() checks this
  std::span<const std::string> patch_names = {};       ///< for messages; may be missing
  std::span<const std::uint32_t> triangle_patch = {};  ///< index into patch_names for each triangle; empty without patch_names
  bool may_split = false;  ///< engines may split the triangles: the caller can apply the splits, or rejects the result (TetraLadder)
  /// Some triangles lie back to back: they are the two sides of sheets without thickness inside the domain (actuator discs). Their points are doubled at each
  /// location, except on boundary edges of the sheet that end free in the domain: there both sides share one point, and every triangle has a corner that is not
  /// shared. Boundary edges of a sheet may also lie on edges of the rest of the boundary, which has two points at each location there, too. All triangles
  /// together are closed and manifold by their indices.
  bool has_sheets = false;
  /// Parts of the boundary are tops of layers on wake sheets: wide, flat and fine, where refinement by sterna's own engine may get stuck.
  bool has_wakes = false;
  std::span<const double> layer_volumes = {};  ///< volume of the last prism under each triangle, m^3; 0 without a prism; may be missing
};

/// Tetrahedra inside a boundary. \post points of the boundary come first, in order, bit-identical; every boundary triangle is a face of exactly one tet; every
/// tet positive (exact); no other outer face. With splits, all that holds for the split boundary: its points are the old points and those of the splits, its
/// triangles those of the splits.
struct TetraResult {
  std::vector<Vec3> new_points;                          ///< Steiner points in the volume; node number = n boundary points (with those of splits) + index
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< CGNS order, positive volume
  BoundarySplits splits;                                 ///< empty: the boundary is unchanged
  std::string engine;                                    ///< engine that made them: "tetgen", "hxt" or "sterna"
  bool is_two_pass = false;                              ///< a coarse mesh supplied the sizes
  std::vector<std::string> failures;                     ///< failures of the previous attempts, in order
  bool is_reproducible = true;                           ///< false if a time or memory limit affected the choice of the engine
  double engine_seconds = 0.0;                           ///< time inside the engine alone; log only
  double engine_peak_bytes = 0.0;                        ///< peak memory of the helper process; log only
};

/// Error of fill() after engines have failed.
class FillError : public Error {
 public:
  FillError(ErrorInfo info, bool is_repeatable, std::vector<std::string> failures)
      : Error(std::move(info)), is_repeatable_(is_repeatable), failures_(std::make_shared<const std::vector<std::string>>(std::move(failures))) {}
  /// Returns true if a repetition on this boundary would fail again, and no time or memory limit was involved.
  bool is_repeatable() const { return is_repeatable_; }
  const std::vector<std::string>& failures() const { return *failures_; }  ///< problems of all attempts, in order

 private:
  bool is_repeatable_;
  std::shared_ptr<const std::vector<std::string>> failures_;
};

/// Successive attempts at filling a boundary, until the caller accepts one; fill() accepts the first.
class TetraLadder {
 public:
  /// Checks the boundary. The arguments must outlive it; `sizes` may be null.
  /// \throws as fill() for the boundary and options
  TetraLadder(const TetraBoundary& boundary, SizeSupply* sizes, const TetraOptions& options, const RunContext& context);
  ~TetraLadder();
  TetraLadder(const TetraLadder&) = delete;
  TetraLadder& operator=(const TetraLadder&) = delete;

  /// Returns true if the first attempt uses sterna's own engine, which runs on all threads of the caller; the others run in a separate process.
  bool begins_here() const;
  /// Returns the next candidate, verified. A candidate with splits fills the boundary as split.
  /// \throws FillError if no attempt is left
  TetraResult next();
  /// Rejects the latest candidate because the boundary's owner cannot apply its splits: counts as a failure of the engine.
  /// \throws `reason` if it is a stop
  void reject(const Error& reason);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs an engine in its helper process, found beside the running executable or one folder above it, and verifies its result (verify.h).
///
/// Engines: "tetgen", TetGen 1.5 with its radius-edge ratio; "hxt", HXT of Gmsh; "sterna", sterna's own engine (own_engine.h), then the others; "automatic" is
/// sterna's own engine where there is a size field and few boundary triangles are slivers, else hxt, or tetgen if hxt is not built in (docs/tetrahedra.md). All
/// keep the boundary and make edges of about the length that the size field requires. Without a size field (nullptr), TetGen's sizes follow from the
/// radius-edge ratio, HXT's from the boundary. Coordinates are first scaled by a power of two, so a mesh in other units is the same mesh.
///
/// Before any engine runs, the boundary is checked, exactly where necessary (preflight.h); defects that are difficult for engines are logged. For a clear
/// boundary, these are searched while the first engine runs.
///
/// Ladder: if the engine fails in a repeatable way (exit code, signal, failed verification, too many new points), the other engine is tried. TetGen follows
/// with permission to split triangles of the boundary that it cannot keep (`boundary_splits` "ladder", and a boundary that may be split). The few points on
/// edges that TetGen could not remove after recovering the boundary then count as splits, not as a failed verification. With "always" TetGen comes first and
/// also splits triangles where this improves tetrahedra. A user's time or memory limit ends the call unless `fall_back_on_limits` is set. After the engine's
/// default limit of processor time, which is proportional to boundary and sizes, the other engine is tried, and splits only with `fall_back_on_limits`. Every
/// step is logged as a warning and kept in the result.
///
/// Sheets are one layer of facets for the engines (sheets.h); the result is separated into both sides. No engine may split triangles then. With `two_pass`
/// TetGen comes first and runs twice: a coarse mesh without sizes, then the mesh with the smaller of the smoothed sizes at its nodes and the size field. A stop
/// of the context or the time limit kills the helper at once; it never outlives the call.
/// \throws FillError if the engines have failed; Error bad_argument (index, coordinate, unused point, repeated or collinear corners), open_surface,
/// non_manifold_surface, self_intersection, not_orientable for the boundary; tetra_engine_missing; tetra_engine_failed (crash, its own error, time or memory
/// limit); tetra_result_invalid; cancelled. Each with locations if available; of several failures the first.
/// \pre !boundary.may_split: no caller could apply the splits.
TetraResult fill(const TetraBoundary& boundary, const SizeField* size_field, const TetraOptions& options, const RunContext& context);
/// Fills the boundary; engines start with the boundary and wait for the sizes when they need them.
/// \throws also the errors of building the size field.
TetraResult fill(const TetraBoundary& boundary, SizeSupply& sizes, const TetraOptions& options, const RunContext& context);

/// Returns one point strictly inside each cavity of a wall, that is, in each connected solid region (an inverted shell bounds a hole of the solid around it and
/// is no separate solid). Each point lies behind one of the region's largest triangles, centred along the axes, verified by exact ray crossings. In order of
/// first triangle.
/// \pre wall closed, manifold, without self-intersection, normals out of the body.
/// \throws Error(not_orientable) if the region behind a shell is not a bounded solid (normals into the body, or bodies nested in bodies).
std::vector<Point> find_cavity_points(const TriMesh& wall, const RunContext& context);

}  // namespace sterna::volmesh
