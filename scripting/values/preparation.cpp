#include "scripting/values/preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/math/constants.h"
#include "scripting/values/open_domains.h"
#include "scripting/values/remeshed_surface.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {
namespace {

using volmesh::FindingKind;
using volmesh::InspectReport;

// Seconds of one thread, fitted to all files of tests/data/shared. The program for the fit is not kept.
constexpr double k_start_seconds = 0.05;       ///< start of each step
constexpr double k_repair_of_facet = 1e-5;     ///< per facet: welding, seams, distances
constexpr double k_repair_of_hull = 0.15;      ///< hull, if facets cross: mostly samples of distances
constexpr double k_repair_of_crossing = 4e-4;  ///< per crossing pair: cutting, hull, repair of rounding errors
constexpr double k_repair_of_filling = 1e-4;   ///< per facet that fills a hole
constexpr double k_wrap_of_triangle = 2.5e-4;  ///< per triangle of the wrap
constexpr double k_wrap_coarse = 2.0;          ///< factor if a coarser wrap closes openings first
constexpr double k_wrap_leaking = 3.0;         ///< factor if openings are wider than the widest gap
constexpr double k_remesh_of_facet = 3.5e-5;
constexpr double k_remesh_of_first = 5e-4;  ///< per facet of the given surface: coarse surfaces are refined to many new triangles
constexpr double k_remesh_first = 2000.0;
constexpr double k_model_of_triangle = 4e-5;  ///< per triangle: faces are meshed twice, the first time to find crossings
constexpr double k_seconds_off = 3.0;         ///< factor by which the seconds may be wrong

std::int64_t count_slivers(const InspectReport& report, double limit) {
  const auto field = std::ranges::find(report.fields, "smallest_angle", &TriMeshField::name);
  if (field == report.fields.end()) return 0;
  return std::ranges::count_if(field->values, [&](float angle) { return !(angle * k_degree >= limit); });
}

bool is_torn(const InspectReport& report) {
  constexpr std::array k_torn = {FindingKind::non_manifold, FindingKind::open, FindingKind::not_orientable, FindingKind::crossing};
  return std::ranges::any_of(k_torn, [&](FindingKind kind) {
    const volmesh::Finding* finding = report.find(kind);
    return finding != nullptr && finding->severity == volmesh::Severity::error;
  });
}

/// Returns true if the surface is open only in planes where the domain ends: --auto accepts it unchanged.
bool is_open_domain(const InspectReport& report, const AutoSurface& options, const RunContext& context) {
  if (report.is_closed || options.stitching.fluid == "inside") return false;
  for (const FindingKind kind : {FindingKind::non_manifold, FindingKind::not_orientable, FindingKind::crossing})
    if (const volmesh::Finding* finding = report.find(kind); finding != nullptr && finding->severity == volmesh::Severity::error) return false;
  return ends_in_planes(report.mesh, context).has_value();
}

std::string counted(std::int64_t n, const char* one, const char* many) { return count_text(n) + " " + (n == 1 ? one : many); }

/// Quotes the name for a shell.
std::string quoted(const std::string& name) {
  if (name.find_first_of(" '\"$&()*;<>?[]\\`|!#~") == std::string::npos) return name;
  std::string text = "'";
  for (const char c : name) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string stem_of(const std::string& name) {
  std::filesystem::path path(name);
  if (path.extension() == ".gz") path = path.stem();
  return path.stem().string();
}

/// Returns the expected actions of repair, from its forecast.
std::string to_do(const surfmesh::RepairForecast& forecast) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (forecast.n_seams > 0) add(counted(forecast.n_seams, "seam zipped", "seams zipped"));
  if (forecast.n_sheets > 0) add(counted(forecast.n_sheets, "sheet removed", "sheets removed"));
  if (forecast.n_holes > 0) add(counted(forecast.n_holes, "hole filled", "holes filled"));
  if (forecast.n_crossings > 0) add(counted(forecast.n_crossings, "pair of crossing facets cut", "pairs of crossing facets cut"));
  if (forecast.n_crowded > 0) add(counted(forecast.n_crowded, "edge with more than two facets separated", "edges with more than two facets separated"));
  if (forecast.half) add("half model recognised, open at " + forecast.half->axis + fmt::format(" = {:.4g} m", forecast.half->at));
  return text.empty() ? "facets welded and oriented" : text;
}

void choose_repair_or_wrap(Preparation& p, const AutoSurface& options) {
  const surfmesh::RepairForecast& forecast = p.forecast;
  if (!forecast.locations.empty()) p.location = forecast.locations.front();
  if (forecast.is_enough) {
    p.needed = Strength::repair;
    p.is_changed = forecast.n_changes > 0 || forecast.n_crossings > 0 || forecast.n_crowded > 0;
    p.reason = forecast.problem + "; to do: " + to_do(forecast) + (p.is_changed ? "" : ", nothing is changed");
    p.seconds = k_start_seconds + k_repair_of_facet * static_cast<double>(forecast.n_facets) +
                k_repair_of_crossing * static_cast<double>(forecast.n_crossings) + k_repair_of_filling * static_cast<double>(forecast.n_fillings) +
                (forecast.n_crossings > 0 || forecast.n_crowded > 0 ? k_repair_of_hull : 0.0);
    p.basis = counted(forecast.n_facets, "facet", "facets") + ", " + counted(forecast.n_crossings, "crossing", "crossings") + ", " +
              counted(forecast.n_fillings, "facet fills holes", "facets fill holes");
    return;
  }
  p.needed = Strength::wrap;
  p.is_changed = true;
  const surfmesh::WrapEstimate wrap = surfmesh::estimate_wrap(forecast.area, forecast.length, options.wrap);
  if (forecast.n_open > 0) {
    p.reason = forecast.problem + "; repair leaves " + counted(forecast.n_open, "opening", "openings") +
               fmt::format(", the widest {:.4g} m across ({:.3g} of the length): above the limits of repair, or as large as the surface itself",
                           forecast.widest_open, forecast.widest_open / forecast.length);
    p.location = forecast.widest_location;
    if (forecast.widest_open >= forecast.length)
      p.hint =
          "a surface with an opening as large as its length is a sheet; wrapped, its thickness is about the wrap's offset. If a part of the surface is "
          "missing, add it";
    else if (forecast.widest_open > wrap.widest_gap)
      p.hint = fmt::format("wrap leaks through openings wider than {:.3g} m and wraps both sides of the skin behind them: gap = {:.3g} closes this opening",
                           wrap.widest_gap, forecast.widest_open);
  } else {
    p.reason = forecast.problem + "; facets cross, and the outer hull is switched off (hull = false)";
  }
  // The input is wrapped once. If openings are wider than the edge, a coarser wrap precedes; if they are wider than the widest gap, the skin has both sides.
  const double rounds = forecast.widest_open > wrap.widest_gap ? k_wrap_leaking : forecast.widest_open > 2.0 * wrap.edge ? k_wrap_coarse : 1.0;
  p.seconds =
      k_start_seconds + k_repair_of_facet * static_cast<double>(forecast.n_facets) + rounds * k_wrap_of_triangle * static_cast<double>(wrap.n_triangles);
  p.basis = counted(forecast.n_facets, "facet", "facets") + ", about " + counted(wrap.n_triangles, "triangle", "triangles") + " of the wrap";
}

void advise_remesh(Preparation& p, const InspectReport& report) {
  p.is_remesh_advised = true;
  p.needed = Strength::remesh;
  const double smallest = [&] {
    const auto field = std::ranges::find(report.fields, "smallest_angle", &TriMeshField::name);
    return static_cast<double>(*std::ranges::min_element(field->values));
  }();
  p.reason = fmt::format("{:.3g} % of the triangles ({}) have an angle below {:.3g} deg, the smallest {:.3g} deg: tetrahedra on them tend to fail gate G14",
                         100.0 * p.needle_share, count_text(p.n_slivers), p.sliver_limit / k_degree, smallest);
  if (const volmesh::Finding* needle = report.find(FindingKind::needle); needle != nullptr && !needle->locations.empty())
    p.location = needle->locations.front().position;
  const auto n = static_cast<std::int64_t>(report.mesh.n_triangles());
  p.seconds = k_start_seconds + k_remesh_of_first * std::min(static_cast<double>(n), k_remesh_first) + k_remesh_of_facet * static_cast<double>(n);
  p.basis = counted(n, "triangle", "triangles");
}

/// Writes the commands for the preparation. Writes none if the names of the files are unknown.
void write_commands(Preparation& p, std::span<const std::string> inputs, double in_metres) {
  if (p.needed == Strength::none || p.needed == Strength::beyond || inputs.empty()) return;
  std::string words, names;
  for (const std::string& name : inputs) {
    words += " " + quoted(name);
    names += (names.empty() ? "\"" : ", \"") + name + "\"";
  }
  const std::string verb(to_string(p.needed));
  const std::string unit = in_metres == 1.0 ? "" : fmt::format("{:g}", in_metres);
  const std::string stem = stem_of(inputs.front());
  if (p.is_model) {
    p.command = "sterna surface" + words + " --auto -o " + quoted(stem + "_wall.obj");
    p.script = "read_surface{ " + names + ", auto = true }";
    return;
  }
  p.command = "sterna " + verb + words + (unit.empty() ? "" : " --unit " + unit) + " -o " +
              quoted(stem + "_" + verb + (p.needed == Strength::wrap ? "ped" : "ed") + ".obj");
  p.script = "read_surface{ " + names + (unit.empty() ? "" : ", unit = " + unit) + ", " + verb + " = true }";
}

}  // namespace

