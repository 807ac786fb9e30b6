// `sterna mesh`: a wall from files, changed as the command line requests, and the volume mesh around it.
#include <algorithm>
#include <array>
#include <chrono>

#include "geom/base/error.h"
#include "io/output/atomic_file.h"
#include "scripting/cli/commands.h"
#include "scripting/cli/volume_request.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/consumers.h"
#include "scripting/values/filled_crevices.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/manifest.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/open_domains.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/remeshed_surface.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/values/verbs.h"
#include "scripting/values/wrap_surfaces.h"
#include "scripting/verbs/half_verbs.h"

namespace sterna::scripting {
namespace {

using Clock = std::chrono::steady_clock;

// Fractions of the progress of `sterna mesh`, from runs on surfaces of 10 k to 200 k triangles.
constexpr double k_mesh_read_end = 0.03;
constexpr double k_mesh_surface_end = 0.2;  ///< for models
constexpr double k_mesh_made_end = 0.93;

/// The request of the command line: its options by stages, and its words.
struct MeshRequest {
  explicit MeshRequest(const CommandLine& given);

  bool is_auto() const { return line.flag("auto"); }  ///< files are used as they are, or repaired, or wrapped; if triangles are slivers, they are remeshed
  bool is_repaired() const { return line.flag("repair"); }
  bool is_wrapped() const { return line.flag("wrap"); }
  bool is_remeshed() const { return line.flag("remesh"); }
  const std::vector<std::string>& files() const { return line.all("surfaces"); }
  std::filesystem::path stages() const { return line.word("stages"); }
  /// Returns true if the command line names the option, alone or with its stage.
  bool is_given(std::string_view stage, std::string_view name) const {
    return std::ranges::any_of(options, [&](const auto& option) {
      return option.first == name ? stage != "surface_mesh" : option.first == std::string(stage) + "." + std::string(name);
    });
  }

  const CommandLine& line;
  OptionOverrides options;   ///< options of reading, preparing and meshing
  OptionOverrides half;      ///< --set half.axis=z; only with --half
  OptionOverrides remesh;    ///< --set remesh.max_edge=0.1; only with --remesh or --auto
  OptionOverrides crevices;  ///< --fill-crevices 0.1 as {"width", "0.1"} and --set fill_crevices.angle=45; empty: nothing is filled
  OptionOverrides writing;   ///< --numbering and --set write.numbering=both
};

MeshRequest::MeshRequest(const CommandLine& given) : line(given), options(options_with_farfield(given)) {
  half = take_stage(options, "half");
  remesh = take_stage(options, "remesh");
  if (const std::string width = given.word("fill-crevices"); !width.empty()) crevices.emplace_back("width", width);
  for (auto& option : take_stage(options, "fill_crevices")) crevices.push_back(std::move(option));
  WriteOptions of_files;
  writing = take_options(options, sterna::options_of(of_files));
  for (auto& option : take_stage(options, "write")) writing.push_back(std::move(option));
}

/// Returns the steps of a run if the only input is a .sterna file with steps; else nothing.
StageContent steps_of(const MeshRequest& request, const CommandContext& context) {
  if (request.files().size() != 1 || std::filesystem::path(request.files().front()).extension() != ".sterna") return {};
  return read_stages(input_paths(request.files()).front(), context.run.part("read", 0.0, k_mesh_read_end));
}

/// Refuses what belongs to steps that are complete already in the file.
void refuse_completed_steps(const StageContent& steps, const MeshRequest& request, const OptionTable& open) {
  const std::string& file = request.files().front();
  const auto refuse_done = [&](std::string_view option) {
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "option " + std::string(option),
                 .problem = "belongs to a step that is complete already in " + file,
                 .hint = "start again from the surface"});
  };
  refuse_without_effect(request.line.given, {"--half", "--auto", "--repair", "--wrap", "--remesh", "--fill-crevices"}, "mesh",
                        "the surface is complete already in " + file, "start again from the surface");
  for (const OptionOverrides* options : {&request.half, &request.remesh, &request.crevices})
    if (!options->empty()) refuse_done(options->front().first);
  for (const char* const name : {"disc", "wake-sheet", "periodic"})
    if (!request.line.all(name).empty()) refuse_done(std::string("--") + name);
  if (!request.line.patches_of("patch").empty()) refuse_done("--patch");
  for (const char* const name : {"source", "wake"})
    if (steps.tetrahedra && !request.line.all(name).empty()) refuse_done(std::string("--") + name);
  volmesh::MeshCase all;
  const OptionTable known = volmesh::options_of(all);
  for (const auto& [name, text] : request.options)
    if (const Option& option = find_option(known, name, "option " + name);
        std::none_of(open.begin(), open.end(), [&](const Option& o) { return o.name == option.name; }))
      refuse_done(name);
}

