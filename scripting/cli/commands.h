// The subcommands of `sterna` that are no verbs. Each takes the words of its command line, prints its result and returns the exit status. It throws Error; the
// caller prints the error and converts its code to the exit status.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scripting/cache/stage_cache.h"
#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"
#include "scripting/lua/input_path.h"

namespace sterna::scripting {

/// Returns the cache of --cache; null without a folder.
/// \throws Error(write_failed) if the folder cannot be created
std::unique_ptr<const StageCache> cache_of(const CommandLine& line);

/// Returns the files of the current folder.
std::vector<InputPath> input_paths(const std::vector<std::string>& names);

int run_command(const CommandLine& line, const CommandContext& context);
/// Prints all problems of a script; status 2 if there are any.
int check_script_command(const CommandLine& line, const CommandContext& context);
int mesh_command(const CommandLine& line, const CommandContext& context);
int surface_command(const CommandLine& line, const CommandContext& context);
int cache_command(const CommandLine& line, const CommandContext& context);
int check_command(const CommandLine& line, const CommandContext& context);
int info_command(const CommandLine& line, const CommandContext& context);
/// Prints the report; status 1 if there is an error, with --strict also for a warning.
int inspect_command(const CommandLine& line, const CommandContext& context);
int convert_command(const CommandLine& line, const CommandContext& context);
/// Apply the functions of mesh:foam_case and mesh:su2_config to a mesh from a file. Wrong options are reported before the mesh is read.
int foam_case_command(const CommandLine& line, const CommandContext& context);
int su2_config_command(const CommandLine& line, const CommandContext& context);
/// Writes the same files as pentagrow into the current folder: the mesh as hybrid.bmsh, .cgns, .taumesh or .su2 as OutputFormat requests (each with its
/// manifest), outermost.vtu (the envelope), boundaries.smesh (envelope and outer boundary, with the farfield), sumcos.txt (skew of the prisms in 15 classes),
/// and diagnose.txt (tangled elements, of which there are none if there is a mesh).
int pentagrow_command(const CommandLine& line, const CommandContext& context);
/// Versions, processor, memory, engines, page, browser, a folder for temporary files, and a small mesh by each engine, made in a temporary folder that is
/// removed afterwards. Exit status 0 if nothing that a mesh needs is missing.
int doctor_command(const CommandLine& line, const CommandContext& context);
/// Lists the formats for `sterna formats`.
int formats_command(const CommandLine& line, const CommandContext& context);

/// `sterna info`, `check`, `union` and `convert` of models (model_commands.cpp).
int print_model_info(const CommandLine& line, const CommandContext& context);
int check_model(const CommandLine& line, const CommandContext& context);
int unite_model_files(const CommandLine& line, const CommandContext& context);
int convert_model(const CommandLine& line, const CommandContext& context);

/// Writes the geometry of a failure to `path`. Returns a sentence for the user with the file, or with the reason why it could not be written; an empty string
/// if there is no geometry.
std::string draw_trouble(const Error& error, const std::filesystem::path& path);

}  // namespace sterna::scripting
