#include "scripting/values/filled_crevices.h"

#include <fmt/format.h>

#include "scripting/values/geometry_changes.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {
namespace {

constexpr std::size_t k_crevices_in_log = 10;

}  // namespace

SurfaceValue filled_crevices(const SurfaceValue& wall, const volmesh::CreviceOptions& options, const RunContext& context) {
  volmesh::CreviceResult result = volmesh::fill_crevices(wall.mesh, options, context);
  const volmesh::CreviceReport& report = result.report;
  if (report.n_left > 0)
    context.warn(
        fmt::format("fill_crevices: {} of gaps {} open, the first at ({:.6g}, {:.6g}, {:.6g}): the wall would become non-manifold, "
                    "would enclose fluid, or would move by more than half of the width. Remesh the walls there with edges of similar length, "
                    "or use another width",
                    count_text(report.n_left) + (report.n_left == 1 ? " tetrahedron" : " tetrahedra"), report.n_left == 1 ? "stays" : "stay",
                    report.left.front().x, report.left.front().y, report.left.front().z));
  if (report.crevices.empty()) {
    context.warn(fmt::format("fill_crevices: no crevice up to {:.3g} m wide {}; the surface is unchanged", options.width,
                             report.n_left > 0 ? "could be filled" : "was found"));
    return wall;
  }
  SurfaceValue made = wall;
  replace_mesh(made, std::move(result.wall));
  const std::string text =
      fmt::format("crevices filled: {} up to {:.3g} m wide, {:.3g} m^3 in total; new triangles are at most {:.3g} m from the given wall; {} -> {} triangles",
                  report.crevices.size(), options.width, report.volume, report.distance, count_text(report.n_triangles_before), count_text(report.n_triangles));
  made.history.push_back({.changes = {text}});
  made.report.messages.push_back(text);
  context.info(text);
  for (const std::string& line : volmesh::to_lines(report, k_crevices_in_log)) {
    made.report.messages.push_back("crevice filled at " + line);
    context.info("crevice filled at " + line);
  }
  if (report.crevices.size() > k_crevices_in_log) context.info(fmt::format("smaller crevices filled: {} more", report.crevices.size() - k_crevices_in_log));
  note_change(made, compare_geometry(wall.mesh, made.mesh, "fill_crevices", context), context);
  return made;
}

}  // namespace sterna::scripting
