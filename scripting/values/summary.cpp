#include "scripting/values/summary.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/math/constants.h"
#include "geom/mesh/layer_room.h"
#include "geom/mesh/volume_regions.h"
#include "scripting/values/layer_json.h"
#include "scripting/values/manifest.h"

namespace sterna::scripting {
namespace {

constexpr double k_bytes_per_mb = 1e6;
constexpr double k_least_reported = 0.5;      ///< a stage reports its busy share only if it takes at least this many seconds
constexpr std::size_t k_listed_troubles = 3;  ///< number of measures that miss a limit in the summary; the summary of a finished mesh has a dozen lines

std::string counted(std::int64_t n, std::string_view one, std::string_view many) { return count_text(n) + " " + std::string(n == 1 ? one : many); }

std::string verdict_text(const MeshValue& mesh) {
  if (!mesh.check) return "not checked";
  return mesh.check->is_valid() ? "VALID" : "INVALID";
}

std::int64_t n_nodes(const MeshValue& mesh) { return static_cast<std::int64_t>(mesh.mesh.points.size()); }

/// Returns name and value of the strictest kind of limit that `value` misses.
std::pair<const char*, double> missed_limit(const GateResult& gate, double value) {
  if (gate.is_hard_missed) return {"hard limit", gate.limits.hard};
  const bool is_target_missed = info_of(gate.measure).is_low_bad ? value < gate.limits.target : value > gate.limits.target;
  return is_target_missed ? std::pair{"target", gate.limits.target} : std::pair{"usual limit", gate.limits.usual};
}

/// Returns "hard limit 5 deg", "target 12 deg", "usual limit 35 deg".
std::string missed_limit_text(const GateResult& gate, double value) {
  const MeasureInfo& info = info_of(gate.measure);
  const auto [name, limit] = missed_limit(gate, value);
  return fmt::format("{} {:.4g}{}", name, in_report_unit(info, limit), info.is_angle ? " deg" : "");
}

/// Returns the value at the worst location that is not forced by the input surface; the worst of all if there is none.
double reported_value(const GateResult& gate) { return gate.locations.empty() ? gate.worst : gate.locations.front().value; }

/// Returns the factor by which the worst location misses the strictest kind of limit, by which problems are sorted. Infinite if a value of 0 misses a lower
/// limit.
double excess_of(const GateResult& gate) {
  const double value = reported_value(gate);
  const double limit = missed_limit(gate, value).second;
  const double ratio = info_of(gate.measure).is_low_bad ? limit / value : value / limit;
  return value > 0.0 && limit > 0.0 ? ratio : std::numeric_limits<double>::infinity();
}

/// Returns the reason why the layer closest to a location is lower than its target. Empty if it has its full height, or if the reason is unknown.
std::string_view lowered_at(const HybridMesh& mesh, const Point& location) {
  const LayerBlock& layers = mesh.layers;
  if (layers.n_lines() == 0 || mesh.request.reason.size() != layers.n_lines() || mesh.request.target_height.size() != layers.n_lines()) return {};
  const auto base_point = [&](std::size_t line) { return mesh.points[layers.node(static_cast<std::uint32_t>(line), 0)]; };
  const auto top = [&](std::size_t line) { return mesh.points[layers.node(static_cast<std::uint32_t>(line), layers.layers_of_line(line))]; };
  const auto distance_from = [&](std::size_t line) { return std::min(norm2(base_point(line) - location), norm2(top(line) - location)); };
  std::size_t nearest = 0;
  for (std::size_t line = 1; line < layers.n_lines(); ++line)
    if (distance_from(line) < distance_from(nearest)) nearest = line;
  if (distance(base_point(nearest), top(nearest)) >= k_full_height_share * mesh.request.target_height[nearest]) return {};
  const std::size_t reason = mesh.request.reason[nearest];
  return reason > 0 && reason < mesh.request.reasons.size() ? std::string_view(mesh.request.reasons[reason]) : std::string_view();
}

/// Returns the remedy at the worst location of a measure. At a compressed layer this is not a larger number of layers, which would worsen the measure.
std::string remedy_at(const GateResult& gate, const HybridMesh* mesh) {
  const bool is_of_height = gate.measure == Measure::interface_height || gate.measure == Measure::interface_volume || gate.measure == Measure::stack_growth;
  if (!mesh || !is_of_height || gate.locations.empty()) return std::string(remedy_of(gate.measure));
  const std::string_view reason = lowered_at(*mesh, gate.locations.front().position);
  if (reason.empty()) return "more layers, a larger max_growth, or shorter edges on the wall there";
  return "the layer is compressed there (" + std::string(reason) +
         "): less refinement along the corner (surface_mesh: narrow = 20; where parts meet, intersection_factor = 1); in a gap, gap_cells; or truncate = "
         "\"auto\"";
}

/// Returns a line on a measure that misses a limit: the problem in plain words, its worst location that is not forced, and the remedy.
std::string trouble_text(const GateResult& gate, const HybridMesh* mesh) {
  const MeasureInfo& info = info_of(gate.measure);
  const double value = reported_value(gate);
  std::string text = fmt::format("  worst       {}: {} {} {:.4g}{} ({})", trouble_of(gate.measure), info.gate, to_string(gate.state),
                                 in_report_unit(info, value), info.is_angle ? " deg" : "", missed_limit_text(gate, value));
  if (!gate.locations.empty()) text += " at " + format_point(gate.locations.front().position) + ", " + gate.locations.front().what;
  return text + "; " + remedy_at(gate, mesh) + "\n";
}

/// Returns the measures that miss a limit: first those that FAIL, then those that warn, each group with the worst first.
std::vector<const GateResult*> troubles_of(const CheckReport& report) {
  std::vector<const GateResult*> troubles;
  for (const GateState state : {GateState::fail, GateState::warn}) {
    const std::size_t n_before = troubles.size();
    for (const GateResult& gate : report.gates)
      if (gate.state == state) troubles.push_back(&gate);
    std::stable_sort(troubles.begin() + static_cast<std::ptrdiff_t>(n_before), troubles.end(),
                     [](const GateResult* a, const GateResult* b) { return excess_of(*a) > excess_of(*b); });
  }
  return troubles;
}

/// Returns the worst few problems. The others are available by -v, `sterna check`, the manifest and the report page.
std::string troubles_text(const CheckReport& report, const HybridMesh* mesh) {
  const std::vector<const GateResult*> troubles = troubles_of(report);
  std::string text;
  for (std::size_t i = 0; i < std::min(troubles.size(), k_listed_troubles); ++i) text += trouble_text(*troubles[i], mesh);
  return text;
}

/// Returns " G5 G9": the gates with a measure for which `is_meant` holds, each once.
template <class IsMeant>
std::string gate_names(const CheckReport& report, const IsMeant& is_meant) {
  std::string names;
  std::string_view last;
  for (const GateResult& gate : report.gates) {
    if (!is_meant(gate) || info_of(gate.measure).gate == last) continue;
    last = info_of(gate.measure).gate;
    names += " " + std::string(last);
  }
  return names;
}

/// Returns the time that this program took without the engine.
double rest_seconds(const MeshValue& mesh, const RunMeasure& measure) { return measure.wall_seconds - mesh.origin->report.tetra_engine_seconds; }

}  // namespace

std::string count_text(std::int64_t n) {
  std::string digits = std::to_string(n);
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > (n < 0 ? 1 : 0); i -= 3) digits.insert(static_cast<std::size_t>(i), 1, ' ');
  return digits;
}

