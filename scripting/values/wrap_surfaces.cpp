#include "scripting/values/wrap_surfaces.h"

#include "geom/mesh/topology.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

/// Share of the progress; reading is bound by the disk.
constexpr double k_wrap_read_end = 0.1;
constexpr const char* k_wrap_stage = "wrap";

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
  const SurfaceItems read = read_items(items, reading, context.part("read", 0.0, k_wrap_read_end));
  surfmesh::WrapOptions used = options;
  used.fluid = read.wall.options.fluid;
  const StageTimer timer(context, k_wrap_stage);
  WrappedWall made = cached<WrappedWall>(
      reuse, k_wrap_stage, {}, reuse.cache ? std::optional(wrap_key(read.soups, used)) : std::nullopt, context,
      [&] { return wrapped(read.soups, used, context.part(k_wrap_stage, k_wrap_read_end, 1.0)); },
      [](ByteSink& sink, const WrappedWall& wall) {
        write_value(sink, wall.mesh);
        write_value(sink, wall.report);
      },
      std::function<WrappedWall(ByteSource&)>([](ByteSource& source) {
        WrappedWall wall;
        read_value(source, wall.mesh);
        read_value(source, wall.report);
        return wall;
      }));
  SurfaceValue wall = with_mesh(read, std::move(made.mesh), std::move(made.report));
  wall.smooth_angle.reset();  // of the triangles before
  wall.wrap_options = used;
  wall.changes.push_back(change_text("wrapped", wall.report.messages));
  context.info(describe(wall) + " (wrapped)");
  return wall;
}

}  // namespace sterna::scripting
