#include "geom/cad/occt_call.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressScope.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TCollection_AsciiString.hxx>

#include <chrono>
#include <mutex>
#include <new>

#include "geom/base/error.h"

namespace sterna::cad {
namespace {

using Clock = std::chrono::steady_clock;

/// Longest OpenCASCADE message that is passed on; readers may report a problem for every entity of a file.
constexpr std::size_t k_max_words = 600;

/// Collects OpenCASCADE's error messages instead of printing them.
class ComplaintPrinter : public Message_Printer {
 public:
  std::string take() { return std::move(words_); }
  DEFINE_STANDARD_RTTI_INLINE(ComplaintPrinter, Message_Printer)

 protected:
  void send(const TCollection_AsciiString& text, const Message_Gravity gravity) const override {
    if (gravity < Message_Fail || words_.size() > k_max_words) return;
    words_ += (words_.empty() ? "" : "; ") + std::string(text.ToCString());
  }

 private:
  mutable std::string words_;
};

/// Passes a stop and the time limit to OpenCASCADE, and its progress to us.
class StopIndicator : public Message_ProgressIndicator {
 public:
  StopIndicator(const RunContext& context, double time_limit) : context_(context), start_(Clock::now()), time_limit_(time_limit) {}
  bool is_late() const { return time_limit_ > 0.0 && std::chrono::duration<double>(Clock::now() - start_).count() > time_limit_; }
  DEFINE_STANDARD_RTTI_INLINE(StopIndicator, Message_ProgressIndicator)

 protected:
  Standard_Boolean UserBreak() override { return context_.stop_token().stop_requested() || is_late(); }
  void Show(const Message_ProgressScope&, const Standard_Boolean) override {}

 private:
  RunContext context_;
  Clock::time_point start_;
  double time_limit_;
};

/// During its lifetime OpenCASCADE's messenger passes its messages only to us.
class QuietMessenger {
 public:
  QuietMessenger() : messenger_(Message::DefaultMessenger()), printers_(messenger_->Printers()), complaints_(new ComplaintPrinter) {
    messenger_->ChangePrinters().Clear();
    messenger_->AddPrinter(complaints_);
  }
  ~QuietMessenger() { messenger_->ChangePrinters() = printers_; }
  QuietMessenger(const QuietMessenger&) = delete;
  QuietMessenger& operator=(const QuietMessenger&) = delete;
  std::string words() { return complaints_->take(); }

 private:
  Handle(Message_Messenger) messenger_;
  Message_SequenceOfPrinters printers_;
  Handle(ComplaintPrinter) complaints_;
};

std::mutex& occt_mutex() {
  static std::mutex mutex;  // OpenCASCADE's translators share static parameters: only a process-wide lock helps
  return mutex;
}

[[noreturn]] void fail(const OcctTask& task, const std::string& problem, const std::string& complaints, const char* otherwise) {
  throw Error({.code = ErrorCode::geometry_failed,
               .attempted = task.attempted,
               .problem = problem + (complaints.empty() ? "" : "; OpenCASCADE reports: " + complaints),
               .hint = task.hint.empty() ? otherwise : task.hint});
}

}  // namespace

void run_occt(const OcctTask& task, const RunContext& context, const std::function<void(const Message_ProgressRange&)>& work) {
  const std::lock_guard lock(occt_mutex());
  context.check_stop();
  QuietMessenger messenger;
  const Handle(StopIndicator) indicator = new StopIndicator(context, task.time_limit);
  const auto refuse_when_late = [&] {
    context.check_stop();
    if (indicator->is_late())
      fail(task, "took longer than the limit of " + std::to_string(static_cast<int>(task.time_limit)) + " s", {}, "a larger time_limit, or simpler geometry");
  };
  try {
    work(indicator->Start());
  } catch (const Error&) {  // a translator that was stopped cannot be distinguished from one that failed
    refuse_when_late();
    throw;
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const std::string name = failure.DynamicType()->Name();
    const std::string text = failure.GetMessageString() ? failure.GetMessageString() : "";
    context.check_stop();
    fail(task, "OpenCASCADE failed with " + name + (text.empty() ? "" : " (" + text + ")"), messenger.words(),
         "another tolerance, or fewer parts at once to find the part that causes the failure");
  }
  refuse_when_late();
}

}  // namespace sterna::cad
