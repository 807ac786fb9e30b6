#include "scripting/values/verbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "geom/base/error.h"
#include "geom/boolean/union_patches.h"
#include "io/file/format_table.h"
#include "io/file/input_hash.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "io/output/atomic_file.h"
#include "io/volume/sterna_file.h"
#include "scripting/lua/quantity.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/foam_zones.h"
#include "scripting/values/geometry_changes.h"
#include "scripting/values/layer_json.h"
#include "scripting/values/manifest.h"
#include "scripting/values/mesh_manifest.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_manifest.h"
#include "scripting/values/wall_files.h"

namespace sterna::scripting {
namespace {

// Fractions of the progress of read_wall; reading is bound by the disk, stitching by the intersection test.
constexpr double k_wall_read_end = 0.3;
/// Progress at the ends of the steps of unite_surfaces. Cutting and remeshing take most of its time.
constexpr double k_union_read_end = 0.2;

void require_output(const std::filesystem::path& path, io::FormatUse use) {
  const io::Format& format = io::format_to_write(path, use);
  if (format.require_output) return format.require_output(path);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder))
    throw Error({.code = ErrorCode::write_failed, .attempted = "writing " + path.string(), .problem = "there is no folder " + folder.string()});
  io::AtomicFile probe(path);  // reports why the file cannot be written; removed at once
}

/// Rejects a volume mesh that is given as a wall. Its surface has wall, planes and farfield, so the aircraft would become a cavity of a body as large as the
/// domain.
void require_surface(const SurfaceSoup& soup, const InputPath& file, const surfmesh::StitchOptions& options) {
  if (soup.n_cells == 0 || options.take_boundary) return;
  std::string names;
  constexpr std::size_t k_named = 8;
  for (std::size_t i = 0; i < soup.patch_names.size() && i < k_named; ++i) names += (i > 0 ? ", " : "") + soup.patch_names[i];
  if (soup.patch_names.size() > k_named) names += ", ...";
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "reading " + file.name + " as a surface",
               .problem = fmt::format("it is a volume mesh of {} cells; its boundary ({}) is more than a wall",
                                      count_text(static_cast<std::int64_t>(soup.n_cells)), names),
               .hint = "give the surface from which the mesh was made. `sterna convert " + file.name +
                       " boundary.stl --surface` writes its boundary; read_surface{ ..., take_boundary = true } or --take-boundary takes all of it"});
}

}  // namespace

WallFiles read_wall_files(std::span<const InputPath> files, const surfmesh::StitchOptions& options, const RunContext& context) {
  WallFiles result;
  SurfaceValue& wall = result.wall;
  wall.options = options;
  const StageTimer timer(context, "read");
  for (const InputPath& file : files) {
    result.soups.push_back(io::read_surface_file(file.path, context));
    require_surface(result.soups.back(), file, options);
    wall.inputs.push_back({file.name, io::hash_input(file.path)});
    const auto known = read_surface_manifest(file, wall.inputs.back().hash, context);
    if (!known || !known->smooth_angle || wall.inputs.size() == 1) wall.smooth_angle = known ? known->smooth_angle : std::nullopt;
    else if (wall.smooth_angle) wall.smooth_angle = std::max(*wall.smooth_angle, *known->smooth_angle);
    if (known) {
      if (known->encloses_fluid && options.fluid == "automatic") wall.options.fluid = "inside";
      result.kinds.insert(known->kinds.begin(), known->kinds.end());
      wall.layers.insert(wall.layers.end(), known->layers.begin(), known->layers.end());
      inherit(wall.history, known->history);
    }
    context.progress(static_cast<double>(result.soups.size()) / static_cast<double>(files.size()));
  }
  return result;
}

SurfaceValue join_wall(const WallFiles& files, const RunContext& context) {
  const StageTimer timer(context, "stitch");
  SurfaceValue wall = files.wall;
  surfmesh::StitchResult stitched = surfmesh::stitch_surface(files.soups, wall.options, context);
  wall.mesh = std::move(stitched.mesh);
  wall.report = std::move(stitched.report);
  set_kinds(wall.mesh.patches, files.kinds);
  for (const std::string& text : wall.report.warnings) context.warn(text);
  note_reading(wall, files.soups, context);
  return wall;
}

