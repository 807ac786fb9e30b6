// Arguments that a script and its modules declare with args{}.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// An argument that a script declares with args{}.
struct ScriptParameter {
  std::string name;
  ScriptValue initial;             ///< SI; nil: the argument is required
  ScriptValue value;               ///< SI, the current value
  std::optional<double> min, max;  ///< limits in `unit`
  std::optional<double> step;      ///< step in `unit`
  std::string unit = {};           ///< "deg"; empty: a plain number, string or flag
  double unit_value = 1.0;         ///< SI value of the unit, which plain numbers on the command line have
};

/// All arguments that a run has declared so far, in script and modules.
struct DeclaredArguments {
  std::vector<ScriptParameter> list = {};             ///< in the order of declaration
  std::map<std::string, std::string> locations = {};  ///< name -> location of the declaration, "case.lua:5"
  std::set<std::string> calls = {};                   ///< locations of the args{} that have run
  bool is_refused = false;                            ///< the error of an unknown argument was raised
};

}  // namespace sterna::scripting
