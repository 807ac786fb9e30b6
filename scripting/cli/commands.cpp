#include "scripting/cli/commands.h"
#include "scripting/cli/info_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <limits>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/mesh/check.h"
#include "geom/mesh/half.h"
#include "io/field/trouble_vtu.h"
#include "io/file/format_table.h"
#include "io/file/surface_file.h"
#include "io/output/atomic_file.h"
#include "io/volume/volume_vtu.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/series/case_worker.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/filled_crevices.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/manifest.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/open_domains.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/remeshed_surface.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"
#include "scripting/values/wake_verbs.h"
#include "scripting/values/wall_files.h"
#include "scripting/values/wrap_surfaces.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/gate_limits.h"
#include "scripting/verbs/half_verbs.h"
#include "scripting/verbs/model_gates.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {
namespace {

using Clock = std::chrono::steady_clock;

// Fractions of the progress of `sterna mesh`, from runs on surfaces of 10 k to 200 k triangles.
constexpr double k_read_end = 0.03;
constexpr double k_surface_end = 0.2;  ///< for models
constexpr double k_mesh_end = 0.93;

struct PatchSize {
  std::int64_t n_triangles = 0, n_quads = 0;
};

void print_box(const CommandContext& context, const Box& box) {
  if (!box.empty())
    context.console.print(fmt::format("  box      {} to {}, longest side {:.6g} m", format_point(box.min), format_point(box.max), box.longest_side()));
}

void print_patches(const CommandContext& context, const Column<PatchId, Patch>& patches, const std::vector<PatchSize>& sizes,
                   const std::set<std::string>& unknown_kinds = {}) {
  for (const PatchId id : patches.ids()) {
    const PatchSize& size = sizes[id.index()];
    const std::string kind = unknown_kinds.contains(patches[id].name) ? "kind unknown" : std::string(to_string(patches[id].kind));
    std::string text = fmt::format("  patch    \"{}\", {}: {} triangles", patches[id].name, kind, count_text(size.n_triangles));
    if (size.n_quads > 0) text += ", " + count_text(size.n_quads) + " quads";
    context.console.print(text);
  }
}

int print_volume_info(const InputPath& input, double unit, const CommandContext& context) {
  MeshValue value = read_mesh(input, context.run);
  if (count_cells(value.mesh).total() == 0) return -1;
  Box box;
  for (const Point& p : value.mesh.points) box.add(unit * p);
  std::vector<PatchSize> sizes(value.mesh.patches.size());
  for (const BoundaryTriangle& face : value.mesh.boundary_triangles) ++sizes[face.patch.index()].n_triangles;
  for (const BoundaryQuad& face : value.mesh.boundary_quads) ++sizes[face.patch.index()].n_quads;
  context.console.print("  " + describe(value));
  print_box(context, box);
  print_patches(context, value.mesh.patches, sizes, value.unknown_kinds);
  // This is a brief check, without the slow exact test for intersections.
  const CheckReport report = check(value.mesh, {.intersections = false}, context.run.part("check", 0.3, 1.0));
  context.console.print(
      "  check    " +
      std::string(report.is_valid() ? "no faults found; boundaries were not tested for intersection" : "INVALID; `sterna check` lists the locations") + "; " +
      quality_text(report));
  return k_exit_success;
}

/// Prints the ranges of edges and angles; for triangles without area only their number.
void print_triangle_quality(const CommandContext& context, const TriMesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0, least_angle = std::numbers::pi, most_angle = 0.0, area = 0.0;
  std::int64_t n_degenerate = 0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const std::array<Point, 3> p = corners(mesh, t);
    const double twice_area = norm(cross(p[1] - p[0], p[2] - p[0]));
    if (twice_area <= 0.0) {
      ++n_degenerate;
      continue;
    }
    area += 0.5 * twice_area;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = p[(k + 1) % 3] - p[k];
      const double angle = angle_between(edge, p[(k + 2) % 3] - p[k]);
      shortest = std::min(shortest, norm(edge));
      longest = std::max(longest, norm(edge));
      least_angle = std::min(least_angle, angle);
      most_angle = std::max(most_angle, angle);
    }
  }
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  if (area > 0.0)
    context.console.print(fmt::format("  quality  area {:.6g} m^2, edges {:.4g} to {:.4g} m, angles {:.3g} to {:.4g} deg", area, shortest, longest,
                                      k_degrees * least_angle, k_degrees * most_angle));
  if (n_degenerate > 0) context.console.print(fmt::format("  quality  triangles without area: {}", count_text(n_degenerate)));
}

