#include "scripting/values/inspect_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "geom/base/error.h"
#include "geom/draw/draw.h"
#include "io/field/field_vtu.h"
#include "io/file/format_table.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "io/output/atomic_file.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/wall_files.h"
#include "surfmesh/remesh/remesh_forecast.h"

namespace sterna::scripting {
namespace {

using volmesh::Finding;
using volmesh::FindingKind;
using volmesh::InspectReport;
using volmesh::InspectRequest;
using volmesh::Severity;
using PlainJson = nlohmann::json;

constexpr double k_joined = 0.3;     ///< progress after files have been read and joined
constexpr double k_inspected = 0.9;  ///< progress after the inspection; the rest is the required preparation
constexpr double k_percent = 100.0;
constexpr double k_many_triangles = 1e6;              ///< above this number of triangles, the faces that cause it are reported
constexpr double k_read = 0.3, k_forecast_end = 0.4;  ///< progress for models: after files have been read, and after triangles have been predicted

FindingKind kind_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::open_surface: return FindingKind::open;
    case ErrorCode::non_manifold_surface: return FindingKind::non_manifold;
    case ErrorCode::not_orientable: return FindingKind::not_orientable;
    case ErrorCode::self_intersection: return FindingKind::crossing;
    case ErrorCode::file_malformed:
    case ErrorCode::empty_surface: return FindingKind::malformed;
    default: return FindingKind::refused;
  }
}

bool is_of_surface(ErrorCode code) { return kind_of(code) != FindingKind::refused; }

Finding finding_of(const Error& error, const InspectRequest& request) {
  const ErrorInfo& info = error.info();
  Finding finding{.kind = kind_of(info.code), .severity = Severity::error, .count = error.n_locations(), .text = info.problem, .advice = info.hint};
  const std::size_t n = std::min(info.locations.size(), static_cast<std::size_t>(request.limits.max_places));
  for (std::size_t i = 0; i < n; ++i) finding.locations.push_back({info.locations[i].position, {}, 0.0, info.locations[i].what});
  return finding;
}

/// Replaces the finding of the same kind in the report. If there is such a finding, its triangles are marked already.
void replace_finding(InspectReport& report, Finding finding) {
  const auto same = std::find_if(report.findings.begin(), report.findings.end(), [&](const Finding& other) { return other.kind == finding.kind; });
  if (same != report.findings.end()) *same = std::move(finding);
  else volmesh::add_finding(report, std::move(finding), {});
}

std::vector<std::string> names_of(std::span<const InputPath> files) {
  std::vector<std::string> names;
  for (const InputPath& file : files) names.push_back(file.name);
  return names;
}

/// Returns the corner angle below which volume_mesh treats a triangle as a sliver. If this is disabled, returns the angle that it would have.
double sliver_limit_of(const InspectRequest& request) {
  const double requested = request.volume.needles.split_needles;
  return requested > 0.0 ? requested : volmesh::SliverOptions{}.split_needles;
}

/// Returns all triangles as given in the files, in metres. Only coincident corners of STL are joined.
TriMesh triangles_of(const WallFiles& files) {
  TriMesh all;
  for (const SurfaceSoup& soup : files.soups) {
    const auto is_wrong = [&](const auto& t) { return std::ranges::any_of(t, [&](std::uint32_t v) { return v >= soup.points.size(); }); };
    if (std::ranges::any_of(soup.triangles, is_wrong)) continue;  // the finding on this soup reports it
    TriMesh mesh = io::to_tri_mesh(soup);
    for (Point& p : mesh.points) p *= files.wall.options.unit;
    append(all, mesh);
  }
  return all;
}

/// Returns the triangles that the reader turned over, if its triangles correspond one to one to those of the files.
std::vector<TriangleId> turned_triangles(const WallFiles& files, const TriMesh& mesh) {
  std::vector<TriangleId> turned;
  std::size_t n = 0;
  for (const SurfaceSoup& soup : files.soups) n += soup.triangles.size();
  if (n != mesh.n_triangles()) return turned;
  TriangleId t(0);
  for (const SurfaceSoup& soup : files.soups) {
    for (const auto& v : soup.triangles) {
      const Vec3 before = cross(soup.points[v[1]] - soup.points[v[0]], soup.points[v[2]] - soup.points[v[0]]);
      const auto [a, b, c] = corners(mesh, t);
      if (dot(before, cross(b - a, c - a)) < 0.0) turned.push_back(t);
      t = TriangleId(t.index() + 1);
    }
  }
  return turned;
}

