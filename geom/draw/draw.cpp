// Main function: converts options to a scene, draws the scene as a picture, and adds title, legend and axes.
#include "geom/draw/draw.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/number_text.h"
#include "geom/draw/canvas.h"
#include "geom/draw/figures.h"
#include "geom/draw/legend.h"
#include "geom/draw/scene.h"
#include "geom/mesh/body_patches.h"

namespace sterna {
namespace {

using namespace draw;

/// Fraction of the picture that is left free around its contents.
constexpr double k_margin = 0.04;
/// Distance of the eye in a perspective view, in radii. The picture then extends 17 degrees to each side.
constexpr double k_eye = 3.4;
constexpr Rgb k_paper{255, 255, 255};

Camera camera_of(const Scene& scene, const Layout& layout, bool is_perspective) {
  Camera camera = camera_towards(scene.toward);
  Box box;
  for (const Point& p : scene.polygons.corners) box.add(p);
  camera.target = scene.focus ? scene.focus->center : box.center();
  double radius = scene.focus ? scene.focus->radius : 0.5 * distance(box.min, box.max);
  if (!(radius > 0.0)) radius = 1.0;
  if (is_perspective) camera.distance = k_eye * radius;
  const double room_x = (1.0 - 2.0 * k_margin) * (layout.width - layout.panel), room_y = (1.0 - 2.0 * k_margin) * (layout.height - layout.head);
  if (scene.focus) {
    camera.scale = 0.5 * std::min(room_x, room_y) / radius;
    camera.x = layout.middle_x();
    camera.y = layout.middle_y();
    return camera;
  }
  constexpr double k_far = std::numeric_limits<double>::infinity();
  double x0 = k_far, x1 = -k_far, y0 = k_far, y1 = -k_far;
  for (const Point& p : scene.polygons.corners) {
    const Projected at = camera.project(p);
    x0 = std::min(x0, at.x);
    x1 = std::max(x1, at.x);
    y0 = std::min(y0, at.y);
    y1 = std::max(y1, at.y);
  }
  const double wide = std::max(x1 - x0, 1e-9 * radius), high = std::max(y1 - y0, 1e-9 * radius);
  camera.scale = std::min(room_x / wide, room_y / high);
  camera.x = layout.middle_x() - 0.5 * camera.scale * (x0 + x1);
  camera.y = layout.middle_y() - 0.5 * camera.scale * (y0 + y1);
  return camera;
}

std::string title_of(const DrawOptions& options, std::string_view name, const Scene& scene) {
  if (options.title == "none") return "";
  if (options.title != "automatic") return options.title;
  return name.empty() ? scene.caption : std::string(name) + ": " + scene.caption;
}

std::string draw_mesh(const HybridMesh& mesh, bool is_surface, const DrawOptions& options, std::string_view name, std::span<const DrawMark> given_marks,
                      const RunContext& context) {
  require_draw_options(options);
  const Scene scene = build_scene(mesh, is_surface, options, context);
  const std::string title = title_of(options, name, scene);
  const std::span<const DrawMark> marks = options.places ? given_marks : std::span<const DrawMark>{};
  Layout layout = layout_of(options, scene, !title.empty(), marks);
  Camera camera = camera_of(scene, layout, options.projection == "perspective");
  const RasterOptions raster{options.width, options.height, options.edges, std::max(1.0, 0.05 * layout.text), k_paper};
  Image picture = rasterise(scene.polygons, camera, raster, context);
  if (layout.inset > 0.0 && !place_inset(layout, scene, picture, k_paper)) {  // no corner is empty
    move_inset_to_panel(layout);
    camera = camera_of(scene, layout, options.projection == "perspective");
    picture = rasterise(scene.polygons, camera, raster, context);
  }
  Canvas canvas(picture);
  draw_lines(canvas, layout, camera, scene);
  draw_marks(canvas, layout, camera, marks);
  if (!title.empty()) {
    canvas.rectangle(0.0, 0.0, layout.width, layout.head, k_paper);
    draw_title(canvas, layout, title);
  }
  if (options.legend) {
    draw_legend(canvas, layout, scene, marks);
    draw_axes(canvas, layout, camera);
  }
  return canvas.png();
}

}  // namespace

void require_draw_options(const DrawOptions& options) {
  view_of(options.view);
  if (options.cut != "none") plane_of(options.cut);
  sphere_of(options.focus);
  coloring_of(options.color, options.cut != "none");
}

std::vector<DrawMark> marks_of(const CheckReport& report) {
  std::vector<DrawMark> marks;
  for (std::size_t i = 0; i < report.findings.size(); ++i) {
    const CheckFinding& finding = report.findings[i];
    const bool is_first = std::none_of(report.findings.begin(), report.findings.begin() + static_cast<std::ptrdiff_t>(i),
                                       [&](const CheckFinding& f) { return f.violation == finding.violation; });
    if (is_first)
      marks.push_back({finding.position, std::string(gate_of(finding.violation)) + " " + std::string(to_string(finding.violation)) + ": " + finding.what});
  }
  for (const GateState state : {GateState::fail, GateState::warn})
    for (const GateResult& gate : report.gates) {
      if (gate.state != state || gate.locations.empty()) continue;
      const MeasureInfo& info = info_of(gate.measure);
      marks.push_back({gate.locations.front().position, std::string(info.gate) + " " + std::string(info.title) + " " +
                                                            number_text(in_report_unit(info, gate.locations.front().value), 3) +
                                                            (info.is_angle ? " deg" : "")});
    }
  return marks;
}

std::string draw_png(const HybridMesh& mesh, const DrawOptions& options, std::string_view name, std::span<const DrawMark> marks, const RunContext& context) {
  return draw_mesh(mesh, false, options, name, marks, context);
}

std::string draw_png(const TriMesh& surface, const DrawOptions& options, std::string_view name, std::span<const DrawMark> marks, const RunContext& context) {
  return draw_mesh(boundary_of(surface), true, options, name, marks, context);
}

}  // namespace sterna