int print_surface_info(const InputPath& input, double unit, const CommandContext& context) {
  // The files are joined in the same way as by `sterna mesh`, but without the slow exact test for intersections. The caller reports defects that prevent
  // joining.
  surfmesh::StitchOptions options;
  options.unit = unit;
  options.allow_open = true;
  options.check_intersections = false;
  const WallFiles files = read_wall_files(std::span(&input, 1), options, context.run.part("read", 0.0, 0.3));
  const SurfaceSoup& soup = files.soups.front();
  context.console.print(fmt::format("  surface  {} triangles, {} points, patches {}", count_text(static_cast<std::int64_t>(soup.triangles.size())),
                                    count_text(static_cast<std::int64_t>(soup.points.size())), soup.has_names ? "by name" : "without names"));
  Box box;
  for (const Vec3& p : soup.points) box.add(unit * p);
  print_box(context, box);
  const SurfaceValue wall = join_wall(files, context.run.part("stitch", 0.3, 1.0));
  std::vector<PatchSize> sizes(wall.mesh.patches.size());
  for (const PatchId patch : wall.mesh.triangle_patch) ++sizes[patch.index()].n_triangles;
  context.console.print("  joined   " + describe(wall));
  print_patches(context, wall.mesh.patches, sizes);
  print_triangle_quality(context, wall.mesh);
  return k_exit_success;
}

/// Returns the steps of a run if the only input is a .sterna file with steps; else nothing.
StageContent steps_of(const MeshCommand& command, const CommandContext& context) {
  if (command.inputs.size() != 1 || std::filesystem::path(command.inputs.front()).extension() != ".sterna") return {};
  return read_stages({command.inputs.front(), command.inputs.front()}, context.run.part("read", 0.0, k_read_end));
}

/// Returns true if the command line names the option, alone or with its stage.
bool is_given(const MeshCommand& command, std::string_view stage, std::string_view name) {
  return std::ranges::any_of(command.options, [&](const auto& option) {
    return option.first == name ? stage != "surface_mesh" : option.first == std::string(stage) + "." + std::string(name);
  });
}

/// Continues from the last step. Options of the command line override those of the file.
MeshValue continue_mesh(const StageContent& steps, const MeshCommand& command, const Reuse& reuse, const CommandContext& context) {
  if (!command.stages.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "mesh",
                 .problem = "--stages requires a run from the start; this run continues from " + command.inputs.front()});
  const std::string done = "belongs to a step that is complete already in " + command.inputs.front();
  const auto refuse_done = [&](std::string_view option) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + std::string(option), .problem = done, .hint = "start again from the surface"});
  };
  refuse_without_effect(command.given, {"--half", "--auto", "--repair", "--wrap", "--remesh", "--fill-crevices"}, "mesh",
                        "the surface is complete already in " + command.inputs.front(), "start again from the surface");
  for (const OptionOverrides* options : {&command.volume.half, &command.remesh, &command.crevices})
    if (!options->empty()) refuse_done(options->front().first);
  if (!command.volume.discs.empty()) refuse_done("--disc");
  if (!command.volume.sheets.empty()) refuse_done("--wake-sheet");
  if (!command.volume.periodic.empty()) refuse_done("--periodic");
  if (!command.volume.patches.empty()) refuse_done("--patch");
  if (steps.tetrahedra && !command.volume.sources.empty()) refuse_done("--source");
  if (steps.tetrahedra && !command.volume.wakes.empty()) refuse_done("--wake");
  volmesh::MeshCase options = steps.envelope->options, all;
  const volmesh::MeshSteps to_come = volmesh::k_finish_step | (steps.tetrahedra ? volmesh::MeshSteps{0} : volmesh::k_tetrahedra_step);
  const OptionTable open = volmesh::options_of(options, to_come);
  const OptionTable known = volmesh::options_of(all);
  for (const auto& [name, text] : command.options)
    if (const Option& option = find_option(known, name, "option " + name);
        std::none_of(open.begin(), open.end(), [&](const Option& o) { return o.name == option.name; }))
      refuse_done(name);
  set_options(open, command.options, context);
  if (is_given(command, "farfield", "farfield_surface")) {  // otherwise the farfield is in the file
    SurfaceValue inputs;
    read_farfield_of(options, inputs, context.run);
  }
  if (!command.volume.sources.empty() || !command.volume.wakes.empty()) options.sources.clear();  // those of the command replace those of the file
  add_sources(command.volume, steps.envelope->wall->mesh, options);
  const RunContext part = context.run.part("volume_mesh", k_read_end, k_mesh_end);
  context.run.info("continuing after the " + std::string(steps.tetrahedra ? "tetrahedra" : "envelope") + " of " + command.inputs.front());
  return steps.tetrahedra ? finish_mesh(*steps.tetrahedra, options, part, reuse)
                          : finish_mesh(make_tetrahedra(*steps.envelope, options, part, reuse), options, part, reuse);
}

/// With --fill-crevices: fills crevices of the surface that gets the layers.
void fill_wall(const MeshCommand& command, SurfaceValue& wall, const CommandContext& context) {
  volmesh::CreviceOptions options;
  set_options(sterna::options_of(options), command.crevices, context);
  wall = filled_crevices(wall, options, context.run);
}