void add_repairs(const SurfaceValue& wall, const WallFiles& files, const InspectRequest& request, InspectReport& report) {
  const surfmesh::StitchReport& stitched = wall.report;
  if (stitched.n_flipped > 0) {
    const std::vector<TriangleId> turned = turned_triangles(files, wall.mesh);
    Finding finding{.kind = FindingKind::turned, .severity = Severity::note, .count = stitched.n_flipped};
    finding.text = count_text(stitched.n_flipped) + (stitched.n_flipped == 1 ? " triangle was" : " triangles were") +
                   " reversed on reading: the orientation differed from the neighbours, or a body was inside out";
    finding.advice = "no action required: volume_mesh reads the surface the same way. `sterna convert` writes the repaired surface for other programs";
    for (std::size_t i = 0; i < std::min(turned.size(), static_cast<std::size_t>(request.limits.max_places)); ++i) {
      const auto [a, b, c] = corners(wall.mesh, turned[i]);
      finding.locations.push_back(
          {(a + b + c) / 3.0, wall.mesh.patches[wall.mesh.triangle_patch[turned[i]]].name, 0.0, "triangle " + std::to_string(turned[i].value())});
    }
    volmesh::add_finding(report, std::move(finding), turned);
  }
  const std::int64_t n_repairs = stitched.n_degenerate_removed + stitched.n_duplicate_removed + stitched.n_welded_near;
  if (n_repairs == 0) return;
  Finding finding{.kind = FindingKind::repaired, .severity = Severity::note, .count = n_repairs};
  finding.text =
      fmt::format("repaired on reading: removed {} triangles without area and {} copies of triangles or doubled sheets, welded {} vertices to close ones",
                  count_text(stitched.n_degenerate_removed), count_text(stitched.n_duplicate_removed), count_text(stitched.n_welded_near));
  finding.advice = "no action required: volume_mesh reads the surface the same way. If the exact shape matters, list the repairs with -v";
  volmesh::add_finding(report, std::move(finding), {});
}

std::string count_text_of(double n) {
  return count_text(static_cast<std::int64_t>(n < 1e4 ? std::round(n) : n < 1e6 ? 100.0 * std::round(n / 100.0) : 1e4 * std::round(n / 1e4)));
}

/// Reports the faces with most of a model's triangles, the rule responsible for them, and the remedy. Returns nothing if the number is not large.
std::optional<Finding> many_triangles_of(const surfmesh::SurfaceForecast& forecast, const InspectRequest& request) {
  if (forecast.n_triangles <= k_many_triangles || forecast.largest.empty()) return std::nullopt;
  const surfmesh::FaceForecast& most = forecast.largest.front();
  Finding finding{.kind = FindingKind::many_triangles, .severity = Severity::warn, .count = 1, .value = forecast.n_triangles, .limit = k_many_triangles};
  finding.text =
      fmt::format("the sizes require about {} triangles on the surface; face \"{}\" needs {:.0f} % of them, with edges down to {:.3g} m, because of {}",
                  count_text_of(forecast.n_triangles), most.name, k_percent * most.n_triangles / forecast.n_triangles, most.least_edge, most.rule);
  finding.advice = most.advice + " (--set surface_mesh.min_edge=LENGTH and so on, or for this face only --patch \"" + most.name + ":...\")";
  for (std::size_t i = 0; i < std::min(forecast.largest.size(), static_cast<std::size_t>(request.limits.max_places)); ++i) {
    const surfmesh::FaceForecast& face = forecast.largest[i];
    finding.locations.push_back({face.location, face.name, face.n_triangles,
                                 fmt::format("about {} triangles, edges down to {:.3g} m: {}", count_text_of(face.n_triangles), face.least_edge, face.rule)});
  }
  return finding;
}