void report_wall(const SurfaceValue& wall, const RunContext& context) {
  // The unit is always reported, because an error by a factor of 1000 would be noticed only when the solver runs.
  const double unit = wall.options.unit;
  context.info(describe(wall) + fmt::format(" (1 unit of the file = {:g} m)", unit));
  constexpr double k_tiny = 0.1, k_huge = 1000.0;  // m; models in tunnels are longer than k_tiny, ships are shorter than k_huge
  if (const double length = body_length(wall.mesh); length > 0.0 && (length < k_tiny || length > k_huge))
    context.info(fmt::format("hint: the surface is {:.4g} m long: is 1 unit of the file {:g} m? (unit = mm, --unit inch ...)", length, unit));
}

SurfaceValue read_wall(std::span<const InputPath> files, const surfmesh::StitchOptions& options, const RunContext& context) {
  const WallFiles read = read_wall_files(files, options, context.part("read", 0.0, k_wall_read_end));
  SurfaceValue wall = join_wall(read, context.part("stitch", k_wall_read_end, 1.0));
  report_wall(wall, context);
  return wall;
}

SurfaceValue unite_surfaces(std::span<const UnionItem> items, double unit, const UnionOptions& options, const RunContext& context) {
  SurfaceValue result;
  result.options.unit = unit;
  result.options.check_intersections = false;  // union accepts crossings; it proves that its result has none
  std::vector<UnionPart> parts;
  std::vector<std::string> changes;  // of the parts; their figures describe other surfaces
  for (const UnionItem& item : items) {
    SurfaceValue read;
    if (const auto* file = std::get_if<InputPath>(&item)) {
      const double n = static_cast<double>(items.size()), i = static_cast<double>(parts.size());
      read = read_wall(std::span(file, 1), result.options, context.part("read", k_union_read_end * i / n, k_union_read_end * (i + 1) / n));
    } else {
      read = *std::get<SurfaceHandle>(item);
    }
    parts.push_back({read.inputs.empty() ? "" : std::filesystem::path(read.inputs.front().name).stem().string(), std::move(read.mesh)});
    for (InputFile& input : read.inputs) result.inputs.push_back(std::move(input));
    result.layers.insert(result.layers.end(), read.layers.begin(), read.layers.end());
    for (std::string& change : changes_of(read.history)) changes.push_back(std::move(change));
  }
  result.history.push_back({.options = options, .changes = std::move(changes)});
  const StageTimer timer(context, "union");
  UnionResult united = unite_meshes(parts, options, context.part("union", k_union_read_end, 1.0));
  result.mesh = std::move(united.mesh);
  result.report.n_triangles_read = 0;
  for (const UnionPart& part : parts) result.report.n_triangles_read += static_cast<std::int64_t>(part.mesh.n_triangles());
  result.report.n_components = united.report.n_components;
  result.report.messages = std::move(united.report.messages);
  TriMesh whole;
  const std::vector<std::vector<Patch>> names = result_patches(parts);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    TriMesh part = parts[i].mesh;
    part.patches = Column<PatchId, Patch>(names[i]);
    append(whole, part);
  }
  note_change(result, compare_geometry(whole, result.mesh, "union", context), context, GeometryChangeUse::unites_bodies);
  return result;
}

MeshValue read_mesh(const InputPath& file, const RunContext& context, io::Incomplete incomplete) {
  const StageTimer timer(context, "read");
  MeshValue value;
  value.mesh = io::read_volume_file(file.path, context.part("read", 0.0, 1.0), incomplete);
  value.inputs.push_back({file.name, io::hash_input(file.path)});
  complete_from_manifest(value, file, value.inputs.back().hash, context);
  if (!value.unknown_kinds.empty() && count_cells(value.mesh).total() > 0)
    context.warn("the kind of " + quoted_list(value.unknown_kinds) + " is unknown and taken as wall: " + why_kinds_are_unknown(file));
  return value;
}

void require_mesh_output(const std::filesystem::path& path) { require_output(path, io::FormatUse::write_volume); }
void require_surface_output(const std::filesystem::path& path) { require_output(path, io::FormatUse::write_surface); }

