// The only reader of verbs' tables. It collects every problem (unknown keys with a suggestion, wrong types, ranges, missing values) before it throws.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// Returns the value of an option as a script writes it: vectors and lists as tables, no value as nil.
ScriptValue script_value_of(const OptionValue& value);

/// Reads one table of one call. Every entry must be read by one of the members; finish() reports the others as problems.
class TableReader {
 public:
  /// \p attempted is the start of the message: "case.lua:5: volume_mesh".
  TableReader(const ScriptTable& table, std::string attempted);
  /// For a verb's own table. If the run only checks (script_check.h), the options are noted, and finish() ends a heavy verb.
  TableReader(const ScriptTable& table, const Attempt& attempted);

  /// Sets the options named in the table, flat ("layers = 30") or in a table by stage ("envelope = { layers = 30 }"; there the prefix of the stage's name may
  /// be omitted: "farfield = { radius = 50 }" for farfield_radius). Returns the number of named options.
  std::size_t read_options(const OptionTable& options);
  /// Returns the function that the table has for this option, alone or in its stage's table; the option is then marked as given. Returns null if there is none.
  /// To be called before read_options.
  const FunctionHandle* option_function(std::string_view stage, std::string_view name);
  /// Returns true if the table names the option, alone or in its stage's table.
  /// \pre read_options
  bool is_given(std::string_view stage, std::string_view name) const { return given_.contains(std::string(stage) + "." + std::string(name)); }
  /// Returns the length from flow conditions that the table has for this option; null if there is none.
  /// \pre read_options
  const QuantityValue* quantity_of(std::string_view stage, std::string_view name) const;
  bool has_problems() const { return !problems_.empty(); }
  /// Returns the unnamed entries, and marks them as read.
  const std::vector<ScriptValue>& items();
  /// Returns a named entry that is no option, or nullptr, and marks it as read.
  const ScriptValue* field(const std::string& name);
  /// Notes the required options that still have no value; an option with a rejected value is already a problem.
  void require(const OptionTable& options);
  /// Notes a problem found by the caller.
  void add_problem(std::string problem);

  /// \throws Error(bad_argument, or unknown_option if all problems are unknown keys) with every problem of the table; ChecksDone if the check ends the verb
  /// here.
  void finish();

 private:
  void set(const Option& option, const std::string& key, const ScriptValue& value);
  void read_stage(const OptionTable& options, const std::string& stage, const ScriptTable& table);
  void add_unknown(const std::string& key, const std::vector<std::string>& known);

  const ScriptTable& table_;
  std::string attempted_;
  ScriptCheck* check_ = nullptr;
  bool ends_with_checks_ = false;
  std::vector<std::string> known_;                    ///< keys that the verb accepts, for suggestions
  std::set<std::string> requested_;                   ///< keys that were read
  std::set<std::string> functions_;                   ///< options that have a function instead of a value
  std::map<std::string, QuantityHandle> quantities_;  ///< options given as flow quantities
  std::set<std::string> given_;                       ///< options that have a value already, to detect contradictions
  bool are_items_requested_ = false;
  std::vector<std::string> problems_;
  std::size_t n_unknown_ = 0;
};

}  // namespace sterna::scripting
