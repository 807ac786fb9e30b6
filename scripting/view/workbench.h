// The workbench: follows a script, has it run by a worker process whenever it or its arguments change, and answers the page (docs/view.md).
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
  std::filesystem::path input;     ///< what the user named: a script, or the file of a model, a surface, a mesh
  std::filesystem::path script;    ///< what is run: the input, or a script made for it that reads it
  bool is_made_script = false;     ///< the latter: it is run as it is, and has no arguments to write back
  OptionOverrides arguments;       ///< NAME=VALUE that it starts with
  std::vector<std::string> words;  ///< command line of a worker behind the program's name
  std::string_view page;           ///< HTML
  std::string cases;               ///< of a series that has run, its JSON list (series_cases.h); empty: it is none
  std::vector<std::filesystem::path> pictures;
};

class Workbench {
 public:
  explicit Workbench(const WorkbenchSettings& settings);
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  /// Follows the script until a stop is asked for; afterwards nobody waits in answer() any more.
  void follow(const std::stop_token& stop);
  /// An answer to the page, from any thread; waits while the page has seen all there is.
  PageAnswer answer(const PageRequest& request);

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sterna::scripting
