// Helpers shared by the geometry verbs: points, numbers and lists from tables, and models from values.
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
/// Returns the point of {x, y, z}: three numbers without names.
std::optional<Vec3> point_of(const ScriptValue& value);
/// Returns the pair of {a, b}: two numbers without names.
std::optional<std::array<double, 2>> pair_of(const ScriptValue& value);
/// Returns a list of rows of n numbers each: {{1, 2}, {3, 4}}. Returns nothing for any other value.
std::optional<std::vector<std::vector<double>>> rows_of(const ScriptValue& value, std::size_t n);
/// Returns the numbers of a list: {1, 2, 3}.
std::optional<std::vector<double>> numbers_of(const ScriptValue& value);

/// Returns the named entry as a point {x, y, z}, if there is one. Notes a problem if the entry is no point.
std::optional<Vec3> read_point(TableReader& reader, const std::string& name);
std::optional<std::array<double, 2>> read_pair(TableReader& reader, const std::string& name, std::string_view what);
std::optional<std::vector<double>> read_numbers(TableReader& reader, const std::string& name);
/// Notes every unnamed entry beyond the n-th.
void refuse_items_beyond(TableReader& reader, std::size_t n);

/// An entry made by a verb such as sphere{...}: a table that names its shape.
struct ShapeEntry {
  TableHandle table;  ///< null: the entry is no such table
  std::string shape;  ///< "sphere"; empty if `table` is null
  ScriptValue value;  ///< the entry itself
  std::string where;  ///< "sources, entry 2", for messages
};
/// Returns the entries of the list `name` = { sphere{...}, box{...} }, or the only entry if it is given alone. Empty if the table has none. Notes problems; \p
/// usage is an example of an entry
std::vector<ShapeEntry> read_shapes(TableReader& reader, const std::string& name, std::string_view usage);

/// Returns the file "name" beside the script or in the current folder, for verbs that take one file.
std::optional<InputPath> single_file(const ScriptCall& call, TableReader& reader);

/// Reads "wall", "slip", "inflow", ...; notes a problem if the value is no kind of patch.
std::optional<PatchKind> read_patch_kind(const ScriptValue& value, const std::string& key, TableReader& reader);

/// Returns the model of a value: a model itself, or the model of a component. Null for any other value.
ModelHandle model_of(const ScriptValue& value, const ScriptCall& call);

/// Returns the rotation about the fixed axes through `about`: first roll (starboard wing down), then pitch (nose up), then yaw (nose to starboard). The axes
/// are x aft, y starboard, z up; angles are in radians.
Transform attitude(const Point& about, double roll, double pitch, double yaw);

/// Returns the reference data of a wing as a table for the script.
ScriptValue wing_table(const WingReference& wing);
/// Returns a table of numbers for the script.
ScriptValue list_of(const Vec3& p);

}  // namespace sterna::scripting
