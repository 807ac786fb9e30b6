// The subcommands of `sterna`, free of any parsing: each takes its settings, prints its result and returns the exit status.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/read_cad.h"
#include "scripting/check_options.h"
#include "scripting/console.h"
#include "scripting/convert.h"
#include "scripting/script_call.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::scripting {

/// What every command gets: where to print, and the run.
struct CommandContext {
  Console& console;
  const RunContext& run;
};

struct RunCommand {
  std::filesystem::path script;
  OptionOverrides overrides;  ///< --set
};

struct MeshCommand {
  std::vector<std::string> inputs;
  std::vector<std::filesystem::path> outputs;
  OptionOverrides options;  ///< --layers 30 as {"layers", "30"} and --set stage.option=value
  std::filesystem::path stats;
  std::filesystem::path stages;  ///< .sterna file that keeps the steps of the run; empty: none
};

struct SurfaceCommand {
  std::vector<std::string> inputs;
  std::vector<std::filesystem::path> outputs;
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, what it asks for
  std::vector<std::string> sources;                              ///< source_of_text
  OptionOverrides options;
};

struct UnionCommand {
  std::vector<std::string> inputs;
  std::filesystem::path output;
  OptionOverrides options;
};

struct CheckCommand {
  std::string input;
  bool is_json = false;
  CheckSettings options;
};

struct InfoCommand {
  std::string input;
  std::string unit = "1";
};

struct ConvertCommand {
  std::string input;
  std::filesystem::path output;
  ConvertSettings settings;
  OptionOverrides options;  ///< of models: --unit, --tolerance ...
};

/// `sterna info` and `sterna check` of a model file (model_commands.cpp): what it holds with its reference data; whether it is closed, with every open edge.
int print_model_info(const InfoCommand& command, const CommandContext& context);
int check_model(const CheckCommand& command, const CommandContext& context);
/// `sterna union` of models, and `sterna convert` of a model to a model. `options` are checked against each command's schema.
int unite_models(const UnionCommand& command, const CommandContext& context);
int convert_model(const ConvertCommand& command, const CommandContext& context);

/// The options of `sterna surface`, and of `sterna mesh` of a model, but for those of the volume. The arguments must outlive the table.
OptionTable model_surface_options(surfmesh::SurfaceMeshOptions& surface, ReadCadOptions& reading);

/// Sets every option; all problems are reported together, also options that are given twice with different values. \throws Error(bad_argument)
void set_options(const OptionTable& table, const OptionOverrides& given);

/// Each throws Error; the caller prints it and turns its code into the exit status.
int execute(const RunCommand& command, const CommandContext& context);
int execute(const MeshCommand& command, const CommandContext& context);
int execute(const SurfaceCommand& command, const CommandContext& context);
int execute(const UnionCommand& command, const CommandContext& context);
int execute(const CheckCommand& command, const CommandContext& context);
int execute(const InfoCommand& command, const CommandContext& context);
int execute(const ConvertCommand& command, const CommandContext& context);
/// `sterna formats`
int list_formats(const CommandContext& context);

/// Writes the geometry of a failure to `path`; returns the sentence that tells the user so, or why it could not be written. Empty without geometry.
std::string draw_trouble(const Error& error, const std::filesystem::path& path);

}  // namespace sterna::scripting
