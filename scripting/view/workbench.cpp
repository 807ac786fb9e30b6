// There are three kinds of threads. follow() starts, feeds and ends the workers; one reader per worker takes its answers; the server's threads answer the page.
// All share State under one mutex; every change raises its version and wakes the waiting threads.
#include "scripting/view/workbench.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <fstream>
#include <iterator>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "geom/base/child_process.h"
#include "geom/base/error.h"
#include "io/output/atomic_file.h"
#include "scripting/interpreter/script_args.h"
#include "scripting/lua/script_sandbox.h"
#include "scripting/view/script_defaults.h"
#include "scripting/view/view_worker.h"
#include "scripting/view/watched_files.h"

namespace sterna::scripting {
namespace {

using BenchJson = nlohmann::ordered_json;
using BenchClock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto k_look_interval = 60ms;      ///< between checks of the files
constexpr auto k_page_patience = 20s;       ///< if there is no news, an answer without news is given after this time
constexpr auto k_answer_timeout = 60s;      ///< waiting time of the page for a cut or an inspection
constexpr auto k_sketch_patience = 1500ms;  ///< time in which a sketch may finish before a newer one replaces it
constexpr auto k_quick_sketch = 300ms;      ///< sketches that take longer than this show their progress
constexpr auto k_end_patience = 3s;         ///< time after a stop request at which a worker is killed
constexpr std::size_t k_most_lines = 400;   ///< maximum number of lines in the log

/// One object of the picture. It is kept, marked as old, until a completed run has made it again or has not made it.
struct ShownObject {
  BenchJson about;  ///< as reported by the worker: key, kind, verb, file, line, is_shown, text
  int run = 0;
  std::size_t id = 0;  ///< within that run
  std::uint64_t scene = 0;
  int scene_run = 0;
  bool is_quick = false;
  std::shared_ptr<const std::string> bytes;
  std::string failure;
  std::string key() const { return about.value("key", ""); }
  /// Returns true if geometry mode makes the object; meshes are kept until the next mesh.
  bool is_geometry() const { return about.value("kind", "") == "model" || about.value("kind", "") == "component"; }
};

struct State {
  std::uint64_t version = 1, scenes = 0;
  int run = 0;
  std::string mode, status = "starting";  ///< status: running, done, failed or stopped
  std::string stage;
  double share = 0.0;
  BenchJson left = nullptr, problems = BenchJson::array(), parameters = BenchJson::array();
  double seconds = 0.0;
  BenchClock::time_point started{};
  std::vector<ShownObject> objects;
  std::map<std::string, std::string> values;  ///< arguments that differ from the script
  std::vector<std::string> to_show, to_hide;  ///< keys of objects that the user has chosen to show and to hide
  std::deque<BenchJson> lines;                ///< in the log
  std::uint64_t n_lines = 0;
  std::map<int, std::shared_ptr<const std::string>> answered;  ///< answers by request number
  std::map<int, std::string> refused;
  int n_requests = 0;
};

/// A worker process with the thread that reads its answers.
struct WorkerProcess {
  int number = 0;
  ChildProcess child;
  std::unique_ptr<Pipe> jobs, answers;
  std::thread reader;
  bool is_busy = false, is_gone = false;
  std::string mode;
  BenchClock::time_point since;
};

PageAnswer json_answer(const BenchJson& json, int status = 200) {
  return {.status = status,
          .type = "application/json",
          .body = std::make_shared<const std::string>(json.dump(-1, ' ', false, BenchJson::error_handler_t::replace))};
}
PageAnswer refusal(const std::string& text, int status = 409) { return json_answer({{"text", text}}, status); }

}  // namespace

class Workbench::Parts {
 public:
  explicit Parts(const WorkbenchSettings& settings) : settings_(settings), page_(std::make_shared<const std::string>(settings.page)) {
    for (const auto& [name, text] : settings.arguments) state_.values[name] = text;
  }

  ~Parts() { end_workers(); }