namespace {

Numbering numbering_for(const io::Format& format, const WriteOptions& options) {
  if (options.numbering != "automatic") return numbering_of(options.numbering);
  return format.name == "OpenFOAM" ? Numbering::both : Numbering::lines;
}

}  // namespace

void write_mesh_alone(const HybridMesh& mesh, const std::filesystem::path& path, std::string_view format_name, const WriteOptions& options,
                      const RunContext& context) {
  const io::Format& format = io::format_to_write(path, io::FormatUse::write_volume, format_name);
  const Numbering numbering = numbering_for(format, options);
  if (numbering == Numbering::lines || format.name == "sterna") return io::write_volume_file(mesh, path, context, format_name);
  // If all cells share one numbering, the format orders them itself, which requires the columns. The order of nodes hardly affects solvers with values in
  // cells.
  const HybridMesh numbered = renumbered(mesh, format.write_numbered ? Numbering::both : numbering, context);
  io::write_volume_file(numbered, path, context, format_name, numbering);
}

void write_mesh(const MeshValue& mesh, const std::filesystem::path& given, const WriteOptions& options, const RunContext& context) {
  const std::filesystem::path path = given.has_filename() ? given : given.parent_path();  // a folder may end in a slash
  const StageTimer timer(context, "write");
  const RunContext part = context.part("write " + path.filename().string(), 0.0, 1.0);
  if (path.extension() == ".sterna") {  // a .sterna file also holds the known data of the mesh
    io::write_sterna({.mesh = &mesh.mesh,
                      .manifest = manifest_json(mesh, path, context.seed()),
                      .certificate = mesh.origin ? certificate_json(mesh.origin->report.certificate).dump() : std::string(),
                      .quality = mesh.check ? to_json(*mesh.check) : std::string()},
                     path, part);
  } else if (const io::Format& format = io::format_to_write(given, io::FormatUse::write_volume, {}); format.name == "OpenFOAM") {
    write_zoned_foam(mesh, given, numbering_for(format, options), part);
  } else {
    write_mesh_alone(mesh.mesh, given, {}, options, part);  // the given path, because its slash marks a folder that is still to be created
  }
  write_manifest(mesh, path, context);
}

namespace {

/// Returns the number of vertices that single precision merges with others: neighbours closer than rounding.
std::int64_t count_merged_by_rounding(const TriMesh& mesh) {
  using Rounded = std::array<float, 3>;
  std::vector<std::pair<Rounded, Point>> points;
  for (const Point& p : mesh.points) points.push_back({{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}, p});
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::int64_t n = 0;
  for (std::size_t i = 1; i < points.size(); ++i) n += points[i].first == points[i - 1].first && !(points[i].second == points[i - 1].second);
  return n;
}

}  // namespace

void write_surface(const SurfaceValue& surface, const std::filesystem::path& path, const RunContext& context) {
  io::write_surface_file(surface.mesh, path, context);
  if (const std::string extension = path.extension().string(); (extension == ".stl" || extension == ".STL") && surface.mesh.patches.size() <= 1)  // binary
    if (const std::int64_t n = count_merged_by_rounding(surface.mesh); n > 0)
      context.warn(
          fmt::format("{}: STL is single precision, which merges {} of {} vertices with others: after reading, the surface may be open or touch itself there. "
                      "Use .obj, .ply or .off, which keep all digits",
                      path.string(), count_text(n), count_text(static_cast<std::int64_t>(surface.mesh.n_vertices()))));
  if (has_surface_manifest(surface)) write_surface_manifest(surface, path);
}

OptionTable all_options(surfmesh::StitchOptions& surface, volmesh::MeshCase& volume) {
  OptionTable table = sterna::options_of(surface);
  for (Option& option : volmesh::options_of(volume)) table.push_back(std::move(option));
  return table;
}

void replace_mesh(SurfaceValue& surface, TriMesh mesh) {
  surface.mesh = std::move(mesh);
  surface.mesh_report.reset();
  surface.true_surface = {};
  surface.parts.clear();
}

}  // namespace sterna::scripting