/// Predicts the result of remesh, if it is advised.
void foresee_remesh(const TriMesh& wall, const InspectRequest& request, Inspection& report, const RunContext& context) {
  if (!report.preparation.is_remesh_advised || report.find(FindingKind::crossing) != nullptr || report.find(FindingKind::non_manifold) != nullptr) return;
  surfmesh::RemeshForecast forecast;
  try {
    forecast = surfmesh::forecast_remesh(wall, {}, {}, {}, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    context.info("inspect: the number of triangles after remesh cannot be predicted: " + error.info().problem);
    return;
  }
  report.remeshed_triangles = forecast.n_triangles;
  if (forecast.n_triangles <= k_many_triangles) return;
  Finding finding{.kind = FindingKind::many_triangles, .severity = Severity::warn, .count = 1, .value = forecast.n_triangles, .limit = k_many_triangles};
  finding.text = fmt::format("remesh would make about {} triangles; patch \"{}\" needs {:.0f} % of them, with edges down to {:.3g} m, because of {}",
                             count_text_of(forecast.n_triangles), forecast.patch, k_percent * forecast.of_patch / forecast.n_triangles, forecast.least_edge,
                             forecast.is_by_longest ? "max_edge" : "curvature or narrow regions");
  finding.advice = forecast.is_by_longest ? "a larger max_edge of remesh" : "a larger curvature_angle or min_edge of remesh";
  if (request.limits.max_places > 0) finding.locations.push_back({forecast.location, forecast.patch, forecast.least_edge, "the shortest edges"});
  replace_finding(report, std::move(finding));
}

}  // namespace

Inspection inspect_files(std::span<const InputPath> inputs, const surfmesh::StitchOptions& options, InspectRequest request, const RunContext& context,
                         const BeforeInspection& before) {
  WallFiles files = read_wall_files(inputs, options, context.part("read", 0.0, 0.5 * k_joined));
  files.wall.options.check_intersections = false;  // inspect_wall finds the pairs itself
  std::optional<Finding> refusal;
  std::optional<SurfaceValue> wall;
  for (const bool is_lenient : {false, true}) {
    if (is_lenient) files.wall.options.allow_open = true;
    try {
      wall = join_wall(files, context.part("join", 0.5 * k_joined, k_joined));
      break;
    } catch (const Error& error) {
      if (!is_of_surface(error.code())) throw;
      if (!refusal) refusal = finding_of(error, request);
    }
  }
  Inspection report;
  const RunContext inspecting = context.part("inspect", k_joined, k_inspected);
  if (wall) {
    if (before.cut) wall = before.cut(*wall, context.part("half", k_joined, k_joined));
    if (before.complete_options) before.complete_options(*wall, request.volume, context);
    request.volume = with_wall_facts(*wall, request.volume);
    static_cast<InspectReport&>(report) = volmesh::inspect_wall(wall->mesh, request, inspecting);
    if (refusal) replace_finding(report, std::move(*refusal));
    add_repairs(*wall, files, request, report);
  } else {
    static_cast<InspectReport&>(report) = volmesh::inspect_triangles(triangles_of(files), request, inspecting);
    replace_finding(report, std::move(*refusal));
  }
  AutoSurface requested;
  requested.stitching = files.wall.options;
  report.preparation =
      foresee_preparation(files.soups, report, requested, sliver_limit_of(request), names_of(inputs), false, context.part("foresee", k_inspected, 1.0));
  if (wall) foresee_remesh(wall->mesh, request, report, context.part("remesh", 1.0, 1.0));
  return report;
}

namespace {

Inspection inspect_joined(const SurfaceValue& surface, InspectRequest request, bool must_close, const RunContext& context) {
  request.volume = with_wall_facts(surface, request.volume);
  Inspection report;
  static_cast<InspectReport&>(report) = volmesh::inspect_wall(surface.mesh, request, context.part("inspect", 0.0, k_inspected));
  const SurfaceHandle borrowed(SurfaceHandle(), &surface);
  const std::array items = {UnionItem(borrowed)};
  AutoSurface requested;
  requested.stitching.fluid = surface.options.fluid;
  report.preparation = foresee_preparation(read_items(items, requested.stitching, context).soups, report, requested, sliver_limit_of(request), {}, must_close,
                                           context.part("foresee", k_inspected, 1.0));
  if (!surface.true_surface.wall) foresee_remesh(surface.mesh, request, report, context.part("remesh", 1.0, 1.0));
  return report;
}

}  // namespace

Inspection inspect_surface(const SurfaceValue& surface, InspectRequest request, const RunContext& context) {
  return inspect_joined(surface, std::move(request), false, context);
}

