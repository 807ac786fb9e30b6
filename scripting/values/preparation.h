// What a surface needs before it can be meshed, foreseen: which of repair, wrap and remesh, why, and how long that takes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/verbs.h"
#include "volmesh/inspect/inspect.h"

namespace sterna::scripting {

enum class Strength : std::uint8_t {
  none,    ///< it is meshed as it is
  repair,  ///< what is torn or crosses is mended
  wrap,    ///< a closed surface around it
  remesh,  ///< it is sound, but its triangles make cells fail
  beyond   ///< none of the three helps
};
/// "none", "repair", "wrap", "remesh", "beyond"
std::string_view to_string(Strength strength);

struct Preparation {
  Strength needed = Strength::none;
  bool is_model = false;           ///< the file is a model: its faces are meshed first
  bool is_triangulated = false;    ///< a model whose triangles go on without it, because its faces cross, fold or are open
  bool is_remesh_advised = false;  ///< also after repair
  std::string reason;              ///< one sentence, with counts
  std::optional<Point> place;      ///< m; the first of what is wrong
  std::string command;             ///< that does it; empty: nothing to do
  std::string script;              ///< the same in Lua
  std::string hint;                ///< what else to set; may be empty
  double seconds = 0.0;            ///< of all that is done to the surface, one thread; of `none`: 0
  std::string basis;               ///< of the seconds: what was counted, and how far they are off
  bool is_changed = false;         ///< whether repair changes anything: half a model may only have to be recognised
  surfmesh::RepairForecast forecast;
  std::int64_t n_needles = 0;  ///< triangles with a corner below needle_limit
  double needle_share = 0.0;
  double needle_limit = 0.0;  ///< rad
};

/// What --auto would do to these soups (in units of options.stitching.unit), by the same steps as far as they are quick (surfmesh::foresee_repair). `report` is
/// the inspection of the same surface: what it calls an error decides whether anything is torn, its triangles how many needles there are. `inputs` are the
/// names of the files, for the command line. \throws Error(cancelled)
Preparation foresee_preparation(const std::vector<SurfaceSoup>& soups, const volmesh::InspectReport& report, const AutoSurface& options, double needle_limit,
                                std::span<const std::string> inputs, bool must_close, const RunContext& context);

/// Of a model whose surface was looked at: what that needs is done to its triangles by --auto. `changes`: what was done already, a union of solids for example.
void complete_for_model(Preparation& preparation, std::int64_t n_triangles, std::span<const std::string> changes, std::span<const std::string> inputs);

/// Several lines for people, each with two blanks before it.
std::string text_of(const Preparation& preparation);
/// An object for the JSON of the inspection.
std::string json_of(const Preparation& preparation);

}  // namespace sterna::scripting
