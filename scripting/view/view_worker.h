// The process of the workbench in which scripts run. A crash or a stop of this process does not affect the page.
//
// Jobs are lines of JSON on stdin; answers are lines of JSON on a descriptor. "bytes": n in an answer means that n bytes follow its line.
//   {"do": "run", "run": 3, "mode": "sketch" | "geometry" | "mesh", "arguments": {"span": "11"}, "wanted": ["model"], "unwanted": [], "kept": []}
//     -> parameters, log, print, progress, objects, scene ..., ended
//   {"do": "scene", "run": 3, "id": 2}                  an object of that run   -> scene, or failed
//   {"do": "cut", "run": 3, "id": 2, "plane": "x=1.2", "ask": 7}                -> asked, or failed
//   {"do": "inspect", "run": 3, "id": 2, "ask": 8}                              -> asked, or failed
// A sketch does not unite solids and shows shapes only. The mode "geometry" makes models and reads surfaces, without meshing or writing anything. The mode
// "mesh" runs the script as in `sterna run`.
#pragma once

#include <filesystem>

#include "scripting/cache/stage_cache.h"
#include "scripting/command/command_context.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// Descriptor to which answers are written.
inline constexpr int k_view_answers = 4;

struct ViewWorker {
  std::filesystem::path script;
  OptionOverrides overrides;
  const StageCache* cache = nullptr;
};

/// Answers jobs until stdin ends; stopping a job (SIGTERM) ends the process. Returns the exit status.
int run_view_worker(const ViewWorker& worker, const CommandContext& context);

}  // namespace sterna::scripting
