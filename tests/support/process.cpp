#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "tests/support/data.h"

namespace sterna::test {
namespace {

using Clock = std::chrono::steady_clock;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns a name for stdout and stderr outside of the folder, because tests check the folder's contents.
std::filesystem::path temporary_file() {
  std::string name = (std::filesystem::temp_directory_path() / "sterna_test_XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) throw std::runtime_error("no temporary file");
  close(descriptor);
  return name;
}

/// Returns true if the process now catches SIGINT, or blocks SIGINT to wait for it; before that, Ctrl-C ends the process.
bool takes_interrupt(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word, value; status >> word;) {
    if (word == "State:" && status >> value && value == "Z") return true;  // it has ended
    if (word == "State:" && status >> value && value == "Z") return true;  // it has ended
    if ((word == "SigBlk:" || word == "SigCgt:") && status >> value && (std::stoull(value, nullptr, 16) >> (SIGINT - 1) & 1u) != 0) return true;
  }
  return false;
}

}  // namespace

ProcessResult run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          double interrupt_after) {
  const std::filesystem::path output = temporary_file(), errors = temporary_file();
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const Clock::time_point start = Clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    const int out = open(output.c_str(), O_WRONLY | O_TRUNC), err = open(errors.c_str(), O_WRONLY | O_TRUNC);
    if (out < 0 || err < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(err, STDERR_FILENO) < 0 || chdir(folder.c_str()) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  Clock::time_point interrupted = start;
  if (interrupt_after >= 0.0) {
    while (!takes_interrupt(child)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::duration<double>(interrupt_after));
    kill(child, SIGINT);
    interrupted = Clock::now();
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child) throw std::runtime_error("waitpid failed");
  ProcessResult result;
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.seconds_after_interrupt = std::chrono::duration<double>(Clock::now() - interrupted).count();
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = contents(output);
  result.errors = contents(errors);
  std::filesystem::remove(output);
  std::filesystem::remove(errors);
  return result;
}

StartedProcess::StartedProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  const int nothing = open("/dev/null", O_RDWR);
  if (dup2(nothing, STDOUT_FILENO) < 0 || dup2(nothing, STDERR_FILENO) < 0 || chdir(folder.c_str()) != 0) _exit(126);
  execv(argv[0], argv.data());
  _exit(127);
}

StartedProcess::~StartedProcess() {
  if (has_ended()) return;
  signal(SIGKILL);
  wait();
}

bool StartedProcess::has_ended() {
  if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ < 0;
}

void StartedProcess::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

int StartedProcess::wait() {
  if (pid_ > 0) waitpid(pid_, &status_, 0);
  pid_ = -1;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> pids;
  std::error_code ended;  // the process may end at any time
  for (std::filesystem::directory_iterator it("/proc/" + std::to_string(process) + "/task", ended), end; !ended && it != end; it.increment(ended)) {
    std::ifstream children(it->path() / "children");
    for (pid_t pid = 0; children >> pid;) pids.push_back(pid);
  }
  return pids;
}

std::filesystem::path sterna_program() { return build_folder() / "sterna"; }

pid_t first_child() {
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(task.path() / "children");
    pid_t pid = 0;
    if (children >> pid) return pid;
  }
  return 0;
}

}  // namespace sterna::test
