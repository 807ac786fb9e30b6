#include "scripting/cli/determinism.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "geom/base/error.h"
#include "geom/base/hash.h"
#include "io/output/scratch_folder.h"
#include "scripting/series/case_status.h"
#include "scripting/series/worker_process.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds k_pause{5};         ///< polling interval for a run
constexpr std::chrono::milliseconds k_stop_grace{800};  ///< time given to a run after a stop request; Ctrl-C must take effect within a second
constexpr std::size_t k_quoted = 2000;                  ///< bytes of a run's output quoted in a message
constexpr std::size_t k_block = std::size_t{1} << 16;   ///< bytes compared at a time

std::string threads_text(int threads) { return std::to_string(threads) + (threads == 1 ? " thread" : " threads"); }

/// Returns "1, 2 and 7 threads".
std::string threads_text(const std::vector<int>& threads) {
  std::string text;
  for (std::size_t i = 0; i < threads.size(); ++i) text += (i == 0 ? "" : i + 1 == threads.size() ? " and " : ", ") + std::to_string(threads[i]);
  return text + (threads == std::vector{1} ? " thread" : " threads");
}

/// Returns true if a file contains times, so that it is excluded from the comparison.
bool holds_times(const fs::path& file) {
  const std::string name = file.filename().string();
  return file.extension() == ".html" || name == k_measure_file || name == k_log_file;
}

/// Returns the files below the folder by name; those that contain times go to `left_out`.
std::set<std::string> files_in(const fs::path& folder, std::set<std::string>& left_out) {
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), folder).string();
    (holds_times(entry.path()) ? left_out : files).insert(name);
  }
  return files;
}

/// Returns the position of the first byte that differs.
std::uint64_t first_difference(const fs::path& a, const fs::path& b) {
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  std::vector<char> of_first(k_block), of_second(k_block);
  for (std::uint64_t at = 0;;) {
    first.read(of_first.data(), static_cast<std::streamsize>(k_block));
    second.read(of_second.data(), static_cast<std::streamsize>(k_block));
    const auto n = static_cast<std::size_t>(std::min(first.gcount(), second.gcount()));
    const auto [end, ignored] = std::mismatch(of_first.begin(), of_first.begin() + static_cast<std::ptrdiff_t>(n), of_second.begin());
    at += static_cast<std::uint64_t>(end - of_first.begin());
    if (static_cast<std::size_t>(end - of_first.begin()) < n || n < k_block) return at;
  }
}

/// Returns the number of threads of each run; a number that is given twice compares two equal runs.
std::vector<int> thread_numbers(const CommandLine& line) {
  std::vector<int> threads;
  for (const std::string& number : line.all("threads")) threads.push_back(std::stoi(number));
  return threads.empty() ? std::vector<int>{1, 2, 7} : threads;
}

std::string end_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (const std::size_t error = text.rfind("error: "); error != std::string::npos) text.erase(0, error + 7);
  if (text.size() > k_quoted) text.erase(0, text.size() - k_quoted);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

/// Returns the command line of a run in its own folder. Input files are searched there first (for files that the run itself wrote), then in the folder of the
/// user, then beside the script.
std::vector<std::string> words_of(const CommandLine& line, int threads, const RunContext& run) {
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe").string(), "run", fs::absolute(line.word("script")).string()};
  for (const auto& [name, value] : line.arguments) words.push_back(name + "=" + value);
  for (const auto& [name, value] : line.set) words.push_back("--set=" + name + "=" + value);
  words.push_back("--seed=" + std::to_string(run.seed()));
  words.push_back("--threads=" + std::to_string(threads));
  words.push_back("--look-in=" + fs::current_path().string());
  return words;
}