std::string_view to_string(Strength strength) {
  static constexpr std::array<std::string_view, 5> k_names = {"none", "repair", "wrap", "remesh", "beyond"};
  return k_names[static_cast<std::size_t>(strength)];
}

Preparation foresee_preparation(const std::vector<SurfaceSoup>& soups, const InspectReport& report, const AutoSurface& options, double sliver_limit,
                                std::span<const std::string> inputs, bool must_close, const RunContext& context) {
  Preparation p;
  p.sliver_limit = sliver_limit;
  p.n_slivers = count_slivers(report, sliver_limit);
  p.needle_share = report.mesh.n_triangles() == 0 ? 0.0 : static_cast<double>(p.n_slivers) / static_cast<double>(report.mesh.n_triangles());
  if (const volmesh::Finding* malformed = report.find(FindingKind::malformed)) {
    p.needed = Strength::beyond;
    p.reason = malformed->text;
    return p;
  }
  if ((is_torn(report) || (must_close && !report.is_closed)) && !is_open_domain(report, options, context)) {
    try {
      p.forecast = surfmesh::foresee_repair(soups, options.stitching, options.repair, context);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      p.needed = Strength::beyond;
      p.reason = error.info().problem;
      return p;
    }
  }
  const bool has_slivers = p.needle_share >= k_many_slivers;
  if (p.forecast.is_needed) {
    choose_repair_or_wrap(p, options);
    p.is_remesh_advised = has_slivers;
  } else if (has_slivers) {
    advise_remesh(p, report);
  }
  if (p.seconds > 0.0) p.basis += fmt::format("; on one thread, within a factor of {:g} for the files used to fit the estimate", k_seconds_off);
  write_commands(p, inputs, options.stitching.unit);
  return p;
}

