#include "scripting/view/view_worker.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>

#include "geom/base/child_process.h"
#include "geom/base/error.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/script_watch.h"
#include "scripting/series/case_worker.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/terminal/time_left.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/view/view_scene.h"

namespace sterna::scripting {
namespace {

using WorkerJson = nlohmann::ordered_json;
using WorkerClock = std::chrono::steady_clock;

/// Writes complete answers, from any thread.
class Answers {
 public:
  void send(WorkerJson json, const std::string& bytes = {}) {
    const std::lock_guard lock(mutex_);
    if (!bytes.empty()) json["bytes"] = bytes.size();
    write_all(json.dump(-1, ' ', false, WorkerJson::error_handler_t::replace) + "\n");
    write_all(bytes);
  }

 private:
  /// \throws Error(write_failed) if the workbench no longer reads
  static void write_all(std::string_view text) {
    while (!text.empty()) {
      const ssize_t n = write(k_view_answers, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw Error({.code = ErrorCode::write_failed, .attempted = "answering the workbench", .problem = "the workbench has ended"});
      text.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  std::mutex mutex_;
};

/// An object made by the script, in order of creation.
struct MadeObject {
  ScriptValue value;
  std::string verb, where;  ///< "wing", "case.lua:12"
  std::string name;         ///< name of the variable; empty: none
  bool is_of_script = false;
  bool is_sent = false;  ///< the page has the current version
};

/// Splits "case.lua:12: " into {"case.lua", 12}.
std::pair<std::string, int> file_and_line(std::string_view text) {
  for (std::size_t at = text.find(':'); at != std::string_view::npos; at = text.find(':', at + 1)) {
    std::size_t end = at + 1;
    int line = 0;
    while (end < text.size() && end < at + 8 && text[end] >= '0' && text[end] <= '9') line = 10 * line + (text[end++] - '0');
    if (end > at + 1 && (end == text.size() || text[end] == ':' || text[end] == '\n')) return {std::string(text.substr(0, at)), line};
  }
  return {std::string(), 0};
}

WorkerJson problem_json(const Error& error) {
  const ErrorInfo& info = error.info();
  // In Lua's own messages the location is in the problem; in messages of verbs it is before the attempted action.
  auto location = file_and_line(info.attempted);
  if (location.second == 0) location = file_and_line(info.problem);
  WorkerJson locations = WorkerJson::array();
  for (const ErrorLocation& p : info.locations) locations.push_back({{"at", {p.position.x, p.position.y, p.position.z}}, {"what", p.what}});
  return {{"text", error.what()}, {"code", to_string(error.code())}, {"file", location.first}, {"line", location.second}, {"places", std::move(locations)}};
}

WorkerJson value_json(const ScriptValue& value, double unit) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&value); whole && unit == 1.0) return *whole;
  if (const auto number = number_of(value)) return *number / unit;
  return nullptr;
}

WorkerJson parameter_json(const ScriptParameter& p) {
  const auto or_null = [](const std::optional<double>& x) { return x ? WorkerJson(*x) : WorkerJson(nullptr); };
  return {{"name", p.name},
          {"initial", value_json(p.initial, p.unit_value)},
          {"value", value_json(p.value, p.unit_value)},
          {"min", or_null(p.min)},
          {"max", or_null(p.max)},
          {"step", or_null(p.step)},
          {"unit", p.unit}};
}

enum class Mode { sketch, geometry, mesh };

class Worker {
 public:
  Worker(const ViewWorker& settings, const CommandContext& context) : settings_(settings), context_(context) {}

  int answer_jobs() {
    std::string text;
    for (;;) {
      for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
        const WorkerJson job = WorkerJson::parse(text.substr(0, end));
        const std::string what = job.value("do", "");
        if (what == "run") run(job);
        else if (what == "scene" || what == "cut" || what == "inspect") send_requested(job, what);
        context_.run.check_stop();
      }
      if (!read_some(STDIN_FILENO, text)) return k_exit_success;
    }
  }

 private:
  // ---- Running

  void run(const WorkerJson& job) {
    number_ = job.value("run", 0);
    start_ = WorkerClock::now();
    arguments_.clear();
    const WorkerJson arguments = job.value("arguments", WorkerJson::object());
    for (const auto& [name, text] : arguments.items()) arguments_.emplace_back(name, text.get<std::string>());
    to_show_ = job.value("wanted", std::vector<std::string>{});
    to_hide_ = job.value("unwanted", std::vector<std::string>{});
    kept_ = job.value("kept", std::vector<std::string>{});
    const std::string mode = job.value("mode", "geometry");
    if (mode == "mesh") {
      pass(Mode::mesh);
      return end("mesh", true);
    }
    const bool has_left_out = pass(Mode::sketch);
    if (mode == "sketch") return end("sketch", true);
    if (!has_left_out) return end("geometry", true);  // no union was left out, so this is the geometry: its measures and problems count
    end("sketch", false);
    pass(Mode::geometry);
    end("geometry", true);
  }

