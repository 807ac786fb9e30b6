#include "scripting/values/repair_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scripting/cache/stage_cache.h"
#include "scripting/values/geometry_changes.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/open_domains.h"
#include "scripting/values/remeshed_surface.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/value_keys.h"
#include "scripting/values/wall_files.h"
#include "scripting/values/wrap_surfaces.h"
#include "surfmesh/model/replaced_faces.h"
#include "surfmesh/repair/folded_edges.h"
#include "surfmesh/stitch/as_read.h"

namespace sterna::scripting {
namespace {

constexpr const char* k_repair_stage = "repair";
constexpr double k_repair_read_end = 0.1;  ///< progress of repair_surfaces
// Progress of read_as_it_is.
constexpr double k_files_read_end = 0.3;
constexpr double k_closed_end = 0.8;
// Progress of auto_surface.
constexpr double k_as_it_is_end = 0.3;
constexpr double k_triangles_end = 0.35;
constexpr double k_repair_end = 0.6;
constexpr double k_remesh_begin = 0.7;
constexpr std::size_t k_faces_reported = 3;  ///< number of faces named in the summary

/// Cached data of a repair.
struct RepairedWall {
  TriMesh mesh;
  surfmesh::StitchReport report;
  std::vector<std::string> messages;
  bool is_changed = false;
};

ContentKey repair_key(const SurfaceItems& items, surfmesh::RepairOptions options) {
  KeyMaker maker(k_repair_stage);
  for (const SurfaceSoup& soup : items.soups)
    maker.add(soup.points).add(soup.triangles).add(soup.patch).add(soup.patch_names).add(soup.source).add(soup.has_names).add(soup.single_precision);
  surfmesh::StitchOptions stitching = items.wall.options;
  return maker.add(sterna::options_of(stitching)).add(sterna::options_of(options)).key();
}

/// Reports the faces of a model whose triangles were replaced, with their distance from the face.
void report_replaced_faces(const SurfaceValue& made, SurfaceValue& repaired, const RunContext& context) {
  const surfmesh::ReplacedFaces replaced = surfmesh::find_replaced_faces(*made.true_surface.wall, made.mesh, repaired.mesh, context);
  if (replaced.faces.empty()) return;
  const std::vector<std::string> lines = to_lines(replaced.faces, replaced.faces.size());
  std::string text =
      fmt::format("triangles of {} of {} faces of the model were replaced, the other {} of {} triangles are unchanged: ", replaced.faces.size(),
                  made.mesh_report->faces.size(), count_text(replaced.n_exact), count_text(static_cast<std::int64_t>(repaired.mesh.n_triangles())));
  for (std::size_t i = 0; i < std::min(k_faces_reported, lines.size()); ++i) text += (i == 0 ? "" : "; ") + lines[i];
  if (lines.size() > k_faces_reported) text += fmt::format("; and {} more (see log or report)", lines.size() - k_faces_reported);
  repaired.history.back().changes.push_back(std::move(text));
  for (const std::string& line : lines) {
    repaired.report.messages.push_back(line);
    context.info("repair: " + line);
  }
}

bool are_models(std::span<const InputPath> files) {
  return std::ranges::all_of(files, [](const InputPath& file) { return is_model_file(file.path); });
}

/// A repaired surface that is not accepted yet. No warnings have been given for it.
struct Repaired {
  SurfaceValue wall;
  std::optional<GeometryChange> change;  ///< nothing: unchanged
};

Repaired repaired_of(std::span<const UnionItem> items, const surfmesh::StitchOptions& stitching, const surfmesh::RepairOptions& options, const Reuse& reuse,
                     const RunContext& context, const std::function<void(const surfmesh::RepairReport&)>& look) {
  const SurfaceItems read = read_items(items, stitching, context.part("read", 0.0, k_repair_read_end));
  const StageTimer timer(context, k_repair_stage);
  const auto make = [&] {
    surfmesh::RepairResult result = surfmesh::repair_surface(read.soups, read.wall.options, options, context.part("repair", k_repair_read_end, 1.0));
    if (look) look(result.report);
    return RepairedWall{std::move(result.mesh), std::move(result.report.stitch), std::move(result.report.messages), !result.report.changes.empty()};
  };
  const std::optional<ContentKey> key = reuse.cache && !look ? std::optional(repair_key(read, options)) : std::nullopt;
  RepairedWall made = cached<RepairedWall>(reuse, k_repair_stage, {}, key, context, make);
  Repaired result{with_mesh(read, std::move(made.mesh), std::move(made.report)), std::nullopt};
  SurfaceValue& wall = result.wall;
  wall.history.push_back({.options = options});
  if (made.is_changed || wall.report.n_degenerate_removed + wall.report.n_duplicate_removed > 0) {
    GeometryChange change = compare_geometry(surfmesh::mesh_as_read(read.soups, read.wall.options), wall.mesh, "repair", context);
    if (made.is_changed || !change.is_small()) result.change = std::move(change);
  }
  if (made.is_changed) wall.history.back().changes.push_back(change_text("repaired", made.messages));
  context.info(describe(wall) + (made.is_changed ? " (repaired)" : " (nothing to repair)"));
  return result;
}

/// Reads a surface that is sound: closed, or open in planes of the domain only.
/// \throws Error of read_wall; also for a surface that is not closed
SurfaceValue read_as_it_is(std::span<const InputPath> files, const surfmesh::StitchOptions& stitching, const RunContext& context) {
  const WallFiles read = read_wall_files(files, stitching, context.part("read", 0.0, k_files_read_end));
  try {
    SurfaceValue wall = join_wall(read, context.part("stitch", k_files_read_end, k_closed_end));
    report_wall(wall, context);
    return wall;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::open_surface || stitching.allow_open || read.wall.options.fluid == "inside") throw;
    WallFiles open = read;
    open.wall.options.allow_open = true;
    try {
      SurfaceValue wall = join_wall(open, context.part("stitch", k_closed_end, 1.0));
      if (const std::optional<std::string> planes = ends_in_planes(wall.mesh, context)) {
        context.info("auto: " + *planes);
        wall.report.messages.push_back(*planes);
        report_wall(wall, context);
        return wall;
      }
    } catch (const Error& other) {
      if (!is_about_surface(other)) throw;
    }
    throw;
  }
}

/// Returns one sentence if the surface to be wrapped is a sheet.
std::optional<std::string> sheet_of(std::span<const UnionItem> items, const surfmesh::StitchOptions& stitching, const RunContext& context) {
  surfmesh::StitchOptions open = stitching;
  open.allow_open = true;
  open.check_intersections = false;
  const SurfaceItems read = read_items(items, open, context);
  try {
    return is_open_sheet(surfmesh::stitch_surface(read.soups, open, context).mesh, context);
  } catch (const Error& error) {
    if (!is_about_surface(error)) throw;
    return std::nullopt;
  }
}

/// Returns the accepted surface, with warnings about missing or different parts.
SurfaceValue accepted(Repaired repaired, const RunContext& context) {
  for (const std::string& text : repaired.wall.report.warnings) context.warn(text);
  if (repaired.change) note_change(repaired.wall, *repaired.change, context);
  return std::move(repaired.wall);
}

}  // namespace

