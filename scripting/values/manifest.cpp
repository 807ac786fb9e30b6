#include "scripting/values/manifest.h"

#include <cmath>
#include <tuple>

#include "geom/mesh/volume_regions.h"
#include "io/file/input_hash.h"
#include "io/output/atomic_file.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/layer_json.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/wake_verbs.h"

namespace sterna::scripting {
namespace {

Json cells_json(const HybridMesh& mesh) {
  const CellCounts cells = count_cells(mesh);
  return {
      {"nodes", mesh.points.size()}, {"prisms", cells.prisms}, {"pyramids", cells.pyramids}, {"tetrahedra", cells.tetrahedra}, {"hexahedra", cells.hexahedra}};
}

/// Returns the hard, target and usual limits that differ from the default limits, in the unit of reports (angles in degrees); empty if none differs. The whole
/// report is the output of `sterna check --json`.
Json own_limits_json(const MeasureInfo& info, const GateLimits& limits) {
  Json json = Json::object();
  for (const auto& [name, own, usual] : {std::tuple("hard", limits.hard, info.limits.hard), std::tuple("target", limits.target, info.limits.target),
                                         std::tuple("usual", limits.usual, info.limits.usual)}) {
    if (own == usual || (std::isnan(own) && std::isnan(usual))) continue;
    json[name] = std::isfinite(own) ? Json(in_report_unit(info, own)) : Json(nullptr);
  }
  return json;
}

Json quality_json(const CheckReport& report) {
  Json measures = Json::object();
  for (const GateResult& gate : report.gates) {
    const MeasureInfo& info = info_of(gate.measure);
    Json entry = {{"gate", info.gate}, {"state", to_string(gate.state)}};
    if (gate.state != GateState::not_checked) {
      const double worst = in_report_unit(info, gate.worst);
      entry["worst"] = std::isfinite(worst) ? Json(worst) : Json(nullptr);
      entry["share_within"] = gate.share_within;
      if (Json limits = own_limits_json(info, gate.limits); !limits.empty()) entry["limits"] = std::move(limits);
    }
    measures[std::string(info.name)] = std::move(entry);
  }
  Json json = {{"verdict", to_string(report.quality_state())}, {"verdict_line", verdict_line(report)}};
  for (const auto& [key, state] : {std::pair("failed", GateState::fail), std::pair("warned", GateState::warn)}) {
    json[key] = Json::array();
    for (const GateResult& gate : report.gates)
      if (gate.state == state) json[key].push_back(info_of(gate.measure).name);
  }
  json["forced"] = Json::object();
  for (const GateResult& gate : report.gates)
    if (gate.n_forced > 0) json["forced"][std::string(info_of(gate.measure).name)] = gate.n_forced;
  json["measures"] = std::move(measures);
  return json;
}

/// Returns the matching sides of the mesh, and the matching error if checked.
Json periodic_sides_json(const MeshValue& mesh) {
  Json list = Json::array();
  for (const PeriodicSides& sides : mesh.mesh.periodic) {
    const std::string &first = mesh.mesh.patches[sides.first].name, &second = mesh.mesh.patches[sides.second].name;
    Json entry = {{"first", first}, {"second", second}, {"translation", {sides.translation.x, sides.translation.y, sides.translation.z}}};
    if (mesh.check)
      for (const PeriodicMatchReport& match : mesh.check->periodic)
        if (match.first == first && match.second == second) entry.update({{"nodes", match.n_nodes}, {"faces", match.n_faces}, {"worst_distance", match.worst}});
    list.push_back(std::move(entry));
  }
  return list;
}

Json improvement_json(const volmesh::ImproveReport& report) {
  Json remaining = Json::array();
  for (const ErrorLocation& location : report.remaining)
    remaining.push_back({{"at", {location.position.x, location.position.y, location.position.z}}, {"what", location.what}});
  return {{"bad_before", report.n_bad_before},
          {"bad_after", report.n_bad_after},
          {"bad_off_boundary", report.n_bad_free_after},
          {"forced", report.n_forced},
          {"unforced", report.n_bad_after - report.n_bad_free_after - report.n_forced},
          {"at_boundary", report.n_at_boundary},
          {"slid_lines", report.n_slid},
          {"remaining", remaining}};
}

void add_report(Json& json, const volmesh::VolumeMeshReport& report) {
  json["layer"] = layer_json(report.layer);
  json["certificate"] = certificate_json(report.certificate);
  json["improvement"] = improvement_json(report.improvement);
  json["tetra_engine"] = report.tetra_engine;
  if (!report.tetra_failures.empty()) json["tetra_failures"] = report.tetra_failures;
  if (!report.tetra_choice.empty()) json["tetra_choice"] = report.tetra_choice;
  if (report.n_split_triangles > 0) json["boundary_triangles_added_by_splits"] = report.n_split_triangles;
  if (report.slivers.n_slivers > 0) json["needles"] = slivers_json(report.slivers);
  if (!report.is_reproducible) json["reproducible"] = "not reproducible: a time or memory limit decided which engine made the tetrahedra";
}

}  // namespace

Json unmeasured_quality_json(const std::string& rounding) {
  return {{"verdict", "not checked"}, {"reason", "not measured on the file: " + rounding},
          {"failed", Json::array()},  {"warned", Json::array()},
          {"forced", Json::object()}, {"measures", Json::object()}};
}

Json regions_json(const HybridMesh& mesh) {
  Json regions = Json::array();
  for (const VolumeRegion& region : volume_regions(mesh)) regions.push_back({{"volume", region.volume}, {"patches", region.patches}});
  return regions;
}

std::string check_json(const CheckReport& report, const HybridMesh& mesh) {
  Json json = Json::parse(to_json(report));
  if (report.is_complete) json["fluid_regions"] = regions_json(mesh);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string check_text(const CheckReport& report, const HybridMesh& mesh) {
  const std::string regions = report.is_complete ? describe_regions(volume_regions(mesh)) : "";
  return to_text(report) + (regions.empty() ? "" : "regions of fluid: " + regions + "\n");
}

void add_request(Json& json, const MeshOrigin& origin) {
  surfmesh::StitchOptions surface = origin.surface_options;
  volmesh::MeshCase volume = origin.options;
  SurfaceHistory history = origin.history;
  OptionTable options = all_options(surface, volume);
  for (Option& option : history_options(history)) options.push_back(std::move(option));
  json["options"] = options_json(options);
  if (const SurfaceRecipe* const recipe = last_of<SurfaceRecipe>(history)) add_recipe(json, *recipe);
  add_changes(json, history);
  if (origin.smooth_angle) json["wall"] = {{"max_smooth_angle", *origin.smooth_angle}};
  if (!volume.patches.empty()) json["patch_rules"] = rules_json(volume.patches);
  if (volume.first_heights)
    json["first_heights"] = {{"by", "a function of location"}, {"least", volume.first_heights->least()}, {"greatest", volume.first_heights->greatest()}};
  if (!volume.sources.empty()) json["sources"] = values_json(volume.sources);
  if (!volume.discs.empty()) json["actuator_discs"] = values_json(volume.discs);
  if (!volume.wakes.empty()) json["wake_sheets"] = values_json(volume.wakes);
  if (!volume.periodic.empty()) json["periodic"] = periodic_json(volume.periodic);
}

Json inputs_json(const std::vector<InputFile>& inputs) {
  Json list = Json::array();
  for (const InputFile& input : inputs) list.push_back({{"file", input.name}, {"xxh3_128", input.hash}});
  return list;
}

Json manifest_of(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed, const std::string& hash, const std::string& rounding) {
  Json json = {{"schema", "sterna-manifest-1"}, {"program", "sterna " STERNA_VERSION}, {"output", output.filename().string()}};
  if (!hash.empty()) json["output_xxh3_128"] = hash;
  json["seed"] = seed;
  json["inputs"] = inputs_json(mesh.inputs);
  if (mesh.origin) add_request(json, *mesh.origin);
  json["patches"] = Json::array();
  for (const Patch& patch : mesh.mesh.patches) json["patches"].push_back({{"name", patch.name}, {"kind", to_string(patch.kind)}});
  if (!mesh.mesh.periodic.empty()) json["periodic_sides"] = periodic_sides_json(mesh);
  json["mesh"] = cells_json(mesh.mesh);
  json["fluid_regions"] = regions_json(mesh.mesh);
  if (mesh.origin) add_report(json, mesh.origin->report);
  json["verdict"] = !mesh.check ? "not checked" : mesh.check->is_valid() ? "VALID" : "INVALID";
  if (mesh.check && mesh.check->quality_measured) json["quality"] = rounding.empty() ? quality_json(*mesh.check) : unmeasured_quality_json(rounding);
  return json;
}

std::string manifest_json(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed, const std::string& hash,
                          const std::string& rounding) {
  return manifest_of(mesh, output, seed, hash, rounding).dump(2) + "\n";
}

std::filesystem::path manifest_path(const std::filesystem::path& output) { return (output.has_filename() ? output : output.parent_path()).string() + ".json"; }

void write_manifest(const MeshValue& mesh, const std::filesystem::path& output, const RunContext& context, std::string_view format) {
  const std::string rounding = mesh.check ? io::rounding_of_volume_file(mesh.mesh, output, context, format) : std::string();
  io::write_whole(manifest_path(output), manifest_json(mesh, output, context.seed(), io::hash_input(output), rounding));
}

}  // namespace sterna::scripting
