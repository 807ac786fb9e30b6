#include "scripting/lua/table_reader.h"

#include <algorithm>
#include <optional>

#include "geom/base/error.h"
#include "scripting/lua/quantity.h"
#include "scripting/lua/script_check.h"

namespace sterna::scripting {
namespace {

std::string joined(const ErrorInfo& info) { return info.hint.empty() ? info.problem : info.problem + " (" + info.hint + ")"; }

const Option* find(const OptionTable& options, std::string_view name) {
  const auto it = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == name; });
  return it == options.end() ? nullptr : &*it;
}

bool is_stage(const OptionTable& options, std::string_view name) {
  return std::any_of(options.begin(), options.end(), [&](const Option& o) { return o.stage == name; });
}

/// Returns the name of an option in its stage's own table, which is the name without the stage's prefix.
std::string short_name(const Option& option) {
  const std::string prefix = std::string(option.stage) + "_";
  const std::string name(option.name);
  return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

/// Returns the numbers of a list {1, 2, 3} without names.
std::optional<std::vector<double>> list_of_numbers(const ScriptValue& value) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || !(*table)->fields.empty() || !(*table)->other_keys.empty()) return std::nullopt;
  std::vector<double> numbers;
  for (const ScriptValue& item : (*table)->items) {
    if (const auto* number = std::get_if<double>(&item)) numbers.push_back(*number);
    else if (const auto* whole = std::get_if<std::int64_t>(&item)) numbers.push_back(static_cast<double>(*whole));
    else return std::nullopt;
  }
  return numbers;
}

/// Returns the value of an option that is a vector or a list; nothing for any other option or value.
std::optional<OptionValue> value_of_table(const Option& option, const ScriptValue& value) {
  const std::optional<std::vector<double>> numbers = list_of_numbers(value);
  if (option.kind == OptionKind::vector && numbers && numbers->size() == 3) return Vec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  if (option.kind == OptionKind::numbers && numbers) return *numbers;
  return std::nullopt;
}

/// Returns a hint to write a single string in place of a list of strings, if the option expects one string; else an empty text.
std::string as_one_text(const Option& option, const ScriptValue& value) {
  const auto* list = std::get_if<TableHandle>(&value);
  if (option.kind != OptionKind::string || !list || (*list)->items.empty()) return {};
  std::string text;
  for (const ScriptValue& item : (*list)->items) {
    if (!std::holds_alternative<std::string>(item)) return {};
    text += (text.empty() ? "" : " ") + std::get<std::string>(item);
  }
  return "; write " + std::string(option.name) + " = \"" + text + "\"";
}

bool contains(const std::vector<std::string>& names, std::string_view name) { return std::ranges::find(names, name) != names.end(); }

ScriptValue list_value(std::vector<ScriptValue> items) {
  return std::make_shared<const ScriptTable>(ScriptTable{.items = std::move(items), .fields = {}, .other_keys = {}});
}

}  // namespace

ScriptValue script_value_of(const OptionValue& value) {
  return std::visit(
      [](const auto& v) -> ScriptValue {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, Vec3>) return list_value({v.x, v.y, v.z});
        else if constexpr (std::is_same_v<V, std::vector<double>>) return list_value({v.begin(), v.end()});
        else if constexpr (std::is_same_v<V, std::vector<Vec3>>) {
          std::vector<ScriptValue> points;
          for (const Vec3& point : v) points.push_back(script_value_of(point));
          return list_value(std::move(points));
        } else return v;
      },
      value);
}

TableReader::TableReader(const ScriptTable& table, std::string attempted) : table_(table), attempted_(std::move(attempted)) {}

TableReader::TableReader(const ScriptTable& table, const Attempt& attempted)
    : table_(table), attempted_(attempted), check_(attempted.check), ends_with_checks_(attempted.ends_with_checks) {}

const FunctionHandle* TableReader::option_function(std::string_view stage, std::string_view name) {
  const auto function_in = [&](const ScriptTable& table) {
    const auto location = table.fields.find(std::string(name));
    return location == table.fields.end() ? nullptr : std::get_if<FunctionHandle>(&location->second);
  };
  const FunctionHandle* function = function_in(table_);
  if (const auto location = table_.fields.find(std::string(stage)); !function && location != table_.fields.end())
    if (const auto* nested = std::get_if<std::shared_ptr<const ScriptTable>>(&location->second)) function = function_in(**nested);
  if (function) functions_.insert(std::string(stage) + "." + std::string(name));
  return function;
}

std::size_t TableReader::read_options(const OptionTable& options) {
  const std::size_t n_before = given_.size();
  for (const Option& option : options) {
    known_.emplace_back(option.name);
    if (std::find(known_.begin(), known_.end(), option.stage) == known_.end()) known_.emplace_back(option.stage);
  }
  for (const auto& [key, value] : table_.fields) {
    const auto* nested = std::get_if<std::shared_ptr<const ScriptTable>>(&value);
    if (nested && is_stage(options, key)) {
      requested_.insert(key);
      read_stage(options, key, **nested);
    } else if (const Option* option = find(options, key)) {
      requested_.insert(key);
      set(*option, key, value);
    } else if (is_stage(options, key)) {
      requested_.insert(key);
      add_problem(key + ": expected a table with options of this stage, not " + std::string(type_text(value)));
    }
  }
  return given_.size() - n_before;
}