  /// Runs the script once; returns true if a sketch left something out.
  bool pass(Mode mode) {
    objects_.clear();
    problems_ = WorkerJson::array();
    mode_ = mode;
    left_ = TimeLeft();
    const auto seconds = [this] { return std::chrono::duration<double>(WorkerClock::now() - start_).count(); };
    run_.emplace(RunSettings{.threads = context_.run.threads(),
                             .seed = context_.run.seed(),
                             .stop = context_.run.stop_token(),
                             .dump_directory = {},
                             .log =
                                 [this](LogLevel level, std::string_view text) {
                                   if (level != LogLevel::debug)
                                     answers_.send({{"is", "log"}, {"run", number_}, {"warns", level >= LogLevel::warning}, {"text", text}});
                                 },
                             .progress =
                                 [this, seconds](const ProgressState& state) {
                                   left_.note(state, seconds());
                                   const auto estimate = left_.estimate();
                                   answers_.send({{"is", "progress"},
                                                  {"run", number_},
                                                  {"stage", state.stage},
                                                  {"share", state.share},
                                                  {"left", estimate ? WorkerJson(*estimate) : WorkerJson(nullptr)}});
                                 }});
    ScriptCheck check;
    check.makes_geometry = true;
    ScriptWatch watch;
    watch.is_sketch = mode == Mode::sketch;
    watch.made = [this](const ScriptCall& call, const ScriptValue& value) { note_made(call, value); };
    watch.named = [this](std::string_view name, bool is_of_script, const ScriptValue& value) { note_name(name, is_of_script, value); };
    watch.declared = [this](const std::vector<ScriptParameter>& parameters, bool is_complete) {
      WorkerJson list = WorkerJson::array();
      for (const ScriptParameter& p : parameters) list.push_back(parameter_json(p));
      answers_.send({{"is", "parameters"}, {"run", number_}, {"list", std::move(list)}, {"complete", is_complete}});
    };
    ScriptSettings settings{
        .script = settings_.script,
        .overrides = settings_.overrides,
        .print =
            [this](std::string_view text) {
              answers_.send({{"is", "log"}, {"run", number_}, {"warns", false}, {"text", text}});
            },
        .on_mesh = {},
        .cache = settings_.cache,
        .series = {.program = std::filesystem::read_symlink("/proc/self/exe"), .words = words(), .worker = {}, .stops_itself = context_.stops_itself},
        .arguments = arguments_,
        .watch = &watch};
    try {
      if (mode == Mode::mesh) run_script(settings, *run_);
      else check_script(settings, check, *run_);
      for (const ErrorHandle& problem : check.problems) problems_.push_back(problem_json(*problem));
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      problems_.push_back(problem_json(error));
    }
    return watch.has_left_out;
  }

  /// Returns the arguments for a series' own workers, as in `sterna run`.
  std::vector<std::string> words() const {
    std::vector<std::string> list;
    for (const auto& [name, value] : settings_.overrides) list.push_back("--set=" + name + "=" + value);
    list.push_back("--seed=" + std::to_string(context_.run.seed()));
    for (const auto& [name, value] : arguments_) list.push_back(name + "=" + value);
    return list;
  }

  void note_made(const ScriptCall& call, const ScriptValue& value) {
    if (!is_drawable(value) || is_placeholder(call, value)) return;
    // After an error the script continues with placeholders; objects made from them must not be shown.
    if (call.session.check && !call.session.check->problems.empty()) return;
    if (std::ranges::any_of(objects_, [&](const MadeObject& known) { return is_same_object(known.value, value); })) return;
    std::string where = call.where;
    while (where.ends_with(' ') || where.ends_with(':')) where.pop_back();
    objects_.push_back({.value = value, .verb = std::string(call.verb), .where = std::move(where), .name = {}});
    // Meshes take long to make. They are therefore shown immediately, before their variables are known.
    if (mode_ == Mode::mesh && !std::holds_alternative<ComponentHandle>(value) && !std::holds_alternative<ModelHandle>(value)) {
      send_objects("mesh", false);
      send_scene(objects_.size() - 1, false);
    }
  }

  void note_name(std::string_view name, bool is_of_script, const ScriptValue& value) {
    for (MadeObject& object : objects_)
      if (is_same_object(object.value, value) && (object.name.empty() || (is_of_script && !object.is_of_script))) {
        object.name = name;
        object.is_of_script = is_of_script;
      }
  }

  // ---- Reports to the page

  /// Returns the keys by which the page identifies objects in the next run. A key is the variable, or the verb and the number of its call.
  std::vector<std::string> keys() const {
    std::vector<std::string> list;
    for (const MadeObject& object : objects_) {
      const std::string base = object.name.empty() ? object.verb : object.name;
      std::string key = base;
      for (int i = 2; std::ranges::find(list, key) != list.end(); ++i) key = base + " " + std::to_string(i);
      list.push_back(std::move(key));
    }
    return list;
  }

