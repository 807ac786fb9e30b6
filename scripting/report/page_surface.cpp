#include "scripting/report/page_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "geom/base/error.h"
#include "geom/mesh/body_patches.h"
#include "scripting/report/thin_surface.h"

namespace sterna::scripting {

namespace {

Json page_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json page_point(const Point& p) { return Json::array({p.x, p.y, p.z}); }
Json location_json(const ArrayLocation& location) { return {{"type", location.type}, {"at", location.at}, {"n", location.n}}; }

/// Returns true for walls. Other boundaries are not part of the body, and the farthest of them does not indicate the body's size.
bool is_body(PatchKind kind) { return kind == PatchKind::wall; }

/// Patch numbers have 16 bits in a page.
constexpr std::size_t k_most_patches = std::size_t{1} << 16;

constexpr std::uint8_t k_all_edges = 7, k_first_two = 3, k_last_two = 6;

}  // namespace

PageTriangles page_triangles(const HybridMesh& mesh) {
  PageTriangles page;
  const auto add = [&](NodeId a, NodeId b, NodeId c, std::size_t face, std::uint8_t edges, PatchId patch) {
    page.triangles.push_back({a.value(), b.value(), c.value()});
    page.face.push_back(static_cast<std::uint32_t>(face));
    page.edges.push_back(edges);
    page.patch.push_back(static_cast<std::uint16_t>(patch.value()));
  };
  for (std::size_t i = 0; i < mesh.boundary_triangles.size(); ++i) {
    const BoundaryTriangle& t = mesh.boundary_triangles[i];
    add(t.nodes[0], t.nodes[1], t.nodes[2], i, k_all_edges, t.patch);
  }
  for (std::size_t i = 0; i < mesh.boundary_quads.size(); ++i) {
    const BoundaryQuad& q = mesh.boundary_quads[i];
    const std::size_t face = mesh.boundary_triangles.size() + i;
    add(q.nodes[0], q.nodes[1], q.nodes[2], face, k_first_two, q.patch);
    add(q.nodes[0], q.nodes[2], q.nodes[3], face, k_last_two, q.patch);
  }
  page.is_of_body = patches_of_bodies(mesh);
  return page;
}

PageTriangles page_triangles(const TriMesh& mesh) {
  PageTriangles page;
  for (const TriangleId t : mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.triangles[t];
    page.triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
    page.face.push_back(t.value());
    page.edges.push_back(k_all_edges);
    page.patch.push_back(static_cast<std::uint16_t>(mesh.triangle_patch[t].value()));
  }
  page.is_of_body = patches_of_bodies(boundary_of(mesh));
  return page;
}

Json page_field_json(std::string_view name, std::string_view title, std::string_view unit, bool is_log, bool is_low_bad, const GateLimits& limits,
                     const std::vector<float>& values, PageArrays& arrays) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float v : values)
    if (std::isfinite(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  return {{"name", name},
          {"title", title},
          {"unit", unit},
          {"values", location_json(arrays.add(std::span(values)))},
          {"min", page_number(low)},
          {"max", page_number(high)},
          {"is_log", is_log},
          {"low_is_bad", is_low_bad},
          {"limits", {{"hard", page_number(limits.hard)}, {"target", page_number(limits.target)}, {"usual", page_number(limits.usual)}}}};
}

PageMaker::PageMaker(std::span<const Point> points, const PageTriangles& triangles, const Column<PatchId, Patch>& patches,
                     const std::vector<SurfaceField>& fields)
    : points_(points), triangles_(triangles), patches_(patches), fields_(fields) {
  if (patches.size() > k_most_patches)
    throw Error({.code = ErrorCode::overflow,
                 .attempted = "making a report page",
                 .problem = std::to_string(patches.size()) + " patches; a page can distinguish " + std::to_string(k_most_patches) + " patches",
                 .hint = "merge patches by their names"});
  const auto is_of_body = [&](std::size_t patch) { return triangles.is_of_body.empty() || triangles.is_of_body[patch] != 0; };
  Box bodies, all;
  for (std::size_t t = 0; t < triangles.triangles.size(); ++t)
    for (const std::uint32_t corner : triangles.triangles[t]) {
      all.add(points[corner]);
      if (is_body(patches[PatchId(triangles.patch[t])].kind) && is_of_body(triangles.patch[t])) bodies.add(points[corner]);
    }
  const Box& box = bodies.empty() ? all : bodies;
  if (box.empty()) return;
  origin_ = box.center();
  length_ = box.longest_side();
}

Json PageMaker::frame_json() const { return {{"length", length_}, {"origin", page_point(origin_)}}; }

Json PageMaker::patches_json() const {
  std::vector<double> areas(patches_.size(), 0.0);
  std::vector<std::int64_t> counts(patches_.size(), 0);
  for (std::size_t t = 0; t < triangles_.triangles.size(); ++t) {
    const auto& c = triangles_.triangles[t];
    areas[triangles_.patch[t]] += 0.5 * norm(cross(points_[c[1]] - points_[c[0]], points_[c[2]] - points_[c[0]]));
    ++counts[triangles_.patch[t]];
  }
  Json list = Json::array();
  for (const PatchId p : patches_.ids())
    list.push_back({{"name", patches_[p].name},
                    {"kind", to_string(patches_[p].kind)},
                    {"area", areas[p.index()]},
                    {"triangles", counts[p.index()]},
                    {"is_of_body", triangles_.is_of_body.empty() || triangles_.is_of_body[p.index()] != 0}});
  return list;
}

Json PageMaker::surface_json(std::size_t most, PageArrays& arrays) const {
  const ThinSurface thin = thin_surface(points_, triangles_.triangles, most);
  const bool is_thinned = thin.triangles.size() < triangles_.triangles.size();
  std::vector<std::uint32_t> number(points_.size(), k_none);
  std::vector<float> points;
  std::vector<std::uint32_t> corners;
  std::vector<std::uint16_t> patch;
  std::vector<std::uint8_t> edges;
  for (std::size_t t = 0; t < thin.triangles.size(); ++t) {
    for (const std::uint32_t i : thin.triangles[t]) {
      if (number[i] == k_none) {
        number[i] = static_cast<std::uint32_t>(points.size() / 3);
        const Vec3 p = points_[i] - origin_;
        points.insert(points.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      }
      corners.push_back(number[i]);
    }
    patch.push_back(triangles_.patch[thin.source[t]]);
    edges.push_back(is_thinned ? k_all_edges : triangles_.edges[thin.source[t]]);
  }
  Json json = {{"shown", thin.triangles.size()}, {"total", triangles_.triangles.size()}};
  json["points"] = location_json(arrays.add(std::span<const float>(points)));
  json["triangles"] = location_json(arrays.add(std::span<const std::uint32_t>(corners)));
  json["patch"] = location_json(arrays.add(std::span<const std::uint16_t>(patch)));
  json["edges"] = location_json(arrays.add(std::span<const std::uint8_t>(edges)));
  json["fields"] = Json::array();
  for (const SurfaceField& field : fields_) {
    if (std::none_of(field.values.begin(), field.values.end(), [](double v) { return std::isfinite(v); })) continue;
    std::vector<float> values;
    for (const std::uint32_t t : thin.source) values.push_back(shortened(field.values[triangles_.face[t]]));
    const SurfaceFieldInfo& info = field.info;
    json["fields"].push_back(page_field_json(info.name, info.title, info.unit, info.is_log, info.is_low_bad, info.limits, values, arrays));
  }
  return json;
}

/// Returns the polygons nearest to the focus.
Json page_cut_json(const CutLocation& location, const MeshCut& cut, std::size_t most, PageArrays& arrays) {
  std::vector<std::uint32_t> chosen(cut.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  if (cut.size() > most) {
    std::vector<double> off(cut.size());
    for (std::size_t k = 0; k < cut.size(); ++k) off[k] = distance(cut.corners_of(k).front(), location.focus);
    std::sort(chosen.begin(), chosen.end(), [&](std::uint32_t a, std::uint32_t b) { return std::pair(off[a], a) < std::pair(off[b], b); });
    chosen.resize(most);
    std::sort(chosen.begin(), chosen.end());
  }
  const Point origin = location.focus;
  std::vector<float> points, shape, quality, layer, volume;
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint8_t> kind;
  for (const std::uint32_t k : chosen) {
    for (const Point& corner : cut.corners_of(k)) {
      const Vec3 p = corner - origin;
      points.insert(points.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    first.push_back(static_cast<std::uint32_t>(points.size() / 3));
    const CutPolygon& polygon = cut.polygons[k];
    kind.push_back(static_cast<std::uint8_t>(polygon.kind));
    shape.push_back(shortened(polygon.shape));
    quality.push_back(shortened(polygon.kind == CellKind::tetrahedron ? polygon.quality : std::nan("")));
    layer.push_back(polygon.layer >= 0 ? static_cast<float>(polygon.layer + 1) : std::nanf(""));
    volume.push_back(shortened(polygon.volume));
  }
  Json json = {{"name", location.name},
               {"origin", page_point(location.plane.origin)},
               {"base", page_point(origin)},
               {"normal", page_point(location.plane.normal)},
               {"focus", {{"center", page_point(location.focus)}, {"radius", location.radius}}}};
  json["shown"] = chosen.size();
  json["total"] = cut.size();
  json["points"] = location_json(arrays.add(std::span<const float>(points)));
  json["first"] = location_json(arrays.add(std::span<const std::uint32_t>(first)));
  json["kind"] = location_json(arrays.add(std::span<const std::uint8_t>(kind)));
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  constexpr GateLimits k_no_limits{k_nan, k_nan, k_nan, 1.0};
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  GateLimits dihedral = info_of(Measure::min_dihedral).limits;
  for (double* limit : {&dihedral.hard, &dihedral.target, &dihedral.usual}) *limit *= k_degrees;
  json["fields"] = {page_field_json("shape", "shape of the cell (1 = ideal)", "", false, true, k_no_limits, shape, arrays),
                    page_field_json("min_dihedral", "smallest dihedral angle of the tetrahedron", "deg", false, true, dihedral, quality, arrays),
                    page_field_json("layer", "number of the layer, from the wall", "", false, false, k_no_limits, layer, arrays),
                    page_field_json("volume", "volume", "m^3", true, false, k_no_limits, volume, arrays)};
  return json;
}

}  // namespace sterna::scripting