/// With --remesh: remeshes the surface with the fineness of the family. Sources refine the surface in the same way as the volume.
void remesh_wall(const MeshCommand& command, const volmesh::MeshCase& volume, SurfaceValue& wall, const Reuse& reuse, const CommandContext& context) {
  if (!command.is_remeshed) {
    if (!command.remesh.empty() && !command.is_auto)
      throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + command.remesh.front().first, .problem = "is given without --remesh or --auto"});
    return;
  }
  RemeshRecipe recipe;
  if (is_given(command, "family", "refinement")) recipe.options.sizes.refinement = volume.family.refinement;
  set_options(sterna::options_of(recipe.options), command.remesh, context);
  layer_rules_of(command.volume.patches, &recipe.patches);
  recipe.sources = sources_of(command.volume.sources);
  wall = remeshed(wall, recipe, {}, context.run, reuse);
}

/// Returns the options that `sterna mesh` has only for other inputs or with other flags.
std::vector<OptionsElsewhere> elsewhere_of(const MeshCommand& command, bool is_model, AutoSurface& unused) {
  const std::string& name = command.inputs.front();
  std::vector<OptionsElsewhere> result;
  if (is_model) {
    OptionTable table = sterna::options_of(unused.stitching);
    result.push_back({std::move(table), "applies to triangulations (STL ...), and " + name + " is a model"});
  } else {
    result.push_back(
        {model_surface_options(unused.recipe.options, unused.reading), "applies to the faces of models (STEP ...), and " + name + " is a triangulation"});
  }
  result.push_back({sterna::options_of(unused.repair), "is given without --repair"});
  result.push_back({sterna::options_of(unused.wrap), "is given without --wrap"});
  return result;
}

/// Completes the options: sets values that follow from combinations of options, and derives heights from flow conditions.
void complete_options(volmesh::MeshCase& options, const MeshCommand& command, const RunContext& context) {
  choose_solve_for(
      options, [&](std::string_view name) { return is_given(command, "envelope", name); }, "reading the options");
  choose_family_wake(options, is_given(command, "family", "refinement"));
  for (const auto& [name, text] : command.options) {
    if (is_flow_text(text)) context.info(name + ": " + quantity_of_text(text).text);
    if (name == "first_height" || name == "envelope.first_height") choose_boundary_layer(options, text);
  }
  for (const auto& [names, of_patch] : command.volume.patches)
    for (const auto& [name, text] : of_patch)
      if (is_flow_text(text)) context.info(name + " of " + names + ": " + quantity_of_text(text).text);
}

/// Adds the options of repair and wrap, if requested.
void add_preparation(const MeshCommand& command, AutoSurface& requested, OptionTable& table) {
  if (command.is_repaired + command.is_wrapped + command.is_auto > 1)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading the options", .problem = "more than one of --repair, --wrap and --auto"});
  if (command.is_repaired || command.is_auto)
    for (Option& option : sterna::options_of(requested.repair)) table.push_back(std::move(option));
  if (command.is_wrapped || command.is_auto)
    for (Option& option : sterna::options_of(requested.wrap))
      if (option.name != "unit" && option.name != "split_angle" && option.name != "fluid") table.push_back(std::move(option));  // those of reading apply
}

/// Returns the wall of triangulations.
SurfaceValue wall_of(const MeshCommand& command, const std::vector<InputPath>& inputs, const AutoSurface& requested, const Reuse& reuse,
                     const CommandContext& context) {
  if (command.is_auto) return auto_triangles(inputs, requested, reuse, context.run.part("surface", 0.0, k_surface_end));
  const std::vector<UnionItem> items(inputs.begin(), inputs.end());
  if (command.is_repaired) return repair_surfaces(items, requested.stitching, requested.repair, reuse, context.run.part("surface", 0.0, k_surface_end));
  if (command.is_wrapped) {
    surfmesh::WrapOptions wrap = requested.wrap;
    wrap.unit = requested.stitching.unit;
    wrap.split_angle = requested.stitching.split_angle;
    wrap.fluid = requested.stitching.fluid;
    return wrap_surfaces(items, wrap, reuse, context.run.part("surface", 0.0, k_surface_end));
  }
  return read_wall(inputs, requested.stitching, context.run.part("surface", 0.0, k_read_end));
}

