#include "geom/base/error.h"
#include "io/grammar/fluent_parser.h"
#include "io/mesh/orientation.h"
#include "io/mesh/surface_builder.h"
#include "io/volume/fluent.h"

namespace sterna::io {

HybridMesh read_volume_fluent(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  FluentContent content = parse_fluent(buffer, context);
  context.progress(0.5);
  HybridMesh mesh;
  if (content.n_cell_zones > 1)
    context.warn(buffer.source + ": the " + std::to_string(content.n_cell_zones) + " cell zones become one zone; faces between them become interior faces");
  mesh.points.raw() = std::move(content.points);
  mesh.patches = std::move(content.patches);
  add_cells_and_boundary(content.faces, mesh, buffer.source, context);
  if (content.n_inner_walls > 0) context.warn("faces of boundary zones between two cells, read as interior faces: " + std::to_string(content.n_inner_walls));
  context.progress(0.8);
  orient_mesh(mesh, context);
  return mesh;
}

SurfaceSoup read_surface_fluent(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const FluentContent content = parse_fluent(buffer, context);
  const auto is_wall = [&](PatchId patch) { return content.patches[patch].kind == PatchKind::wall || content.patches[patch].kind == PatchKind::slip; };
  bool has_walls = false;
  for (const PatchId patch : content.patches.ids()) has_walls = has_walls || is_wall(patch);
  std::string left_out;
  for (const PatchId patch : content.patches.ids())
    if (has_walls && !is_wall(patch)) left_out += (left_out.empty() ? "\"" : ", \"") + content.patches[patch].name + "\"";
  if (!left_out.empty()) context.info(buffer.source + ": zones that are not walls are left out: " + left_out);
  SurfaceBuilder builder(buffer.source);
  builder.reserve_points(content.points.size());
  for (const Vec3& p : content.points) builder.add_point(p);
  std::vector<std::uint32_t> corners;
  for (std::size_t f = 0; f < content.faces.n_faces(); ++f) {
    const PatchId patch = content.faces.patch[f];
    if (!patch.is_valid() || (has_walls && !is_wall(patch))) continue;
    corners.assign(content.faces.nodes.rbegin() + static_cast<std::ptrdiff_t>(content.faces.nodes.size() - content.faces.first[f + 1]),
                   content.faces.nodes.rbegin() + static_cast<std::ptrdiff_t>(content.faces.nodes.size() - content.faces.first[f]));
    builder.set_patch(content.patches[patch].name);
    builder.add_polygon(corners);
  }
  SurfaceSoup soup = builder.finish(context, true);
  soup.has_names = true;
  soup.n_cells = content.faces.n_cells;
  return soup;
}

}  // namespace sterna::io
