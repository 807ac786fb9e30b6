#include "scripting/values/geometry_tools.h"

#include "scripting/lua/component_value.h"
#include "scripting/lua/quantity.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {

std::optional<double> number_of(const ScriptValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* quantity = std::get_if<QuantityHandle>(&value); quantity && (*quantity)->is_length()) return (*quantity)->metres;
  return std::nullopt;
}

std::optional<std::vector<double>> numbers_of(const ScriptValue& value) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || !(*table)->fields.empty() || !(*table)->other_keys.empty()) return std::nullopt;
  std::vector<double> numbers;
  for (const ScriptValue& item : (*table)->items) {
    const auto number = number_of(item);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<Vec3> point_of(const ScriptValue& value) {
  const auto numbers = numbers_of(value);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  return Vec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

std::optional<std::array<double, 2>> pair_of(const ScriptValue& value) {
  const auto numbers = numbers_of(value);
  if (!numbers || numbers->size() != 2) return std::nullopt;
  return std::array{(*numbers)[0], (*numbers)[1]};
}

std::optional<std::vector<std::vector<double>>> rows_of(const ScriptValue& value, std::size_t n) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || (*table)->items.empty() || !(*table)->fields.empty() || !(*table)->other_keys.empty()) return std::nullopt;
  std::vector<std::vector<double>> rows;
  for (const ScriptValue& item : (*table)->items) {
    auto row = numbers_of(item);
    if (!row || row->size() != n) return std::nullopt;
    rows.push_back(std::move(*row));
  }
  return rows;
}

std::optional<Vec3> read_point(TableReader& reader, const std::string& name) {
  const ScriptValue* value = reader.field(name);
  if (!value) return std::nullopt;
  const auto point = point_of(*value);
  if (!point) reader.add_problem(name + ": expected a point {x, y, z} in metres, not " + std::string(type_text(*value)));
  return point;
}

std::optional<std::array<double, 2>> read_pair(TableReader& reader, const std::string& name, std::string_view what) {
  const ScriptValue* value = reader.field(name);
  if (!value) return std::nullopt;
  const auto pair = pair_of(*value);
  if (!pair) reader.add_problem(name + ": expected " + std::string(what) + ", not " + std::string(type_text(*value)));
  return pair;
}

std::optional<std::vector<double>> read_numbers(TableReader& reader, const std::string& name) {
  const ScriptValue* value = reader.field(name);
  if (!value) return std::nullopt;
  const auto numbers = numbers_of(*value);
  if (!numbers) reader.add_problem(name + ": expected a list of numbers, not " + std::string(type_text(*value)));
  return numbers;
}

void refuse_items_beyond(TableReader& reader, std::size_t n) {
  if (reader.items().size() > n) reader.add_problem("entry " + std::to_string(n + 1) + ": unexpected, the verb takes fewer entries without names");
}

std::vector<ShapeEntry> read_shapes(TableReader& reader, const std::string& name, std::string_view usage) {
  const ScriptValue* value = reader.field(name);
  if (!value) return {};
  const auto* table = std::get_if<TableHandle>(value);
  if (!table) {
    reader.add_problem(name + ": expected a list such as { " + std::string(usage) + " }");
    return {};
  }
  const bool is_single = (*table)->fields.contains("shape");
  if (!is_single && (!(*table)->fields.empty() || !(*table)->other_keys.empty())) reader.add_problem(name + ": entries of this list must not have names");
  std::vector<ShapeEntry> entries;
  for (const ScriptValue& item : is_single ? std::vector<ScriptValue>{*value} : (*table)->items) {
    ShapeEntry entry{.table = nullptr, .shape = {}, .value = item, .where = name + ", entry " + std::to_string(entries.size() + 1)};
    if (const auto* shape = std::get_if<TableHandle>(&item); shape && (*shape)->fields.contains("shape")) {
      entry.table = *shape;
      if (const auto* text = std::get_if<std::string>(&(*shape)->fields.at("shape"))) entry.shape = *text;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::optional<InputPath> single_file(const ScriptCall& call, TableReader& reader) {
  const std::vector<InputPath> files = file_names(call, reader);
  if (files.size() > 1) reader.add_problem("takes one file, not " + std::to_string(files.size()));
  if (files.empty()) return std::nullopt;
  return files.front();
}

std::optional<PatchKind> read_patch_kind(const ScriptValue& value, const std::string& key, TableReader& reader) {
  std::string known;
  for (const PatchKind kind :
       {PatchKind::wall, PatchKind::slip, PatchKind::symmetry, PatchKind::inflow, PatchKind::outflow, PatchKind::farfield, PatchKind::interface}) {
    if (const auto* text = std::get_if<std::string>(&value); text && *text == to_string(kind)) return kind;
    known += (known.empty() ? "" : ", ") + std::string(to_string(kind));
  }
  const auto* text = std::get_if<std::string>(&value);
  reader.add_problem(key + ": expected the kind of a patch (" + known + "), not " + (text ? "\"" + *text + "\"" : std::string(type_text(value))));
  return std::nullopt;
}

ModelHandle model_of(const ScriptValue& value, const ScriptCall& call) {
  if (const auto* model = std::get_if<ModelHandle>(&value)) return *model;
  if (const auto* component = std::get_if<ComponentHandle>(&value)) {
    ModelValue model = make_aircraft({.components = {*component}}, call.session.context);
    model.provenance = key_of(**component);
    return std::make_shared<const ModelValue>(std::move(model));
  }
  return nullptr;
}

Transform attitude(const Point& about, double roll, double pitch, double yaw) {
  return rotation(about, {0.0, 0.0, -1.0}, yaw) * rotation(about, {0.0, 1.0, 0.0}, pitch) * rotation(about, {-1.0, 0.0, 0.0}, roll);
}

ScriptValue wing_table(const WingReference& wing) {
  auto table = std::make_shared<ScriptTable>();
  table->fields = {{"span", wing.span},
                   {"area", wing.area},
                   {"projected_area", wing.projected_area},
                   {"unrolled_area", wing.unrolled_area},
                   {"aspect_ratio", wing.aspect_ratio},
                   {"mean_geometric_chord", wing.mean_geometric_chord},
                   {"mean_aerodynamic_chord", wing.mean_aerodynamic_chord},
                   {"aerodynamic_chord_start", list_of(wing.aerodynamic_chord_start)}};
  return table;
}

ScriptValue list_of(const Vec3& p) {
  auto table = std::make_shared<ScriptTable>();
  table->items = {p.x, p.y, p.z};
  return table;
}

}  // namespace sterna::scripting
