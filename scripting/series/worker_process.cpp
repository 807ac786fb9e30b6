#include "scripting/series/worker_process.h"

#include <poll.h>

#include <array>

#include "geom/base/error.h"
#include "scripting/series/case_worker.h"

namespace sterna::scripting {
namespace {

constexpr int k_poll_ms = 20;  ///< maximum delay until a stop is noticed

Pipe pipe_of_command() { return Pipe(ErrorCode::internal, "starting a command"); }

}  // namespace

ChildProcess start_worker(const std::vector<std::string>& words, const std::filesystem::path& output, int lock, const std::filesystem::path& folder) {
  ChildStart start{.words = words, .descriptors = {}, .output = output.string(), .folder = folder.string()};
  if (lock >= 0) start.descriptors.emplace_back(lock, k_series_lock_descriptor);
  return ChildProcess(start);
}

CommandResult run_command(const std::vector<std::string>& words, const RunContext& context) {
  Pipe output = pipe_of_command(), errors = pipe_of_command();
  ChildProcess process(
      {.words = words, .descriptors = {{output.write_end.value, STDOUT_FILENO}, {errors.write_end.value, STDERR_FILENO}}, .output = {}, .folder = {}});
  output.write_end.reset();
  errors.write_end.reset();
  CommandResult result;
  bool is_output_open = true, is_errors_open = true;
  while (is_output_open || is_errors_open) {
    std::array<pollfd, 2> events = {pollfd{is_output_open ? output.read_end.value : -1, POLLIN, 0},
                                    pollfd{is_errors_open ? errors.read_end.value : -1, POLLIN, 0}};
    if (poll(events.data(), events.size(), k_poll_ms) > 0) {
      if (events[0].revents != 0) is_output_open = read_some(output.read_end.value, result.output);
      if (events[1].revents != 0) is_errors_open = read_some(errors.read_end.value, result.errors);
    }
    context.check_stop();  // the destructor kills the process
  }
  const int status = process.wait();
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace sterna::scripting