/// Generates the volume mesh. With --auto a remeshed surface is tried as well if the given triangles allow no envelope or no tetrahedra. The remeshed surface
/// is tried first if the triangles are slivers.
MeshValue fill(const MeshCommand& command, SurfaceValue wall, const volmesh::MeshCase& options, double begin, const Reuse& reuse,
               const CommandContext& context) {
  const RunContext part = context.run.part("volume_mesh", begin, k_mesh_end);
  if (command.is_auto && options.farfield.farfield_floor.empty()) wall = as_body(wall, options.farfield.farfield_shape != "none", part);
  if (!command.is_auto || command.is_remeshed) return make_volume_mesh(wall, options, command.stages, part, reuse);
  RemeshRecipe recipe;
  recipe.options.sizes.refinement = options.family.refinement;
  recipe.sources = sources_of(command.volume.sources);
  set_options(sterna::options_of(recipe.options), command.remesh, context);
  const std::size_t n_changes = wall.changes.size();
  const SurfaceValue first = without_slivers(wall, recipe, part, reuse);
  const bool is_new = first.changes.size() > n_changes;
  try {
    return make_volume_mesh(first, options, command.stages, part, reuse);
  } catch (const Error& error) {
    constexpr std::array k_triangles_at_fault = {ErrorCode::envelope_failed, ErrorCode::tetra_engine_failed, ErrorCode::tetra_result_invalid,
                                                 ErrorCode::mesh_invalid, ErrorCode::self_intersection};
    if (std::ranges::find(k_triangles_at_fault, error.code()) == k_triangles_at_fault.end()) throw;
    context.run.info("auto: " + error.info().attempted + ": " + error.info().problem +
                     (is_new ? "; the triangles before remesh are used" : "; remesh follows"));
    return make_volume_mesh(is_new ? wall : remeshed(wall, recipe, {}, part, reuse), options, command.stages, part, reuse);
  }
}

/// Generates the mesh of models, whose faces are meshed first. For models --unit is an option of reading CAD, and options of joining triangulations are
/// unknown.
MeshValue make_mesh_of_models(const MeshCommand& command, const std::vector<InputPath>& inputs, const Reuse& reuse, const CommandContext& context) {
  if (command.is_repaired || command.is_wrapped)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = command.is_repaired ? "option --repair" : "option --wrap",
                 .problem = inputs.front().name + " is a model, not a triangulation",
                 .hint = "--auto meshes the faces of the model, and repairs or wraps the triangles if they cross or are open"});
  AutoSurface requested;
  SurfaceRecipe& recipe = requested.recipe;
  ReadCadOptions& reading = requested.reading;
  volmesh::MeshCase volume_options;
  volume_options.patches = layer_rules_of(command.volume.patches, &recipe.patches);
  recipe.sources = sources_of(command.volume.sources);  // one source applies to wall and volume
  if (!recipe.sources.empty()) recipe.sources_text = sources_text(recipe.sources, false);
  OptionTable table = volmesh::required_options_of(volume_options);
  add_preparation(command, requested, table);
  for (Option& option : model_surface_options(recipe.options, reading)) table.push_back(std::move(option));
  AutoSurface unused;
  OptionOverrides given = command.options;
  const auto named = [&](std::string_view name) { return std::ranges::find(command.options, name, [](const auto& option) { return option.first; }); };
  if (const auto limit = named("time_limit"); limit != command.options.end() && named("read_cad.time_limit") == command.options.end())
    given.emplace_back("read_cad.time_limit", limit->second);  // one limit applies to reading, too
  set_options(table, given, context, elsewhere_of(command, true, unused));
  if (is_given(command, "family", "refinement") && !is_given(command, "surface_mesh", "refinement"))
    recipe.options.sizes.refinement = volume_options.family.refinement;
  complete_options(volume_options, command, context.run);
  read_features(command.volume, volume_options);
  requested.periodic = volume_options.periodic;
  const RunContext surface_part = context.run.part("surface", 0.0, k_surface_end);
  SurfaceValue wall = command.is_auto ? auto_triangles(inputs, requested, reuse, surface_part)
                                      : mesh_model_files(inputs, reading, recipe, surface_part, reuse, volume_options.periodic);
  remesh_wall(command, volume_options, wall, reuse, context);
  wall = halved(command.volume, wall, context);
  if (!command.crevices.empty()) fill_wall(command, wall, context);
  read_farfield_of(volume_options, wall, context.run);
  add_sources(command.volume, wall.mesh, volume_options);
  return fill(command, std::move(wall), volume_options, k_surface_end, reuse, context);
}

MeshValue make_mesh(const MeshCommand& command, const Reuse& reuse, const CommandContext& context) {
  std::vector<InputPath> inputs;
  for (const std::string& name : command.inputs) inputs.push_back({name, name});
  if (std::any_of(inputs.begin(), inputs.end(), [](const InputPath& input) { return is_model_file(input.path); }))
    return make_mesh_of_models(command, inputs, reuse, context);
  AutoSurface requested;
  volmesh::MeshCase volume_options;
  std::vector<Rule> sizes;  // sizes of the new triangles
  volume_options.patches = layer_rules_of(command.volume.patches, command.is_remeshed ? &sizes : nullptr);
  requested.stitching.allow_open = command.volume.is_half;
  OptionTable table = volmesh::required_options_of(volume_options);
  for (Option& option : sterna::options_of(requested.stitching)) table.push_back(std::move(option));
  add_preparation(command, requested, table);
  AutoSurface unused;
  set_options(table, command.options, context, elsewhere_of(command, false, unused));
  if (!command.volume.sources.empty() && !command.is_remeshed)
    context.run.info(std::string("--source refines the volume; the triangles of the wall stay unchanged") +
                     (command.is_auto ? ", unless --auto remeshes the wall, where sources apply as well" : ": --remesh refines the wall, too"));
  complete_options(volume_options, command, context.run);
  read_features(command.volume, volume_options);
  if (!volume_options.farfield.farfield_floor.empty()) requested.stitching.allow_open = true;
  SurfaceValue wall = wall_of(command, inputs, requested, reuse, context);
  remesh_wall(command, volume_options, wall, reuse, context);
  wall = halved(command.volume, wall, context);
  if (!command.crevices.empty()) fill_wall(command, wall, context);
  read_farfield_of(volume_options, wall, context.run);
  add_sources(command.volume, wall.mesh, volume_options);
  return fill(command, std::move(wall), volume_options, k_read_end, reuse, context);
}

