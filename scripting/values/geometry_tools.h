// What verbs of geometry share: points, numbers and lists out of tables, and models out of values.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "geom/model/frame.h"
#include "geom/model/reference_data.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/lua/verb_tools.h"

namespace sterna::scripting {

std::optional<double> number_of(const ScriptValue& value);
/// {x, y, z}: three numbers without names.
std::optional<Vec3> point_of(const ScriptValue& value);
/// {a, b}: two numbers without names.
std::optional<std::array<double, 2>> pair_of(const ScriptValue& value);
/// A list of rows of n numbers each: {{1, 2}, {3, 4}}. Nothing where it is something else.
std::optional<std::vector<std::vector<double>>> rows_of(const ScriptValue& value, std::size_t n);
/// {1, 2, 3}
std::optional<std::vector<double>> numbers_of(const ScriptValue& value);

/// The named entry as a point {x, y, z}, if it is there; notes a problem when it is something else.
std::optional<Vec3> read_point(TableReader& reader, const std::string& name);
std::optional<std::array<double, 2>> read_pair(TableReader& reader, const std::string& name, std::string_view what);
std::optional<std::vector<double>> read_numbers(TableReader& reader, const std::string& name);
/// Notes every unnamed entry beyond the n-th.
void refuse_items_beyond(TableReader& reader, std::size_t n);

/// What a verb such as sphere{...} gives: a table that says its shape.
struct ShapeEntry {
  TableHandle table;  ///< null: the entry is no such table
  std::string shape;  ///< "sphere"; empty then
  ScriptValue value;  ///< the entry itself
  std::string where;  ///< "sources, entry 2", for messages
};
/// The entries of the list `name` = { sphere{...}, box{...} }, or one of them alone; empty where the table has none. Notes problems; `usage` is an example of
/// an entry.
std::vector<ShapeEntry> read_shapes(TableReader& reader, const std::string& name, std::string_view usage);

/// The file "name" beside the script or in the current folder, for verbs that take one file.
std::optional<InputPath> single_file(const ScriptCall& call, TableReader& reader);

/// "wall", "slip", "inflow", ...; notes a problem where it is none.
std::optional<PatchKind> read_patch_kind(const ScriptValue& value, const std::string& key, TableReader& reader);

/// The model of a value: a model itself, or a component made one. Null where it is neither.
ModelHandle model_of(const ScriptValue& value, const ScriptCall& call);

/// Turned about the fixed axes through `about`: roll (starboard wing down), then pitch (nose up), then yaw (nose to starboard); x aft, y starboard, z up;
/// radians.
Transform attitude(const Point& about, double roll, double pitch, double yaw);

/// The reference data of a wing as a table for the script.
ScriptValue wing_table(const WingReference& wing);
/// A table of numbers for the script.
ScriptValue list_of(const Vec3& p);

}  // namespace sterna::scripting
