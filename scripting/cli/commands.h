// The subcommands of `sterna`, independent of parsing: each takes its settings, prints its result and returns the exit status.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/read_cad.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/cli/convert.h"
#include "scripting/cli/volume_request.h"
#include "scripting/command/command_context.h"
#include "scripting/lua/script_call.h"
#include "scripting/terminal/console.h"
#include "scripting/values/check_options.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::scripting {

/// The options --cache and --cache-limit.
struct CacheChoice {
  std::filesystem::path folder;  ///< empty: no cache
  double limit = k_cache_limit;  ///< bytes
};

struct RunCommand {
  std::filesystem::path script;
  OptionOverrides overrides;  ///< assignments of --set
  CacheChoice cache;
  int tasks = 0;                       ///< --tasks: number of cases of a series that run at the same time; 0 = as given in the script
  bool retries = false;                ///< --retry: failed cases of a series run again
  std::string series_case;             ///< --series-case NAME/INDEX: this process is a worker
  OptionOverrides arguments;           ///< assignments NAME=VALUE
  std::filesystem::path input_folder;  ///< --look-in: this process was started by another one in a folder of its own, and ends with its parent
};

struct MeshCommand {
  std::vector<std::string> inputs;
  std::vector<std::filesystem::path> outputs;
  VolumeRequest volume;
  OptionOverrides options;  ///< --layers 30 as {"layers", "30"} and --set stage.option=value
  std::filesystem::path stats;
  std::filesystem::path stages;  ///< .sterna file for the steps of the run; empty: none
  bool is_repaired = false;      ///< --repair: the files are repaired first
  bool is_wrapped = false;       ///< --wrap: the files are wrapped first
  bool is_auto = false;          ///< --auto: files are used as they are, or repaired, or wrapped; if triangles are slivers, they are remeshed
  bool is_remeshed = false;      ///< the surface is remeshed first
  OptionOverrides remesh;        ///< --set remesh.max_edge=0.1; only with is_remeshed
  OptionOverrides crevices;      ///< --fill-crevices 0.1 as {"width", "0.1"} and --set fill_crevices.angle=45; empty: nothing is filled
  OptionOverrides writing;       ///< --numbering and --set write.numbering=both
  CacheChoice cache;
  std::vector<std::string> given;  ///< result of given_options
};

struct SurfaceCommand {
  std::vector<std::string> inputs;
  std::vector<std::filesystem::path> outputs;
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, options
  std::vector<std::string> sources;                              ///< strings for source_of_text
  OptionOverrides options;
  CacheChoice cache;
  bool is_auto = false;  ///< --auto: crossing or open parts are repaired or wrapped
};

struct CacheCommand {
  std::filesystem::path folder;
  bool is_cleared = false;
  bool is_listed = false;
};

struct HalfCommand {
  std::string input;
  std::filesystem::path output;
  OptionOverrides options;
};

struct RemeshCommand {
  std::string input;
  std::vector<std::filesystem::path> outputs;
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, options
  std::vector<std::string> sources;                              ///< strings for source_of_text
  OptionOverrides options;
  CacheChoice cache;
};

struct UnionCommand {
  std::vector<std::string> inputs;
  std::filesystem::path output;
  OptionOverrides options;
};

struct RepairCommand {
  std::vector<std::string> inputs;
  std::filesystem::path output;
  std::filesystem::path changes;  ///< VTU file for the changed facets; empty: none
  std::filesystem::path report;   ///< JSON file for all changes; empty: none
  OptionOverrides options;
  CacheChoice cache;
};

struct WrapCommand {
  std::vector<std::string> inputs;
  std::filesystem::path output;
  std::filesystem::path changes;  ///< VTU file for the closures; empty: none
  std::filesystem::path report;   ///< JSON file for closures, leaks and distances; empty: none
  OptionOverrides options;
  CacheChoice cache;
};

struct CheckCommand {
  std::string input;
  bool is_json = false;
  std::vector<std::string> models;  ///< --model: files with which the walls are compared (G17, G18)
  CheckSettings options;
  std::vector<std::string> gates;  ///< strings for set_gate_limits
  std::filesystem::path cells;     ///< VTU file for the quality of cells; empty: none
  std::vector<std::string> given;  ///< result of given_options
};

struct InfoCommand {
  std::string input;
  std::string unit;  ///< unit of the file; empty: not given, which means the unit in the file for models, else metres
  bool is_json = false;
};

struct ConvertCommand {
  std::string input;
  std::filesystem::path output;
  ConvertSettings settings;
  OptionOverrides options;         ///< for models: --unit, --tolerance ...
  OptionOverrides writing;         ///< for volume meshes: --numbering
  std::vector<std::string> given;  ///< result of given_options
};

/// `sterna info` and `sterna check` of a model file (model_commands.cpp). The first prints the content of the model with its reference data; the second prints
/// whether the model is closed, with every open edge.
int print_model_info(const InfoCommand& command, const CommandContext& context);
int check_model(const CheckCommand& command, const CommandContext& context);
/// `sterna union` of models, and `sterna convert` of a model to a model. `options` are checked against each command's schema.
int unite_models(const UnionCommand& command, const CommandContext& context);
int convert_model(const ConvertCommand& command, const CommandContext& context);

/// Returns the cache; null without a folder.
/// \throws Error(write_failed) if the folder cannot be created
std::unique_ptr<const StageCache> cache_of(const CacheChoice& choice);

/// Executes a command. Each overload throws Error; the caller prints the error and converts its code to the exit status.
int execute(const RunCommand& command, const CommandContext& context);
int execute(const MeshCommand& command, const CommandContext& context);
int execute(const SurfaceCommand& command, const CommandContext& context);
int execute(const HalfCommand& command, const CommandContext& context);
int execute(const RemeshCommand& command, const CommandContext& context);
int execute(const CacheCommand& command, const CommandContext& context);
int execute(const UnionCommand& command, const CommandContext& context);
int execute(const RepairCommand& command, const CommandContext& context);
int execute(const WrapCommand& command, const CommandContext& context);
int execute(const CheckCommand& command, const CommandContext& context);
int execute(const InfoCommand& command, const CommandContext& context);
int execute(const ConvertCommand& command, const CommandContext& context);
/// Lists the formats for `sterna formats`.
int list_formats(const CommandContext& context);

/// Writes the geometry of a failure to `path`. Returns a sentence for the user with the file, or with the reason why it could not be written; an empty string
/// if there is no geometry.
std::string draw_trouble(const Error& error, const std::filesystem::path& path);

}  // namespace sterna::scripting
