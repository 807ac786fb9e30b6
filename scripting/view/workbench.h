// The workbench: follows a script, runs it in a worker process whenever the script or its arguments change, and answers the page (docs/view.md).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "scripting/lua/script_call.h"
#include "scripting/view/page_server.h"

namespace sterna::scripting {

struct WorkbenchSettings {
  std::filesystem::path input;     ///< the user's input: a script, or the file of a model, a surface, a mesh
  std::filesystem::path script;    ///< script that is run: the input, or a script generated to read the input
  bool is_made_script = false;     ///< the script was generated; it has no arguments to write back
  OptionOverrides arguments;       ///< initial NAME=VALUE
  std::vector<std::string> words;  ///< command line of a worker after the program's name
  std::string_view page;           ///< HTML
  std::string cases;               ///< JSON list of the cases of a finished series (finished_series.h); empty if the input is no series
  std::vector<std::filesystem::path> pictures;
};

class Workbench {
 public:
  explicit Workbench(const WorkbenchSettings& settings);
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  /// Follows the script until a stop is requested; afterwards no call waits in answer() any more.
  void follow(const std::stop_token& stop);
  /// Answers a request of the page, from any thread; waits while there is nothing new for the page.
  PageAnswer answer(const PageRequest& request);

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sterna::scripting