SurfaceValue repair_surfaces(std::span<const UnionItem> items, const surfmesh::StitchOptions& stitching, const surfmesh::RepairOptions& options,
                             const Reuse& reuse, const RunContext& context, const std::function<void(const surfmesh::RepairReport&)>& look) {
  return accepted(repaired_of(items, stitching, options, reuse, context, look), context);
}

OptionTable repair_options(surfmesh::StitchOptions& stitching, surfmesh::RepairOptions& options) {
  OptionTable table = sterna::options_of(options);
  for (Option& option : sterna::options_of(stitching))
    if (option.name != "allow_open" && option.name != "check_intersections") table.push_back(std::move(option));
  return table;
}

TroubleGeometry changed_facets(const surfmesh::RepairReport& report) { return {report.drawing.points, report.drawing.triangles, {}, {}}; }

std::string repair_json(const surfmesh::RepairReport& report) {
  nlohmann::ordered_json json = {{"schema", "sterna-repair-1"}, {"messages", report.messages}, {"length", report.length}};
  json["distance"] = {{"moved", report.moved}, {"from_result", report.from_result}, {"from_input", report.from_input}, {"sampling", report.sampling}};
  if (report.half) json["half"] = {{"axis", report.half->axis}, {"at", report.half->at}, {"off", report.half->off}};
  json["changes"] = nlohmann::ordered_json::array();
  for (const surfmesh::RepairChange& change : report.changes)
    json["changes"].push_back({{"kind", to_string(change.kind)},
                               {"at", {change.position.x, change.position.y, change.position.z}},
                               {"size", change.size},
                               {"facets", change.n_facets}});
  return json.dump(2) + "\n";
}

