#include "scripting/values/mesh_manifest.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/file/input_hash.h"
#include "io/output/atomic_file.h"
#include "scripting/values/manifest.h"

namespace sterna::scripting {
namespace {

constexpr std::array k_kinds = {PatchKind::wall,    PatchKind::slip,     PatchKind::symmetry, PatchKind::inflow,
                                PatchKind::outflow, PatchKind::farfield, PatchKind::interface};

[[noreturn]] void refuse_mesh_manifest(const InputPath& file, const std::string& problem) {
  throw Error(
      {.code = ErrorCode::file_malformed, .attempted = "reading " + file.name + ".json", .problem = problem, .hint = "delete it, or write the mesh again"});
}

/// Returns a name in a spelling common to all formats, because formats replace unsupported characters by other letters.
std::string plain_name(std::string_view name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (!text.empty() && std::isdigit(static_cast<unsigned char>(text.front()))) text = "patch_" + text;
  return text;
}

/// Names and kinds of a manifest.
class KnownPatches {
 public:
  KnownPatches(const Json& json, const InputPath& file) {
    for (const Json& entry : json.value("patches", Json::array())) {
      const bool is_sound = entry.is_object() && entry.contains("name") && entry["name"].is_string() && entry.contains("kind") && entry["kind"].is_string();
      const auto kind = std::ranges::find_if(k_kinds, [&](PatchKind k) { return is_sound && to_string(k) == entry["kind"].get<std::string>(); });
      if (kind == k_kinds.end()) refuse_mesh_manifest(file, "an entry of its patches has no name, or no kind of patch");
      exact_[entry["name"].get<std::string>()] = *kind;
      plain_[plain_name(entry["name"].get<std::string>())].push_back(*kind);
    }
  }

  std::optional<PatchKind> kind_of(const std::string& name) const {
    if (const auto found = exact_.find(name); found != exact_.end()) return found->second;
    const auto found = plain_.find(plain_name(name));
    if (found == plain_.end()) return std::nullopt;
    const bool is_one = std::ranges::all_of(found->second, [&](PatchKind kind) { return kind == found->second.front(); });
    return is_one ? std::optional(found->second.front()) : std::nullopt;
  }

 private:
  std::map<std::string, PatchKind> exact_;
  std::map<std::string, std::vector<PatchKind>> plain_;  ///< patches by common spelling; several if their names become identical
};

std::optional<PatchId> patch_named(const HybridMesh& mesh, const std::string& name) {
  for (const PatchId p : mesh.patches.ids())
    if (mesh.patches[p].name == name) return p;
  for (const PatchId p : mesh.patches.ids())
    if (plain_name(mesh.patches[p].name) == plain_name(name)) return p;
  return std::nullopt;
}

/// Sets the kinds of patches. Kinds in the second file of the format win, with a warning if the manifest differs.
void add_kinds(HybridMesh& mesh, const KnownPatches& known, const InputPath& file, const RunContext& context) {
  const bool is_beside = !io::format_of(file.path).carries_patch_kinds && io::states_patch_kinds(file.path);
  for (Patch& patch : mesh.patches) {
    const std::optional<PatchKind> kind = known.kind_of(patch.name);
    if (!kind || *kind == patch.kind) continue;
    if (!is_beside) patch.kind = *kind;
    else
      context.warn("patch \"" + patch.name + "\" of " + file.name + " is of kind " + std::string(to_string(patch.kind)) +
                   " in its file of boundary conditions, but of kind " + std::string(to_string(*kind)) + " in " + file.name + ".json: the kind is taken as " +
                   std::string(to_string(patch.kind)));
  }
}

/// Returns the patches with faces that are walls only by default.
std::set<std::string> unknown_kinds(const HybridMesh& mesh, const KnownPatches* known, const InputPath& file) {
  const io::Format& format = io::format_of(file.path);
  // VTK files of other programs identify patches only by numbers.
  const auto is_number = [](const std::string& name) { return name.starts_with("patch_") && name.find_first_not_of("0123456789", 6) == std::string::npos; };
  const bool states_all = io::states_patch_kinds(file.path), is_vtk = format.name.starts_with("VT");
  std::vector<std::uint8_t> has_faces(mesh.patches.size(), 0);
  for (const BoundaryTriangle& face : mesh.boundary_triangles) has_faces[face.patch.index()] = 1;
  for (const BoundaryQuad& face : mesh.boundary_quads) has_faces[face.patch.index()] = 1;
  std::set<std::string> names;
  for (const PatchId p : mesh.patches.ids()) {
    const Patch& patch = mesh.patches[p];
    if (has_faces[p.index()] == 0 || patch.kind != PatchKind::wall || (known && known->kind_of(patch.name))) continue;
    if (!states_all || (is_vtk && is_number(patch.name))) names.insert(patch.name);
  }
  return names;
}

void add_periodic_sides(HybridMesh& mesh, const Json& json, const InputPath& file) {
  if (!mesh.periodic.empty()) return;
  for (const Json& entry : json.value("periodic_sides", Json::array())) {
    const Json& way = entry.is_object() && entry.contains("translation") ? entry["translation"] : Json();
    const bool is_vector = way.is_array() && way.size() == 3 && std::ranges::all_of(way, [](const Json& x) { return x.is_number(); });
    if (!is_vector || !entry.contains("first") || !entry["first"].is_string() || !entry.contains("second") || !entry["second"].is_string())
      refuse_mesh_manifest(file, "an entry of its periodic_sides has no first, second or translation");
    const auto first = patch_named(mesh, entry["first"].get<std::string>()), second = patch_named(mesh, entry["second"].get<std::string>());
    if (!first || !second) refuse_mesh_manifest(file, "its periodic_sides name patches that " + file.name + " does not have");
    mesh.periodic.push_back({*first, *second, {way[0].get<double>(), way[1].get<double>(), way[2].get<double>()}});
  }
}

/// Sets the requested smallest first height and largest growth, if they are numbers. For a member of a family these are h0/f and r^(1/f) (layer_choice.h).
void add_request(HybridMesh& mesh, const Json& json) {
  if (mesh.request.is_known() || json.contains("first_heights")) return;
  const auto number = [](const Json& from, const char* location) -> std::optional<double> {
    const Json::json_pointer at(location);
    return from.contains(at) && from.at(at).is_number() ? std::optional(from.at(at).get<double>()) : std::nullopt;
  };
  const auto height = number(json, "/options/envelope/first_height"), growth = number(json, "/options/envelope/max_growth");
  if (!height || !growth || !(*height > 0.0)) return;
  mesh.request.first_height = *height;
  mesh.request.max_growth = *growth;
  for (const Json& rule : json.value("patch_rules", Json::array())) {
    if (const auto of_patch = number(rule, "/first_height"); of_patch && *of_patch > 0.0)
      mesh.request.first_height = std::min(mesh.request.first_height, *of_patch);
    if (const auto of_patch = number(rule, "/max_growth")) mesh.request.max_growth = std::max(mesh.request.max_growth, *of_patch);
  }
  const double refinement = number(json, "/options/family/refinement").value_or(1.0);
  if (refinement > 0.0 && refinement != 1.0) {
    mesh.request.first_height /= refinement;
    mesh.request.max_growth = std::pow(mesh.request.max_growth, 1.0 / refinement);
  }
}

std::optional<Json> read_json(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}), nullptr, false);
  if (!json.is_object()) return std::nullopt;
  return json;
}

