// flow{}, y_plus{}, boundary_layer{}: from flow conditions to the first height and the total height of layers; the same as texts of the command line.
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
/// quantity.name: height, wall_distance, skin_friction, friction_velocity, thickness, and what is known of the flow.
extern const ScriptVerb k_quantity_field;

/// Flow conditions out of a verb's table: an entry among its items from number `first_item` on (flow{...}), or named numbers; notes problems.
/// Nothing where there is a problem. Asks for the items.
std::optional<volmesh::FlowState> read_flow(TableReader& reader, std::size_t first_item);
/// Conditions that a table names, without the rest of it. `conditions` must outlive the table.
OptionTable flow_options(volmesh::FlowConditions& conditions);

/// Whether the text is "y_plus ..." or "boundary_layer ...".
bool is_flow_text(std::string_view text);
/// "y_plus 1 mach=0.78 altitude=11000 length=4.2", "boundary_layer factor=1.3 reynolds=6e6 length=1".
/// \throws Error(bad_argument, unknown_option)
QuantityValue quantity_of_text(const std::string& text);

}  // namespace sterna::scripting