void TableReader::read_stage(const OptionTable& options, const std::string& stage, const ScriptTable& table) {
  std::vector<std::string> known;
  for (const Option& option : options)
    if (option.stage == stage) known.push_back(short_name(option));
  for (const auto& [key, value] : table.fields) {
    const auto it = std::find_if(options.begin(), options.end(),
                                 [&, name = std::string_view(key)](const Option& o) { return o.stage == stage && (o.name == name || short_name(o) == name); });
    if (it == options.end()) add_unknown(stage + "." + key, known);
    else set(*it, stage + "." + key, value);
  }
  if (!table.items.empty() || !table.other_keys.empty()) add_problem(stage + ": every entry of this table needs a name");
}

void TableReader::set(const Option& option, const std::string& key, const ScriptValue& value) {
  if (!given_.insert(std::string(option.stage) + "." + std::string(option.name)).second) {
    add_problem(key + ": given twice");
    return;
  }
  if (functions_.contains(std::string(option.stage) + "." + std::string(option.name)) && std::holds_alternative<FunctionHandle>(value)) return;
  try {
    if (const auto* flag = std::get_if<bool>(&value)) set_option(option, *flag);
    else if (const auto* whole = std::get_if<std::int64_t>(&value)) set_option(option, *whole);
    else if (const auto* text = std::get_if<std::string>(&value)) set_option(option, *text);
    else if (const auto* number = std::get_if<double>(&value); number && is_automatic(*number)) add_problem(key + ": is not a number (NaN, e.g. from 0/0)");
    else if (number) set_option(option, *number);
    else if (const auto* quantity = std::get_if<QuantityHandle>(&value);
             quantity && (*quantity)->is_length() && option.kind == OptionKind::number && option.unit == Unit::metre) {
      set_option(option, (*quantity)->metres);
      quantities_[std::string(option.stage) + "." + std::string(option.name)] = *quantity;
    } else if (const std::optional<OptionValue> read = value_of_table(option, value)) set_option(option, *read);
    else
      add_problem(key + ": " + std::string(type_text(value)) + " is not allowed here, expected " + std::string(kind_text(option.kind)) + " (" +
                  std::string(option.help) + ")" + as_one_text(option, value));
    if (check_) check_->options.push_back({attempted_, std::string(option.stage) + "." + std::string(option.name), option.get()});
  } catch (const Error& error) {
    const bool is_angle_in_degrees = option.unit == Unit::radian && !std::holds_alternative<std::string>(value);
    add_problem(key + ": " + (is_angle_in_degrees ? error.info().problem + " (angles are in radians; write degrees as 40*deg)" : joined(error.info())));
  }
}

const QuantityValue* TableReader::quantity_of(std::string_view stage, std::string_view name) const {
  const auto found = quantities_.find(std::string(stage) + "." + std::string(name));
  return found == quantities_.end() ? nullptr : found->second.get();
}

const std::vector<ScriptValue>& TableReader::items() {
  are_items_requested_ = true;
  return table_.items;
}

const ScriptValue* TableReader::field(const std::string& name) {
  known_.push_back(name);
  requested_.insert(name);
  const auto it = table_.fields.find(name);
  return it == table_.fields.end() ? nullptr : &it->second;
}

void TableReader::require(const OptionTable& options) {
  for (const Option& option : options) {
    if (given_.contains(std::string(option.stage) + "." + std::string(option.name)) || contains(table_.unknown_fields, option.name)) continue;
    try {
      require_options({option}, attempted_);
    } catch (const Error& error) {
      add_problem(error.info().problem);
    }
  }
}

void TableReader::add_problem(std::string problem) { problems_.push_back(std::move(problem)); }

void TableReader::add_unknown(const std::string& key, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(key.substr(key.rfind('.') + 1), known);
  // A mistyped key is one mistake: it is not reported in addition as a missing option (see require()).
  if (!nearest.empty()) std::erase_if(problems_, [&](const std::string& problem) { return problem.starts_with("needs " + nearest + " ("); });
  add_problem("unknown key \"" + key + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"));
  ++n_unknown_;
}

void TableReader::finish() {
  for (const auto& [key, value] : table_.fields)
    if (!requested_.contains(key)) add_unknown(key, known_);
  for (const std::string& key : table_.unknown_fields)
    if (!contains(known_, key)) add_unknown(key, known_);
  if (!are_items_requested_ && !table_.items.empty()) add_problem("entry 1: every entry of this table needs a name");
  for (const std::string& key : table_.other_keys) add_problem("key " + key + ": keys must be names");
  if (problems_.empty() && ends_with_checks_) throw ChecksDone{};
  if (problems_.empty()) return;
  std::string text;
  if (problems_.size() == 1) {
    text = problems_.front();
  } else {
    text = std::to_string(problems_.size()) + " problems in this table";
    for (const std::string& problem : problems_) text += "\n  - " + problem;
  }
  throw Error({.code = n_unknown_ == problems_.size() ? ErrorCode::unknown_option : ErrorCode::bad_argument, .attempted = attempted_, .problem = text});
}

}  // namespace sterna::scripting
