#include "scripting/series/case_worker.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "geom/base/error.h"
#include "geom/mesh/check.h"
#include "io/field/trouble_vtu.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/script_function.h"
#include "scripting/series/case_status.h"
#include "scripting/values/kept_reference.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_json.h"

namespace sterna::scripting {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Data of a mesh that a case made.
struct MeshNote {
  MeshFigures figures;
  std::string check_json;  ///< empty if the mesh was never checked
};

MeshNote note_of(const MeshValue& mesh) {
  MeshNote note;
  note.figures.cells = count_cells(mesh.mesh).total();
  note.figures.verdict = "not checked";
  if (!mesh.check) return note;
  note.figures.verdict = mesh.check->is_valid() ? "VALID" : "INVALID";
  if (mesh.check->quality_measured) {
    note.figures.quality = worst_gates_text(*mesh.check) + verdict_line(*mesh.check).substr(note.figures.verdict.size());
    note.figures.worst = worst_quality_text(*mesh.check);
  }
  note.check_json = to_json(*mesh.check);
  return note;
}

/// Copies the script as read in this run, with its modules.
void copy_script(const ScriptSession& session, const fs::path& folder) {
  fs::create_directories(folder / "script");
  io::write_whole(folder / "script" / session.script.filename(), session.series.script_text);
  for (const auto& [name, source] : session.series.modules) io::write_whole(folder / "script" / (name + ".lua"), source);
}

/// Writes all data that differ between two runs of the same case.
void write_measure(const ScriptSession& session, double seconds, const fs::path& folder) {
  nlohmann::ordered_json json = {{"schema", "sterna-case-measure-1"},
                                 {"seconds", seconds},
                                 {"threads", session.context.threads()},
                                 {"host", host_name()},
                                 {"peak_memory_bytes", peak_memory_bytes()}};
  json["reused"] = session.reused;
  json["stage_seconds"] = nlohmann::ordered_json::object();
  for (const StageTime& stage : session.context.times()) json["stage_seconds"][stage.stage] = stage.seconds;
  io::write_whole(folder / k_measure_file, json.dump(2) + "\n");
}

/// Returns the error message without the first step, the call of the function, which is common to all cases.
std::string message_of_function(const Error& error) {
  ErrorInfo info = error.info();
  if (info.attempted != k_calling_function) return error.what();
  info.attempted.clear();
  return Error(std::move(info)).what();
}

/// Returns true if the cause is a full disk, lack of memory or a terminated process, not the case itself.
bool is_of_machine(const Error& error) {
  if (error.code() == ErrorCode::write_failed) return true;
  const bool can_be = error.code() == ErrorCode::overflow || error.code() == ErrorCode::tetra_engine_failed;
  return can_be && std::string_view(error.what()).find("memory") != std::string_view::npos;
}

/// Stores the function's error in the status, and writes its geometry.
void note_failure(const Error& error, CaseStatus& status, const fs::path& folder) {
  status.state = error.code() == ErrorCode::cancelled ? CaseState::killed : CaseState::failed;
  status.message = status.state == CaseState::killed ? "stopped on request" : message_of_function(error);
  status.code = to_string(error.code());
  status.locations = error.info().locations;
  status.is_of_machine = status.state == CaseState::failed && is_of_machine(error);
  if (status.state == CaseState::failed && !error.info().geometry.empty()) io::write_trouble_vtu(error.info().geometry, folder / "trouble.vtu");
}

void set_reference(const SeriesPlan& plan, const SeriesCase& c, SeriesSession& series) {
  if (!plan.reference) return;
  const SeriesCase& reference = plan.cases[*plan.reference];
  series.reference = ReferenceCase{.folder = plan.folder_of(reference), .name = reference.name, .is_this = reference.index == c.index};
  series.reference->use = std::make_shared<ReferenceUse>(reference.name, series.reference->folder / k_kept_file, series.reference->is_this);
  if (series.reference->is_this) return;
  note_input(series, series.reference->folder / k_status_file);
  note_input(series, series.reference->folder / k_kept_file);
}

}  // namespace

ScriptValue argument_of(const SeriesCase& c) {
  auto p = std::make_shared<ScriptTable>(c.parameters);
  p->fields["name"] = c.name;
  p->fields["index"] = static_cast<std::int64_t>(c.index);
  return std::shared_ptr<const ScriptTable>(p);
}

void become_worker() {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  // If the worker was not started by a pool, the descriptor of that number is unrelated, and setting this flag on it is harmless.
  fcntl(k_series_lock_descriptor, F_SETFD, FD_CLOEXEC);
}

void run_case(const ScriptCall& call, const SeriesPlan& plan, const SeriesCase& c) {
  ScriptSession& session = call.session;
  SeriesSession& series = session.series;
  const Clock::time_point start = Clock::now();
  const fs::path folder = plan.folder_of(c);
  fs::create_directories(folder);
  CaseStatus status{.state = CaseState::running, .key = case_key(plan, c, session), .process = getpid(), .host = host_name()};
  const CaseStatus before = read_status(folder, session.context);
  if (is_current(before, folder, status.key)) {
    session.context.warn("case " + c.name + " is complete already: a queue has restarted this job of an earlier run");
    series.is_case_over = true;
    series.is_case_done = before.state == CaseState::done;
    return;
  }
  status.found = clear_case_folder(folder, before);
  write_status(status, folder);
  io::write_whole(folder / "case.json", case_json(plan, c, session));

  set_reference(plan, c, series);
  series.is_case_running = true;
  session.output_folder = folder;
  std::optional<MeshNote> mesh;
  const auto on_mesh = session.on_mesh;
  session.on_mesh = [&](const MeshValue& made) {
    if (on_mesh) on_mesh(made);
    mesh = note_of(made);
  };
  try {
    const ScriptValue value = plan.function->call(argument_of(c));
    if (const auto* handle = std::get_if<MeshHandle>(&value)) mesh = note_of(**handle);
    if (mesh) status.mesh = mesh->figures;
    status.result = to_result(value);
    if (series.reference && series.reference->is_this) series.reference->use->save(session.context);
    status.state = CaseState::done;
  } catch (const Error& error) {
    note_failure(error, status, folder);
    session.context.log(LogLevel::error, error.what());
  }
  session.on_mesh = on_mesh;
  session.output_folder.clear();
  series.is_case_running = false;
  if (series.reference) series.reference->use.reset();

  copy_script(session, folder);
  if (mesh && !mesh->check_json.empty()) io::write_whole(folder / "quality.json", mesh->check_json);
  write_measure(session, std::chrono::duration<double>(Clock::now() - start).count(), folder);
  status.inputs = series.inputs;
  if (status.state != CaseState::killed) status.outputs = outputs_in(folder, status.found);
  write_status(status, folder);
  series.is_case_over = true;
  series.is_case_done = status.state == CaseState::done;
}

}  // namespace sterna::scripting