  void follow(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] { changed_.notify_all(); });
    WatchedFiles files(settings_.script, settings_.input);
    request_run(settings_.is_made_script ? "mesh" : "geometry");
    while (!stop.stop_requested()) {
      if (is_mesh_written_.exchange(false)) files.accept_others();
      if (files.have_changed()) request_run(settings_.is_made_script ? "mesh" : "geometry");
      {
        std::unique_lock lock(mutex_);
        take_step();
        changed_.wait_for(lock, k_look_interval, [&] { return stop.stop_requested() || is_step_due_; });
        is_step_due_ = false;
      }
    }
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    changed_.notify_all();
    end_workers();
  }

  PageAnswer answer(const PageRequest& request) {
    try {
      if (!request.is_post) {
        if (request.name.empty()) return {.type = "text/html; charset=utf-8", .body = page_};
        if (request.name == "state") return state_answer(request);
        if (request.name == "scene") return scene_answer(request);
        if (request.name == "cases") return cases_answer();
        if (request.name == "picture") return picture_answer(request);
        if (request.name == "script") return json_answer({{"text", read_script(settings_.script)}});
        return refusal("there is no such page", 404);
      }
      const BenchJson body = BenchJson::parse(request.body.empty() ? "{}" : request.body);
      if (!body.is_object()) return refusal("expected an object", 400);
      if (request.name == "values") return set_values(body);
      if (request.name == "run") return answer_run(body);
      if (request.name == "stop") return answer_stop();
      if (request.name == "show") return answer_show(body);
      if (request.name == "cut") return answer_of_object("cut", body, "application/octet-stream");
      if (request.name == "inspect") return answer_of_object("inspect", body, "application/json");
      if (request.name == "save") return save_values();
      return refusal("there is no such page", 404);
    } catch (const BenchJson::exception& error) {
      return refusal(std::string("the request cannot be read: ") + error.what(), 400);
    } catch (const Error& error) {
      return refusal(error.what());
    }
  }

 private:
  // ---- Requests of the page

  PageAnswer state_answer(const PageRequest& request) {
    const std::uint64_t since = number_in(request.value("since")), lines_since = number_in(request.value("lines"));
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, k_page_patience, [&] { return is_over_ || state_.version > since; });
    BenchJson objects = BenchJson::array();
    for (const ShownObject& object : state_.objects) {
      BenchJson entry = object.about;
      entry["scene"] = object.scene;
      entry["scene_run"] = object.scene_run;
      entry["is_quick"] = object.is_quick;
      entry["is_old"] = object.scene_run < state_.run || object.run < state_.run;
      if (object.bytes) entry["bytes"] = object.bytes->size();
      if (!object.failure.empty()) entry["failure"] = object.failure;
      objects.push_back(std::move(entry));
    }
    BenchJson lines = BenchJson::array();
    const std::uint64_t first = state_.n_lines - state_.lines.size();
    for (std::size_t i = 0; i < state_.lines.size(); ++i)
      if (first + i >= lines_since) lines.push_back(state_.lines[i]);
    const bool is_running = state_.status == "running";
    const double seconds = is_running ? std::chrono::duration<double>(BenchClock::now() - state_.started).count() : state_.seconds;
    return json_answer({{"version", state_.version},
                        {"file", settings_.input.filename().string()},
                        {"has_script", !settings_.is_made_script},
                        {"has_cases", !settings_.cases.empty()},
                        {"is_over", is_over_},
                        {"run",
                         {{"number", state_.run},
                          {"mode", state_.mode},
                          {"status", state_.status},
                          {"stage", state_.stage},
                          {"share", state_.share},
                          {"left", state_.left},
                          {"seconds", seconds}}},
                        {"parameters", state_.parameters},
                        {"values", state_.values},
                        {"problems", state_.problems},
                        {"objects", std::move(objects)},
                        {"n_lines", state_.n_lines},
                        {"lines", std::move(lines)}});
  }

  PageAnswer scene_answer(const PageRequest& request) {
    const std::uint64_t scene = number_in(request.value("scene"));
    const std::lock_guard lock(mutex_);
    for (const ShownObject& object : state_.objects)
      if (object.scene == scene && object.bytes) return {.type = "application/octet-stream", .body = object.bytes};
    return refusal("this picture no longer exists", 410);
  }

  PageAnswer cases_answer() const {
    if (settings_.cases.empty()) return refusal("this is not a series", 404);
    return {.type = "application/json", .body = std::make_shared<const std::string>(settings_.cases)};
  }

  PageAnswer picture_answer(const PageRequest& request) const {
    const std::string text = request.value("picture");
    const std::uint64_t picture = number_in(text);
    if (text.empty() || picture >= settings_.pictures.size()) return refusal("there is no such picture", 404);
    std::ifstream file(settings_.pictures[picture], std::ios::binary);
    if (!file) return refusal("this picture no longer exists", 410);
    return {.type = "image/png", .body = std::make_shared<const std::string>(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>())};
  }

  PageAnswer set_values(const BenchJson& body) {
    const bool is_dragging = body.value("is_dragging", false);
    {
      const std::lock_guard lock(mutex_);
      const BenchJson values = body.value("values", BenchJson::object());
      for (const auto& [name, text] : values.items()) {
        split_argument(name + "=");  // rejects names that are not valid for an argument
        if (text.is_null()) state_.values.erase(name);
        else state_.values[name] = text.get<std::string>();
      }
    }
    if (!settings_.is_made_script) request_run(is_dragging ? "sketch" : "geometry");
    else if (!is_dragging) request_run("mesh");
    return json_answer({{"ok", true}});
  }

  PageAnswer answer_run(const BenchJson& body) {
    const std::string mode = body.value("mode", "geometry");
    if (mode != "geometry" && mode != "mesh") return refusal("there is no mode " + mode, 400);
    request_run(mode);
    return json_answer({{"ok", true}});
  }

  PageAnswer answer_stop() {
    const std::lock_guard lock(mutex_);
    requested_mode_.clear();
    if (worker_ && worker_->is_busy) {
      retire();
      state_.status = "stopped";
      state_.left = nullptr;
      report_change();
    }
    return json_answer({{"ok", true}});
  }

  PageAnswer answer_show(const BenchJson& body) {
    const std::string key = body.value("key", "");
    const bool is_shown = body.value("is_shown", true);
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(state_.objects, [&](const ShownObject& object) { return object.key() == key; });
    if (found == state_.objects.end()) return refusal("there is no object " + key, 404);
    std::erase(state_.to_show, key);
    std::erase(state_.to_hide, key);
    (is_shown ? state_.to_show : state_.to_hide).push_back(key);
    const bool is_missing = !found->bytes || found->scene_run < found->run;
    if (is_shown && is_missing) requested_scenes_.push_back(key);
    is_step_due_ = true;
    changed_.notify_all();
    return json_answer({{"ok", true}});
  }

  /// Requests a cut through an object, or an inspection, from the worker, and waits for the result.
  PageAnswer answer_of_object(const char* what, const BenchJson& body, std::string_view type) {
    const std::string key = body.value("key", "");
    std::unique_lock lock(mutex_);
    const auto found = std::ranges::find_if(state_.objects, [&](const ShownObject& object) { return object.key() == key; });
    if (found == state_.objects.end()) return refusal("there is no object " + key, 404);
    if (!worker_ || worker_->is_busy || worker_->is_gone || found->run != held_run_)
      return refusal(std::string(std::string_view(what) == "cut" ? "the mesh" : "the surface") + " is not available: mesh again");
    const int request_id = ++state_.n_requests;
    send_job({{"do", what}, {"run", found->run}, {"id", found->id}, {"plane", body.value("plane", "")}, {"ask", request_id}});
    const auto is_there = [&] { return is_over_ || state_.answered.contains(request_id) || state_.refused.contains(request_id); };
    changed_.wait_for(lock, k_answer_timeout, is_there);
    if (const auto answer = state_.answered.find(request_id); answer != state_.answered.end()) {
      const PageAnswer result{.type = type, .body = answer->second};
      state_.answered.erase(answer);
      return result;
    }
    const auto refused = state_.refused.find(request_id);
    return refusal(refused == state_.refused.end() ? "the worker does not respond in time" : refused->second);
  }

  PageAnswer save_values() {
    if (settings_.is_made_script) return refusal("there is no script to write");
    std::vector<std::pair<std::string, std::string>> values;
    {
      const std::lock_guard lock(mutex_);
      values.assign(state_.values.begin(), state_.values.end());
    }
    if (values.empty()) return refusal("all values are those of the script already");
    io::write_whole(settings_.script, with_defaults(read_script(settings_.script), values));
    const std::lock_guard lock(mutex_);
    state_.values.clear();  // the values are now in the script; the file watcher detects the change
    return json_answer({{"ok", true}});
  }

  // ---- Runs

  void request_run(const std::string& mode) {
    const std::lock_guard lock(mutex_);
    // The new request replaces a pending one and covers it. A pending mesh stays, because no other run makes it.
    if (requested_mode_ != "mesh") requested_mode_ = mode;
    is_step_due_ = true;
    changed_.notify_all();
  }

  /// \pre the lock is held
  void report_change() {
    ++state_.version;
    changed_.notify_all();
  }

  /// Starts the requested work if possible. \pre the lock is held
  void take_step() {
    look_at_retired();
    if (worker_ && worker_->is_gone) take_lost_worker();
    if (!requested_mode_.empty()) {
      const bool is_sketching = worker_ && worker_->is_busy && worker_->mode == "sketch" && BenchClock::now() - worker_->since < k_sketch_patience;
      if (is_sketching) return;  // wait, because the sketch will finish soon, and the next one follows
      if (worker_ && worker_->is_busy) retire();
      if (!worker_) start_worker();
      if (worker_) begin_run();
    }
    if (worker_ && !worker_->is_busy)
      for (const std::string& key : std::exchange(requested_scenes_, {}))
        for (const ShownObject& object : state_.objects)
          if (object.key() == key && object.run == held_run_) send_job({{"do", "scene"}, {"run", object.run}, {"id", object.id}});
  }

  void begin_run() {
    state_.run += 1;
    state_.mode = std::exchange(requested_mode_, {});
    state_.status = "running";
    state_.stage.clear();
    state_.share = 0.0;
    state_.left = nullptr;
    state_.started = BenchClock::now();
    worker_->is_busy = true;
    worker_->mode = state_.mode;
    worker_->since = state_.started;
    held_run_ = state_.run;
    std::vector<std::string> kept;
    for (const ShownObject& object : state_.objects)
      if (object.about.value("is_shown", false)) kept.push_back(object.key());
    send_job({{"do", "run"},
              {"run", state_.run},
              {"mode", state_.mode},
              {"arguments", state_.values},
              {"wanted", state_.to_show},
              {"unwanted", state_.to_hide},
              {"kept", kept}});
    report_change();
  }

  void start_worker() {
    try {
      auto fresh = std::make_shared<WorkerProcess>(WorkerProcess{.number = ++n_workers_,
                                                                 .child = ChildProcess(start_of_worker()),
                                                                 .jobs = std::move(new_jobs_),
                                                                 .answers = std::move(new_answers_),
                                                                 .reader = {},
                                                                 .mode = {},
                                                                 .since = BenchClock::now()});
      fresh->jobs->read_end.reset();
      fresh->answers->write_end.reset();
      fresh->reader = std::thread([this, fresh = fresh.get()] { read_answers(*fresh); });
      worker_ = std::move(fresh);
    } catch (const Error& error) {
      fail(error.what());
      requested_mode_.clear();
    }
  }

  ChildStart start_of_worker() {
    new_jobs_ = std::make_unique<Pipe>(ErrorCode::internal, "starting a worker");
    new_answers_ = std::make_unique<Pipe>(ErrorCode::internal, "starting a worker");
    return {.words = settings_.words,
            .descriptors = {{new_jobs_->read_end.value, STDIN_FILENO}, {new_answers_->write_end.value, k_view_answers}},
            .output = {},
            .folder = {}};
  }

  /// Stops the worker; a new one replaces it. \pre the lock is held
  void retire() {
    worker_->child.stop();
    worker_->since = BenchClock::now();
    worker_->jobs.reset();
    retired_.push_back(std::move(worker_));
    worker_.reset();
  }

  void look_at_retired() {
    for (auto it = retired_.begin(); it != retired_.end();) {
      WorkerProcess& old = **it;
      if (BenchClock::now() - old.since > k_end_patience) old.child.kill();
      if (old.is_gone && old.child.ended()) {
        old.reader.join();
        it = retired_.erase(it);
      } else ++it;
    }
  }

  /// Handles a worker that ended by itself. \pre the lock is held
  void take_lost_worker() {
    const int status = worker_->child.wait();
    worker_->reader.join();
    const bool was_busy = worker_->is_busy;
    worker_.reset();
    if (was_busy)
      fail("the process that ran the script ended " + (!WIFSIGNALED(status) ? "with status " + std::to_string(WEXITSTATUS(status))
                                                       : WTERMSIG(status) == SIGKILL
                                                           ? std::string("because it was killed, perhaps for lack of memory")
                                                           : "by signal " + std::to_string(WTERMSIG(status)) + " (please report this)"));
  }

  void fail(const std::string& text) {
    state_.status = "failed";
    state_.problems = BenchJson::array({{{"text", text}, {"code", "internal"}, {"file", ""}, {"line", 0}, {"places", BenchJson::array()}}});
    report_change();
  }

  void send_job(const BenchJson& job) {
    std::string text = job.dump(-1, ' ', false, BenchJson::error_handler_t::replace) + "\n";
    for (std::string_view rest = text; !rest.empty();) {
      const ssize_t n = write(worker_->jobs->write_end.value, rest.data(), rest.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return;  // the worker is gone, which its reader will detect
      rest.remove_prefix(static_cast<std::size_t>(n));
    }
  }

  void end_workers() {
    std::list<std::shared_ptr<WorkerProcess>> all;
    {
      const std::lock_guard lock(mutex_);
      if (worker_) retire();
      all.swap(retired_);
    }
    const auto end = BenchClock::now() + k_end_patience;
    for (const auto& worker : all) {
      while (!worker->child.ended() && BenchClock::now() < end) std::this_thread::sleep_for(10ms);
      worker->child.kill();
      worker->reader.join();
    }
  }

  // ---- Answers of workers

  void read_answers(WorkerProcess& worker) {
    std::string text;
    std::size_t n_bytes = 0;  // number of bytes that belong to `line`
    BenchJson line;
    const auto take = [&] {
      for (;;) {
        if (n_bytes > 0) {
          if (text.size() < n_bytes) return;
          auto bytes = std::make_shared<const std::string>(text.substr(0, n_bytes));
          text.erase(0, n_bytes);
          n_bytes = 0;
          note(worker, line, std::move(bytes));
          continue;
        }
        const std::size_t end = text.find('\n');
        if (end == std::string::npos) return;
        line = BenchJson::parse(text.substr(0, end), nullptr, false);
        text.erase(0, end + 1);
        if (!line.is_object()) continue;
        n_bytes = line.value("bytes", std::size_t{0});
        if (n_bytes == 0) note(worker, line, nullptr);
      }
    };
    std::vector<char> buffer(1 << 18);
    for (;;) {
      const ssize_t n = read(worker.answers->read_end.value, buffer.data(), buffer.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(n));
      take();
    }
    const std::lock_guard lock(mutex_);
    worker.is_gone = true;
    is_step_due_ = true;
    changed_.notify_all();
  }

  void note(WorkerProcess& worker, const BenchJson& line, std::shared_ptr<const std::string> bytes) {
    const std::lock_guard lock(mutex_);
    if (worker_.get() != &worker || line.value("run", -1) != state_.run) return;  // the answer is from a run that was superseded
    const std::string is = line.value("is", "");
    if (is == "log") note_line(line);
    else if (is == "progress") {
      state_.stage = line.value("stage", "");
      state_.share = line.value("share", 0.0);
      state_.left = line.value("left", BenchJson(nullptr));
    } else if (is == "parameters") note_parameters(line["list"], line.value("complete", false));
    else if (is == "objects") note_objects(line);
    else if (is == "scene") note_scene(line, std::move(bytes));
    else if (is == "asked") state_.answered[line.value("ask", 0)] = std::move(bytes);
    else if (is == "failed") note_failure(line);
    else if (is == "ended") note_end(worker, line);
    // A sketch is reported once, when it is complete. While a slider moves, the page has no time for intermediate steps.
    const bool is_step_of_sketch =
        is != "ended" && is != "asked" && worker.mode == "sketch" && worker.is_busy && BenchClock::now() - worker.since < k_quick_sketch;
    if (!is_step_of_sketch) report_change();
  }

  void note_line(const BenchJson& line) {
    state_.lines.push_back({{"run", state_.run}, {"warns", line.value("warns", false)}, {"text", line.value("text", "")}});
    ++state_.n_lines;
    if (state_.lines.size() > k_most_lines) state_.lines.pop_front();
  }

  /// Drops values of arguments that the script no longer has. The script then runs without them.
  void note_parameters(const BenchJson& list, bool is_complete) {
    state_.parameters = list;
    if (!is_complete) return;  // a module may declare more
    const auto n_dropped = std::erase_if(
        state_.values, [&](const auto& entry) { return std::ranges::none_of(list, [&](const BenchJson& p) { return p.value("name", "") == entry.first; }); });
    if (n_dropped > 0 && requested_mode_.empty()) requested_mode_ = state_.mode;
  }

  void note_objects(const BenchJson& line) {
    for (const BenchJson& about : line["list"]) {
      const std::string key = about.value("key", "");
      auto found = std::ranges::find_if(state_.objects,
                                        [&](const ShownObject& object) { return object.run == state_.run && object.id == about.value("id", std::size_t{0}); });
      if (found == state_.objects.end() || found->about.value("kind", "") != about.value("kind", ""))
        found = std::ranges::find_if(state_.objects, [&](const ShownObject& object) { return object.key() == key; });
      if (found == state_.objects.end()) found = state_.objects.insert(found, ShownObject{});
      found->about = about;
      found->run = state_.run;
      found->id = about.value("id", std::size_t{0});
      found->failure.clear();
    }
  }

  void note_scene(const BenchJson& line, std::shared_ptr<const std::string> bytes) {
    for (ShownObject& object : state_.objects) {
      if (object.run != state_.run || object.id != line.value("id", std::size_t{0})) continue;
      object.bytes = std::move(bytes);
      object.scene = ++state_.scenes;
      object.scene_run = state_.run;
      object.is_quick = line.value("is_quick", false);
      return;
    }
  }

  void note_failure(const BenchJson& line) {
    if (const int request_id = line.value("ask", 0); request_id > 0) {
      state_.refused[request_id] = line.value("text", "");
      return;
    }
    for (ShownObject& object : state_.objects)
      if (object.run == state_.run && object.id == line.value("id", std::size_t{0})) object.failure = line.value("text", "");
  }

  void note_end(WorkerProcess& worker, const BenchJson& line) {
    const bool is_over = line.value("is_over", true);
    const std::string mode = line.value("mode", "");
    if (mode != "sketch") state_.problems = line["problems"];
    if (mode != "sketch" && state_.problems.empty())
      std::erase_if(state_.objects, [&](const ShownObject& object) { return object.run < state_.run && (mode == "mesh" || object.is_geometry()); });
    std::ranges::stable_sort(state_.objects, {},
                             [&](const ShownObject& object) { return object.run == state_.run ? object.id : std::size_t{1'000'000} + object.id; });
    if (!is_over) return;
    worker.is_busy = false;
    if (mode == "mesh") is_mesh_written_ = true;
    state_.status = state_.problems.empty() || mode == "sketch" ? "done" : "failed";
    state_.share = 1.0;
    state_.left = nullptr;
    state_.seconds = line.value("seconds", 0.0);
    is_step_due_ = true;
  }

  static std::uint64_t number_in(const std::string& text) {
    std::uint64_t number = 0;
    for (const char c : text) {
      if (c < '0' || c > '9' || number > 1'000'000'000'000) return 0;
      number = 10 * number + static_cast<std::uint64_t>(c - '0');
    }
    return number;
  }

  const WorkbenchSettings settings_;
  const std::shared_ptr<const std::string> page_;
  std::mutex mutex_;
  std::condition_variable changed_;
  State state_;
  std::string requested_mode_;                 ///< next requested run; empty: none
  std::vector<std::string> requested_scenes_;  ///< keys
  bool is_step_due_ = false, is_over_ = false;
  std::atomic<bool> is_mesh_written_ = false;
  int held_run_ = 0;  ///< run whose objects the worker holds
  int n_workers_ = 0;
  std::unique_ptr<Pipe> new_jobs_, new_answers_;
  std::shared_ptr<WorkerProcess> worker_;
  std::list<std::shared_ptr<WorkerProcess>> retired_;
};

Workbench::Workbench(const WorkbenchSettings& settings) : parts_(std::make_unique<Parts>(settings)) {}
Workbench::~Workbench() = default;
void Workbench::follow(const std::stop_token& stop) { parts_->follow(stop); }
PageAnswer Workbench::answer(const PageRequest& request) { return parts_->answer(request); }

}  // namespace sterna::scripting