[[noreturn]] void refuse_failed_run(const std::string& script, int threads, int wait_status, const fs::path& output, const fs::path& kept) {
  const std::string how = WIFSIGNALED(wait_status) ? signal_text(WTERMSIG(wait_status)) : "exit status " + std::to_string(WEXITSTATUS(wait_status));
  const std::string words = end_of(output);
  throw Error({.code = ErrorCode::script_failed,
               .attempted = "running " + script + " with " + threads_text(threads),
               .problem = "the run failed, " + how + (words.empty() ? "" : ": " + words),
               .hint = "the files of the runs are kept in " + kept.string() + "; `sterna run " + script + " --threads " + std::to_string(threads) +
                       "` repeats the run"});
}

/// Waits for the end of the process. \throws Error(cancelled) once the process has ended
int finish(ChildProcess& process, const RunContext& run) {
  for (;;) {
    if (const std::optional<int> ended = process.ended()) return *ended;
    if (run.stop_token().stop_requested()) {
      process.stop();
      for (const Clock::time_point end = Clock::now() + k_stop_grace; Clock::now() < end && !process.ended();) std::this_thread::sleep_for(k_pause);
      process.kill();
      run.check_stop();
    }
    std::this_thread::sleep_for(k_pause);
  }
}

void require_usable(const std::string& script, const std::vector<int>& threads) {
  if (!fs::exists(script))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "checking the determinism of " + script, .problem = "there is no such file"});
  if (threads.size() < 2)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "--threads " + (threads.empty() ? std::string() : std::to_string(threads.front())),
                 .problem = "one run cannot be compared",
                 .hint = "--threads 1,2,7, or the same number twice for two equal runs: --threads 2,2"});
}

}  // namespace

bool DeterminismReport::is_pass() const {
  return !files.empty() && std::ranges::all_of(files, [](const ComparedFile& file) { return file.differences.empty(); });
}

void compare_run(const fs::path& first, const fs::path& folder, int threads, DeterminismReport& report) {
  std::set<std::string> left_out(report.left_out.begin(), report.left_out.end());
  const std::set<std::string> here = files_in(folder, left_out);
  report.left_out.assign(left_out.begin(), left_out.end());
  if (first == folder) {
    for (const std::string& name : here)
      report.files.push_back({.name = name, .hash = hash_file(folder / name), .bytes = fs::file_size(folder / name), .differences = {}});
    return;
  }
  for (const std::string& name : here)
    if (std::ranges::none_of(report.files, [&](const ComparedFile& file) { return file.name == name; }))
      report.files.push_back({.name = name, .hash = {}, .bytes = 0, .differences = {}});
  std::ranges::sort(report.files, {}, &ComparedFile::name);
  for (ComparedFile& file : report.files) {
    if (!here.contains(file.name)) {
      if (!file.hash.empty()) file.differences.push_back({.threads = threads, .hash = {}, .bytes = 0, .at = 0});
      continue;
    }
    const std::string hash = hash_file(folder / file.name);
    if (hash == file.hash) continue;
    const std::uint64_t at = file.hash.empty() ? 0 : first_difference(first / file.name, folder / file.name);
    file.differences.push_back({.threads = threads, .hash = hash, .bytes = fs::file_size(folder / file.name), .at = at});
  }
}

std::string to_text(const DeterminismReport& report) {
  const std::size_t n_different =
      static_cast<std::size_t>(std::ranges::count_if(report.files, [](const ComparedFile& file) { return !file.differences.empty(); }));
  const auto files = [](std::size_t n) { return std::to_string(n) + (n == 1 ? " file" : " files"); };
  std::string text = "G22 determinism: ";
  if (report.files.empty()) text += "FAIL, the script wrote no file to compare\n";
  else if (n_different == 0) text += "pass, " + files(report.files.size()) + " equal for " + threads_text(report.threads) + "\n";
  else
    text += "FAIL, " + std::to_string(n_different) + " of " + files(report.files.size()) + (n_different == 1 ? " differs" : " differ") + " between " +
            threads_text(report.threads) + "\n";
  for (const ComparedFile& file : report.files) {
    if (file.hash.empty()) text += fmt::format("  {}: {} did not write this file\n", file.name, threads_text(report.threads.front()));
    else text += fmt::format("  {}  {:>12} bytes  {}\n", file.hash, count_text(static_cast<std::int64_t>(file.bytes)), file.name);
    for (const ComparedFile::Difference& d : file.differences) {
      if (d.hash.empty()) text += fmt::format("      {} did not write this file\n", threads_text(d.threads));
      else if (file.hash.empty())
        text += fmt::format("      {} wrote {} bytes, {}\n", threads_text(d.threads), count_text(static_cast<std::int64_t>(d.bytes)), d.hash);
      else
        text += fmt::format("      {}: {}, {} bytes, first difference at byte {}\n", threads_text(d.threads), d.hash,
                            count_text(static_cast<std::int64_t>(d.bytes)), count_text(static_cast<std::int64_t>(d.at)));
    }
  }
  if (!report.left_out.empty()) {
    text += "  not compared, because they contain times:";
    for (const std::string& name : report.left_out) text += " " + name;
    text += "\n";
  }
  if (!report.kept.empty()) text += "  the files of the runs are kept in " + report.kept.string() + "\n";
  return text;
}

