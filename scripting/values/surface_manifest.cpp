#include "scripting/values/surface_manifest.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "geom/base/error.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "io/file/input_hash.h"
#include "io/output/atomic_file.h"
#include "scripting/values/manifest.h"
#include "scripting/values/patch_rules.h"

namespace sterna::scripting {
namespace {

constexpr const char* k_schema = "sterna-surface-1";

Json point_json(const Point& p) { return {p.x, p.y, p.z}; }

Json faces_json(const surfmesh::SurfaceMeshReport& report) {
  Json list = Json::array();
  for (const surfmesh::FaceMeshSummary& face : report.faces) {
    if (face.n_triangles == 0) continue;
    list.push_back({{"face", face.face.value()},
                    {"name", face.name},
                    {"triangles", face.n_triangles},
                    {"min_angle", k_degrees * face.min_angle},
                    {"max_angle", k_degrees * face.max_angle},
                    {"min_angle_at", point_json(face.worst_location)},
                    {"outside_20_130", face.n_outside_20_130},
                    {"max_normal_angle", k_degrees * face.max_normal_angle},
                    {"normal_at", point_json(face.normal_location)}});
  }
  return list;
}

Json quality_json(const surfmesh::SurfaceMeshReport& report) {
  Json json = {{"min_angle", k_degrees * report.min_angle},
               {"max_angle", k_degrees * report.max_angle},
               {"angle_quantile_1_percent", k_degrees * report.angle_quantile_1},
               {"share_20_130", report.share_20_130},
               {"mean_radius_ratio", report.mean_radius_ratio},
               {"least_angles_by_10_degrees", report.least_angles}};
  if (report.worst_face.is_valid()) {
    const surfmesh::FaceMeshSummary& worst = report.faces[report.worst_face.index()];
    json["worst"] = {{"face", worst.name}, {"at", point_json(worst.worst_location)}};
  }
  json["max_smooth_angle"] = {{"degrees", k_degrees * report.max_smooth_angle}, {"at", point_json(report.smooth_angle_location)}};
  json["edges_to_surfaces"] = {{"metres", report.max_edge_distance}, {"at", point_json(report.edge_distance_location)}};
  json["edges_beyond_tolerance"] = report.loose_edges.size();
  json["share_normals_within_curvature_angle"] = report.share_normals;
  json["crossings"] = report.n_crossings;
  json["absorbed"] = Json::array();
  for (const surfmesh::AbsorbedPart& part : report.absorbed)
    json["absorbed"].push_back({{"what", part.what}, {"at", point_json(part.location)}, {"metres", part.size}});
  json["faces"] = faces_json(report);
  return json;
}

[[noreturn]] void refuse_manifest(const InputPath& file, const std::string& problem) {
  throw Error(
      {.code = ErrorCode::file_malformed, .attempted = "reading " + file.name + ".json", .problem = problem, .hint = "delete it, or write the surface again"});
}

/// Returns true if the normals of a surface point into the fluid, that is, inwards in total.
bool encloses_fluid(const TriMesh& mesh) {
  if (mesh.points.empty()) return false;
  const Point origin = mesh.points[VertexId(0)];
  double volume = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    volume += tet_volume(origin, a, b, c);
  }
  return volume < 0.0;
}

std::map<std::string, PatchKind> kinds_of(const Json& json, const InputPath& file) {
  std::map<std::string, PatchKind> kinds;
  const Json list = json.value("patches", Json::array());
  for (const Json& patch : list) {
    const bool is_sound = patch.is_object() && patch.contains("name") && patch["name"].is_string() && patch.contains("kind") && patch["kind"].is_string();
    bool is_known = false;
    for (const PatchKind kind :
         {PatchKind::wall, PatchKind::slip, PatchKind::symmetry, PatchKind::inflow, PatchKind::outflow, PatchKind::farfield, PatchKind::interface}) {
      if (!is_sound || patch["kind"].get<std::string>() != to_string(kind)) continue;
      kinds[patch["name"].get<std::string>()] = kind;
      is_known = true;
    }
    if (!is_known) refuse_manifest(file, "an entry of its patches has no name, or no kind of patch");
  }
  return kinds;
}

SurfaceHistory history_of(const Json& json, const InputPath& file) {
  try {
    return read_changes(json);
  } catch (const Json::exception&) {
    refuse_manifest(file, "its changes are not a list of strings");
  }
}

}  // namespace