std::string describe(const SurfaceValue& surface) {
  const Box box = bounding_box(surface.mesh);
  return fmt::format("TriMesh: {}, {}, {}, {:.6g} m long", counted(static_cast<std::int64_t>(surface.mesh.n_triangles()), "triangle", "triangles"),
                     surface.report.is_closed ? "closed" : "open", counted(static_cast<std::int64_t>(surface.mesh.patches.size()), "patch", "patches"),
                     box.empty() ? 0.0 : box.longest_side());
}

std::string change_text(std::string_view done, const std::vector<std::string>& messages) {
  std::string text(done);
  for (std::size_t i = 0; i < messages.size(); ++i) text += (i == 0 ? ": " : "; ") + messages[i];
  return text;
}

std::string describe(const MeshValue& mesh) {
  const CellCounts cells = count_cells(mesh.mesh);
  std::string text = "HybridMesh: " + counted(n_nodes(mesh), "node", "nodes");
  if (cells.prisms > 0) text += ", " + counted(cells.prisms, "prism", "prisms");
  if (cells.pyramids > 0) text += ", " + counted(cells.pyramids, "pyramid", "pyramids");
  if (cells.tetrahedra > 0) text += ", " + counted(cells.tetrahedra, "tetrahedron", "tetrahedra");
  if (cells.hexahedra > 0) text += ", " + counted(cells.hexahedra, "hexahedron", "hexahedra");
  return text + ", " + counted(static_cast<std::int64_t>(mesh.mesh.patches.size()), "patch", "patches") + ", " + verdict_text(mesh);
}