bool is_about_surface(const Error& error) {
  switch (error.code()) {
    case ErrorCode::empty_surface:
    case ErrorCode::open_surface:
    case ErrorCode::non_manifold_surface:
    case ErrorCode::self_intersection:
    case ErrorCode::not_orientable:
    case ErrorCode::geometry_failed:
    case ErrorCode::mesh_invalid: return true;
    default: return false;
  }
}

surfmesh::WrapOptions wrap_with_reading(surfmesh::WrapOptions wrap, const surfmesh::StitchOptions& reading) {
  wrap.unit = reading.unit;
  wrap.split_angle = reading.split_angle;
  wrap.fluid = reading.fluid;
  return wrap;
}

SurfaceValue auto_triangles(std::span<const InputPath> files, const AutoSurface& options, const Reuse& reuse, const RunContext& context) {
  ErrorInfo first;
  std::optional<SurfaceValue> open;  // surface of a model, perhaps of half a model
  surfmesh::StitchOptions stitching = options.stitching;
  try {
    const RunContext as_it_is = context.part("as it is", 0.0, k_as_it_is_end);
    if (!are_models(files)) return read_as_it_is(files, stitching, as_it_is);
    SurfaceValue surface = mesh_model_files(files, options.reading, options.recipe, as_it_is, reuse, options.periodic);
    if (surface.report.is_closed) return surface;
    if (stitching.fluid != "inside")
      if (const std::optional<std::string> planes = ends_in_planes(surface.mesh, as_it_is)) {
        context.info("auto: " + *planes);
        return surface;
      }
    first = {.code = ErrorCode::open_surface, .attempted = "meshing the model's surface", .problem = "the surface is open"};
    open = std::move(surface);
  } catch (const Error& error) {
    if (!is_about_surface(error)) throw;
    first = error.info();
  }
  context.info("auto: " + first.attempted + ": " + first.problem + "; repair follows");
  std::vector<UnionItem> items(files.begin(), files.end());
  SurfaceHandle of_model;  // surface of the model with the triangles of its faces
  if (are_models(files)) {
    SurfaceRecipe recipe = options.recipe;
    recipe.options.crossings = "ignore";
    recipe.options.failed_faces = "hole";  // repair fills the holes of failed faces
    const RunContext part = context.part("triangles", k_as_it_is_end, k_triangles_end);
    of_model = std::make_shared<const SurfaceValue>(open ? *open : mesh_model_files(files, options.reading, recipe, part, reuse, options.periodic));
    items = {of_model};
    stitching.unit = 1.0;
    if (options.reading.fluid != "automatic") stitching.fluid = options.reading.fluid;
  }
  std::optional<Repaired> folded;  // a repaired surface whose remaining facets are folded onto each other
  try {
    Repaired repaired = repaired_of(items, stitching, options.repair, reuse, context.part("repair", k_triangles_end, k_repair_end), {});
    if (open && changes_of(repaired.wall.history) == changes_of(open->history)) return *open;
    if (of_model) report_replaced_faces(*of_model, repaired.wall, context);
    const std::int64_t n_folded = surfmesh::count_folded_edges(repaired.wall.mesh);
    if (static_cast<double>(n_folded) < surfmesh::k_many_folded * 1.5 * static_cast<double>(repaired.wall.mesh.n_triangles()))
      return accepted(std::move(repaired), context);
    context.info(fmt::format("auto: repair leaves {} pairs of facets folded onto each other, around which tetrahedra cannot be made; wrap follows",
                             count_text(n_folded)));
    folded = std::move(repaired);
  } catch (const Error& error) {
    if (!is_about_surface(error)) throw;
    first.problem += "; repair: " + error.info().problem;
    context.info("auto: repair: " + error.info().problem + "; wrap follows");
  }
  if (const std::optional<std::string> sheet = sheet_of(items, stitching, context.part("sheet", k_repair_end, k_repair_end))) context.warn("auto: " + *sheet);
  try {
    return wrap_surfaces(items, wrap_with_reading(options.wrap, stitching), reuse, context.part("wrap", k_repair_end, 1.0));
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    if (folded) return accepted(std::move(*folded), context);
    first.problem += "; wrap: " + error.info().problem;
    throw Error(std::move(first));
  }
}

SurfaceValue auto_surface(std::span<const InputPath> files, const AutoSurface& options, const Reuse& reuse, const RunContext& context) {
  const SurfaceValue made = auto_triangles(files, options, reuse, context.part("triangles", 0.0, k_remesh_begin));
  return without_slivers(made, {.options = options.remesh, .patches = {}, .sources = {}}, context.part("remesh", k_remesh_begin, 1.0), reuse);
}

}  // namespace sterna::scripting
