// The subcommands of `sterna`, free of any parsing: each takes its settings, prints its result and returns the exit status.
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
#include "scripting/command/command_context.h"
#include "scripting/lua/script_call.h"
#include "scripting/terminal/console.h"
#include "scripting/values/check_options.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::scripting {

/// --cache and --cache-limit.
struct CacheChoice {
  std::filesystem::path folder;  ///< empty: no cache
  double limit = k_cache_limit;  ///< bytes
};

struct RunCommand {
  std::filesystem::path script;
  OptionOverrides overrides;  ///< --set
  CacheChoice cache;
  int tasks = 0;                       ///< --tasks: cases of a series at a time; 0 = as the script says
  bool retries = false;                ///< --retry: failed cases of a series run again
  std::string series_case;             ///< --series-case NAME/INDEX: this process is a worker
  OptionOverrides arguments;           ///< NAME=VALUE
  std::filesystem::path input_folder;  ///< --look-in: this process was started in a folder of its own by another one, and ends with it
};

struct MeshCommand {
  std::vector<std::string> inputs;
  std::vector<std::filesystem::path> outputs;
  OptionOverrides options;                                       ///< --layers 30 as {"layers", "30"} and --set stage.option=value
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, what it asks for
  std::filesystem::path stats;
  std::filesystem::path stages;       ///< .sterna file that keeps the steps of the run; empty: none
  std::vector<std::string> discs;     ///< disc_of_text
  std::vector<std::string> periodic;  ///< periodic_of_text
  std::vector<std::string> sources;   ///< source_of_text
  std::vector<std::string> sheets;    ///< wake_sheet_of_text
  std::vector<std::string> wakes;     ///< wake_of_text
  bool is_half = false;               ///< the half of the surface
  bool is_repaired = false;           ///< --repair: the files are repaired first
  bool is_wrapped = false;            ///< --wrap: the files are wrapped first
  bool is_auto = false;               ///< --auto: as they are, else repaired, else wrapped; remeshed where they are needles
  OptionOverrides half;               ///< --set half.axis=z; only with is_half
  bool is_remeshed = false;           ///< the surface gets new triangles first
  OptionOverrides remesh;             ///< --set remesh.max_edge=0.1; only with is_remeshed
  OptionOverrides writing;            ///< --numbering and --set write.numbering=both
  CacheChoice cache;
  std::vector<std::string> given;  ///< given_options
};

struct SurfaceCommand {
  std::vector<std::string> inputs;
  std::vector<std::filesystem::path> outputs;
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, what it asks for
  std::vector<std::string> sources;                              ///< source_of_text
  OptionOverrides options;
  CacheChoice cache;
  bool is_auto = false;  ///< --auto: what crosses or is open is repaired or wrapped
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
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, what it asks for
  std::vector<std::string> sources;                              ///< source_of_text
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
  std::filesystem::path changes;  ///< VTU of the changed facets; empty: none
  std::filesystem::path report;   ///< JSON of all changes; empty: none
  OptionOverrides options;
  CacheChoice cache;
};

struct WrapCommand {
  std::vector<std::string> inputs;
  std::filesystem::path output;
  std::filesystem::path changes;  ///< VTU of what was closed; empty: none
  std::filesystem::path report;   ///< JSON of closures, leaks, distances; empty: none
  OptionOverrides options;
  CacheChoice cache;
};

struct CheckCommand {
  std::string input;
  bool is_json = false;
  std::vector<std::string> models;  ///< --model: the walls are compared with them (G17, G18)
  CheckSettings options;
  std::vector<std::string> gates;  ///< set_gate_limits
  std::filesystem::path cells;     ///< VTU of the quality of cells; empty: none
  std::vector<std::string> given;  ///< given_options
};

struct InfoCommand {
  std::string input;
  std::string unit;  ///< empty: not given; of models what the file says, else metres
  bool is_json = false;
};

struct ConvertCommand {
  std::string input;
  std::filesystem::path output;
  ConvertSettings settings;
  OptionOverrides options;         ///< of models: --unit, --tolerance ...
  OptionOverrides writing;         ///< of volume meshes: --numbering
  std::vector<std::string> given;  ///< given_options
};

/// `sterna info` and `sterna check` of a model file (model_commands.cpp): what it holds with its reference data; whether it is closed, with every open edge.
int print_model_info(const InfoCommand& command, const CommandContext& context);
int check_model(const CheckCommand& command, const CommandContext& context);
/// `sterna union` of models, and `sterna convert` of a model to a model. `options` are checked against each command's schema.
int unite_models(const UnionCommand& command, const CommandContext& context);
int convert_model(const ConvertCommand& command, const CommandContext& context);

/// The options of `sterna surface`, and of `sterna mesh` of a model, but for those of the volume. The arguments must outlive the table.
OptionTable model_surface_options(surfmesh::SurfaceMeshOptions& surface, ReadCadOptions& reading);

/// Null without a folder.
/// \throws Error(write_failed) when the folder cannot be made
std::unique_ptr<const StageCache> cache_of(const CacheChoice& choice);

/// Each throws Error; the caller prints it and turns its code into the exit status.
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
/// `sterna formats`
int list_formats(const CommandContext& context);

/// Writes the geometry of a failure to `path`; returns the sentence that tells the user so, or why it could not be written. Empty without geometry.
std::string draw_trouble(const Error& error, const std::filesystem::path& path);

}  // namespace sterna::scripting
