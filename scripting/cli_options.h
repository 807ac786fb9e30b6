// Options of stages on the command line, from their schemas.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "scripting/script_call.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// --set STAGE.OPTION=VALUE, any number of times.
void add_set_option(CLI::App& command, OptionOverrides& overrides);
/// One --kebab-name for each option of the schema, grouped by stage. Given twice, both are kept: set_options refuses them where they differ.
void add_schema_options(CLI::App& command, const OptionTable& table, OptionOverrides& overrides);

}  // namespace sterna::scripting