double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0;  // Linux counts in KiB
}

std::string worst_quality_text(const CheckReport& report) {
  const std::vector<const GateResult*> troubles = troubles_of(report);
  if (troubles.empty()) return {};
  const MeasureInfo& info = info_of(troubles.front()->measure);
  return fmt::format("{} {:.4g}{}", info.name, in_report_unit(info, reported_value(*troubles.front())), info.is_angle ? " deg" : "");
}

std::string worst_gates_text(const CheckReport& report) {
  const GateState worst = report.quality_state();
  std::string text(to_string(worst));
  if (worst != GateState::warn && worst != GateState::fail) return text;
  const auto is_of_worst = [&](const GateResult& gate) { return gate.state == worst; };
  return text + ":" + gate_names(report, is_of_worst);
}

std::string quality_text(const CheckReport& report) {
  if (!report.quality_measured) return "quality not checked";
  std::string text;
  for (const Consumer consumer : k_consumers) {
    if (!report.consumers.has(consumer)) continue;
    const GateState worst = report.quality_state(consumer);
    text += (text.empty() ? "" : "; ") + std::string(to_string(consumer)) + ": " + verdict_of(report, consumer);
    if (worst != GateState::warn && worst != GateState::fail) continue;
    text += ":" + gate_names(report, [&](const GateResult& gate) { return state_for(gate, consumer) == worst; });
  }
  return text;
}

