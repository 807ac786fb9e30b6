#include "scripting/report/report_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/draw/choices.h"
#include "geom/mesh/cut_locations.h"
#include "scripting/report/page_arrays.h"
#include "scripting/report/page_surface.h"
#include "scripting/report/report_gates.h"
#include "scripting/report/report_page.h"
#include "scripting/values/manifest.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {

namespace {

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// Factor of the budget for the next attempt if the page is too large.
constexpr double k_less = 0.6;
Json json_of(const Point& p) { return Json::array({p.x, p.y, p.z}); }

/// Returns the names of options that differ from their defaults, by stage.
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
    facts.push_back({"mean height of the layer", in_metres(value.origin->report.layer.mean_height, 4)});
    facts.push_back({"full height", number_text(100.0 * value.origin->report.layer.coverage, 4) + " % of the area; the geometry permits " +
                                        number_text(100.0 * value.origin->report.layer.attainable, 4) + " %"});
    facts.push_back({"tetrahedra by", value.origin->report.tetra_engine});
  }
  return facts;
}

std::string title_of(const ReportOptions& options, std::string_view name) { return options.title == "automatic" ? std::string(name) : options.title; }

/// Returns the user's cuts, then the automatic cuts that the user has not named. A user's plane is viewed at its point nearest to the centre of the bodies.
std::vector<CutLocation> locations_of(const HybridMesh& mesh, const std::vector<std::string>& requested, bool with_automatic, const PageMaker& maker,
                                      const RunContext& context) {
  constexpr double k_radius_share = 0.6;  // radius relative to the bodies' length, so that all bodies are visible
  std::vector<CutLocation> automatic = automatic_cuts(mesh, context), locations;
  for (const std::string& text : requested) {
    if (const std::optional<CutPlane> plane = draw::plane_of(text)) {
      const Vec3 normal = normalized(plane->normal);
      locations.push_back({text, *plane, maker.origin() - dot(maker.origin() - plane->origin, normal) * normal, k_radius_share * maker.length()});
    } else {
      locations.push_back(draw::location_of(automatic, text, "report", "cut"));
    }
  }
  if (!with_automatic) return locations;
  for (CutLocation& location : automatic)
    if (std::none_of(locations.begin(), locations.end(), [&](const CutLocation& known) { return known.name == location.name; }))
      locations.push_back(std::move(location));
  return locations;
}

/// Tests that the user's planes cut the mesh.
/// \pre `locations` begins with the requested ones.
/// \throws Error(bad_argument) for a requested plane that does not intersect the mesh.
void require_cells(const HybridMesh& mesh, std::span<const std::string> requested, const std::vector<CutLocation>& locations,
                   const std::vector<MeshCut>& cuts) {
  for (std::size_t i = 0; i < requested.size(); ++i)
    if (cuts[i].size() == 0)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "report: cut \"" + requested[i] + "\"",
                   .problem = clear_plane_text(mesh, locations[i].plane),
                   .hint = "choose a plane between these limits"});
}

std::string too_large(std::size_t bytes) { return "the page would have " + std::to_string(bytes) + " bytes, more than " + std::to_string(k_most_page_bytes); }

/// Makes the page with decreasing budgets until it is small enough.
template <class Make>
std::string small_page(const ReportOptions& options, const RunContext& context, const Make& make) {
  double share = 1.0;
  constexpr double k_least = 0.01;
  for (;; share *= k_less) {
    const auto most = [&](int n) { return std::max<std::size_t>(1, static_cast<std::size_t>(share * n)); };
    std::string page = make(most(options.max_triangles), most(options.max_polygons));
    if (page.size() <= k_most_page_bytes) return page;
    if (share < k_least)
      throw Error({.code = ErrorCode::overflow, .attempted = "making a report page", .problem = too_large(page.size()), .hint = "give fewer cuts"});
    context.debug(too_large(page.size()) + ": the page is thinned");
  }
}

}  // namespace

void require_report_cuts(const std::vector<std::string>& cuts) {
  if (report_page().empty()) page_text("", {});
  for (const std::string& cut : cuts) draw::plane_of(cut);
}

std::string report_html(const MeshValue& mesh, const ReportOptions& options, const std::vector<std::string>& requested_cuts, std::string_view name,
                        const RunContext& context) {
  if (!mesh.check || !mesh.check->quality_measured) mesh.check = check(mesh.mesh, {}, context.part("check", 0.0, 0.4));
  const CheckReport& report = *mesh.check;
  if (!report.is_complete)
    throw Error({.code = ErrorCode::mesh_invalid,
                 .attempted = "making a report page",
                 .problem = "indices or points of the mesh are invalid, so the mesh cannot be shown",
                 .hint = "`sterna check` lists the faults"});
  const std::vector<SurfaceField> fields = surface_fields(mesh.mesh, context);
  const PageTriangles triangles = page_triangles(mesh.mesh);
  const PageMaker maker(mesh.mesh.points.raw(), triangles, mesh.mesh.patches, fields);
  const std::vector<CutLocation> locations = locations_of(mesh.mesh, requested_cuts, options.automatic_cuts, maker, context);
  std::vector<MeshCut> cuts;
  for (const CutLocation& location : locations) {
    cuts.push_back(cut_mesh(mesh.mesh, location.plane, context));
    context.progress(0.4 + 0.4 * static_cast<double>(cuts.size()) / static_cast<double>(locations.size()));
  }

  require_cells(mesh.mesh, requested_cuts, locations, cuts);

  const std::string title = title_of(options, name);
  Json head = {{"schema", "sterna-report-1"}, {"program", "sterna " STERNA_VERSION}, {"title", title}, {"kind", "volume"}, {"facts", facts_json(mesh)}};
  head.update(maker.frame_json());
  head.update(page_check_json(report));
  head["symmetry_normal"] = json_of(symmetry_normal(mesh.mesh));
  head["patches"] = maker.patches_json();
  head["manifest"] = manifest_of(mesh, std::string(name), context.seed());
  if (mesh.origin) head["options_set"] = options_set_json(*mesh.origin);
  head["run"] = options.times && mesh.origin ? run_json(context) : Json(nullptr);
  return small_page(options, context, [&](std::size_t n_triangles, std::size_t n_polygons) {
    PageArrays arrays;
    Json json = head;
    json["surface"] = maker.surface_json(n_triangles, arrays);
    json["cuts"] = Json::array();
    for (std::size_t i = 0; i < locations.size(); ++i)
      if (cuts[i].size() > 0) json["cuts"].push_back(page_cut_json(locations[i], cuts[i], std::max<std::size_t>(1, n_polygons / locations.size()), arrays));
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
  head["facts"] = Json::array();  // array of pairs: a pair of strings in braces would become an object
  const auto add_fact = [&](const char* fact, const std::string& text) { head["facts"].push_back(Json::array({fact, text})); };
  add_fact("triangles", count_text(static_cast<std::int64_t>(mesh.n_triangles())));
  add_fact("vertices", count_text(static_cast<std::int64_t>(mesh.n_vertices())));
  add_fact("closed", surface.report.is_closed ? "yes" : "no");
  head.update(maker.frame_json());
  head.update(page_no_check_json());
  head["patches"] = maker.patches_json();
  head["manifest"] = {{"inputs", inputs_json(surface.inputs)}};
  if (const std::vector<std::string> changes = changes_of(surface.history); !changes.empty()) head["manifest"]["changes"] = changes;
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
