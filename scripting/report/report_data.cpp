#include "scripting/report/report_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/draw/choices.h"
#include "geom/mesh/cut_places.h"
#include "geom/mesh/surface_fields.h"
#include "scripting/report/page_arrays.h"
#include "scripting/report/report_gates.h"
#include "scripting/report/report_page.h"
#include "scripting/report/thin_surface.h"
#include "scripting/values/manifest.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {
using Json = nlohmann::ordered_json;

/// For nlohmann's conversions.
static void to_json(Json& json, const ArrayPlace& place) { json = {{"type", place.type}, {"at", place.at}, {"n", place.n}}; }

namespace {

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// The page is made anew with so much of the budget where it came out too large.
constexpr double k_less = 0.6;
/// Kinds of boundaries that carry no part of the body: the farthest of them says nothing about its size.
bool is_body(PatchKind kind) { return kind == PatchKind::wall; }

Json json_of(const Point& p) { return Json::array({p.x, p.y, p.z}); }
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Patches are numbered by 16 bits in a page.
constexpr std::size_t k_most_patches = std::size_t{1} << 16;

/// Boundary faces as triangles, with the face and the edges that each has of it.
struct PageTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face;  ///< triangles, then quads
  std::vector<std::uint8_t> edges;  ///< bit k: corner k to k + 1
  std::vector<std::uint16_t> patch;
};

constexpr std::uint8_t k_all_edges = 7, k_first_two = 3, k_last_two = 6;

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
  return page;
}

Json field_json(std::string_view name, std::string_view title, std::string_view unit, bool is_log, bool is_low_bad, const GateLimits& limits,
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
          {"values", arrays.add(std::span(values))},
          {"min", number(low)},
          {"max", number(high)},
          {"is_log", is_log},
          {"low_is_bad", is_low_bad},
          {"limits", {{"hard", number(limits.hard)}, {"target", number(limits.target)}, {"usual", number(limits.usual)}}}};
}

/// What pages are made of, whatever they are about.
class PageMaker {
 public:
  PageMaker(std::span<const Point> points, const PageTriangles& triangles, const Column<PatchId, Patch>& patches, const std::vector<SurfaceField>& fields)
      : points_(points), triangles_(triangles), patches_(patches), fields_(fields) {
    if (patches.size() > k_most_patches)
      throw Error({.code = ErrorCode::overflow,
                   .attempted = "making a report page",
                   .problem = std::to_string(patches.size()) + " patches; a page tells " + std::to_string(k_most_patches) + " apart",
                   .hint = "merge patches by their names"});
    Box bodies, all;
    for (std::size_t t = 0; t < triangles.triangles.size(); ++t)
      for (const std::uint32_t corner : triangles.triangles[t]) {
        all.add(points[corner]);
        if (is_body(patches[PatchId(triangles.patch[t])].kind)) bodies.add(points[corner]);
      }
    const Box& box = bodies.empty() ? all : bodies;
    if (box.empty()) return;
    origin_ = box.center();
    length_ = box.longest_side();
  }

  const Point& origin() const { return origin_; }
  double length() const { return length_; }
  Json frame() const { return {{"length", length_}, {"origin", json_of(origin_)}}; }

  Json patches_json() const {
    std::vector<double> areas(patches_.size(), 0.0);
    std::vector<std::int64_t> counts(patches_.size(), 0);
    for (std::size_t t = 0; t < triangles_.triangles.size(); ++t) {
      const auto& c = triangles_.triangles[t];
      areas[triangles_.patch[t]] += 0.5 * norm(cross(points_[c[1]] - points_[c[0]], points_[c[2]] - points_[c[0]]));
      ++counts[triangles_.patch[t]];
    }
    Json list = Json::array();
    for (const PatchId p : patches_.ids())
      list.push_back({{"name", patches_[p].name}, {"kind", to_string(patches_[p].kind)}, {"area", areas[p.index()]}, {"triangles", counts[p.index()]}});
    return list;
  }

