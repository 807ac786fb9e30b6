#include "scripting/values/filled_crevices.h"

#include <fmt/format.h>

#include "scripting/values/geometry_changes.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {
namespace {

constexpr std::size_t k_crevices_in_log = 10;

/// Replaces the mesh, and drops the data that belong to its former triangles.
void replace_mesh(SurfaceValue& surface, TriMesh mesh) {
  surface.mesh = std::move(mesh);
  surface.mesh_report.reset();
  surface.model_wall.reset();
  surface.model_wall_key.reset();
  surface.parts.clear();
}

}  // namespace

SurfaceValue filled_crevices(const SurfaceValue& wall, const volmesh::CreviceOptions& options, const RunContext& context) {
  volmesh::CreviceResult result = volmesh::fill_crevices(wall.mesh, options, context);
  const volmesh::CreviceReport& report = result.report;
  if (report.n_left > 0)
    context.warn(
        fmt::format("fill_crevices: {} thin tetrahedra between walls stay fluid, the first at ({:.6g}, {:.6g}, {:.6g}): filling them would make the "
                    "wall non-manifold or would enclose fluid; try another width",
                    report.n_left, report.left.front().x, report.left.front().y, report.left.front().z));
  if (report.crevices.empty()) {
    context.warn(fmt::format("fill_crevices: no crevice is narrower than {:.3g} m; the surface is unchanged", options.width));
    return wall;
  }
  SurfaceValue made = wall;
  replace_mesh(made, std::move(result.wall));
  const std::string text =
      fmt::format("crevices filled: {} up to {:.3g} m wide, {:.3g} m^3 in total; new triangles are at most {:.3g} m from the given wall; {} -> {} triangles",
                  report.crevices.size(), options.width, report.volume, report.distance, count_text(report.n_triangles_before), count_text(report.n_triangles));
  made.changes.push_back(text);
  made.report.messages.push_back(text);
  context.info(text);
  for (const std::string& line : volmesh::to_lines(report, k_crevices_in_log)) {
    made.report.messages.push_back("crevice filled at " + line);
    context.info("crevice filled at " + line);
  }
  if (report.crevices.size() > k_crevices_in_log) context.info(fmt::format("{} smaller crevices more", report.crevices.size() - k_crevices_in_log));
  note_change(made, compare_geometry(wall.mesh, made.mesh, "fill_crevices", context), context);
  return made;
}

}  // namespace sterna::scripting