void complete_for_model(Preparation& p, std::int64_t n_triangles, std::span<const std::string> changes, std::span<const std::string> inputs) {
  p.is_model = true;
  p.is_triangulated = p.needed == Strength::repair || p.needed == Strength::wrap;
  for (const std::string& change : changes) p.hint += (p.hint.empty() ? "done already: " : "; ") + change;
  if (p.needed != Strength::none) p.seconds += k_model_of_triangle * static_cast<double>(n_triangles);
  write_commands(p, inputs, 1.0);
}

nlohmann::json json_of(const Preparation& p) {
  nlohmann::json json = {{"needed", to_string(p.needed)},
                         {"reason", p.reason},
                         {"command", p.command},
                         {"script", p.script},
                         {"hint", p.hint},
                         {"seconds", p.seconds},
                         {"basis", p.basis},
                         {"model", p.is_model},
                         {"triangulated", p.is_triangulated},
                         {"changed", p.is_changed},
                         {"remesh", p.is_remesh_advised},
                         {"needles", p.n_slivers},
                         {"needle_share", p.needle_share}};
  json["at"] = p.location ? nlohmann::json{p.location->x, p.location->y, p.location->z} : nlohmann::json(nullptr);
  const surfmesh::RepairForecast& f = p.forecast;
  json["found"] = {{"facets", f.n_facets},         {"seams", f.n_seams},
                   {"sheets", f.n_sheets},         {"holes", f.n_holes},
                   {"hole_facets", f.n_fillings},  {"stay_open", f.n_open},
                   {"widest_open", f.widest_open}, {"crossings", f.n_crossings},
                   {"crowded_edges", f.n_crowded}, {"half", f.half ? f.half->axis : ""}};
  return json;
}

std::string text_of(const Preparation& p) {
  if (p.needed == Strength::none)
    return "  first nothing       " + std::string(p.is_model ? "the faces of the model can be meshed" : "the surface is sound") +
           (p.hint.empty() ? "" : "; " + p.hint) + "\n";
  std::string text =
      fmt::format("  first {:<13} {}{}\n", to_string(p.needed), p.needed == Strength::beyond ? "neither repair nor wrap nor remesh helps: " : "", p.reason);
  if (p.location) text += "        at " + format_point(*p.location) + "\n";
  if (p.is_triangulated) text += "        the model is replaced by triangles; patches keep the names of its faces\n";
  if (!p.command.empty()) text += "        run: " + p.command + "\n";
  if (!p.script.empty()) text += "        or in Lua: " + p.script + "\n";
  if (!p.hint.empty()) text += "        try: " + p.hint + "\n";
  if (p.seconds > 0.0) text += fmt::format("        takes about {} s ({})\n", number_text(p.seconds, 2), p.basis);
  if (p.is_remesh_advised && p.needed != Strength::remesh)
    text += fmt::format("        then remesh: {:.3g} % of the triangles have an angle below {:.3g} deg\n", 100.0 * p.needle_share, p.sliver_limit / k_degree);
  return text;
}

}  // namespace sterna::scripting