bool is_ours(const Json& json) { return json.value("schema", Json()) == "sterna-manifest-1" || json.value("schema", Json()) == "sterna-surface-1"; }

}  // namespace

std::optional<Json> fitting_manifest(const InputPath& file, const std::string& hash, const RunContext& context) {
  std::optional<Json> json = read_json(manifest_path(file.path));
  if (!json || !is_ours(*json)) return std::nullopt;  // there is none, or it is a file of another program
  if (json->value("output_xxh3_128", Json()) == hash) return json;
  context.warn(
      file.name + ".json is " +
      (json->contains("output_xxh3_128") ? "of another version of " + file.name : "of an older version of sterna and does not identify the mesh file") +
      ": its kinds of patches and options are ignored. Write the file again with sterna, or delete the manifest");
  return std::nullopt;
}

void complete_from_manifest(MeshValue& value, const InputPath& file, const std::string& hash, const RunContext& context) {
  if (io::format_of(file.path).name == "sterna") return;  // contains all these data itself
  const std::optional<Json> manifest = fitting_manifest(file, hash, context);
  const Json json = manifest.value_or(Json::object());
  if (!manifest || json.value("schema", Json()) != "sterna-manifest-1") {  // there is none, or it is that of a surface
    value.unknown_kinds = unknown_kinds(value.mesh, nullptr, file);
    return;
  }
  const KnownPatches known(json, file);
  add_kinds(value.mesh, known, file, context);
  add_periodic_sides(value.mesh, json, file);
  add_request(value.mesh, json);
  value.unknown_kinds = unknown_kinds(value.mesh, &known, file);
}

std::string quoted_list(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "patch \"" : ", \"") + name + "\"";
  return text;
}

std::string why_kinds_are_unknown(const InputPath& file) {
  const std::optional<Json> json = read_json(manifest_path(file.path));
  const std::string manifest = manifest_path(file.name).string();
  return file.name + " has the names of these patches, but not their kinds, and " +
         (json && is_ours(*json) ? "its manifest " + manifest + " is of another version of the file" : "there is no manifest " + manifest + " with kinds");
}

void write_manifest_of_copy(Json json, const std::filesystem::path& to, const std::string& rounding) {
  json["output"] = (to.has_filename() ? to : to.parent_path()).filename().string();
  json["output_xxh3_128"] = io::hash_input(to);
  if (!rounding.empty() && json.contains("quality")) json["quality"] = unmeasured_quality_json(rounding);
  io::write_whole(manifest_path(to), json.dump(2) + "\n");
}

}  // namespace sterna::scripting