/// Continues from the last step. Options of the command line override those of the file.
MeshValue continue_mesh(const StageContent& steps, const MeshRequest& request, const Reuse& reuse, const CommandContext& context) {
  const std::string& file = request.files().front();
  if (!request.stages().empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "mesh", .problem = "--stages requires a run from the start; this run continues from " + file});
  volmesh::MeshCase options = steps.envelope->options;
  const volmesh::MeshSteps to_come = volmesh::k_finish_step | (steps.tetrahedra ? volmesh::MeshSteps{0} : volmesh::k_tetrahedra_step);
  const OptionTable open = volmesh::options_of(options, to_come);
  refuse_completed_steps(steps, request, open);
  set_options(open, request.options, context);
  if (request.is_given("farfield", "farfield_surface")) {  // otherwise the farfield is in the file
    SurfaceValue inputs;
    read_farfield_of(options, inputs, context.run);
  }
  if (!request.line.all("source").empty() || !request.line.all("wake").empty()) options.sources.clear();  // those of the command replace those of the file
  add_sources(request.line, steps.envelope->wall->mesh, options);
  const RunContext part = context.run.part("volume_mesh", k_mesh_read_end, k_mesh_made_end);
  context.run.info("continuing after the " + std::string(steps.tetrahedra ? "tetrahedra" : "envelope") + " of " + file);
  return steps.tetrahedra ? finish_mesh(*steps.tetrahedra, options, part, reuse)
                          : finish_mesh(make_tetrahedra(*steps.envelope, options, part, reuse), options, part, reuse);
}

/// With --fill-crevices: fills crevices of the surface that gets the layers.
SurfaceValue filled(const MeshRequest& request, SurfaceValue wall, const CommandContext& context) {
  if (request.crevices.empty()) return wall;
  volmesh::CreviceOptions options;
  set_options(sterna::options_of(options), request.crevices, context);
  return filled_crevices(wall, options, context.run);
}

/// With --remesh: remeshes the surface with the fineness of the family. Sources refine the surface in the same way as the volume.
SurfaceValue remeshed_wall(const MeshRequest& request, const volmesh::MeshCase& volume, SurfaceValue wall, const Reuse& reuse, const CommandContext& context) {
  if (!request.is_remeshed()) {
    if (!request.remesh.empty() && !request.is_auto())
      throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + request.remesh.front().first, .problem = "is given without --remesh or --auto"});
    return wall;
  }
  RemeshRecipe recipe;
  if (request.is_given("family", "refinement")) recipe.options.sizes.refinement = volume.family.refinement;
  set_options(sterna::options_of(recipe.options), request.remesh, context);
  layer_rules_of(request.line.patches_of("patch"), &recipe.patches);
  recipe.sources = sources_of(request.line.all("source"));
  return remeshed(wall, recipe, {}, context.run, reuse);
}

/// Adds the options of repair and wrap, if requested.
void add_preparation(const MeshRequest& request, AutoSurface& requested, OptionTable& table) {
  if (request.is_repaired() + request.is_wrapped() + request.is_auto() > 1)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading the options", .problem = "more than one of --repair, --wrap and --auto"});
  if (request.is_repaired() || request.is_auto())
    for (Option& option : sterna::options_of(requested.repair)) table.push_back(std::move(option));
  if (request.is_wrapped() || request.is_auto())
    for (Option& option : sterna::options_of(requested.wrap))
      if (option.name != "unit" && option.name != "split_angle" && option.name != "fluid") table.push_back(std::move(option));  // those of reading apply
}