  /// Returns the objects shown by default: the last object made, preferably one of the script's own variables. Components are shown only if nothing is made of
  /// them. If the script failed half way, the objects that were shown before are returned, because the last object is then an arbitrary part.
  std::vector<bool> shown() const {
    const auto is_component = [](const MadeObject& object) { return std::holds_alternative<ComponentHandle>(object.value); };
    std::vector<bool> list(objects_.size(), false);
    if (!problems_.empty() && mode_ != Mode::mesh && !kept_.empty()) {
      const std::vector<std::string> names = keys();
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = std::ranges::find(kept_, names[i]) != kept_.end();
      return list;
    }
    std::size_t last = objects_.size();
    for (const bool must_be_named : {false, true})
      for (std::size_t i = 0; i < objects_.size(); ++i)
        if (!is_component(objects_[i]) && (!must_be_named || objects_[i].is_of_script)) last = i;
    if (last < list.size()) list[last] = true;
    else if (problems_.empty())  // not after a failure, because a script that failed half way has made only parts
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = is_component(objects_[i]);
    return list;
  }

  void send_objects(std::string_view mode, bool is_complete) {
    const std::vector<std::string> names = keys();
    const std::vector<bool> is_shown = shown();
    WorkerJson list = WorkerJson::array();
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const MadeObject& object = objects_[i];
      const auto [file, line] = file_and_line(object.where);
      list.push_back({{"id", i},
                      {"key", names[i]},
                      {"kind", object_name(object.value)},
                      {"verb", object.verb},
                      {"file", file},
                      {"line", line},
                      {"is_shown", bool(is_shown[i])},
                      {"text", object_text(object.value)}});
    }
    answers_.send({{"is", "objects"}, {"run", number_}, {"mode", mode}, {"is_complete", is_complete}, {"list", std::move(list)}});
  }

  void send_scene(std::size_t id, bool is_quick) {
    try {
      const std::string bytes = scene_bytes(objects_[id].value, {.is_quick = is_quick}, *run_);
      answers_.send({{"is", "scene"}, {"run", number_}, {"id", id}, {"is_quick", is_quick}}, bytes);
      objects_[id].is_sent = !is_quick;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled || error.code() == ErrorCode::write_failed) throw;
      answers_.send({{"is", "failed"}, {"run", number_}, {"id", id}, {"text", error.what()}});
    }
  }

  void end(std::string_view mode, bool is_over) {
    const bool is_quick = mode == "sketch";
    send_objects(mode, true);
    const std::vector<std::string> names = keys();
    const std::vector<bool> is_shown = shown();
    const auto contains = [](const std::vector<std::string>& list, const std::string& name) { return std::ranges::find(list, name) != list.end(); };
    for (std::size_t i = 0; i < objects_.size(); ++i)
      if (!objects_[i].is_sent && (contains(to_show_, names[i]) || (is_shown[i] && !contains(to_hide_, names[i])))) send_scene(i, is_quick);
    answers_.send({{"is", "ended"},
                   {"run", number_},
                   {"mode", mode},
                   {"is_over", is_over},
                   {"seconds", std::chrono::duration<double>(WorkerClock::now() - start_).count()},
                   {"problems", is_quick ? WorkerJson::array() : problems_}});
  }

  /// Sends an object's scene, a cut through it, or inspection results, for the current run.
  void send_requested(const WorkerJson& job, const std::string& what) {
    const auto id = job.value("id", std::size_t{0});
    const auto request_id = job.value("ask", 0);
    if (job.value("run", -1) != number_ || id >= objects_.size())
      return answers_.send({{"is", "failed"}, {"run", job.value("run", -1)}, {"id", id}, {"ask", request_id}, {"text", "the run of this object has ended"}});
    if (what == "scene") return send_scene(id, false);
    try {
      const ScriptValue& value = objects_[id].value;
      const std::string bytes = what == "inspect" ? inspection_json(value, *run_) : cut_bytes(value, job.value("plane", ""), k_most_cut_polygons, *run_);
      answers_.send({{"is", "asked"}, {"run", number_}, {"id", id}, {"ask", request_id}}, bytes);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled || error.code() == ErrorCode::write_failed) throw;
      answers_.send({{"is", "failed"}, {"run", number_}, {"id", id}, {"ask", request_id}, {"text", error.what()}});
    }
  }

  static constexpr std::size_t k_most_cut_polygons = 200'000;

  const ViewWorker& settings_;
  const CommandContext& context_;
  Answers answers_;
  int number_ = 0;
  Mode mode_ = Mode::geometry;
  WorkerClock::time_point start_;
  TimeLeft left_;
  OptionOverrides arguments_;
  std::vector<std::string> to_show_, to_hide_;  ///< keys of objects that the user has chosen to show and to hide
  std::vector<std::string> kept_;               ///< keys of objects that were shown before without the user's choice
  std::optional<RunContext> run_;
  std::vector<MadeObject> objects_;
  WorkerJson problems_ = WorkerJson::array();
};

}  // namespace

int run_view_worker(const ViewWorker& worker, const CommandContext& context) {
  become_worker();
  return Worker(worker, context).answer_jobs();
}

}  // namespace sterna::scripting
