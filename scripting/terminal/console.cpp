#include "scripting/terminal/console.h"

#include <fmt/core.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <mutex>

#include "geom/base/error.h"
#include "scripting/terminal/time_left.h"

namespace sterna::scripting {
namespace {

using Clock = std::chrono::steady_clock;

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::debug: return spdlog::level::debug;
    case LogLevel::info: return spdlog::level::info;
    case LogLevel::warning: return spdlog::level::warn;
    case LogLevel::error: return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::string_view prefix_of(spdlog::level::level_enum level) {
  if (level == spdlog::level::warn) return "warning: ";
  if (level >= spdlog::level::err) return "error: ";
  return "";
}

/// The progress line at the bottom of a terminal; guarded by the console's mutex.
class ProgressLine {
 public:
  void show(const ProgressState& state) {
    if (!is_terminal_) return;
    time_left_.note(state, std::chrono::duration<double>(Clock::now() - begin_).count());
    std::string text = fmt::format("[{:3.0f} %] {}", 100.0 * time_left_.share(), state.stage);
    if (const std::optional<double> left = time_left_.estimate()) text += ", about " + duration_text(*left) + " left";
    std::fprintf(stderr, "\r%s\033[K", text.c_str());
    std::fflush(stderr);
    is_shown_ = true;
  }
  void wipe() {
    if (!is_shown_) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    is_shown_ = false;
  }

 private:
  bool is_terminal_ = isatty(STDERR_FILENO) != 0;
  bool is_shown_ = false;
  TimeLeft time_left_;
  Clock::time_point begin_ = Clock::now();
};

class StderrSink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string_view prefix = prefix_of(message.level);
    std::fprintf(stderr, "%.*s%.*s\n", static_cast<int>(prefix.size()), prefix.data(), static_cast<int>(message.payload.size()), message.payload.data());
  }
  void flush_() override { std::fflush(stderr); }
};

}  // namespace

struct Console::State {
  std::mutex mutex;
  ProgressLine line;
  bool is_quiet = false;
  std::unique_ptr<spdlog::logger> logger;
};

Console::Console(const ConsoleSettings& settings) : state_(std::make_unique<State>()) {
  state_->is_quiet = settings.is_quiet;
  auto to_stderr = std::make_shared<StderrSink>();
  to_stderr->set_level(settings.is_quiet ? spdlog::level::warn : settings.is_verbose ? spdlog::level::debug : spdlog::level::info);
  std::vector<spdlog::sink_ptr> sinks = {to_stderr};
  if (!settings.log_file.empty()) {
    try {
      auto to_file = std::make_shared<spdlog::sinks::basic_file_sink_st>(settings.log_file.string(), true);
      to_file->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
      sinks.push_back(to_file);
    } catch (const spdlog::spdlog_ex& failure) {
      throw Error({.code = ErrorCode::write_failed, .attempted = "opening the log " + settings.log_file.string(), .problem = failure.what()});
    }
  }
  state_->logger = std::make_unique<spdlog::logger>("sterna", sinks.begin(), sinks.end());
  state_->logger->set_level(spdlog::level::debug);
  state_->logger->flush_on(spdlog::level::warn);
}

Console::~Console() { end_progress(); }

void Console::print(std::string_view text) {
  const std::scoped_lock lock(state_->mutex);
  state_->line.wipe();
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  std::fflush(stdout);
}

void Console::log(LogLevel level, std::string_view text) {
  const std::scoped_lock lock(state_->mutex);
  state_->line.wipe();
  state_->logger->log(level_of(level), text);
}

void Console::error(std::string_view text) { log(LogLevel::error, text); }

void Console::progress(const ProgressState& state) {
  const std::scoped_lock lock(state_->mutex);
  if (!state_->is_quiet) state_->line.show(state);
}

void Console::end_progress() {
  const std::scoped_lock lock(state_->mutex);
  state_->line.wipe();
}

std::string duration_text(double seconds) {
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  if (seconds < 60.0) return fmt::format("{:.0f} s", seconds);
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole % 3600 / 60);
}

}  // namespace sterna::scripting