  Json surface_json(std::size_t most, PageArrays& arrays) const {
    const ThinSurface thin = thin_surface(points_, triangles_.triangles, most);
    const bool is_thinned = thin.triangles.size() < triangles_.triangles.size();
    std::vector<std::uint32_t> number(points_.size(), std::numeric_limits<std::uint32_t>::max());
    std::vector<float> points;
    std::vector<std::uint32_t> corners;
    std::vector<std::uint16_t> patch;
    std::vector<std::uint8_t> edges;
    for (std::size_t t = 0; t < thin.triangles.size(); ++t) {
      for (const std::uint32_t i : thin.triangles[t]) {
        if (number[i] == std::numeric_limits<std::uint32_t>::max()) {
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
    json["points"] = arrays.add(std::span<const float>(points));
    json["triangles"] = arrays.add(std::span<const std::uint32_t>(corners));
    json["patch"] = arrays.add(std::span<const std::uint16_t>(patch));
    json["edges"] = arrays.add(std::span<const std::uint8_t>(edges));
    json["fields"] = Json::array();
    for (const SurfaceField& field : fields_) {
      if (std::none_of(field.values.begin(), field.values.end(), [](double v) { return std::isfinite(v); })) continue;
      std::vector<float> values;
      for (const std::uint32_t t : thin.source) values.push_back(shortened(field.values[triangles_.face[t]]));
      const SurfaceFieldInfo& info = field.info;
      json["fields"].push_back(field_json(info.name, info.title, info.unit, info.is_log, info.is_low_bad, info.limits, values, arrays));
    }
    return json;
  }

 private:
  std::span<const Point> points_;
  const PageTriangles& triangles_;
  const Column<PatchId, Patch>& patches_;
  const std::vector<SurfaceField>& fields_;
  Point origin_{};
  double length_ = 1.0;
};

/// The polygons next to the focus.
Json cut_json(const CutPlace& place, const MeshCut& cut, std::size_t most, PageArrays& arrays) {
  std::vector<std::uint32_t> chosen(cut.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  if (cut.size() > most) {
    std::vector<double> off(cut.size());
    for (std::size_t k = 0; k < cut.size(); ++k) off[k] = distance(cut.corners_of(k).front(), place.focus);
    std::sort(chosen.begin(), chosen.end(), [&](std::uint32_t a, std::uint32_t b) { return std::pair(off[a], a) < std::pair(off[b], b); });
    chosen.resize(most);
    std::sort(chosen.begin(), chosen.end());
  }
  const Point origin = place.focus;
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
  Json json = {{"name", place.name},
               {"origin", json_of(place.plane.origin)},
               {"base", json_of(origin)},
               {"normal", json_of(place.plane.normal)},
               {"focus", {{"center", json_of(place.focus)}, {"radius", place.radius}}}};
  json["shown"] = chosen.size();
  json["total"] = cut.size();
  json["points"] = arrays.add(std::span<const float>(points));
  json["first"] = arrays.add(std::span<const std::uint32_t>(first));
  json["kind"] = arrays.add(std::span<const std::uint8_t>(kind));
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  constexpr GateLimits k_no_limits{k_none, k_none, k_none, 1.0};
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  GateLimits dihedral = info_of(Measure::min_dihedral).limits;
  for (double* limit : {&dihedral.hard, &dihedral.target, &dihedral.usual}) *limit *= k_degrees;
  json["fields"] = {field_json("shape", "shape of the cell (1 = ideal)", "", false, true, k_no_limits, shape, arrays),
                    field_json("min_dihedral", "smallest dihedral of the tet", "deg", false, true, dihedral, quality, arrays),
                    field_json("layer", "layer from the wall", "", false, false, k_no_limits, layer, arrays),
                    field_json("volume", "volume", "m^3", true, false, k_no_limits, volume, arrays)};
  return json;
}

Json inputs_json(const std::vector<InputFile>& inputs) {
  Json list = Json::array();
  for (const InputFile& input : inputs) list.push_back({{"file", input.name}, {"xxh3_128", input.hash}});
  return list;
}

/// Names of options that differ from their defaults, by stage.
Json options_set_json(const MeshOrigin& origin) {
  surfmesh::StitchOptions surface = origin.surface_options;
  volmesh::MeshCase volume = origin.options;
  Json json = Json::object();
  for (const Option& option : all_options(surface, volume))
    if (!is_default(option)) json[std::string(option.stage)].push_back(option.name);
  return json;
}

Json run_json(const RunContext& context) {
  Json run = {{"stages", Json::array()}};
  double seconds = 0.0;
  for (const StageTime& stage : context.times()) {
    const auto depth = std::count(stage.stage.begin(), stage.stage.end(), '/');
    if (depth == 0) seconds += stage.seconds;
    run["stages"].push_back({{"name", stage.stage}, {"seconds", stage.seconds}, {"busy", stage.busy_share(context.threads())}, {"depth", depth}});
  }
  run["seconds"] = seconds;
  run["peak_memory"] = peak_memory_bytes();
  run["threads"] = context.threads();
  return run;
}

Json facts_json(const MeshValue& value) {
  const HybridMesh& mesh = value.mesh;
  const CellCounts cells = count_cells(mesh);
  Json facts = Json::array();
  facts.push_back({"nodes", count_text(static_cast<std::int64_t>(mesh.points.size()))});
  for (const auto& [name, n] : {std::pair("prisms", cells.prisms), std::pair("pyramids", cells.pyramids), std::pair("hexahedra", cells.hexahedra),
                                std::pair("tetrahedra", cells.tetrahedra)})
    if (n > 0) facts.push_back({name, count_text(n)});
  facts.push_back({"boundary", count_text(static_cast<std::int64_t>(mesh.boundary_triangles.size())) + " triangles, " +
                                   count_text(static_cast<std::int64_t>(mesh.boundary_quads.size())) + " quads"});
  if (mesh.layers.n_columns() > 0) facts.push_back({"layers", std::string(mesh.layers.is_uniform() ? "" : "up to ") + std::to_string(mesh.layers.n_layers)});
  if (mesh.request.is_known()) facts.push_back({"first height", in_metres(mesh.request.first_height)});
  if (value.origin) {
    facts.push_back({"mean height of the layer", in_metres(value.origin->layer.mean_height, 4)});
    facts.push_back({"full height", number_text(100.0 * value.origin->layer.coverage, 4) + " % of the area; the geometry permits " +
                                        number_text(100.0 * value.origin->layer.attainable, 4) + " %"});
    facts.push_back({"tetrahedra by", value.origin->tetra_engine});
  }
  return facts;
}

std::string title_of(const ReportOptions& options, std::string_view name) { return options.title == "automatic" ? std::string(name) : options.title; }

/// The user's cuts, then the automatic ones that they do not name. A plane of the user's is looked at where it comes next to the middle of the bodies.
std::vector<CutPlace> places_of(const HybridMesh& mesh, const std::vector<std::string>& wanted, bool with_automatic, const PageMaker& maker,
                                const RunContext& context) {
  constexpr double k_radius_share = 0.6;  // of the bodies' length: all of them is seen
  std::vector<CutPlace> automatic = automatic_cuts(mesh, context), places;
  for (const std::string& text : wanted) {
    if (const std::optional<CutPlane> plane = draw::plane_of(text)) {
      const Vec3 normal = normalized(plane->normal);
      places.push_back({text, *plane, maker.origin() - dot(maker.origin() - plane->origin, normal) * normal, k_radius_share * maker.length()});
    } else {
      places.push_back(draw::place_of(automatic, text, "report", "cut"));
    }
  }
  if (!with_automatic) return places;
  for (CutPlace& place : automatic)
    if (std::none_of(places.begin(), places.end(), [&](const CutPlace& known) { return known.name == place.name; })) places.push_back(std::move(place));
  return places;
}

/// \pre the places begin with those that were asked for. \throws Error(bad_argument) for one of them whose plane is clear of the mesh.
void require_cells(const HybridMesh& mesh, std::span<const std::string> wanted, const std::vector<CutPlace>& places, const std::vector<MeshCut>& cuts) {
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (cuts[i].size() == 0)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "report: cut \"" + wanted[i] + "\"",
                   .problem = clear_plane_text(mesh, places[i].plane),
                   .hint = "choose a plane between these limits"});
}

std::string too_large(std::size_t bytes) { return "the page would have " + std::to_string(bytes) + " bytes, more than " + std::to_string(k_most_page_bytes); }

/// Makes the page with less and less until it is small enough.
template <class Make>
std::string small_page(const ReportOptions& options, const RunContext& context, const Make& make) {
  double share = 1.0;
  constexpr double k_least = 0.01;
  for (;; share *= k_less) {
    const auto most = [&](int n) { return std::max<std::size_t>(1, static_cast<std::size_t>(share * n)); };
    std::string page = make(most(options.max_triangles), most(options.max_polygons));
    if (page.size() <= k_most_page_bytes) return page;
    if (share < k_least)
      throw Error({.code = ErrorCode::overflow, .attempted = "making a report page", .problem = too_large(page.size()), .hint = "name fewer cuts"});
    context.debug(too_large(page.size()) + ": it is thinned");
  }
}

}  // namespace

void require_report_cuts(const std::vector<std::string>& cuts) {
  if (report_page().empty()) page_text("", {});
  for (const std::string& cut : cuts) draw::plane_of(cut);
}

std::string report_html(const MeshValue& mesh, const ReportOptions& options, const std::vector<std::string>& cuts_wanted, std::string_view name,
                        const RunContext& context) {
  if (!mesh.check || !mesh.check->quality_measured) mesh.check = check(mesh.mesh, {}, context.part("check", 0.0, 0.4));
  const CheckReport& report = *mesh.check;
  if (!report.is_complete)
    throw Error({.code = ErrorCode::mesh_invalid,
                 .attempted = "making a report page",
                 .problem = "indices or points of the mesh are unusable, so that nothing of it can be shown",
                 .hint = "`sterna check` lists them"});
  const std::vector<SurfaceField> fields = surface_fields(mesh.mesh, context);
  const PageTriangles triangles = page_triangles(mesh.mesh);
  const PageMaker maker(mesh.mesh.points.raw(), triangles, mesh.mesh.patches, fields);
  const std::vector<CutPlace> places = places_of(mesh.mesh, cuts_wanted, options.automatic_cuts, maker, context);
  std::vector<MeshCut> cuts;
  for (const CutPlace& place : places) {
    cuts.push_back(cut_mesh(mesh.mesh, place.plane, context));
    context.progress(0.4 + 0.4 * static_cast<double>(cuts.size()) / static_cast<double>(places.size()));
  }

  require_cells(mesh.mesh, cuts_wanted, places, cuts);

  const std::string title = title_of(options, name);
  Json head = {{"schema", "sterna-report-1"}, {"program", "sterna " STERNA_VERSION}, {"title", title}, {"kind", "volume"}, {"facts", facts_json(mesh)}};
  head.update(maker.frame());
  head.update(Json::parse(page_check_json(report)));
  head["symmetry_normal"] = json_of(symmetry_normal(mesh.mesh));
  head["patches"] = maker.patches_json();
  head["manifest"] = Json::parse(manifest_json(mesh, std::string(name), context.seed()));
  if (mesh.origin) head["options_set"] = options_set_json(*mesh.origin);
  head["run"] = options.times && mesh.origin ? run_json(context) : Json(nullptr);
  return small_page(options, context, [&](std::size_t n_triangles, std::size_t n_polygons) {
    PageArrays arrays;
    Json json = head;
    json["surface"] = maker.surface_json(n_triangles, arrays);
    json["cuts"] = Json::array();
    for (std::size_t i = 0; i < places.size(); ++i)
      if (cuts[i].size() > 0) json["cuts"].push_back(cut_json(places[i], cuts[i], std::max<std::size_t>(1, n_polygons / places.size()), arrays));
    return page_text(text_of(json), arrays);
  });
}

std::string report_html(const SurfaceValue& surface, const ReportOptions& options, std::string_view name, const RunContext& context) {
  const TriMesh& mesh = surface.mesh;
  const std::vector<SurfaceField> fields = surface_fields(mesh, context);
  const PageTriangles triangles = page_triangles(mesh);
  const PageMaker maker(mesh.points.raw(), triangles, mesh.patches, fields);
  const std::string title = title_of(options, name);
  Json head = {{"schema", "sterna-report-1"}, {"program", "sterna " STERNA_VERSION}, {"title", title}, {"kind", "surface"}};
  head["facts"] = Json::array();  // pairs of texts in braces would be an object
  const auto add_fact = [&](const char* fact, const std::string& text) { head["facts"].push_back(Json::array({fact, text})); };
  add_fact("triangles", count_text(static_cast<std::int64_t>(mesh.n_triangles())));
  add_fact("vertices", count_text(static_cast<std::int64_t>(mesh.n_vertices())));
  add_fact("closed", surface.report.is_closed ? "yes" : "no");
  head.update(maker.frame());
  head.update(Json::parse(page_no_check_json()));
  head["patches"] = maker.patches_json();
  head["manifest"] = {{"inputs", inputs_json(surface.inputs)}};
  if (!surface.changes.empty()) head["manifest"]["changes"] = surface.changes;
  head["run"] = options.times ? run_json(context) : Json(nullptr);
  head["cuts"] = Json::array();
  return small_page(options, context, [&](std::size_t n_triangles, std::size_t) {
    PageArrays arrays;
    Json json = head;
    json["surface"] = maker.surface_json(n_triangles, arrays);
    return page_text(text_of(json), arrays);
  });
}

}  // namespace sterna::scripting
