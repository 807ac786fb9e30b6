// Inside geom/cad only: every use of OpenCASCADE that may fail runs in here, so that its exceptions become Errors, its messages stay off the terminal,
// and a stop or a time limit reaches it.
#pragma once

#include <functional>
#include <string>

#include "geom/base/run_context.h"

class Message_ProgressRange;

namespace sterna::cad {

struct OcctTask {
  std::string attempted;    ///< "reading wing.step"
  double time_limit = 0.0;  ///< seconds; 0: none
  std::string hint = {};
};

/// Runs `work` and translates what it throws. One call at a time in the whole process: translators and the messenger of OpenCASCADE are global.
/// OpenCASCADE asks for a stop only where it reports progress; `work` calls context.check_stop() between its steps.
/// \throws Error(geometry_failed) with OpenCASCADE's own words, Error(cancelled) on a stop, Error(geometry_failed) past the time limit.
void run_occt(const OcctTask& task, const RunContext& context, const std::function<void(const Message_ProgressRange&)>& work);

}  // namespace sterna::cad
