// One run of one engine: request out, helper run, reply in, answer proven.
#pragma once

#include <optional>
#include <string_view>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/tetra/boundary_parts.h"
#include "volmesh/tetra/sheets.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/tetra/wire.h"

namespace sterna::volmesh {

enum class EngineKind { tetgen, hxt, sterna };
/// "tetgen", "hxt" or "sterna", as in TetraOptions::engine.
std::string_view to_string(EngineKind kind);
/// "TetGen", "HXT" or "our own engine", for messages.
std::string_view display_name(EngineKind kind);

enum class FailureKind {
  missing,        ///< the engine is not built in, or its helper cannot be started
  deterministic,  ///< it will fail again: exit code, signal, failed verification, too many points
  limit,          ///< time or memory limit, or killed from outside: another machine or day may see another end
};

struct EngineFailure {
  FailureKind kind = FailureKind::deterministic;
  ErrorInfo error;
  bool is_own_limit = false;  ///< the limit of time was ours, in proportion to the boundary and the size field, not the user's
};

/// Whether an engine may split triangles of the boundary.
using SplitMode = wire::Splits;

/// Either a verified result or a failure.
struct EngineOutcome {
  std::optional<TetraResult> result;
  EngineFailure failure;
  double stuck_share = 0.0;  ///< of the result's tetrahedra: flat ones that lie over many triangles of the boundary, because refinement could not part them
};

/// What an engine gets. `parts` are those of the boundary, or of the joined one; there may be no sizes.
struct EngineInput {
  const TetraBoundary& boundary;
  const BoundaryParts& parts;
  SizeSupply* sizes = nullptr;
  SplitMode splits = SplitMode::none;
  const JoinedBoundary* joined = nullptr;  ///< of a boundary with sheets: the engine gets this one
  bool is_recovery_only = false;           ///< TetGen and HXT put no points into the volume but those that the boundary needs; no proof then
};

/// \pre check_boundary() passed; splits with TetGen only, and without sheets.
/// \post the result is proven, with splits for the boundary as split.
/// \throws Error(cancelled) on a stop of the context (the helper is gone by then); Error(tetra_engine_failed) when the system has no memory for the request.
EngineOutcome run_engine(EngineKind kind, const EngineInput& input, const TetraOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
