#include "surfmesh/stitch/patches.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

bool is_allowed(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-'; }

/// Returns the number of bytes of the UTF-8 character at a position; 0 if there is none.
std::size_t bytes_of_character(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const std::size_t n = first < 0x80 ? 1 : first >= 0xc2 && first < 0xe0 ? 2 : first >= 0xe0 && first < 0xf0 ? 3 : first >= 0xf0 && first < 0xf5 ? 4 : 0;
  if (n == 0 || at + n > text.size()) return 0;
  for (std::size_t k = 1; k < n; ++k)
    if ((byte(at + k) & 0xc0) != 0x80) return 0;
  const bool is_overlong = n > 2 && ((first == 0xe0 && byte(at + 1) < 0xa0) || (first == 0xf0 && byte(at + 1) < 0x90));
  const bool is_surrogate = first == 0xed && byte(at + 1) >= 0xa0;
  const bool is_beyond = first == 0xf4 && byte(at + 1) >= 0x90;
  return is_overlong || is_surrogate || is_beyond ? 0 : n;
}

/// Returns the string unchanged if it is UTF-8; other bytes are read as Latin-1.
std::string as_utf8(std::string_view text) {
  bool is_utf8 = true;
  for (std::size_t at = 0, n = 0; is_utf8 && at < text.size(); at += n) {
    n = bytes_of_character(text, at);
    is_utf8 = n > 0;
  }
  if (is_utf8) return std::string(text);
  std::string converted;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 0x80) converted += c;
    else converted += {static_cast<char>(0xc0 | (u >> 6)), static_cast<char>(0x80 | (u & 0x3f))};
  }
  return converted;
}

/// Returns true for control characters, non-ASCII blanks and zero-width marks of more than one byte.
bool is_blank_character(std::string_view character) {
  if (character.size() == 2) return character[0] == '\xc2' && static_cast<unsigned char>(character[1]) <= 0xa0;  // this is the range U+0080 to U+00A0
  if (character == "\xe3\x80\x80" || character == "\xef\xbb\xbf") return true;                                   // these are U+3000 and U+FEFF
  if (character.substr(0, 2) != "\xe2\x80") return false;
  const auto last = static_cast<unsigned char>(character[2]);
  return last <= 0x8f || (last >= 0xa8 && last <= 0xaf);  // these are U+2000 to U+200F and U+2028 to U+202F
}

/// Returns `name`, or name_2, name_3 and so on if it is taken. Adds the result to `taken`.
std::string unique_name(const std::string& name, std::set<std::string>& taken) {
  std::string candidate = name;
  for (int n = 2; !taken.insert(candidate).second; ++n) candidate = name + "_" + std::to_string(n);
  return candidate;
}

/// Returns the file name without folder, ".gz" and extension.
std::string stem_of(const std::string& source) {
  std::filesystem::path path = std::filesystem::path(source).filename();
  if (path.extension() == ".gz") path = path.stem();
  return clean_name(path.stem().string());
}

}  // namespace

std::string clean_name(std::string_view given) {
  const std::string name = as_utf8(given);
  std::string clean;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t n = std::max<std::size_t>(bytes_of_character(name, at), 1);
    if (n > 1 ? !is_blank_character(name.substr(at, n)) : is_allowed(name[at])) clean.append(name, at, n);
    else if (!clean.empty() && clean.back() != '_') clean += '_';
    at += n;
  }
  while (!clean.empty() && clean.back() == '_') clean.pop_back();
  return clean;
}

std::vector<std::string> clean_patch_names(const std::vector<SurfaceSoup>& soups, std::vector<std::string>* messages) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const SurfaceSoup& soup : soups) {
    for (const std::string& given : soup.patch_names) {
      std::string name = soup.has_names ? clean_name(given) : std::string();
      if (name.empty() && soups.size() > 1) name = stem_of(soup.source);
      if (name.empty()) name = "wall";
      names.push_back(unique_name(name, taken));
      if (messages && soup.has_names && !given.empty() && names.back() != given)
        messages->push_back("the patch \"" + as_utf8(given) + "\" of " + soup.source + " was renamed to \"" + names.back() + "\"");
    }
  }
  return names;
}

TriMesh make_mesh(const WorkingSurface& surface, const std::vector<std::string>& names) {
  TriMesh mesh;
  std::vector<VertexId> vertex(surface.points.size());
  std::vector<char> is_used(names.size(), 0);
  for (const std::uint32_t p : surface.patch) is_used[p] = 1;
  std::vector<PatchId> patch(names.size());
  for (std::size_t p = 0; p < names.size(); ++p)
    if (is_used[p]) patch[p] = mesh.patches.push_back({names[p], PatchKind::wall});
  mesh.triangles.reserve(surface.n_facets());
  mesh.triangle_patch.reserve(surface.n_facets());
  for (std::size_t t = 0; t < surface.n_facets(); ++t) {
    TriangleVertices triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      VertexId& v = vertex[surface.facets[t][k]];
      if (!v.is_valid()) v = mesh.points.push_back(surface.points[surface.facets[t][k]]);
      triangle[k] = v;
    }
    mesh.triangles.push_back(triangle);
    mesh.triangle_patch.push_back(patch[surface.patch[t]]);
  }
  return mesh;
}

void split_patches(TriMesh& mesh, double angle, const RunContext& context) {
  const Topology topology(mesh, context);
  Column<TriangleId, Vec3> normal(mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    normal[t] = area_vector(c[0], c[1], c[2]);
  }
  Column<TriangleId, PatchId> region(mesh.n_triangles(), PatchId());
  std::vector<PatchId> region2patch;
  std::vector<std::uint32_t> n_regions(mesh.patches.size(), 0);
  std::vector<TriangleId> stack;
  for (const TriangleId start : mesh.triangles.ids()) {
    if (region[start].is_valid()) continue;
    const PatchId patch = mesh.triangle_patch[start];
    const PatchId current(static_cast<std::uint64_t>(region2patch.size()));
    region2patch.push_back(patch);
    ++n_regions[patch.index()];
    region[start] = current;
    stack.push_back(start);
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId twin = topology.twin(halfedge(t, k));
        if (!twin.is_valid()) continue;
        const TriangleId u = triangle_of(twin);
        if (region[u].is_valid() || mesh.triangle_patch[u] != patch || angle_between(normal[t], normal[u]) > angle) continue;
        region[u] = current;
        stack.push_back(u);
      }
    }
  }
  std::set<std::string> taken;
  for (const Patch& patch : mesh.patches)
    if (n_regions[static_cast<std::size_t>(&patch - mesh.patches.raw().data())] == 1) taken.insert(patch.name);
  Column<PatchId, Patch> patches;
  std::vector<std::uint32_t> number(mesh.patches.size(), 0);
  for (const PatchId from : region2patch) {
    Patch patch = mesh.patches[from];
    if (n_regions[from.index()] > 1) patch.name = unique_name(patch.name + "_" + std::to_string(++number[from.index()]), taken);
    patches.push_back(std::move(patch));
  }
  mesh.patches = std::move(patches);
  mesh.triangle_patch = std::move(region);
}

}  // namespace sterna::surfmesh