std::string read_write(bool is_read, bool is_written) { return is_read && is_written ? "read, write" : is_read ? "read" : is_written ? "write" : "-"; }

}  // namespace

std::unique_ptr<const StageCache> cache_of(const CacheChoice& choice) {
  if (choice.folder.empty()) return nullptr;
  return std::make_unique<const StageCache>(CacheSettings{.folder = choice.folder, .limit = choice.limit});
}

/// Parses "polar/3".
CaseAddress case_of_text(const std::string& text) {
  const std::size_t slash = text.rfind('/');
  CaseAddress address{.series = text.substr(0, slash)};
  const char* end = text.data() + text.size();
  if (slash == std::string::npos || std::from_chars(text.data() + slash + 1, end, address.index).ptr != end || address.index == 0)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "--series-case " + text, .problem = "expected NAME/INDEX"});
  return address;
}

/// Returns all parts of the command line that can change the results of a script. A worker gets the same parts.
std::vector<std::string> worker_words(const RunCommand& command, const RunContext& run) {
  std::vector<std::string> words;
  for (const auto& [name, value] : command.overrides)
    if (name != "retry" && name != "series.retry") words.push_back("--set=" + name + "=" + value);  // a case does not depend on these two
  words.push_back("--seed=" + std::to_string(run.seed()));
  for (const auto& [name, value] : command.arguments) words.push_back(name + "=" + value);
  if (!command.input_folder.empty()) words.push_back("--look-in=" + command.input_folder.string());
  return words;
}

int execute(const RunCommand& command, const CommandContext& context) {
  const std::unique_ptr<const StageCache> cache = cache_of(command.cache);
  SeriesSettings series{.program = std::filesystem::read_symlink("/proc/self/exe"),
                        .words = worker_words(command, context.run),
                        .worker = {},
                        .stops_itself = context.stops_itself,
                        .tasks = command.tasks,
                        .retries = command.retries};
  if (!command.series_case.empty() || !command.input_folder.empty()) become_worker();
  if (!command.series_case.empty()) {
    series.worker = case_of_text(command.series_case);
  }
  const ScriptOutcome outcome = run_script({.script = command.script,
                                            .overrides = command.overrides,
                                            .print = [&](std::string_view text) { context.console.print(text); },
                                            .on_mesh = [&](const MeshValue& mesh) { context.run.info(summary_text(mesh)); },
                                            .cache = cache.get(),
                                            .series = series,
                                            .arguments = command.arguments,
                                            .input_folder = command.input_folder},
                                           context.run);
  if (outcome.n_failed_cases > 0) return k_exit_failed;
  return outcome.n_invalid_cases > 0 ? k_exit_invalid : k_exit_success;
}

int execute(const MeshCommand& command, const CommandContext& context) {
  for (const auto& output : command.outputs) require_mesh_output(output);
  WriteOptions writing;
  CommandContext of_files = context;  // with --show-options, the options of the stages are shown later
  of_files.only_options = false;
  set_options(sterna::options_of(writing), command.writing, of_files);
  const Clock::time_point start = Clock::now();
  const StageContent steps = steps_of(command, context);
  const std::unique_ptr<const StageCache> cache = cache_of(command.cache);
  const Reuse reuse{.cache = cache.get(), .lines = nullptr};
  const MeshValue mesh = steps.envelope ? continue_mesh(steps, command, reuse, context) : make_mesh(command, reuse, context);
  const RunContext write_part = context.run.part("write", k_mesh_end, 1.0);
  for (const auto& output : command.outputs) write_mesh(mesh, output, writing, write_part);
  const RunMeasure measure{
      .wall_seconds = std::chrono::duration<double>(Clock::now() - start).count(), .stages = context.run.times(), .threads = context.run.threads()};

  context.console.end_progress();
  if (!command.outputs.empty()) context.run.info(wrote_text(command.outputs));
  context.run.info(summary_text(mesh, consumers_of_files(command.outputs)));
  context.run.info(measure_text(mesh, measure));
  context.run.debug(stages_text(measure));
  if (!command.stats.empty()) io::write_whole(command.stats, stats_json(mesh, measure));
  return k_exit_success;
}

