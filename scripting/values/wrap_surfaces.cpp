#include "scripting/values/wrap_surfaces.h"

#include <nlohmann/json.hpp>

#include "scripting/cache/stage_cache.h"
#include "scripting/values/geometry_changes.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/value_keys.h"
#include "surfmesh/stitch/as_read.h"

namespace sterna::scripting {
namespace {

/// Progress after reading, which is bound by the disk.
constexpr double k_wrap_read_end = 0.1;
constexpr const char* k_wrap_stage = "wrap";

/// Returns the key of all inputs of the wrap's mesh and report.
ContentKey wrap_key(const std::vector<SurfaceSoup>& soups, surfmesh::WrapOptions options) {
  KeyMaker maker(k_wrap_stage);
  for (const SurfaceSoup& soup : soups) maker.add(soup.points).add(soup.triangles).add(soup.patch).add(soup.patch_names).add(soup.source).add(soup.has_names);
  return maker.add(sterna::options_of(options)).key();
}

struct WrappedWall {
  TriMesh mesh;
  surfmesh::StitchReport report;
};

WrappedWall wrapped(const std::vector<SurfaceSoup>& soups, const surfmesh::WrapOptions& options, const RunContext& context,
                    const std::function<void(const surfmesh::WrapReport&)>& look) {
  surfmesh::WrapResult result = surfmesh::wrap_surface(soups, options, context);
  if (look) look(result.report);
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

SurfaceValue wrap_surfaces(std::span<const UnionItem> items, const surfmesh::WrapOptions& options, const Reuse& reuse, const RunContext& context,
                           const std::function<void(const surfmesh::WrapReport&)>& look) {
  surfmesh::StitchOptions reading;
  reading.unit = options.unit;
  reading.fluid = options.fluid;
  reading.check_intersections = false;  // the wrap proves that its result has none
  reading.allow_open = true;
  const SurfaceItems read = read_items(items, reading, context.part("read", 0.0, k_wrap_read_end));
  surfmesh::WrapOptions used = options;
  used.fluid = read.wall.options.fluid;
  const StageTimer timer(context, k_wrap_stage);
  WrappedWall made = cached<WrappedWall>(reuse, k_wrap_stage, {}, reuse.cache && !look ? std::optional(wrap_key(read.soups, used)) : std::nullopt, context,
                                         [&] { return wrapped(read.soups, used, context.part(k_wrap_stage, k_wrap_read_end, 1.0), look); });
  SurfaceValue wall = with_mesh(read, std::move(made.mesh), std::move(made.report));
  wall.smooth_angle.reset();  // the angle belongs to the former triangles
  wall.history.push_back({.options = used, .changes = {change_text("wrapped", wall.report.messages)}});
  note_change(wall, compare_geometry(surfmesh::mesh_as_read(read.soups, read.wall.options), wall.mesh, "wrap", context), context);
  context.info(describe(wall) + " (wrapped)");
  return wall;
}

TroubleGeometry closed_facets(const surfmesh::WrapReport& report) { return {report.drawing.points, report.drawing.triangles, {}, {}}; }

std::string wrap_json(const surfmesh::WrapReport& report) {
  const auto at = [](const Vec3& p) { return nlohmann::ordered_json{p.x, p.y, p.z}; };
  nlohmann::ordered_json json = {{"schema", "sterna-wrap-1"}, {"messages", report.messages}};
  json["sizes"] = {{"edge", report.edge}, {"gap", report.gap}, {"tolerance", report.tolerance}, {"offset", report.offset}};
  json["distance"] = {{"to_input", report.to_input},
                      {"to_input_closed", report.to_input_closed},
                      {"from_input", report.from_input},
                      {"beyond_tolerance", report.n_beyond_tolerance}};
  json["inside"] = {{"facets", report.n_inside}, {"area", report.inside_area}};
  if (!report.half_axis.empty()) json["half"] = {{"axis", report.half_axis}, {"at", report.half_at}, {"moved", report.half_moved}};
  json["n_closures"] = report.n_closures;
  json["closures"] = nlohmann::ordered_json::array();
  for (const surfmesh::WrapClosure& c : report.closures)
    json["closures"].push_back(
        {{"kind", c.is_opening ? "opening" : "groove"}, {"at", at(c.position)}, {"size", c.size}, {"area", c.area}, {"distance", c.distance}});
  json["leaks"] = nlohmann::ordered_json::array();
  for (const surfmesh::WrapLeak& leak : report.leaks) json["leaks"].push_back({{"at", at(leak.position)}, {"area", leak.area}});
  return json.dump(2) + "\n";
}

}  // namespace sterna::scripting
