// Inside geom/cad only: runs all OpenCASCADE calls that may fail, converts their exceptions to Errors, keeps their messages off the terminal, and applies stop
// requests and time limits.
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

/// Runs `work` and translates its exceptions. One call at a time in the whole process, because translators and the messenger of OpenCASCADE are global.
/// OpenCASCADE checks for a stop only where it reports progress; `work` calls context.check_stop() between its steps.
/// \throws Error(geometry_failed) with OpenCASCADE's message, Error(cancelled) on a stop, Error(geometry_failed) past the time limit.
void run_occt(const OcctTask& task, const RunContext& context, const std::function<void(const Message_ProgressRange&)>& work);

}  // namespace sterna::cad
