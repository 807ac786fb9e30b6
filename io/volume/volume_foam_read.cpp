// polyMesh reader. It reads points, faces, their cells, and patches, and reconstructs the cells from the faces.
#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "geom/base/error.h"
#include "geom/mesh/periodic.h"
#include "io/grammar/foam_file.h"
#include "io/mesh/face_based_mesh.h"
#include "io/mesh/orientation.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_foam.h"

namespace sterna::io {
namespace {

struct FoamPatch {
  Patch patch;
  std::uint64_t first_face = 0, n_faces = 0;
  std::string neighbour;  ///< neighbour of a cyclic patch
  bool is_guess = false;  ///< neither the type nor the groups nor the name state the kind
};

PatchKind kind_of(std::string_view type, const std::vector<std::string>& groups, std::string_view name) {
  if (type == "wall") return PatchKind::wall;
  if (type == "cyclic") return PatchKind::interface;
  if (type == "symmetry" || type == "symmetryPlane") return PatchKind::symmetry;
  for (const PatchKind kind : {PatchKind::slip, PatchKind::inflow, PatchKind::outflow, PatchKind::farfield, PatchKind::interface})
    if (std::find(groups.begin(), groups.end(), to_string(kind)) != groups.end()) return kind;
  const PatchKind kind = kind_of_name(name);
  return kind == PatchKind::wall ? PatchKind::farfield : kind;
}

/// Reads the value of an entry up to its ";" as a flat list of words.
std::vector<std::string> read_value(FoamFile& file) {
  std::vector<std::string> words;
  for (std::string_view word = file.token(); word != ";"; word = file.token()) {
    if (word.empty() || word == "}") file.fail("found no \";\" behind an entry");
    if (word != "(" && word != ")") words.emplace_back(word);
  }
  return words;
}

std::uint64_t number_in(FoamFile& file, const std::vector<std::string>& words, const std::string& key) {
  if (words.size() != 1 || words[0].empty() || words[0].size() > 18 ||
      !std::all_of(words[0].begin(), words[0].end(), [](char c) { return c >= '0' && c <= '9'; }))
    file.fail("found no number as " + key);
  return std::stoull(words[0]);
}

FoamPatch read_patch(FoamFile& file) {
  FoamPatch patch;
  patch.patch.name = file.token();
  file.expect("{");
  std::string type;
  std::vector<std::string> groups;
  bool has_first = false, has_number = false;
  for (std::string key(file.token()); key != "}"; key = file.token()) {
    if (key.empty()) file.fail("found the end of the file, expected \"}\" behind patch " + quoted_excerpt(patch.patch.name));
    const std::vector<std::string> words = read_value(file);
    if (key == "type" && !words.empty()) type = words[0];
    if (key == "inGroups") groups = words;
    if (key == "neighbourPatch" && words.size() == 1) patch.neighbour = words[0];
    if (key == "nFaces") {
      patch.n_faces = number_in(file, words, "nFaces");
      has_number = true;
    }
    if (key == "startFace") {
      patch.first_face = number_in(file, words, "startFace");
      has_first = true;
    }
  }
  if (!has_first || !has_number || type.empty()) file.fail("patch " + quoted_excerpt(patch.patch.name) + " has no type, nFaces or startFace");
  patch.patch.kind = kind_of(type, groups, patch.patch.name);
  patch.is_guess = type == "patch" && patch.patch.kind == PatchKind::farfield && kind_of_name(patch.patch.name) != PatchKind::farfield &&
                   std::ranges::find(groups, to_string(PatchKind::farfield)) == groups.end();
  if (type != "cyclic") patch.neighbour.clear();
  return patch;
}

/// Reads the patches, which cover the faces from n_internal to n_faces without gaps. Returns the neighbours of cyclic patches, by patch.
std::vector<std::string> read_boundary(const std::filesystem::path& folder, std::uint64_t n_internal, FaceBasedMesh& faces, HybridMesh& mesh,
                                       const RunContext& context) {
  FoamFile file(folder / "boundary", "polyBoundaryMesh", context);
  const std::uint64_t n = file.count("the number of patches", 20);  // "a{type b;nFaces 1;startFace 1;}" is longer
  file.expect("(");
  std::uint64_t next = n_internal;
  std::vector<std::string> neighbours;
  for (std::uint64_t i = 0; i < n; ++i) {
    const FoamPatch patch = read_patch(file);
    if (patch.n_faces > 0 && patch.first_face != next)
      file.fail("patch " + quoted_excerpt(patch.patch.name) + " starts at face " + std::to_string(patch.first_face) + ", expected " + std::to_string(next));
    if (patch.n_faces > faces.n_faces() - next)
      file.fail("patch " + quoted_excerpt(patch.patch.name) + " ends after the last face, " + std::to_string(faces.n_faces() - 1));
    if (patch.is_guess && patch.n_faces > 0)
      context.warn((folder / "boundary").string() + ": patch " + quoted_excerpt(patch.patch.name) +
                   " has type patch, which does not define its kind: the kind farfield is used");
    const PatchId id = mesh.patches.push_back(patch.patch);
    neighbours.push_back(patch.neighbour);
    std::fill_n(faces.patch.begin() + static_cast<std::ptrdiff_t>(next), patch.n_faces, id);
    next += patch.n_faces;
  }
  file.expect(")");
  if (next != faces.n_faces()) file.fail("the patches end at face " + std::to_string(next) + " of " + std::to_string(faces.n_faces()));
  return neighbours;
}

/// Finds pairs of cyclic patches that match by a translation; other pairs (rotated, or with different faces) are reported.
void find_periodic(const std::vector<std::string>& neighbours, HybridMesh& mesh, const RunContext& context) {
  for (const PatchId patch : mesh.patches.ids()) {
    const auto other = std::ranges::find(mesh.patches, neighbours[patch.index()], &Patch::name);
    if (neighbours[patch.index()].empty() || other == mesh.patches.end()) continue;
    const PatchId second(static_cast<std::size_t>(other - mesh.patches.begin()));
    if (second <= patch) continue;
    try {
      mesh.periodic.push_back({patch, second, match_periodic(mesh, patch, second, periodic_tolerance(mesh)).translation});
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_argument) throw;
      context.warn("cyclic patches \"" + mesh.patches[patch].name + "\" and \"" + mesh.patches[second].name +
                   "\" are read as two separate patches: " + error.info().problem);
    }
  }
}

/// Name of the layer zone written by sterna.
constexpr const char* k_layer_zone = "layers";
constexpr std::size_t k_named_zones = 4;  ///< in messages

/// Returns the names of the zones in a file: the words before "{ type cellZone". Their lists may be binary.
std::vector<std::string> zone_names(std::string_view text, const std::string& type) {
  std::vector<std::string> names;
  const auto before = [&](std::size_t at) {  // end of the text before a position, without blanks
    while (at > 0 && std::isspace(static_cast<unsigned char>(text[at - 1])) != 0) --at;
    return at;
  };
  for (std::size_t at = text.find(type); at != std::string_view::npos; at = text.find(type, at + type.size())) {
    const std::size_t key = before(at);
    if (key < 4 || text.substr(key - 4, 4) != "type") continue;
    const std::size_t brace = before(key - 4);
    if (brace == 0 || text[brace - 1] != '{') continue;
    const std::size_t end = before(brace - 1);
    std::size_t begin = end;
    while (begin > 0 && std::isspace(static_cast<unsigned char>(text[begin - 1])) == 0 && text[begin - 1] != '(' && text[begin - 1] != '}') --begin;
    names.emplace_back(text.substr(begin, end - begin));
  }
  return names;
}

/// Warns about zones, sets of cells, faces or points in addition to the patches, which HybridMesh cannot store.
void warn_of_zones(const std::filesystem::path& folder, const RunContext& context) {
  constexpr std::array<std::array<const char*, 3>, 3> k_files = {
      {{"cellZones", "cellZone", "cells"}, {"faceZones", "faceZone", "faces"}, {"pointZones", "pointZone", "points"}}};
  for (const auto& [name, type, items] : k_files) {
    const std::filesystem::path path = packed_or_plain(folder / name);
    std::error_code status;  // files that cannot be accessed are not read
    if (!std::filesystem::is_regular_file(path, status)) continue;
    std::vector<std::string> zones;
    try {
      const FileBuffer buffer = load_file(path, context);
      zones = zone_names(buffer.text(), type);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      context.warn(path.string() + " is left out, because it cannot be read: " + error.info().problem);
    }
    if (const auto own = std::ranges::find(zones, k_layer_zone); own != zones.end() && std::string_view(name) == "cellZones") {
      zones.erase(own);
      context.info(path.string() + ": the zone \"" + std::string(k_layer_zone) + "\" of cells is left out");
    }
    if (zones.empty()) continue;
    std::string text;
    for (std::size_t i = 0; i < std::min(zones.size(), k_named_zones); ++i) text += (i == 0 ? "" : ", ") + quoted_excerpt(zones[i]);
    if (zones.size() > k_named_zones) text += " and " + std::to_string(zones.size() - k_named_zones) + " more";
    context.warn(path.string() + ": " + std::to_string(zones.size()) + (zones.size() == 1 ? " zone" : " zones") + " of " + items + " (" + text + ") " +
                 (zones.size() == 1 ? "is" : "are") +
                 " left out: sterna stores no zones. Patches are kept; create the zones again with topoSet after writing OpenFOAM");
  }
}

}  // namespace

