// Predicts the preparation that a surface needs before meshing (repair, wrap or remesh), with reason and expected time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "scripting/values/option_json.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/verbs.h"
#include "volmesh/inspect/inspect.h"

namespace sterna::scripting {

enum class Strength : std::uint8_t {
  none,    ///< the surface is meshed unchanged
  repair,  ///< open or crossing parts must be repaired
  wrap,    ///< the surface must be replaced by a closed surface around it
  remesh,  ///< the surface is sound, but needs new triangles, because its triangles make cells fail
  beyond   ///< none of the three helps
};
/// Returns "none", "repair", "wrap", "remesh", "beyond".
std::string_view to_string(Strength strength);

struct Preparation {
  Strength needed = Strength::none;
  bool is_model = false;           ///< the file is a model: its faces are meshed first
  bool is_triangulated = false;    ///< the triangles of a model are used without the model, because its faces cross, fold or are open
  bool is_remesh_advised = false;  ///< new triangles are advised, also after repair
  std::string reason;              ///< one sentence, with counts
  std::optional<Point> location;   ///< m; location of the first defect
  std::string command;             ///< command for the preparation; empty: nothing to do
  std::string script;              ///< the same command in Lua
  std::string hint;                ///< further settings to make; may be empty
  double seconds = 0.0;            ///< seconds of one thread for all preparation of the surface; 0 for `none`
  std::string basis;               ///< origin of the seconds: the counted quantities, and the margin of error
  bool is_changed = false;         ///< repair changes the surface; false if half a model only has to be recognised as such
  surfmesh::RepairForecast forecast;
  std::int64_t n_slivers = 0;  ///< triangles with a corner below sliver_limit
  double needle_share = 0.0;
  double sliver_limit = 0.0;  ///< rad
};

/// Predicts the actions of --auto on these soups (in units of options.stitching.unit), by the same steps as far as these are quick (surfmesh::foresee_repair).
/// `report` is the inspection of the same surface: its errors decide if repair is needed, and its triangles give the number of slivers. `inputs` are the names
/// of the files, for the command line. \throws Error(cancelled)
Preparation foresee_preparation(const std::vector<SurfaceSoup>& soups, const volmesh::InspectReport& report, const AutoSurface& options, double sliver_limit,
                                std::span<const std::string> inputs, bool must_close, const RunContext& context);

/// Completes the prediction for a model whose surface was inspected, because --auto applies the steps to the triangles of that surface. `changes`: changes that
/// were already made, for example a union of solids.
void complete_for_model(Preparation& preparation, std::int64_t n_triangles, std::span<const std::string> changes, std::span<const std::string> inputs);

/// Returns several human-readable lines, each indented by two blanks.
std::string text_of(const Preparation& preparation);
/// Returns an object for the JSON of the inspection.
nlohmann::json json_of(const Preparation& preparation);

}  // namespace sterna::scripting
