// The prompt on a terminal (a pseudo terminal): editing, completion, history, Ctrl-C, Ctrl-D.
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

constexpr double k_patience = 60.0;  // s: time limit for a loaded machine

/// `sterna` in a separate pseudo terminal, with a separate home folder.
class Terminal {
 public:
  explicit Terminal(const std::filesystem::path& home) {
    const std::string program = test::sterna_program().string(), folder = home.string();
    pid_ = ::forkpty(&screen_, nullptr, nullptr, nullptr);
    if (pid_ == 0) {
      ::setenv("HOME", folder.c_str(), 1);
      ::setenv("TERM", "xterm", 1);
      ::unsetenv("XDG_STATE_HOME");
      if (::chdir(folder.c_str()) == 0) ::execl(program.c_str(), program.c_str(), nullptr);
      ::_exit(127);
    }
  }
  ~Terminal() {
    if (pid_ > 0 && !has_ended_) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(screen_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys) { ASSERT_EQ(::write(screen_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size())); }
  /// Returns the terminal output from now on until `text` has appeared.
  std::string wait_for(const std::string& text) {
    std::string shown;
    const auto begin = std::chrono::steady_clock::now();
    while (shown.find(text) == std::string::npos) {
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > k_patience || !read_some(shown)) {
        ADD_FAILURE() << "\"" << text << "\" did not appear in: " << shown;
        break;
      }
    }
    return shown;
  }
  /// Waits for the end of the program and returns its exit status.
  int wait() {
    std::string rest;
    while (read_some(rest)) {
    }
    int status = 0;
    ::waitpid(pid_, &status, 0);
    has_ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  /// Returns false at the end of the program, or if no output comes for a long time.
  bool read_some(std::string& shown) const {
    pollfd screen{.fd = screen_, .events = POLLIN, .revents = 0};
    if (::poll(&screen, 1, static_cast<int>(1000 * k_patience)) <= 0) return false;
    char bytes[4096];
    const ssize_t n = ::read(screen_, bytes, sizeof bytes);
    if (n <= 0) return false;
    shown.append(bytes, static_cast<std::size_t>(n));
    return true;
  }

  int screen_ = -1;
  pid_t pid_ = -1;
  bool has_ended_ = false;
};

constexpr const char* k_prompt = "> ";
constexpr const char* k_up = "\033[A";
constexpr const char* k_left = "\033[D";
constexpr const char* k_ctrl_c = "\003";
constexpr const char* k_ctrl_d = "\004";

TEST(TerminalPrompt, EditsCompletesRemembersAndStops) {
  const std::filesystem::path home = test::scratch();
  {
    Terminal terminal(home);
    terminal.wait_for(k_prompt);
    terminal.type(std::string("20 + 2") + k_left + "2\n");
    EXPECT_THAT(terminal.wait_for(k_prompt), HasSubstr("42"));
    terminal.type("volume_m\t");
    terminal.wait_for("volume_mesh");
    terminal.type(k_ctrl_c);
    terminal.wait_for(k_prompt);
    terminal.type(std::string(k_up) + "\n");
    EXPECT_THAT(terminal.wait_for(k_prompt), HasSubstr("42")) << "the line that Ctrl-C threw away is not the last statement";
    terminal.type("while true do end\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    terminal.type(k_ctrl_c);
    terminal.wait_for(k_prompt);
    terminal.type("for i = 1, 2 do\n");
    terminal.wait_for(">> ");
    terminal.type("print('n' .. i) end\n");
    EXPECT_THAT(terminal.wait_for(k_prompt), HasSubstr("n2"));
    terminal.type(k_ctrl_d);
    EXPECT_EQ(terminal.wait(), 0);
  }
  std::ifstream history(home / ".local" / "state" / "sterna" / "history");
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(history), {}), HasSubstr("20 + 22"));
  Terminal again(home);
  again.wait_for(k_prompt);
  again.type(std::string(k_up) + "\n");
  EXPECT_THAT(again.wait_for(k_prompt), HasSubstr("n2"));
  again.type("exit\n");
  EXPECT_EQ(again.wait(), 0);
}

}  // namespace
}  // namespace sterna::scripting
