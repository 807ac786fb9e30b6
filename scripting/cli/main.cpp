#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>

#include "scripting/cli/cli.h"

namespace {

/// Prints a last message for a crash in this program or in a library. The process still ends by the signal, so that the parent process can detect it.
extern "C" void say_that_it_crashed(int signal) {
  const char* words =
      "\nerror: sterna crashed; files that were being written are missing\n  try: a larger memory limit, if memory is limited (ulimit -v, the job's memory: "
      "libraries crash without memory); otherwise please report this with the script and its inputs\n";
  [[maybe_unused]] const ssize_t n = ::write(STDERR_FILENO, words, std::strlen(words));
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

/// Installs the handler on a separate stack, because the normal one may be exhausted. Does nothing if crashes are handled elsewhere (sanitizers).
void watch_for_crashes() {
  static std::array<char, 65536> stack;
  stack_t other{};
  other.ss_sp = stack.data();
  other.ss_size = stack.size();
  ::sigaltstack(&other, nullptr);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_handler = say_that_it_crashed;
    action.sa_flags = SA_ONSTACK | SA_RESETHAND | SA_NODEFER;
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace

int main(int argc, char** argv) {
  watch_for_crashes();
  return sterna::scripting::run_command_line(argc, argv);
}