Inspection inspect_models(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, InspectRequest request,
                          const RunContext& context, const BeforeInspection& before) {
  std::optional<Error> refusal;
  SurfaceValue surface;
  ModelsOfFiles models = read_model_files(files, reading, recipe, context.part("read", 0.0, k_joined * k_read));
  std::optional<double> expected;
  std::optional<Finding> many;
  try {
    const surfmesh::SurfaceForecast forecast =
        forecast_models(models.models, models.recipe, context.part("forecast", k_joined * k_read, k_joined * k_forecast_end));
    expected = forecast.n_triangles;
    many = many_triangles_of(forecast, request);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    context.info("inspect: the number of triangles cannot be predicted: " + error.info().problem);
  }
  if (many) context.warn(many->text + "; try " + many->advice);
  const RunContext meshing = context.part("surface", k_joined * k_forecast_end, k_joined);
  try {
    surface = mesh_model_files(models, meshing);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::overflow && many) {
      Inspection report;
      report.expected_triangles = expected;
      replace_finding(report, std::move(*many));
      replace_finding(report, finding_of(error, request));
      report.preparation = {.needed = Strength::beyond, .is_model = true, .reason = "the surface has too many triangles: " + error.info().problem};
      return report;
    }
    if (!is_about_surface(error)) throw;
    refusal = error;
  }
  if (refusal) {
    models.recipe.options.crossings = "ignore";
    try {
      surface = mesh_model_files(models, meshing);
    } catch (const Error& error) {
      if (!is_about_surface(error)) throw;
      Inspection report;
      replace_finding(report, finding_of(error, request));
      report.preparation = {.needed = Strength::beyond, .is_model = true, .reason = "the faces of the model cannot be meshed: " + error.info().problem};
      return report;
    }
  }
  if (before.cut) surface = before.cut(surface, context.part("half", k_joined, k_joined));
  if (before.complete_options) before.complete_options(surface, request.volume, context);
  Inspection report = inspect_joined(surface, request, !before.cut, context.part("inspect", k_joined, 1.0));
  report.expected_triangles = expected;
  if (many) replace_finding(report, std::move(*many));
  if (refusal) replace_finding(report, finding_of(*refusal, request));
  complete_for_model(report.preparation, static_cast<std::int64_t>(surface.mesh.n_triangles()), changes_of(surface.history), names_of(files));
  return report;
}

// ---- Reports ---------------------------------------------------------------------------------------------------------------------------------

namespace {

std::string verdict_of(const InspectReport& report) {
  const auto counted = [&](Severity severity, const char* one, const char* many) {
    const std::int64_t n = report.count(severity);
    return n == 0 ? std::string() : fmt::format(", {} {}", n, n == 1 ? one : many);
  };
  return (report.is_ok() ? "volume_mesh will accept it" : "volume_mesh will refuse it") + counted(Severity::error, "error", "errors") +
         counted(Severity::warn, "warning", "warnings") + counted(Severity::note, "note", "notes");
}

std::string prediction_of(const volmesh::LayerPrediction& layer) {
  std::string text = fmt::format("layers: full height on about {:.3g} % of the area, {:.3g} % compressed, {:.3g} % collapsed", k_percent * layer.coverage,
                                 k_percent * layer.compressed, k_percent * layer.collapsed);
  for (std::size_t i = 0; i < layer.lost_area.size(); ++i)
    text += fmt::format("{}{:.3g} % {}", i == 0 ? " (lower: " : ", ", k_percent * layer.lost_area[i].second, layer.lost_area[i].first);
  return text + (layer.lost_area.empty() ? "" : ")");
}

}  // namespace

std::string text_of(const Inspection& report, const std::string& name) {
  std::string text = fmt::format("inspect {}: {} {}, {}, {} {}, {:.4g} m long\n", name, count_text(static_cast<std::int64_t>(report.mesh.n_triangles())),
                                 report.mesh.n_triangles() == 1 ? "triangle" : "triangles", report.is_closed ? "closed" : "not closed", report.n_bodies,
                                 report.n_bodies == 1 ? "part" : "parts", report.length);
  if (report.expected_triangles)
    text += fmt::format("  sizes {:<13} about {} triangles of the surface were predicted\n", "of the model", count_text_of(*report.expected_triangles));
  if (report.remeshed_triangles)
    text += fmt::format("  sizes {:<13} about {} triangles are predicted\n", "of remesh", count_text_of(*report.remeshed_triangles));
  for (const Finding& finding : report.findings) {
    text += fmt::format("  {:<5} {:<13} {}\n", to_string(finding.severity), to_string(finding.kind), finding.text);
    for (const volmesh::FindingLocation& location : finding.locations)
      text += fmt::format("        at {}{}: {}\n", format_point(location.position), location.patch.empty() ? "" : " on " + location.patch, location.what);
    if (!finding.advice.empty()) text += "        try: " + finding.advice + "\n";
  }
  if (report.layer.is_known) text += "  " + prediction_of(report.layer) + "\n";
  text += text_of(report.preparation);
  return text + "  " + verdict_of(report);
}

