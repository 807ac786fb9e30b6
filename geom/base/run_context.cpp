#include "geom/base/run_context.h"

#include <sys/resource.h>

#include <chrono>

#include "geom/base/error.h"
#include "geom/base/run_context_state.h"

namespace sterna {
namespace {

constexpr auto k_progress_interval = std::chrono::milliseconds(100);

std::int64_t now_ns() { return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Returns the CPU time of this process and of the helpers that it has waited for.
double processor_seconds() {
  double seconds = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return seconds;
}

}  // namespace

RunContext::RunContext(RunSettings settings) : state_(std::make_shared<State>()), pool_(make_thread_pool(settings.threads)) {
  state_->settings = std::move(settings);
}

RunContext RunContext::beside(int threads, std::stop_token stop) const {
  RunContext result = *this;
  result.pool_ = make_side_pool(threads);
  result.is_beside_ = true;
  result.beside_stop_ = std::move(stop);
  return result;
}

ThreadPool& pool_of(const RunContext& context) { return *context.pool_; }

int RunContext::threads() const { return thread_count(*pool_); }
std::uint64_t RunContext::seed() const { return state_->settings.seed; }
const std::filesystem::path& RunContext::dump_directory() const { return state_->settings.dump_directory; }
std::stop_token RunContext::stop_token() const { return state_->settings.stop; }

void RunContext::report_if_long() const {
  if (stage_.empty() || is_beside_) return;
  const std::int64_t now = now_ns(), taken = now - begin_ns_;
  std::int64_t silent_until = state_->silent_until_ns.load(std::memory_order_relaxed);
  if (static_cast<double>(taken) < 1e9 * state_->settings.long_step || now < silent_until) return;
  if (!state_->silent_until_ns.compare_exchange_strong(silent_until, now + taken)) return;  // another thread reports it
  const std::int64_t minutes = taken / 60'000'000'000;
  warn(stage_.substr(0, stage_.find('/')) + " has taken " + (minutes > 0 ? std::to_string(minutes) + " min" : std::to_string(taken / 1'000'000'000) + " s") +
       " so far, now at " + stage_ + ", and continues; Ctrl-C stops the run without leaving partial files");
}

void RunContext::check_stop() const {
  report_if_long();
  if (!state_->settings.stop.stop_requested() && !beside_stop_.stop_requested()) return;
  throw Error({.code = ErrorCode::cancelled, .attempted = stage_.empty() ? "run" : stage_, .problem = "stopped on request"});
}

void RunContext::log(LogLevel level, std::string_view text) const {
  if (!state_->settings.log) return;
  const std::scoped_lock lock(state_->mutex);
  state_->settings.log(level, text);
}

RunContext RunContext::part(std::string_view stage, double from, double to) const {
  RunContext result = *this;
  result.stage_ = stage_.empty() ? std::string(stage) : stage_ + "/" + std::string(stage);
  result.begin_ns_ = begin_ns_;
  if (stage_.empty()) {
    result.begin_ns_ = now_ns();
    state_->silent_until_ns = 0;  // messages about the previous step do not apply to this one
  }
  result.from_ = from_ + from * (to_ - from_);
  result.to_ = from_ + to * (to_ - from_);
  result.progress(0.0);
  return result;
}

void RunContext::progress(double share) const {
  check_stop();
  if (!state_->settings.progress || is_beside_) return;
  const auto now = std::chrono::steady_clock::now();
  const std::scoped_lock lock(state_->mutex);
  if (now - state_->last_progress < k_progress_interval) return;
  state_->last_progress = now;
  state_->settings.progress({.stage = stage_, .share = from_ + share * (to_ - from_)});
}

void RunContext::add_time(const StageTime& time) const {
  const std::scoped_lock lock(state_->mutex);
  for (StageTime& known : state_->times) {
    if (known.stage != time.stage) continue;
    known.seconds += time.seconds;
    known.processor_seconds += time.processor_seconds;
    return;
  }
  state_->times.push_back(time);
}

std::vector<StageTime> RunContext::times() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->times;
}

StageTimer::StageTimer(const RunContext& context, std::string_view stage)
    : context_(context), stage_(stage), start_ns_(now_ns()), processor_start_(processor_seconds()) {}

StageTimer::~StageTimer() {
  context_.add_time(
      {.stage = stage_, .seconds = static_cast<double>(now_ns() - start_ns_) * 1e-9, .processor_seconds = processor_seconds() - processor_start_});
}

}  // namespace sterna
