// One run of one engine: sends the request, runs the helper process, receives the reply, and verifies the result.
#pragma once

#include <optional>
#include <string_view>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/tetra/boundary_parts.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/tetra/tetra_baffles.h"
#include "volmesh/tetra/wire.h"

namespace sterna::volmesh {

enum class EngineKind { tetgen, hxt, sterna };
/// Returns "tetgen", "hxt" or "sterna", the values of TetraOptions::engine.
std::string_view to_string(EngineKind kind);
/// Returns "TetGen", "HXT" or "built-in engine", for messages.
std::string_view display_name(EngineKind kind);

enum class FailureKind {
  missing,        ///< the engine is not included in the build, or its helper cannot be started
  deterministic,  ///< a repetition would also fail: exit code, signal, failed verification, too many points
  limit,          ///< time or memory limit, or the process was killed from outside: the result may differ on another machine or at another time
};

struct EngineFailure {
  FailureKind kind = FailureKind::deterministic;
  ErrorInfo error;
  bool is_own_limit = false;  ///< the time limit was the default, which is proportional to the boundary and the size field, and not given by the user
};

/// Permission of an engine to split triangles of the boundary.
using SplitMode = wire::Splits;

/// Either a verified result or a failure.
struct EngineOutcome {
  std::optional<TetraResult> result;
  EngineFailure failure;
  /// Fraction of tetrahedra that are flat and lie over many boundary triangles, because refinement could not separate these triangles.
  double stuck_share = 0.0;
};

/// Input of an engine. `parts` belong to the boundary, or to the joined boundary if there is one. Sizes may be missing.
struct EngineInput {
  const TetraBoundary& boundary;
  const BoundaryParts& parts;
  SizeSupply* sizes = nullptr;
  SplitMode splits = SplitMode::none;
  const JoinedBoundary* joined = nullptr;  ///< for a boundary with sheets: the joined boundary, which the engine receives in place of the boundary
  bool is_recovery_only = false;           ///< TetGen and HXT then insert only points that the boundary recovery needs; the result is not verified
};

/// Runs an engine. \pre check_boundary() has passed; splits are allowed only for TetGen, and not with sheets
/// \post the result is verified; a result with splits is verified for the split boundary
/// \throws Error(cancelled) if the context is stopped (the helper process has then ended); Error(tetra_engine_failed) if the system has no memory for the
/// request
EngineOutcome run_engine(EngineKind kind, const EngineInput& input, const TetraOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