std::string json_of(const Inspection& report, const std::string& name) {
  const auto number = [](double value) { return std::isfinite(value) ? PlainJson(value) : PlainJson(nullptr); };
  const auto point = [](const Point& p) { return PlainJson{p.x, p.y, p.z}; };
  PlainJson json = {{"schema", "sterna-inspect-1"},
                    {"input", name},
                    {"ok", report.is_ok()},
                    {"triangles", report.mesh.n_triangles()},
                    {"closed", report.is_closed},
                    {"parts", report.n_bodies},
                    {"length", report.length},
                    {"errors", report.count(Severity::error)},
                    {"warnings", report.count(Severity::warn)},
                    {"notes", report.count(Severity::note)}};
  if (report.expected_triangles) json["expected_triangles"] = number(*report.expected_triangles);
  if (report.remeshed_triangles) json["remeshed_triangles"] = number(*report.remeshed_triangles);
  json["preparation"] = json_of(report.preparation);
  json["findings"] = PlainJson::array();
  for (const Finding& finding : report.findings) {
    PlainJson locations = PlainJson::array();
    for (const volmesh::FindingLocation& location : finding.locations)
      locations.push_back({{"at", point(location.position)}, {"patch", location.patch}, {"value", number(location.value)}, {"what", location.what}});
    json["findings"].push_back({{"kind", to_string(finding.kind)},
                                {"severity", to_string(finding.severity)},
                                {"count", finding.count},
                                {"share", number(finding.share)},
                                {"value", number(finding.value)},
                                {"limit", number(finding.limit)},
                                {"unit", finding.unit},
                                {"text", finding.text},
                                {"advice", finding.advice},
                                {"places", std::move(locations)}});
  }
  if (report.layer.is_known) {
    const volmesh::LayerPrediction& layer = report.layer;
    PlainJson lost = PlainJson::object(), patches = PlainJson::array();
    for (const auto& [reason, share] : layer.lost_area) lost[reason] = share;
    for (const auto& patch : layer.patches)
      patches.push_back(
          {{"name", patch.name}, {"area", patch.area}, {"coverage", patch.coverage}, {"compressed", patch.compressed}, {"collapsed", patch.collapsed}});
    json["layer"] = {{"coverage", layer.coverage},
                     {"compressed", layer.compressed},
                     {"collapsed", layer.collapsed},
                     {"lost_area", std::move(lost)},
                     {"patches", std::move(patches)}};
  }
  return json.dump(2);
}

void require_inspection_output(const std::filesystem::path& path) {
  if (path.extension() != ".vtu" && path.extension() != ".png")
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "writing " + path.string(),
                 .problem = "the picture of an inspection is a .vtu or a .png file",
                 .hint = "such as " + path.stem().string() + ".vtu"});
  io::AtomicFile probe(path);  // reports why the file cannot be written; removed at once
}

namespace {

/// Returns the surface with a patch for each kind of finding that is the most severe one at some triangle.
TriMesh by_finding(const InspectReport& report) {
  TriMesh mesh = report.mesh;
  mesh.patches = {};
  const auto field = std::ranges::find(report.fields, "finding", &TriMeshField::name);
  std::map<int, PatchId> patches;
  for (const TriangleId t : mesh.triangles.ids()) {
    const int kind = field == report.fields.end() ? 0 : static_cast<int>(field->values[t.index()]);
    const auto [patch, is_new] = patches.try_emplace(kind, static_cast<std::uint32_t>(mesh.patches.size()));
    if (is_new) mesh.patches.push_back({.name = kind == 0 ? "nothing found" : std::string(to_string(static_cast<volmesh::FindingKind>(kind)))});
    mesh.triangle_patch[t] = patch->second;
  }
  return mesh;
}

void draw_inspection(const InspectReport& report, const std::filesystem::path& path, const RunContext& context) {
  std::vector<DrawMark> marks;
  for (const Finding& finding : report.findings)
    if (!finding.locations.empty()) marks.push_back({finding.locations.front().position, std::string(to_string(finding.severity)) + ": " + finding.text});
  DrawOptions options;
  options.places = true;
  io::write_whole(path, draw_png(by_finding(report), options, "inspection", marks, context));
}

}  // namespace

void write_inspection(const InspectReport& report, const std::filesystem::path& path, const RunContext& context) {
  if (path.extension() == ".png") return draw_inspection(report, path, context);
  io::write_field_vtu(report.mesh, report.fields, path, context);
}

}  // namespace sterna::scripting
