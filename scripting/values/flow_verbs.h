// flow{}, y_plus{} and boundary_layer{} convert flow conditions to the first height and the total height of layers. The command line has the same as strings.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scripting/lua/quantity.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"

namespace sterna::scripting {

std::span<const ScriptVerb> flow_verbs();
/// Reads quantity.name: height, wall_distance, skin_friction, friction_velocity, thickness, and the known flow quantities.
extern const ScriptVerb k_quantity_field;

/// Reads flow conditions from a verb's table. They are an entry among its items from number `first_item` on (flow{...}), or named numbers. Notes problems, and
/// returns nothing if there is one. Reads the items of the table.
std::optional<volmesh::FlowState> read_flow(TableReader& reader, std::size_t first_item);
/// Returns the flow conditions that a table can name, without its other options. `conditions` must outlive the table.
OptionTable flow_options(volmesh::FlowConditions& conditions);

/// Returns true if the string is "y_plus ..." or "boundary_layer ...".
bool is_flow_text(std::string_view text);
/// Parses "y_plus 1 mach=0.78 altitude=11000 length=4.2", "boundary_layer factor=1.3 reynolds=6e6 length=1".
/// \throws Error(bad_argument, unknown_option)
QuantityValue quantity_of_text(const std::string& text);

}  // namespace sterna::scripting
