#include "scripting/interpreter/script_run.h"

#include "geom/base/error.h"
#include "scripting/interpreter/declared_arguments.h"
#include "scripting/interpreter/script_state.h"
#include "scripting/lua/script_check.h"

namespace sterna::scripting {

ScriptOutcome run_script(const ScriptSettings& settings, const RunContext& context) {
  ScriptState state(settings, context);
  SeriesSession& series = state.session().series;
  series.script_text = read_script(settings.script);
  state.run(series.script_text, "@" + settings.script.string());
  if (series.is_case_over) return {.n_failed_cases = series.is_case_done ? 0u : 1u};
  refuse_unknown_arguments(state.session(), true);
  if (settings.series.worker)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = settings.script.string(),
                 .problem = "the script has no series \"" + settings.series.worker->series + "\""});
  return {.n_failed_cases = series.n_failed, .n_invalid_cases = series.n_invalid};
}

void check_script(const ScriptSettings& settings, ScriptCheck& check, const RunContext& context) {
  ScriptSettings checking = settings;
  checking.check = &check;
  try {
    run_script(checking, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    ErrorInfo info = error.info();
    if (error.code() == ErrorCode::script_failed) info.hint += (info.hint.empty() ? "" : "; ") + std::string("the script was not checked after this line");
    check.problems.push_back(std::make_shared<const Error>(std::move(info)));
  }
}

}  // namespace sterna::scripting