std::filesystem::path polymesh_folder(const std::filesystem::path& path) {
  if (!path.has_filename() && path.has_parent_path()) return polymesh_folder(path.parent_path());  // ends in a slash
  if (path.filename() == "polyMesh") return path;
  std::error_code status;  // if the path cannot be accessed; opening it reports the error
  if (std::filesystem::is_directory(path, status)) return path / "constant" / "polyMesh";
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool is_file = extension == ".foam" || std::filesystem::exists(path, status);
  return (is_file ? path.parent_path() : path) / "constant" / "polyMesh";
}

std::vector<std::filesystem::path> polymesh_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  for (const char* const name : {"points", "faces", "owner", "neighbour", "boundary"}) files.push_back(packed_or_plain(polymesh_folder(path) / name));
  return files;
}

HybridMesh read_volume_foam(const std::filesystem::path& path, const RunContext& context) {
  std::error_code status;
  if (!std::filesystem::exists(path, status))  // the polyMesh beside it may belong to another mesh
    throw Error(
        {.code = ErrorCode::file_not_found, .attempted = "reading " + path.string(), .problem = status ? status.message() : "there is no such file or folder"});
  const std::filesystem::path folder = polymesh_folder(path);
  HybridMesh mesh;
  {
    FoamFile file(folder / "points", "vectorField", context);
    std::vector<Vec3> points = file.vectors("a coordinate");
    if (points.size() >= NodeId::k_invalid) throw_id_overflow(points.size());
    mesh.points.raw().assign(points.begin(), points.end());
  }
  context.progress(0.2);
  FaceBasedMesh faces;
  {
    FoamFile file(folder / "faces", "faceList faceCompactList", context);
    if (file.object_class() == "faceList") file.label_lists("a node of a face", mesh.points.size(), faces.nodes, faces.first);
    else file.compact_label_lists("a node of a face", mesh.points.size(), faces.nodes, faces.first);
  }
  const std::uint64_t n_faces = faces.first.size() - 1;
  context.progress(0.4);
  FoamFile owners(folder / "owner", "labelList", context);
  faces.owner = owners.labels("the cell of a face", n_faces, n_faces);  // limit: a cell has more than one face
  if (faces.owner.size() != n_faces) owners.fail("found " + std::to_string(faces.owner.size()) + " owners for " + std::to_string(n_faces) + " faces");
  FoamFile neighbours(folder / "neighbour", "labelList", context);
  faces.neighbour = neighbours.labels("the cell of a face", n_faces, n_faces);
  const std::uint64_t n_internal = faces.neighbour.size();
  faces.neighbour.resize(n_faces, k_none);
  faces.patch.resize(n_faces);
  for (const std::uint32_t cell : faces.owner) faces.n_cells = std::max<std::uint64_t>(faces.n_cells, cell + 1ull);
  for (std::uint64_t f = 0; f < n_internal; ++f) faces.n_cells = std::max<std::uint64_t>(faces.n_cells, faces.neighbour[f] + 1ull);
  const std::vector<std::string> cyclic = read_boundary(folder, n_internal, faces, mesh, context);
  context.progress(0.6);
  add_cells_and_boundary(faces, mesh, folder.string(), context);
  context.progress(0.9);
  orient_mesh(mesh, context);
  find_periodic(cyclic, mesh, context);
  warn_of_zones(folder, context);
  return mesh;
}

}  // namespace sterna::io