std::string summary_text(const MeshValue& mesh, Consumers consumers) {
  const CellCounts cells = count_cells(mesh.mesh);
  const volmesh::LayerReport& layer = mesh.origin->report.layer;
  std::optional<CheckReport> shown = mesh.check;
  if (shown) shown->restrict_to(consumers);
  const bool is_measured = shown && shown->quality_measured;
  std::string text = "  verdict     " + verdict_text(mesh) + (is_measured ? "; " + quality_text(*shown) : "") + "\n";
  for (const std::string& change : changes_of(mesh.origin->history)) text += "  changed     " + change + "\n";
  text += fmt::format("  mesh        {} nodes: ", count_text(n_nodes(mesh)));
  const bool has_layers = layer.n_vertices > 0;
  if (has_layers)
    text += fmt::format("{} prisms in {}{} layers, ", count_text(cells.prisms), mesh.mesh.layers.is_uniform() ? "" : "up to ", mesh.mesh.layers.n_layers);
  if (cells.pyramids > 0) text += count_text(cells.pyramids) + " pyramids, ";
  if (cells.hexahedra > 0) text += count_text(cells.hexahedra) + " hexahedra, ";
  text += fmt::format("{} tetrahedra; wall of {} triangles, {:.6g} m long\n", count_text(cells.tetrahedra), count_text(mesh.origin->n_wall_triangles),
                      layer.body_length);
  if (const std::string regions = describe_regions(volume_regions(mesh.mesh)); !regions.empty()) text += "  regions     of fluid: " + regions + "\n";
  if (const volmesh::SliverReport& slivers = mesh.origin->report.slivers; slivers.n_slivers > 0)
    text += fmt::format("  needles     {} sliver triangles of the wall, {} left; {} edges flipped, {} -> {} triangles\n", count_text(slivers.n_slivers),
                        count_text(slivers.n_left), count_text(slivers.n_flips), count_text(slivers.n_given), count_text(slivers.n_triangles));
  if (mesh.origin->report.n_split_triangles > 0)
    text +=
        fmt::format("  splits      {} more triangles on wall and farfield, required by the tetrahedra\n", count_text(mesh.origin->report.n_split_triangles));
  if (has_layers)
    text += fmt::format("  layer       {:.2f} % of the area at full height along the normal, the geometry permits {:.2f} %; mean height {:.4g} m\n",
                        100.0 * layer.coverage, 100.0 * layer.attainable, layer.mean_height);
  for (const volmesh::PatchLayerReport& patch : layer.patches)
    if (patch.truncated > 0.0)
      text += fmt::format("  truncated   {:.2f} % of patch \"{}\", down to {}\n", 100.0 * patch.truncated, patch.name,
                          patch.least_layers == 1 ? "1 layer" : fmt::format("{} layers", patch.least_layers));
  if (layer.n_compressed > 0)
    text += fmt::format("  compressed  {:.2f} % of the area, {} of {} vertices (too low for the requested first height)\n", 100.0 * layer.compressed_area,
                        count_text(layer.n_compressed), count_text(layer.n_vertices));
  if (!layer.collapsed.empty())
    text += fmt::format("  collapsed   {:.2f} % of the area, {}; first at {}: {}\n", 100.0 * layer.collapsed_area,
                        counted(static_cast<std::int64_t>(layer.collapsed.size()), "vertex", "vertices"), format_point(layer.collapsed.front().position),
                        layer.collapsed.front().what);
  if (is_measured) text += troubles_text(*shown, &mesh.mesh);
  text.pop_back();
  return text;
}

std::string wrote_text(const std::vector<std::filesystem::path>& names) {
  std::string written;
  for (const auto& name : names) written += (written.empty() ? "" : ", ") + name.string();
  return "wrote " + written + (names.size() == 1 ? " and " + manifest_path(names.front()).string() : ", each with a manifest beside it (.json)");
}

std::string check_summary_text(const CheckReport& report, bool reports_troubles) {
  if (!report.is_valid()) return to_text(report);
  std::string text = "VALID";
  if (report.quality_measured) text += "; " + quality_text(report);
  text += fmt::format("; every face matched, every cell valid{}; mesh:check{{ details = true }} prints all gates\n",
                      report.intersections_checked ? ", nothing intersects" : "");
  if (!report.quality_measured) return text;
  if (reports_troubles) text += troubles_text(report, nullptr);
  for (const Measure measure : {Measure::cad_distance, Measure::cad_normal})
    if (report.gate(measure).state != GateState::not_checked) text += to_text(report.gate(measure));
  return text;
}

std::string measure_text(const MeshValue& mesh, const RunMeasure& measure) {
  const bool is_own = mesh.origin->report.tetra_engine == "sterna";
  return fmt::format("  seconds     {:.2f} in total on {} threads: {:.2f} in {}, {:.2f} in other steps; peak memory {:.0f} MB here, {:.0f} MB in the {}",
                     measure.wall_seconds, measure.threads, double(mesh.origin->report.tetra_engine_seconds),
                     is_own ? "the own engine" : mesh.origin->report.tetra_engine, rest_seconds(mesh, measure), peak_memory_bytes() / k_bytes_per_mb,
                     mesh.origin->report.tetra_engine_peak_bytes / k_bytes_per_mb, is_own ? "engine's arrays" : "engine's process");
}