int execute(const CacheCommand& command, const CommandContext& context) {
  std::map<std::string, std::pair<std::size_t, std::uint64_t>> stages;
  std::pair<std::size_t, std::uint64_t> all;
  for (const CacheEntry& entry : StageCache::entries(command.folder)) {
    const std::string stage = entry.stage.empty() ? "damaged" : entry.stage;
    if (command.is_listed) context.console.print(fmt::format("{:>14} bytes  {:<14} {}", entry.bytes, stage, entry.file.string()));
    for (auto* sum : {&stages[stage], &all}) {
      ++sum->first;
      sum->second += entry.bytes;
    }
  }
  for (const auto& [stage, sum] : stages)
    context.console.print(fmt::format("{:<14} {:>8} entries  {:>10.3f} MB", stage, sum.first, static_cast<double>(sum.second) * 1e-6));
  context.console.print(fmt::format("{:<14} {:>8} entries  {:>10.3f} MB", "all", all.first, static_cast<double>(all.second) * 1e-6));
  if (command.is_cleared) context.console.print(fmt::format("removed {} entries", StageCache::clear(command.folder)));
  return k_exit_success;
}

int execute(const HalfCommand& command, const CommandContext& context) {
  if (is_model_file(command.input))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "half " + command.input,
                 .problem = "the file is a model, not a triangulation",
                 .hint = "`sterna mesh " + command.input + " --half ...` meshes half of it; in a script half(read_cad \"...\"); or `sterna surface` first"});
  require_surface_output(command.output);
  HalfOptions options;
  surfmesh::StitchOptions reading;
  OptionTable table = sterna::options_of(options);
  table.push_back(find_option(sterna::options_of(reading), "unit", "half"));
  set_options(table, command.options, context);
  reading.allow_open = true;
  const std::array files = {InputPath{command.input, command.input}};
  const SurfaceValue half = half_surface(read_wall(files, reading, context.run.part("read", 0.0, 0.5)), options, context.run.part("half", 0.5, k_mesh_end));
  write_surface(half, command.output, context.run.part("write", k_mesh_end, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + command.output.string() + ": " + describe(half));
  return k_exit_success;
}

namespace {

/// Reports before the work starts why a file cannot be written. An empty name stands for no file.
void require_writable(const std::filesystem::path& path) {
  if (!path.empty()) io::AtomicFile probe(path);
}

void require_other_output(const std::vector<std::string>& inputs, const std::filesystem::path& output, const std::string& attempted) {
  for (const std::string& name : inputs) {
    std::error_code none;  // for missing files
    if (std::filesystem::equivalent(name, output, none))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = attempted,
                   .problem = "the output " + output.string() + " is one of the inputs, which the output would replace",
                   .hint = "give it another name"});
  }
}

}  // namespace

int execute(const RepairCommand& command, const CommandContext& context) {
  require_other_output(command.inputs, command.output, "repair");
  surfmesh::StitchOptions stitching;
  surfmesh::RepairOptions options;
  set_options(repair_options(stitching, options), command.options, context);
  require_surface_output(command.output);
  require_writable(command.changes);
  require_writable(command.report);
  std::vector<UnionItem> items;
  for (const std::string& name : command.inputs) items.emplace_back(InputPath{name, name});
  const std::unique_ptr<const StageCache> cache = cache_of(command.cache);
  std::function<void(const surfmesh::RepairReport&)> look;
  if (!command.changes.empty() || !command.report.empty())
    look = [&](const surfmesh::RepairReport& report) {
      if (!command.changes.empty() && !report.changes.empty()) io::write_trouble_vtu(changed_facets(report), command.changes);
      if (!command.report.empty()) io::write_whole(command.report, repair_json(report));
    };
  const SurfaceValue repaired =
      repair_surfaces(items, stitching, options, {.cache = cache.get(), .lines = nullptr}, context.run.part("repair", 0.0, k_mesh_end), look);
  write_surface(repaired, command.output, context.run.part("write", k_mesh_end, 1.0));
  context.console.end_progress();
  for (const std::string& change : repaired.changes) context.run.info("changed: " + change);
  context.run.info("wrote " + command.output.string() + ": " + describe(repaired));
  return k_exit_success;
}