std::string to_json(const DeterminismReport& report) {
  using Json = nlohmann::ordered_json;
  Json json = {{"schema", "sterna-determinism-1"},
               {"gate", "G22"},
               {"state", report.is_pass() ? "pass" : "fail"},
               {"script", report.script},
               {"threads", report.threads}};
  json["files"] = Json::array();
  const auto hash = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  for (const ComparedFile& file : report.files) {
    Json entry = {{"file", file.name}, {"bytes", file.bytes}, {"xxh3_128", hash(file.hash)}, {"differences", Json::array()}};
    for (const ComparedFile::Difference& d : file.differences)
      entry["differences"].push_back({{"threads", d.threads}, {"bytes", d.bytes}, {"xxh3_128", hash(d.hash)}, {"first_byte", d.at}});
    json["files"].push_back(std::move(entry));
  }
  json["left_out"] = report.left_out;
  if (!report.kept.empty()) json["kept_in"] = report.kept.string();
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

int determinism_command(const CommandLine& line, const CommandContext& context) {
  const std::string script = line.word("script");
  const std::vector<int> all_threads = thread_numbers(line);
  require_usable(script, all_threads);
  DeterminismReport report{.script = script, .threads = all_threads, .files = {}, .left_out = {}, .kept = {}};
  io::ScratchFolder work("determinism");
  const auto folder_of = [&](std::size_t i) { return work.path() / ("run" + std::to_string(i + 1) + "_threads" + std::to_string(all_threads[i])); };
  for (std::size_t i = 0; i < all_threads.size(); ++i) {
    const int threads = all_threads[i];
    const fs::path folder = folder_of(i), output = folder.string() + ".txt";
    fs::create_directory(folder);
    const Clock::time_point start = Clock::now();
    context.run.info(fmt::format("run {} of {}: {}", i + 1, all_threads.size(), threads_text(threads)));
    ChildProcess process = start_worker(words_of(line, threads, context.run), output, -1, folder);
    if (const int status = finish(process, context.run); status != 0) {
      work.keep();
      refuse_failed_run(script, threads, status, output, work.path());
    }
    compare_run(folder_of(0), folder, threads, report);
    const bool is_equal = report.is_pass();
    context.run.info(fmt::format("run {} of {}: {}, {}{}", i + 1, all_threads.size(), threads_text(threads),
                                 duration_text(std::chrono::duration<double>(Clock::now() - start).count()),
                                 i == 0     ? ""
                                 : is_equal ? ", equal"
                                            : ", different"));
    std::error_code ignored;  // the file is removed with all others at the end
    if (i > 0 && is_equal) fs::remove_all(folder, ignored);
    context.run.progress(static_cast<double>(i + 1) / static_cast<double>(all_threads.size()));
  }
  if (!report.is_pass()) {
    work.keep();
    report.kept = work.path();
  }
  context.console.end_progress();
  context.console.print(line.flag("json") ? to_json(report) : to_text(report));
  return report.is_pass() ? k_exit_success : k_exit_failed;
}

}  // namespace sterna::scripting
