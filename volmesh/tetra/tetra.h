// Fills the space between closed boundaries with tetrahedra: one door to several engines, each in a helper process.
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
  std::span<const Vec3> hole_points;                   ///< one strictly inside each cavity that is not to be meshed
  bool is_clear = false;                               ///< the caller has proven that the triangles meet in shared vertices and edges only; else fill() does
  std::span<const std::string> patch_names = {};       ///< for messages; may be missing
  std::span<const std::uint32_t> triangle_patch = {};  ///< index into patch_names for each triangle; empty without them
  bool may_split = false;                              ///< engines may split the triangles: whoever asks can follow, or rejects (TetraLadder)
  /// Some triangles lie back to back on others: the two sides of sheets without thickness inside the domain (actuator discs). Their points at the same place
  /// are two, but on a rim that ends free in the domain: there both sides share one, and every triangle has a corner that is not. A rim may also lie on edges
  /// of the rest of the boundary, which has two points at each place there, too. All triangles together are closed and manifold by their indices.
  bool has_sheets = false;
  /// Some of it is the tops of layers on wake sheets: wide, flat and fine, where our own engine's refinement may get stuck.
  bool has_wakes = false;
  std::span<const double> layer_volumes = {};  ///< of the last prism under each triangle, m^3; 0 where there is none; may be missing
};

/// \post points of the boundary come first, in order, to the bit; every boundary triangle is a face of exactly one tet; every tet positive (exact);
/// no other outer face. With splits all that holds for the boundary as split: its points are the old ones and those of the splits, its triangles theirs.
struct TetraResult {
  std::vector<Vec3> new_points;                          ///< Steiner points in the volume; node number = n boundary points (with those of splits) + index
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< CGNS order, positive volume
  BoundarySplits splits;                                 ///< empty: the boundary is as it was
  std::string engine;                                    ///< what made them: "tetgen", "hxt" or "sterna"
  bool is_two_pass = false;                              ///< a coarse mesh gave the sizes
  std::vector<std::string> failures;                     ///< of the attempts before, in order
  bool is_reproducible = true;                           ///< false when a time or memory limit decided which engine made them
  double engine_seconds = 0.0;                           ///< inside the engine alone; log only
  double engine_peak_bytes = 0.0;                        ///< of the helper process; log only
};

/// What fill() throws when engines have failed.
class FillError : public Error {
 public:
  FillError(ErrorInfo info, bool is_repeatable, std::vector<std::string> failures)
      : Error(std::move(info)), is_repeatable_(is_repeatable), failures_(std::make_shared<const std::vector<std::string>>(std::move(failures))) {}
  /// It would fail again on this boundary, and no time or memory limit had a part in it.
  bool is_repeatable() const { return is_repeatable_; }
  const std::vector<std::string>& failures() const { return *failures_; }  ///< problems of all attempts, in order

 private:
  bool is_repeatable_;
  std::shared_ptr<const std::vector<std::string>> failures_;
};

/// The attempts at filling a boundary, one after the other, until the caller takes one: see fill(), which takes the first.
class TetraLadder {
 public:
  /// Checks the boundary. The arguments must outlive it; `sizes` may be null.
  /// \throws as fill() for the boundary and options
  TetraLadder(const TetraBoundary& boundary, SizeSupply* sizes, const TetraOptions& options, const RunContext& context);
  ~TetraLadder();
  TetraLadder(const TetraLadder&) = delete;
  TetraLadder& operator=(const TetraLadder&) = delete;

  /// Whether the first attempt is our own engine's, which takes all threads of the caller; the others run in a process of their own.
  bool begins_here() const;
  /// The next candidate, proven. One with splits fills the boundary as split.
  /// \throws FillError when no attempt is left
  TetraResult next();
  /// The latest candidate is of no use, because the boundary's owner cannot follow its splits: a failure as an engine's own.
  /// \throws `reason` if it is a stop
  void reject(const Error& reason);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs an engine in its helper process, found beside the running executable or one folder above it, and proves its answer (verify.h). Engines: "tetgen",
/// TetGen 1.5 with its radius-edge ratio; "hxt", HXT of Gmsh; "sterna", our own (own_engine.h), then the others; "automatic" is hxt, or tetgen where hxt is not
/// built in (docs/tetrahedra.md). All keep the boundary and make edges of about the length that the size field asks for; without one (nullptr) TetGen's sizes
/// follow from the radius-edge ratio, HXT's from the boundary. Coordinates are scaled by a power of two first, so a mesh in other units is the same mesh.
/// Before any engine runs, the boundary is checked, exactly where it must be (preflight.h); what engines find hard is logged. Of a clear boundary that is
/// looked for while the first engine runs. Ladder: when the engine fails in a way that it will repeat (exit code, signal, failed proof, too many new points),
/// the other engine is tried, then TetGen with leave to split triangles of the boundary where it cannot keep them (`boundary_splits` "ladder", and a boundary
/// that may be split: then the few points on edges that TetGen could not take back while it recovered the boundary are splits, too, not a failed proof). With
/// "always" TetGen comes first and splits them where tetrahedra become better by it, too. A time or memory limit of the user ends the call unless
/// `fall_back_on_limits`; after the engine's own limit of processor time, which is in proportion to boundary and sizes, the other engine is tried, but no
/// splits. Every step is logged as a warning and kept in the result. Sheets are one layer of facets for the engines (sheets.h); what comes back is parted. No
/// engine may split triangles then. With `two_pass` TetGen comes first and runs twice: a coarse mesh without sizes, then the mesh with the smoothed sizes at
/// its nodes and the size field, the smaller ones. A stop of the context or the time limit kills the helper at once; it never outlives the call.
/// \throws FillError when the engines have failed; Error bad_argument (index, coordinate, unused point, repeated or collinear corners), open_surface,
/// non_manifold_surface, self_intersection, not_orientable for the boundary; tetra_engine_missing; tetra_engine_failed (crash, its own error, time or memory
/// limit); tetra_result_invalid; cancelled. Each with places where there are any; of several failures the first.
/// \pre !boundary.may_split: nobody would follow.
TetraResult fill(const TetraBoundary& boundary, const SizeField* size_field, const TetraOptions& options, const RunContext& context);
/// Engines begin with the boundary and wait for the sizes when they need them.
/// \throws what the making of the size field throws, too.
TetraResult fill(const TetraBoundary& boundary, SizeSupply& sizes, const TetraOptions& options, const RunContext& context);

/// One point strictly inside each cavity of a wall, that is in each connected solid region (a shell inside out bounds a hole of the solid around it, not a
/// solid of its own): behind one of its largest triangles, centred along the axes, proven by exact ray crossings. In order of first triangle.
/// \pre wall closed, manifold, without self-intersection, normals out of the body.
/// \throws Error(not_orientable) when the region behind a shell is not a bounded solid (normals into the body, or bodies nested in bodies).
std::vector<Point> find_cavity_points(const TriMesh& wall, const RunContext& context);

}  // namespace sterna::volmesh