int execute(const WrapCommand& command, const CommandContext& context) {
  require_other_output(command.inputs, command.output, "wrap");
  surfmesh::WrapOptions options;
  set_options(sterna::options_of(options), command.options, context);
  require_surface_output(command.output);
  require_writable(command.changes);
  require_writable(command.report);
  std::vector<UnionItem> items;
  for (const std::string& name : command.inputs) items.emplace_back(InputPath{name, name});
  const std::unique_ptr<const StageCache> cache = cache_of(command.cache);
  std::function<void(const surfmesh::WrapReport&)> look;
  if (!command.changes.empty() || !command.report.empty())
    look = [&](const surfmesh::WrapReport& report) {
      if (!command.changes.empty() && !report.drawing.triangles.empty()) io::write_trouble_vtu(closed_facets(report), command.changes);
      if (!command.report.empty()) io::write_whole(command.report, wrap_json(report));
    };
  const SurfaceValue wrapped = wrap_surfaces(items, options, {.cache = cache.get(), .lines = nullptr}, context.run.part("wrap", 0.0, k_mesh_end), look);
  write_surface(wrapped, command.output, context.run.part("write", k_mesh_end, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + command.output.string() + ": " + describe(wrapped));
  return k_exit_success;
}

int execute(const RemeshCommand& command, const CommandContext& context) {
  for (const auto& output : command.outputs) require_surface_output(output);
  RemeshRecipe recipe;
  surfmesh::StitchOptions reading;
  OptionTable table = sterna::options_of(recipe.options);
  table.push_back(find_option(sterna::options_of(reading), "unit", "remesh"));
  set_options(table, command.options, context);
  layer_rules_of(command.patches, &recipe.patches);
  for (const std::string& text : command.sources) recipe.sources.push_back(source_of_text(text));
  reading.allow_open = true;
  const auto cache = cache_of(command.cache);
  const std::array files = {InputPath{command.input, command.input}};
  const SurfaceValue wall = remeshed(read_wall(files, reading, context.run.part("read", 0.0, k_read_end)), recipe, {},
                                     context.run.part("remesh", k_read_end, k_mesh_end), {.cache = cache.get()});
  for (const auto& output : command.outputs) write_surface(wall, output, context.run.part("write", k_mesh_end, 1.0));
  context.console.end_progress();
  for (const auto& output : command.outputs) context.run.info("wrote " + output.string() + ": " + describe(wall));
  return k_exit_success;
}

int execute(const UnionCommand& command, const CommandContext& context) {
  for (const std::string& name : command.inputs) {
    std::error_code none;  // missing files are no input, or not yet an output
    if (std::filesystem::equivalent(name, command.output, none))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "union",
                   .problem = "the output " + command.output.string() + " is one of the inputs, which the output would replace",
                   .hint = "give it another name"});
  }
  if (std::any_of(command.inputs.begin(), command.inputs.end(), [](const std::string& name) { return is_model_file(name); }))
    return unite_models(command, context);
  UnionOptions options;
  surfmesh::StitchOptions reading;
  OptionTable table = sterna::options_of(options);
  table.push_back(find_option(sterna::options_of(reading), "unit", "union"));
  set_options(table, command.options, context);
  require_surface_output(command.output);
  std::vector<UnionItem> items;
  for (const std::string& name : command.inputs) items.emplace_back(InputPath{name, name});
  const SurfaceValue united = unite_surfaces(items, reading.unit, options, context.run.part("union", 0.0, k_mesh_end));
  write_surface(united, command.output, context.run.part("write", k_mesh_end, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + command.output.string() + ": " + describe(united));
  return k_exit_success;
}

namespace {

/// \throws Error(unsupported_format) unless the name ends in .vtu, (bad_argument) if the file is the mesh itself
void require_cells_output(const std::filesystem::path& path, const std::filesystem::path& input) {
  const std::string attempted = "--cells " + path.string();
  if (path.extension() != ".vtu")
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = attempted,
                 .problem = "the quality of cells is written as a .vtu file",
                 .hint = "such as --cells " + path.stem().string() + ".vtu"});
  std::error_code none;  // a missing file is a different one
  if (std::filesystem::equivalent(path, input, none))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "this file is the mesh to be checked",
                 .hint = "such as --cells " + path.stem().string() + "_cells.vtu"});
}

[[noreturn]] void refuse_to_check_surface(const std::string& input, const std::string& what) {
  throw Error({.code = ErrorCode::unsupported_format,
               .attempted = "checking " + input,
               .problem = what,
               .hint = "check applies to volume meshes. `sterna info " + input + "` describes the surface and reports whether it is closed, `sterna mesh " +
                       input + " ...` meshes the space around it"});
}

}  // namespace