/// Sets all options of the run: of the volume, and of the surface that its files need.
void set_mesh_options(const MeshRequest& request, bool is_model, AutoSurface& requested, volmesh::MeshCase& volume, const CommandContext& context) {
  OptionTable table = volmesh::required_options_of(volume);
  const OptionTable of_files = sterna::options_of(requested.stitching), of_models = model_surface_options(requested.recipe.options, requested.reading);
  if (!is_model) table.insert(table.end(), of_files.begin(), of_files.end());
  add_preparation(request, requested, table);
  if (is_model) table.insert(table.end(), of_models.begin(), of_models.end());
  OptionOverrides given = request.options;
  const auto limit = std::ranges::find(request.options, "time_limit", [](const auto& option) { return option.first; });
  if (is_model && limit != request.options.end() && !request.is_given("read_cad", "read_cad.time_limit"))
    given.emplace_back("read_cad.time_limit", limit->second);  // one limit applies to reading, too
  AutoSurface unused;
  std::vector<OptionsElsewhere> elsewhere = options_of_other_files(is_model, request.files().front(), unused);
  elsewhere.push_back({sterna::options_of(unused.repair), "is given without --repair"});
  elsewhere.push_back({sterna::options_of(unused.wrap), request.is_wrapped() || request.is_auto()
                                                            ? "belongs to the reading of the files: give --unit, --split-angle or --fluid without a stage"
                                                            : "is given without --wrap"});
  set_options(table, given, context, elsewhere);
  if (is_model && request.is_given("family", "refinement") && !request.is_given("surface_mesh", "refinement"))
    requested.recipe.options.sizes.refinement = volume.family.refinement;
}

void log_flow_texts(const MeshRequest& request, const RunContext& context) {
  for (const auto& [name, text] : request.options)
    if (is_flow_text(text)) context.info(name + ": " + quantity_of_text(text).text);
  for (const auto& [names, of_patch] : request.line.patches_of("patch"))
    for (const auto& [name, text] : of_patch)
      if (is_flow_text(text)) context.info(name + " of " + names + ": " + quantity_of_text(text).text);
}

/// Returns the wall of triangulations.
SurfaceValue wall_of_files(const MeshRequest& request, const std::vector<InputPath>& inputs, const AutoSurface& requested, const Reuse& reuse,
                           const RunContext& context) {
  const std::vector<UnionItem> items(inputs.begin(), inputs.end());
  if (request.is_repaired()) return repair_surfaces(items, requested.stitching, requested.repair, reuse, context.part("surface", 0.0, k_mesh_surface_end));
  if (!request.is_wrapped()) return read_wall(inputs, requested.stitching, context.part("surface", 0.0, k_mesh_read_end));
  return wrap_surfaces(items, wrap_with_reading(requested.wrap, requested.stitching), reuse, context.part("surface", 0.0, k_mesh_surface_end));
}

/// Generates the volume mesh. With --auto a remeshed surface is tried as well if the given triangles allow no envelope or no tetrahedra. The remeshed surface
/// is tried first if the triangles are slivers.
MeshValue fill(const MeshRequest& request, SurfaceValue wall, const volmesh::MeshCase& options, double begin, const Reuse& reuse,
               const CommandContext& context) {
  const RunContext part = context.run.part("volume_mesh", begin, k_mesh_made_end);
  if (request.is_auto() && options.farfield.farfield_floor.empty()) wall = as_body(wall, options.farfield.farfield_shape != "none", part);
  if (!request.is_auto() || request.is_remeshed()) return make_volume_mesh(wall, options, request.stages(), part, reuse);
  RemeshRecipe recipe;
  recipe.options.sizes.refinement = options.family.refinement;
  recipe.sources = sources_of(request.line.all("source"));
  set_options(sterna::options_of(recipe.options), request.remesh, context);
  const std::size_t n_steps = wall.history.size();
  const SurfaceValue first = without_slivers(wall, recipe, part, reuse);
  const bool is_new = first.history.size() > n_steps;
  try {
    return make_volume_mesh(first, options, request.stages(), part, reuse);
  } catch (const Error& error) {
    constexpr std::array k_triangles_at_fault = {ErrorCode::envelope_failed, ErrorCode::tetra_engine_failed, ErrorCode::tetra_result_invalid,
                                                 ErrorCode::mesh_invalid, ErrorCode::self_intersection};
    if (std::ranges::find(k_triangles_at_fault, error.code()) == k_triangles_at_fault.end()) throw;
    context.run.info("auto: " + error.info().attempted + ": " + error.info().problem +
                     (is_new ? "; the triangles before remesh are used" : "; remesh follows"));
    return make_volume_mesh(is_new ? wall : remeshed(wall, recipe, {}, part, reuse), options, request.stages(), part, reuse);
  }
}