std::string surface_manifest_json(const SurfaceValue& surface, const std::filesystem::path& written) {
  Json json = {{"schema", k_schema},
               {"program", "sterna " STERNA_VERSION},
               {"output", written.filename().string()},
               {"output_xxh3_128", io::hash_input(written)},
               {"inputs", inputs_json(surface.inputs)}};
  const SurfaceRecipe* const recipe = last_of<SurfaceRecipe>(surface.history);
  if (recipe || surface.mesh_report) {
    surfmesh::SurfaceMeshOptions options = recipe ? recipe->options : surfmesh::SurfaceMeshOptions{};
    json["options"] = options_json(sterna::options_of(options));
  }
  if (recipe) add_rules(json, *recipe);
  json["patches"] = Json::array();
  Column<PatchId, std::int64_t> n_triangles(surface.mesh.patches.size(), 0);
  for (const PatchId patch : surface.mesh.triangle_patch) ++n_triangles[patch];
  for (const PatchId patch : surface.mesh.patches.ids())
    json["patches"].push_back(
        {{"name", surface.mesh.patches[patch].name}, {"kind", to_string(surface.mesh.patches[patch].kind)}, {"triangles", n_triangles[patch]}});
  add_changes(json, surface.history);
  if (!surface.layers.empty()) json["layers"] = rules_json(surface.layers);
  json["mesh"] = {{"vertices", surface.mesh.n_vertices()},
                  {"triangles", surface.mesh.n_triangles()},
                  {"closed", surface.report.is_closed},
                  {"encloses_fluid", surface.mesh_report || surface.report.is_closed ? encloses_fluid(surface.mesh) : surface.options.fluid == "inside"}};
  if (surface.mesh_report) {
    json["mesh"]["free_edges"] = surface.mesh_report->n_free_edges;
    json["quality"] = quality_json(*surface.mesh_report);
  } else if (surface.smooth_angle) {
    json["quality"] = {{"max_smooth_angle", {{"degrees", k_degrees * *surface.smooth_angle}}}};
  }
  return json.dump(2) + "\n";
}

bool has_surface_manifest(const SurfaceValue& surface) {
  return surface.mesh_report || surface.smooth_angle || !surface.layers.empty() || !changes_of(surface.history).empty() ||
         std::ranges::any_of(surface.mesh.patches, [](const Patch& patch) { return patch.kind != PatchKind::wall; });
}

void write_surface_manifest(const SurfaceValue& surface, const std::filesystem::path& written) {
  io::write_whole(manifest_path(written), surface_manifest_json(surface, written));
}

std::optional<KnownSurface> read_surface_manifest(const InputPath& file, const std::string& hash, const RunContext& context) {
  std::ifstream in(manifest_path(file.path), std::ios::binary);
  if (!in) return std::nullopt;
  const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}), nullptr, false);
  if (!json.is_object() || json.value("schema", Json()) != k_schema) return std::nullopt;  // a file of another program
  if (json.value("output_xxh3_128", Json()) != hash) {
    context.warn(file.name + ".json belongs to another version of " + file.name +
                 ": its kinds of patches and layer options are ignored. Write the surface again, or delete the manifest");
    return std::nullopt;
  }
  const Json::json_pointer pointer("/quality/max_smooth_angle/degrees");
  std::optional<double> smooth_angle;
  if (json.contains("quality")) {
    if (!json.contains(pointer) || !json.at(pointer).is_number() || !(json.at(pointer).get<double>() >= 0.0 && json.at(pointer).get<double>() <= 180.0))
      refuse_manifest(file, "its quality.max_smooth_angle.degrees is not an angle");
    smooth_angle = json.at(pointer).get<double>() / k_degrees;
  }
  const Json::json_pointer inside("/mesh/encloses_fluid");
  const bool encloses = json.contains(inside) && json.at(inside).is_boolean() && json.at(inside).get<bool>();
  return KnownSurface{smooth_angle, kinds_of(json, file), encloses, layer_rules_of_json(json.value("layers", Json::array())), history_of(json, file)};
}

void set_kinds(Column<PatchId, Patch>& patches, const std::map<std::string, PatchKind>& kinds) {
  for (Patch& patch : patches)
    if (const auto kind = kinds.find(patch.name); kind != kinds.end()) patch.kind = kind->second;
}

}  // namespace sterna::scripting