int execute(const CheckCommand& command, const CommandContext& context) {
  if (is_model_file(command.input)) return check_model(command, context);
  if (const io::Format& format = io::format_of(command.input, io::FormatUse::read_volume); !format.read_volume)
    refuse_to_check_surface(command.input, std::string(format.name) + " holds surfaces only");
  for (const std::string& model : command.models)
    if (!is_model_file(model))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "--model " + model,
                   .problem = "the file is not a model",
                   .hint = "give the STEP, IGES, BREP, sumo or CPACS file from which the mesh was made"});
  GateTable limits;
  for (const std::string& text : command.gates) set_gate_limits(text, limits);
  if (!command.cells.empty()) require_cells_output(command.cells, command.input);
  const std::array files = {std::filesystem::path(command.input)};
  const CheckOptions options = command.options.to_options(limits, consumers_of_files(files), CheckSettings::k_command_names);
  const MeshValue mesh = read_mesh({command.input, command.input}, context.run.part("read", 0.0, 0.3));
  if (count_cells(mesh.mesh).total() == 0 && !mesh.mesh.boundary_triangles.empty())
    refuse_to_check_surface(
        command.input, "the file has a surface of " + count_text(static_cast<std::int64_t>(mesh.mesh.boundary_triangles.size())) + " triangles, but no cells");
  const double checked = command.models.empty() ? 1.0 : 0.5;
  CheckReport report = check(mesh.mesh, options, context.run.part("check", 0.3, checked));
  if (!command.models.empty() && report.quality_measured) {
    std::vector<InputPath> models;
    for (const std::string& model : command.models) models.push_back({model, model});
    const SurfaceValue wall = mesh_model_files(models, {}, {}, context.run.part("surface", checked, 0.8));
    measure_on_model(mesh.mesh, wall, limits, report, context.run.part("model", 0.8, 1.0));
  }
  context.console.end_progress();
  if (!command.cells.empty()) io::write_quality_vtu(mesh.mesh, command.cells, context.run);
  context.console.print(command.is_json ? check_json(report, mesh.mesh) : check_text(report, mesh.mesh));
  return command.options.accepts(report) ? k_exit_success : k_exit_invalid;
}

int execute(const InfoCommand& command, const CommandContext& context) {
  surfmesh::StitchOptions unit;
  const OptionTable schema = sterna::options_of(unit);
  if (!command.unit.empty()) set_option_as_typed(find_option(schema, "unit", "info"), command.unit);
  if (command.is_json) {
    const std::string json = info_json(command.input, command.unit.empty() ? std::nullopt : std::optional(unit.unit), context);
    context.console.end_progress();
    context.console.print(json);
    return k_exit_success;
  }
  if (is_model_file(command.input)) return print_model_info(command, context);
  const InputPath input{command.input, command.input};
  const io::Format& format = io::format_of(input.path);
  if (!std::filesystem::exists(input.path))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + command.input, .problem = "there is no such file"});
  context.console.print(fmt::format("{}: {}, 1 unit of the file = {:g} m", command.input, format.name, unit.unit));
  // A format that holds volume meshes may hold a surface alone; then the file is read as a surface.
  if (format.read_volume) {
    const int status = print_volume_info(input, unit.unit, context);
    if (status >= 0) return status;
  }
  return print_surface_info(input, unit.unit, context);
}

int execute(const ConvertCommand& command, const CommandContext& context) {
  if (is_model_file(command.input)) return convert_model(command, context);
  ConvertSettings settings = command.settings;
  set_options(sterna::options_of(settings.writing), command.writing, context);
  settings.is_numbering_given = !command.writing.empty();
  if (!command.options.empty())
    throw Error(
        {.code = ErrorCode::bad_argument,
         .attempted = "convert",
         .problem = "option " + command.options.front().first + " applies to models (STEP, IGES, BREP, sumo, CPACS); " + command.input + " is not a model"});
  const std::string what = convert({command.input, command.input}, command.output, settings, context.run);
  context.console.end_progress();
  context.run.info("wrote " + command.output.string() + ": " + what);
  return k_exit_success;
}

int list_formats(const CommandContext& context) {
  constexpr const char* k_row = "{:<16} {:<12} {:<12} {:<12} {}";
  context.console.print(fmt::format(k_row, "format", "surface", "volume", "patch names", "extensions (each also with .gz for reading)"));
  for (const io::Format& format : io::formats())
    context.console.print(fmt::format(k_row, format.name, read_write(format.read_surface != nullptr, format.write_surface != nullptr),
                                      read_write(format.read_volume != nullptr, format.write_volume != nullptr), format.carries_patch_names ? "yes" : "no",
                                      format.extensions));
  constexpr const char* k_model_row = "{:<16} {:<25} {:<12} {}";
  context.console.print("");
  context.console.print(fmt::format(k_model_row, "format", "model (exact geometry)", "names", "extensions"));
  context.console.print(fmt::format(k_model_row, "STEP", "read, write", "yes", ".step .stp"));
  context.console.print(fmt::format(k_model_row, "IGES", "read, write", "layers", ".iges .igs"));
  context.console.print(fmt::format(k_model_row, "BREP", "read, write", "no", ".brep .egads"));
  context.console.print(fmt::format(k_model_row, "sumo", "read, write", "yes", ".smx"));
  context.console.print(fmt::format(k_model_row, "CPACS", "read", "yes", ".xml"));
  return k_exit_success;
}

std::string draw_trouble(const Error& error, const std::filesystem::path& path) {
  if (error.info().geometry.empty()) return {};
  try {
    io::write_trouble_vtu(error.info().geometry, path);
    return "\n  picture: " + path.string();
  } catch (const Error& failure) {
    return std::string("\n  and the picture could not be written: ") + failure.what();
  }
}

}  // namespace sterna::scripting
