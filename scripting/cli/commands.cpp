#include "scripting/cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/mesh/check.h"
#include "io/field/trouble_vtu.h"
#include "io/file/format_table.h"
#include "io/file/surface_file.h"
#include "io/output/atomic_file.h"
#include "io/volume/volume_vtu.h"
#include "scripting/cli/info_json.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/series/case_worker.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/check_options.h"
#include "scripting/values/consumers.h"
#include "scripting/values/manifest.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/summary.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"
#include "scripting/values/wall_files.h"
#include "scripting/verbs/gate_limits.h"
#include "scripting/verbs/model_gates.h"

namespace sterna::scripting {
namespace {

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

std::string read_write(bool is_read, bool is_written) { return is_read && is_written ? "read, write" : is_read ? "read" : is_written ? "write" : "-"; }

}  // namespace

std::vector<InputPath> input_paths(const std::vector<std::string>& names) {
  std::vector<InputPath> inputs;
  for (const std::string& name : names) inputs.push_back({name, name});
  return inputs;
}

std::unique_ptr<const StageCache> cache_of(const CommandLine& line) {
  if (line.cache.empty()) return nullptr;
  return std::make_unique<const StageCache>(CacheSettings{.folder = line.cache, .limit = line.cache_limit.value_or(k_cache_limit)});
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
std::vector<std::string> worker_words(const CommandLine& line, const RunContext& run) {
  std::vector<std::string> words;
  for (const auto& [name, value] : line.set)
    if (name != "retry" && name != "series.retry") words.push_back("--set=" + name + "=" + value);  // a case does not depend on these two
  words.push_back("--seed=" + std::to_string(run.seed()));
  for (const auto& [name, value] : line.arguments) words.push_back(name + "=" + value);
  if (const std::string folder = line.word("look-in"); !folder.empty()) words.push_back("--look-in=" + folder);
  return words;
}

int run_command(const CommandLine& line, const CommandContext& context) {
  const std::unique_ptr<const StageCache> cache = cache_of(line);
  const std::string series_case = line.word("series-case"), input_folder = line.word("look-in"), tasks = line.word("tasks");
  SeriesSettings series{.program = std::filesystem::read_symlink("/proc/self/exe"),
                        .words = worker_words(line, context.run),
                        .worker = {},
                        .stops_itself = context.stops_itself,
                        .tasks = tasks.empty() ? 0 : std::stoi(tasks),
                        .retries = line.flag("retry")};
  if (!series_case.empty() || !input_folder.empty()) become_worker();
  if (!series_case.empty()) series.worker = case_of_text(series_case);
  const ScriptOutcome outcome = run_script({.script = line.word("script"),
                                            .overrides = line.set,
                                            .print = [&](std::string_view text) { context.console.print(text); },
                                            .on_mesh = [&](const MeshValue& mesh) { context.run.info(summary_text(mesh)); },
                                            .cache = cache.get(),
                                            .series = series,
                                            .arguments = line.arguments,
                                            .input_folder = input_folder},
                                           context.run);
  if (outcome.n_failed_cases > 0) return k_exit_failed;
  return outcome.n_invalid_cases > 0 ? k_exit_invalid : k_exit_success;
}

int cache_command(const CommandLine& line, const CommandContext& context) {
  std::map<std::string, std::pair<std::size_t, std::uint64_t>> stages;
  std::pair<std::size_t, std::uint64_t> all;
  for (const CacheEntry& entry : StageCache::entries(line.word("folder"))) {
    const std::string stage = entry.stage.empty() ? "damaged" : entry.stage;
    if (line.flag("list")) context.console.print(fmt::format("{:>14} bytes  {:<14} {}", entry.bytes, stage, entry.file.string()));
    for (auto* sum : {&stages[stage], &all}) {
      ++sum->first;
      sum->second += entry.bytes;
    }
  }
  for (const auto& [stage, sum] : stages)
    context.console.print(fmt::format("{:<14} {:>8} entries  {:>10.3f} MB", stage, sum.first, static_cast<double>(sum.second) * 1e-6));
  context.console.print(fmt::format("{:<14} {:>8} entries  {:>10.3f} MB", "all", all.first, static_cast<double>(all.second) * 1e-6));
  if (line.flag("clear")) context.console.print(fmt::format("removed {} entries", StageCache::clear(line.word("folder"))));
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

int check_command(const CommandLine& line, const CommandContext& context) {
  const std::string input = line.word("mesh"), findings_per_kind = line.word("findings-per-kind"), solvers = line.word("for"), cells = line.word("cells");
  const std::vector<std::string>& models = line.all("model");
  if (is_model_file(input)) return check_model(line, context);
  if (const io::Format& format = io::format_of(input, io::FormatUse::read_volume); !format.read_volume)
    refuse_to_check_surface(input, std::string(format.name) + " holds surfaces only");
  for (const std::string& model : models)
    if (!is_model_file(model))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "--model " + model,
                   .problem = "the file is not a model",
                   .hint = "give the STEP, IGES, BREP, sumo or CPACS file from which the mesh was made"});
  GateTable limits;
  for (const std::string& text : line.all("gate")) set_gate_limits(text, limits);
  if (!cells.empty()) require_cells_output(cells, input);
  CheckSettings settings{.intersections = line.flag("intersections"), .cell_centred = line.flag("cell-centred"), .strict = line.flag("strict")};
  if (!findings_per_kind.empty()) settings.findings_per_kind = std::stoi(findings_per_kind);
  if (!solvers.empty()) settings.solvers = solvers;
  const std::array files = {std::filesystem::path(input)};
  const CheckOptions options = settings.to_options(limits, consumers_of_files(files), CheckSettings::k_command_names);
  const MeshValue mesh = read_mesh({input, input}, context.run.part("read", 0.0, 0.3));
  if (count_cells(mesh.mesh).total() == 0 && !mesh.mesh.boundary_triangles.empty())
    refuse_to_check_surface(
        input, "the file has a surface of " + count_text(static_cast<std::int64_t>(mesh.mesh.boundary_triangles.size())) + " triangles, but no cells");
  const double checked = models.empty() ? 1.0 : 0.5;
  CheckReport report = check(mesh.mesh, options, context.run.part("check", 0.3, checked));
  if (!models.empty() && report.quality_measured) {
    const SurfaceValue wall = mesh_model_files(input_paths(models), {}, {}, context.run.part("surface", checked, 0.8));
    measure_on_model(mesh.mesh, wall, limits, report, context.run.part("model", 0.8, 1.0));
  }
  context.console.end_progress();
  if (!cells.empty()) io::write_quality_vtu(mesh.mesh, cells, context.run);
  context.console.print(line.flag("json") ? check_json(report, mesh.mesh) : check_text(report, mesh.mesh));
  return settings.accepts(report) ? k_exit_success : k_exit_invalid;
}

int info_command(const CommandLine& line, const CommandContext& context) {
  const std::string file = line.word("file"), text = line.word("unit");
  surfmesh::StitchOptions unit;
  const OptionTable schema = sterna::options_of(unit);
  if (!text.empty()) set_option_as_typed(find_option(schema, "unit", "info"), text);
  if (line.flag("json")) {
    const std::string json = info_json(file, text.empty() ? std::nullopt : std::optional(unit.unit), context);
    context.console.end_progress();
    context.console.print(json);
    return k_exit_success;
  }
  if (is_model_file(file)) return print_model_info(line, context);
  const InputPath input{file, file};
  const io::Format& format = io::format_of(input.path);
  if (!std::filesystem::exists(input.path))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + file, .problem = "there is no such file"});
  context.console.print(fmt::format("{}: {}, 1 unit of the file = {:g} m", file, format.name, unit.unit));
  // A format that holds volume meshes may hold a surface alone; then the file is read as a surface.
  if (format.read_volume) {
    const int status = print_volume_info(input, unit.unit, context);
    if (status >= 0) return status;
  }
  return print_surface_info(input, unit.unit, context);
}

int formats_command(const CommandLine& /*line*/, const CommandContext& context) {
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
