// Options common to several commands: any option of any stage, one --kebab-name for each option of a schema, rules for patches.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// Adds --set stage.option=value.
void add_set_option(CLI::App& command, OptionOverrides& overrides);
/// Adds one --kebab-name for each option of the schema, grouped by stage. \param note appended to the group's name, such as "of triangulations only"
void add_schema_options(CLI::App& command, const OptionTable& table, OptionOverrides& overrides, const std::string& note = {});
/// Returns the names of the options given to this command on the command line: "--json".
std::vector<std::string> given_options(const CLI::App& command);
/// Adds --patch "wing*:max_edge=0.1,curvature_angle=8". If two patterns match, the one with more letters applies.
/// \param name name of the option, if it is another option of the same form
void add_patch_option(CLI::App& command, std::vector<std::pair<std::string, OptionOverrides>>& patches, const std::string& help,
                      const std::string& name = "--patch");

}  // namespace sterna::scripting
