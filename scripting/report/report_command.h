// `sterna report`, and the parts shared with the verb report{}.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geom/mesh/gates.h"
#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"
#include "scripting/lua/input_path.h"
#include "scripting/report/report_options.h"

namespace sterna::scripting {

int report_command(const CommandLine& line, const CommandContext& context);

/// Tests the output path.
/// \throws Error(unsupported_format) unless the name ends in .html
void require_page_output(const std::filesystem::path& path);
/// Returns the page of a volume mesh or surface file, and true if the mesh is INVALID.
/// \throws Error(bad_argument) for a model, and for cuts of a surface; errors of reading; as report_html
std::pair<std::string, bool> page_of_file(const InputPath& input, const ReportOptions& options, const std::vector<std::string>& cuts, const GateTable* limits,
                                          const RunContext& context);
/// Writes the page completely or not at all.
/// \throws Error(write_failed)
void write_page(const std::string& html, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::scripting