/// Reads the request, makes the wall, changes the wall, and meshes the space around it. For models --unit is an option of reading CAD, and options of joining
/// triangulations are unknown.
MeshValue mesh_files(const MeshRequest& request, const Reuse& reuse, const CommandContext& context) {
  const std::vector<InputPath> inputs = input_paths(request.files());
  const bool is_model = std::ranges::any_of(inputs, [](const InputPath& input) { return is_model_file(input.path); });
  if (is_model && (request.is_repaired() || request.is_wrapped()))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = request.is_repaired() ? "option --repair" : "option --wrap",
                 .problem = inputs.front().name + " is a model, not a triangulation",
                 .hint = "--auto meshes the faces of the model, and repairs or wraps the triangles if they cross or are open"});
  AutoSurface requested;
  SurfaceRecipe& recipe = requested.recipe;
  volmesh::MeshCase volume;
  std::vector<Rule> sizes;  // sizes of new triangles; remeshed_wall reads them again
  volume.patches = layer_rules_of(request.line.patches_of("patch"), is_model ? &recipe.patches : request.is_remeshed() ? &sizes : nullptr);
  if (is_model) recipe.sources = sources_of(request.line.all("source"));  // one source applies to wall and volume
  requested.stitching.allow_open = !is_model && request.line.flag("half");
  set_mesh_options(request, is_model, requested, volume, context);
  if (!is_model && !request.line.all("source").empty() && !request.is_remeshed())
    context.run.info(std::string("--source refines the volume; the triangles of the wall stay unchanged") +
                     (request.is_auto() ? ", unless --auto remeshes the wall, where sources apply as well" : ": --remesh refines the wall, too"));
  complete_layers(volume, request.options, "reading the options");
  log_flow_texts(request, context.run);
  read_features(request.line, volume);
  if (is_model) requested.periodic = volume.periodic;
  if (!is_model && !volume.farfield.farfield_floor.empty()) requested.stitching.allow_open = true;
  const RunContext surface_part = context.run.part("surface", 0.0, k_mesh_surface_end);
  SurfaceValue wall = request.is_auto() ? auto_triangles(inputs, requested, reuse, surface_part)
                      : is_model        ? mesh_model_files(inputs, requested.reading, recipe, surface_part, reuse, volume.periodic)
                                        : wall_of_files(request, inputs, requested, reuse, context.run);
  wall = remeshed_wall(request, volume, std::move(wall), reuse, context);
  wall = halved(request.line, request.half, wall, context);
  wall = filled(request, std::move(wall), context);
  read_farfield_of(volume, wall, context.run);
  add_sources(request.line, wall.mesh, volume);
  return fill(request, std::move(wall), volume, is_model ? k_mesh_surface_end : k_mesh_read_end, reuse, context);
}

}  // namespace

int mesh_command(const CommandLine& line, const CommandContext& context) {
  const MeshRequest request(line);
  const std::vector<std::filesystem::path> outputs(line.all("output").begin(), line.all("output").end());
  for (const auto& output : outputs) require_mesh_output(output);
  WriteOptions writing;
  CommandContext of_files = context;  // with --show-options, the options of the stages are shown later
  of_files.only_options = false;
  set_options(sterna::options_of(writing), request.writing, of_files);
  const Clock::time_point start = Clock::now();
  const StageContent steps = steps_of(request, context);
  const std::unique_ptr<const StageCache> cache = cache_of(line);
  const Reuse reuse{.cache = cache.get(), .lines = nullptr};
  const MeshValue mesh = steps.envelope ? continue_mesh(steps, request, reuse, context) : mesh_files(request, reuse, context);
  const RunContext write_part = context.run.part("write", k_mesh_made_end, 1.0);
  for (const auto& output : outputs) write_mesh(mesh, output, writing, write_part);
  const RunMeasure measure{
      .wall_seconds = std::chrono::duration<double>(Clock::now() - start).count(), .stages = context.run.times(), .threads = context.run.threads()};

  context.console.end_progress();
  if (!outputs.empty()) context.run.info(wrote_text(outputs));
  context.run.info(summary_text(mesh, consumers_of_files(outputs)));
  context.run.info(measure_text(mesh, measure));
  context.run.debug(stages_text(measure));
  if (const std::string stats = line.word("stats"); !stats.empty()) io::write_whole(stats, stats_json(mesh, measure));
  return k_exit_success;
}

}  // namespace sterna::scripting
