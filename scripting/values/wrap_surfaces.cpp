#include "scripting/values/wrap_surfaces.h"

#include <filesystem>

#include "geom/mesh/topology.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"
#include "scripting/values/wall_files.h"

namespace sterna::scripting {
namespace {

/// Share of the progress; reading is bound by the disk.
constexpr double k_wrap_read_end = 0.1;
constexpr const char* k_wrap_stage = "wrap";

SurfaceSoup soup_of_surface(const TriMesh& mesh, double unit) {
  SurfaceSoup soup;
  soup.source = "surface";
  soup.has_names = true;
  for (const Vec3& p : mesh.points) soup.points.push_back(p / unit);
  for (const Patch& patch : mesh.patches) soup.patch_names.push_back(patch.name);
  for (const TriangleId t : mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.triangles[t];
    soup.triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
    soup.patch.push_back(mesh.triangle_patch[t].value());
  }
  return soup;
}

/// All that the wrap's mesh and report depend on.
ContentKey wrap_key(const std::vector<SurfaceSoup>& soups, surfmesh::WrapOptions options) {
  KeyMaker maker(k_wrap_stage);
  for (const SurfaceSoup& soup : soups) maker.add(soup.points).add(soup.triangles).add(soup.patch).add(soup.patch_names).add(soup.source).add(soup.has_names);
  return maker.add(sterna::options_of(options)).key();
}

struct WrappedWall {
  TriMesh mesh;
  surfmesh::StitchReport report;
};

WrappedWall wrapped(const std::vector<SurfaceSoup>& soups, const surfmesh::WrapOptions& options, const RunContext& context) {
  surfmesh::WrapResult result = surfmesh::wrap_surface(soups, options, context);
  WrappedWall wall;
  wall.mesh = std::move(result.mesh);
  wall.report.n_triangles_read = result.report.n_facets_read;
  for (const SurfaceSoup& soup : soups) wall.report.n_vertices_read += static_cast<std::int64_t>(soup.points.size());
  wall.report.n_components = result.report.n_components;
  wall.report.is_closed = result.report.half_axis.empty();
  wall.report.messages = std::move(result.report.messages);
  return wall;
}

}  // namespace

SurfaceValue wrap_surfaces(std::span<const UnionItem> items, const surfmesh::WrapOptions& options, const Reuse& reuse, const RunContext& context) {
  surfmesh::StitchOptions reading;
  reading.unit = options.unit;
  reading.fluid = options.fluid;
  reading.check_intersections = false;  // the wrap proves that it has none
  reading.allow_open = true;
  SurfaceValue wall;
  std::vector<SurfaceSoup> soups;
  std::map<std::string, PatchKind> kinds;
  surfmesh::WrapOptions used = options;
  const RunContext read_part = context.part("read", 0.0, k_wrap_read_end);
  for (const UnionItem& item : items) {
    if (const auto* file = std::get_if<InputPath>(&item)) {
      WallFiles read = read_wall_files(std::span(file, 1), reading, read_part);
      wall.inputs.insert(wall.inputs.end(), read.wall.inputs.begin(), read.wall.inputs.end());
      wall.layers.insert(wall.layers.end(), read.wall.layers.begin(), read.wall.layers.end());
      wall.changes.insert(wall.changes.end(), read.wall.changes.begin(), read.wall.changes.end());
      kinds.insert(read.kinds.begin(), read.kinds.end());
      used.fluid = read.wall.options.fluid;
      for (SurfaceSoup& soup : read.soups) soups.push_back(std::move(soup));
    } else {
      const SurfaceValue& surface = *std::get<SurfaceHandle>(item);
      wall.inputs.insert(wall.inputs.end(), surface.inputs.begin(), surface.inputs.end());
      wall.layers.insert(wall.layers.end(), surface.layers.begin(), surface.layers.end());
      wall.changes.insert(wall.changes.end(), surface.changes.begin(), surface.changes.end());
      for (const Patch& patch : surface.mesh.patches) kinds.insert({patch.name, patch.kind});
      soups.push_back(soup_of_surface(surface.mesh, options.unit));
    }
  }
  const StageTimer timer(context, k_wrap_stage);
  const auto make = [&] { return wrapped(soups, used, context.part(k_wrap_stage, k_wrap_read_end, 1.0)); };
  const auto write = [](ByteSink& sink, const WrappedWall& made) {
    write_value(sink, made.mesh);
    write_value(sink, made.report);
  };
  const auto read = [](ByteSource& source) {
    WrappedWall made;
    read_value(source, made.mesh);
    read_value(source, made.report);
    return made;
  };
  WrappedWall made = cached<WrappedWall>(reuse, k_wrap_stage, {}, reuse.cache ? std::optional(wrap_key(soups, used)) : std::nullopt, context, make, write,
                                         std::function<WrappedWall(ByteSource&)>(read));
  wall.mesh = std::move(made.mesh);
  wall.report = std::move(made.report);
  wall.options = reading;
  wall.options.fluid = used.fluid;
  wall.wrap_options = used;
  wall.changes.push_back(change_text("wrapped", wall.report.messages));
  for (Patch& patch : wall.mesh.patches)
    if (const auto kind = kinds.find(patch.name); kind != kinds.end()) patch.kind = kind->second;
  context.info(describe(wall) + " (wrapped)");
  return wall;
}

}  // namespace sterna::scripting
