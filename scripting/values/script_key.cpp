#include "scripting/values/script_key.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "geom/base/hash.h"
#include "geom/model/airfoil.h"
#include "scripting/lua/component_value.h"
#include "scripting/lua/script_function.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/models.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

bool add(const ScriptValue& value, const ScriptCall& call, KeyMaker& maker);

/// Adds a string. If it names a file, also adds the content and the name of the file (without its folder), because models are named after the file.
void add_text(const std::string& text, const ScriptCall& call, KeyMaker& maker) {
  const std::filesystem::path path = find_input(call, text).path;
  std::error_code none;
  const bool is_file = !text.empty() && std::filesystem::is_regular_file(path, none);
  maker.add(is_file);
  if (is_file) maker.add(path.filename().string()).add(hash_file(path));
  else maker.add(text);
}

bool add_table(const ScriptTable& table, const ScriptCall& call, KeyMaker& maker) {
  maker.add(static_cast<std::uint64_t>(table.items.size()));
  for (const ScriptValue& item : table.items)
    if (!add(item, call, maker)) return false;
  maker.add(static_cast<std::uint64_t>(table.fields.size()));
  for (const auto& [name, value] : table.fields) {
    maker.add(name);
    if (!add(value, call, maker)) return false;
  }
  maker.add(table.other_keys);
  return true;
}

/// Returns false if the value has no key.
bool add(const ScriptValue& value, const ScriptCall& call, KeyMaker& maker) {
  if (const auto number = number_of(value)) {  // 2 and 2.0 are the same number
    maker.add("number").add(*number);
    return true;
  }
  maker.add(static_cast<std::uint64_t>(value.index()));
  if (std::holds_alternative<std::monostate>(value)) return true;
  if (const auto* flag = std::get_if<bool>(&value)) maker.add(*flag);
  else if (const auto* text = std::get_if<std::string>(&value)) add_text(*text, call, maker);
  else if (const auto* table = std::get_if<TableHandle>(&value)) return add_table(**table, call, maker);
  else if (const auto* component = std::get_if<ComponentHandle>(&value)) maker.add(key_of(**component));
  else if (const auto* airfoil = std::get_if<AirfoilHandle>(&value)) maker.add((*airfoil)->name).add((*airfoil)->points);
  else if (const auto* function = std::get_if<FunctionHandle>(&value)) maker.add((*function)->key());
  else {
    std::optional<ContentKey> key;
    if (const auto* model = std::get_if<ModelHandle>(&value)) key = (*model)->provenance.key();
    else if (const auto* surface = std::get_if<SurfaceHandle>(&value)) key = key_of(**surface);
    if (!key) return false;
    maker.add(*key);
  }
  return true;
}

/// Returns true if an option can affect a model, which options of meshing do not.
bool is_of_models(const std::string& option) {
  volmesh::MeshCase volume;
  surfmesh::SurfaceMeshOptions surface;
  OptionTable later = volmesh::options_of(volume);
  for (Option& entry : sterna::options_of(surface)) later.push_back(std::move(entry));
  const std::size_t dot = option.find('.');
  return std::none_of(later.begin(), later.end(),
                      [&](const Option& entry) { return dot == std::string::npos ? option == entry.name : option.substr(0, dot) == entry.stage; });
}

}  // namespace

std::optional<ContentKey> key_of_call(const ScriptCall& call) {
  KeyMaker maker("call");
  maker.add(call.verb).add(call.session.context.seed());
  for (const ScriptValue& argument : call.arguments)
    if (!add(argument, call, maker)) return std::nullopt;
  for (const auto& [name, text] : call.session.overrides)
    if (is_of_models(name)) maker.add(name).add(text);
  return maker.key();
}

ScriptValue with_provenance(ScriptValue result, const ScriptCall& call) {
  const auto* model = std::get_if<ModelHandle>(&result);
  const auto is_same = [&](const ScriptValue& argument) { return std::holds_alternative<ModelHandle>(argument) && std::get<ModelHandle>(argument) == *model; };
  if (call.session.cache == nullptr || model == nullptr || std::any_of(call.arguments.begin(), call.arguments.end(), is_same)) return result;
  const std::optional<ContentKey> key = key_of_call(call);
  if (!key) return result;
  auto known = std::make_shared<ModelValue>(**model);  // copies handles only: the geometry is shared
  known->provenance = *key;
  return ModelHandle(std::move(known));
}

}  // namespace sterna::scripting
