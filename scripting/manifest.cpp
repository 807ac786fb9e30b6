#include "scripting/manifest.h"

#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "scripting/layer_json.h"

namespace sterna::scripting {
namespace {

using Json = nlohmann::ordered_json;

Json cells_json(const HybridMesh& mesh) {
  const CellCounts cells = count_cells(mesh);
  return {
      {"nodes", mesh.points.size()}, {"prisms", cells.prisms}, {"pyramids", cells.pyramids}, {"tetrahedra", cells.tetrahedra}, {"hexahedra", cells.hexahedra}};
}

}  // namespace

std::string manifest_json(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed) {
  Json json;
  json["schema"] = "sterna-manifest-1";
  json["program"] = "sterna " STERNA_VERSION;
  json["output"] = output.filename().string();
  json["seed"] = seed;
  json["inputs"] = Json::array();
  for (const InputFile& input : mesh.inputs) json["inputs"].push_back({{"file", input.name}, {"xxh3_128", input.hash}});
  if (mesh.origin) {
    surfmesh::StitchOptions surface = mesh.origin->surface_options;
    volmesh::VolumeMeshOptions volume = mesh.origin->options;
    json["options"] = Json::parse(options_to_json(all_options(surface, volume)));
  }
  json["patches"] = Json::array();
  for (const Patch& patch : mesh.mesh.patches) json["patches"].push_back({{"name", patch.name}, {"kind", to_string(patch.kind)}});
  json["mesh"] = cells_json(mesh.mesh);
  if (mesh.origin) {
    json["layer"] = Json::parse(layer_json(mesh.origin->layer));
    json["certificate"] = Json::parse(certificate_json(mesh.origin->certificate));
    json["tetra_engine"] = mesh.origin->tetra_engine;
    if (!mesh.origin->tetra_failures.empty()) json["tetra_failures"] = mesh.origin->tetra_failures;
    if (!mesh.origin->is_reproducible) json["reproducible"] = "not reproducible: a time or memory limit decided which engine made the tetrahedra";
  }
  json["verdict"] = !mesh.check ? "not checked" : mesh.check->is_valid() ? "VALID" : "INVALID";
  return json.dump(2) + "\n";
}

void write_manifest(const MeshValue& mesh, const std::filesystem::path& output, const RunContext& context) {
  io::AtomicFile file(output.string() + ".json");
  file.append(manifest_json(mesh, output, context.seed()));
  file.commit();
}

}  // namespace sterna::scripting