std::string stages_text(const RunMeasure& measure) {
  std::string text = "  stages     ";
  for (const StageTime& stage : measure.stages) {
    text += fmt::format(" {} {:.2f}", stage.stage, stage.seconds);
    if (stage.seconds >= k_least_reported) text += fmt::format(" ({:.0f} % busy)", 100.0 * stage.busy_share(measure.threads));
  }
  return text;
}

std::string stats_json(const MeshValue& mesh, const RunMeasure& measure) {
  const CellCounts cells = count_cells(mesh.mesh);
  const volmesh::LayerReport& layer = mesh.origin->report.layer;
  Json json;
  json["schema"] = "sterna-stats-1";
  json["program"] = "sterna " STERNA_VERSION;
  json["triangles"] = mesh.origin->n_wall_triangles;
  json["layers"] = mesh.mesh.layers.n_layers;
  json["nodes"] = n_nodes(mesh);
  json["prisms"] = cells.prisms;
  json["pyramids"] = cells.pyramids;
  json["tetrahedra"] = cells.tetrahedra;
  json["fluid_regions"] = volume_regions(mesh.mesh).size();
  json["body_length"] = layer.body_length;
  json["coverage"] = layer.coverage;
  json["attainable"] = layer.attainable;
  json["attained"] = layer.attained;
  json["target_over_eq1"] = layer.target_over_eq1;
  json["mean_height_share"] = layer.mean_height_share;
  json["mean_height"] = layer.mean_height;
  json["lost_area"] = Json::object();
  for (const auto& [reason, share] : layer.lost_area) json["lost_area"][reason] = share;
  json["vertices"] = layer.n_vertices;
  json["compressed"] = layer.n_compressed;
  json["collapsed"] = layer.collapsed.size();
  json["layer"] = layer_json(layer);
  json["certificate"] = certificate_json(mesh.origin->report.certificate);
  const volmesh::ImproveReport& improvement = mesh.origin->report.improvement;
  json["bad_tetrahedra_of_engine"] = improvement.n_bad_before;
  json["bad_tetrahedra"] = improvement.n_bad_after;
  json["bad_tetrahedra_off_boundary"] = improvement.n_bad_free_after;
  json["bad_tetrahedra_forced"] = improvement.n_forced;
  json["bad_tetrahedra_unforced"] = improvement.n_bad_after - improvement.n_bad_free_after - improvement.n_forced;
  json["tetrahedra_at_boundary"] = improvement.n_at_boundary;
  json["min_dihedral_deg"] = k_degrees * improvement.min_angle_after;
  json["max_dihedral_deg"] = k_degrees * improvement.max_angle_after;
  json["verdict"] = verdict_text(mesh);
  json["measures"] = Json::object();
  if (mesh.check)
    for (const GateResult& gate : mesh.check->gates) {
      if (gate.state == GateState::not_checked) continue;
      const MeasureInfo& info = info_of(gate.measure);
      const double worst = in_report_unit(info, gate.worst);
      json["measures"][std::string(info.name)] = {
          {"state", to_string(gate.state)}, {"worst", std::isfinite(worst) ? Json(worst) : nullptr}, {"share_within", gate.share_within}};
    }
  json["threads"] = measure.threads;
  json["wall_seconds"] = measure.wall_seconds;
  json["engine_seconds"] = double(mesh.origin->report.tetra_engine_seconds);
  json["rest_seconds"] = rest_seconds(mesh, measure);
  json["stage_seconds"] = Json::object();
  for (const StageTime& stage : measure.stages) json["stage_seconds"][stage.stage] = stage.seconds;
  json["stage_busy_share"] = Json::object();
  for (const StageTime& stage : measure.stages) json["stage_busy_share"][stage.stage] = stage.busy_share(measure.threads);
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["engine_peak_memory_bytes"] = double(mesh.origin->report.tetra_engine_peak_bytes);
  return json.dump(2) + "\n";
}

}  // namespace sterna::scripting
