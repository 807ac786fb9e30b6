// Reads Gmsh MSH as a surface: triangles and quadrangles of any order by their corners. Volume elements are ignored.
#include "io/surface/surface_msh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "io/grammar/msh_parser.h"
#include "io/mesh/surface_builder.h"
#include "io/names/name_rules.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_max_name = 127;  // Gmsh's limit

class FaceSink final : public MshSink {
 public:
  explicit FaceSink(const std::string& source) : builder_(source) {}
  void reserve_points(std::size_t n) override { builder_.reserve_points(n); }
  void add_point(const Vec3& p) override { builder_.add_point(p); }
  bool takes_any_point() const override { return true; }
  void set_patch(std::string_view name) override { builder_.set_patch(name); }
  void add_face(std::span<const std::uint32_t> corners) override { builder_.add_polygon(corners); }
  void add_cell(std::int64_t, std::span<const std::uint32_t>) override { ++n_cells_; }
  void add_curved_cell() override { ++n_cells_; }
  SurfaceSoup finish(const RunContext& context) {
    SurfaceSoup soup = builder_.finish(context, true);
    soup.n_cells = n_cells_;
    return soup;
  }

 private:
  SurfaceBuilder builder_;
  std::uint64_t n_cells_ = 0;
};

// ---- writing

std::string physical_names(const TriMesh& mesh, const TrianglesByPatch& triangles, const RunContext& context) {
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "Gmsh MSH", .forbidden = "\"", .max_bytes = k_max_name}, context);
  std::string text = "$PhysicalNames\n" + std::to_string(triangles.used_patches().size()) + "\n";
  for (const PatchId patch : triangles.used_patches()) text += "2 " + std::to_string(patch.value() + 1) + " \"" + names[patch.index()] + "\"\n";
  return text + "$EndPhysicalNames\n";
}

/// Writes the entities. Each patch is a surface of the model, for which Gmsh requires the bounding box.
std::string entities(const TriMesh& mesh, const TrianglesByPatch& triangles) {
  std::string text = "$Entities\n0 0 " + std::to_string(triangles.used_patches().size()) + " 0\n";
  for (const PatchId patch : triangles.used_patches()) {
    Box box;
    for (const TriangleId t : triangles.of(patch))
      for (const Point& p : corners(mesh, t)) box.add(p);
    std::array<char, 2 * k_max_point_text> numbers;
    char* at = put_point_text(numbers.data(), box.min);
    *at++ = ' ';
    at = put_point_text(at, box.max);
    const std::string tag = std::to_string(patch.value() + 1);
    text += tag + " " + std::string(numbers.data(), at) + " 1 " + tag + " 0\n";
  }
  return text + "$EndEntities\n";
}

/// Returns lines "<first + i>[ <middle>] a b c" for the triangles of a patch; nodes are counted from 1.
OutputSection element_lines(const TriMesh& mesh, std::span<const TriangleId> triangles, std::uint64_t first, std::string middle) {
  const std::size_t max_bytes = k_max_integer_text + middle.size() + 3 * k_max_id_text + 2;
  return items_section(triangles.size(), max_bytes, [&mesh, triangles, first, middle = std::move(middle)](std::uint64_t i, char* at) {
    at = put_text(put_integer_text(at, static_cast<std::int64_t>(first + i)), middle);
    at = put_corners_text(at, mesh.triangles[triangles[i]], 1);
    *at++ = '\n';
    return at;
  });
}

OutputSection node_tags(std::uint64_t n) {
  return items_section(n, k_max_integer_text + 1, [](std::uint64_t i, char* at) {
    at = put_integer_text(at, static_cast<std::int64_t>(i + 1));
    *at++ = '\n';
    return at;
  });
}

}  // namespace

SurfaceSoup read_msh(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  FaceSink sink(buffer.source);
  const bool has_names = parse_msh(buffer, context, sink);
  SurfaceSoup soup = sink.finish(context);
  soup.has_names = has_names || soup.patch_names.size() > 1;
  return soup;
}

void write_msh(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const TrianglesByPatch triangles(mesh);
  const std::string n_nodes = std::to_string(mesh.n_vertices());
  const std::string n_elements = std::to_string(mesh.n_triangles());
  const std::string entity = triangles.used_patches().empty() ? "1" : std::to_string(triangles.used_patches().front().value() + 1);
  std::vector<OutputSection> sections;
  sections.push_back(fixed_section("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + physical_names(mesh, triangles, context) + entities(mesh, triangles)));
  sections.push_back(fixed_section("$Nodes\n1 " + n_nodes + " 1 " + n_nodes + "\n2 " + entity + " 0 " + n_nodes + "\n"));
  sections.push_back(node_tags(mesh.n_vertices()));
  sections.push_back(point_lines(mesh, ""));
  sections.push_back(fixed_section("$EndNodes\n$Elements\n" + std::to_string(triangles.used_patches().size()) + " " + n_elements + " 1 " + n_elements + "\n"));
  std::uint64_t first = 1;
  for (const PatchId patch : triangles.used_patches()) {
    const auto of_patch = triangles.of(patch);
    sections.push_back(fixed_section("2 " + std::to_string(patch.value() + 1) + " 2 " + std::to_string(of_patch.size()) + "\n"));
    sections.push_back(element_lines(mesh, of_patch, first, " "));
    first += of_patch.size();
  }
  sections.push_back(fixed_section("$EndElements\n"));
  write_file(path, sections, context);
}

void write_msh_2_2(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const TrianglesByPatch triangles(mesh);
  require_count(std::max(mesh.n_vertices(), mesh.n_triangles()), std::numeric_limits<std::int32_t>::max(), "vertices or triangles", "MSH 2.2", path.string());
  std::vector<OutputSection> sections;
  sections.push_back(fixed_section("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + physical_names(mesh, triangles, context) + "$Nodes\n" +
                                   std::to_string(mesh.n_vertices()) + "\n"));
  sections.push_back(items_section(mesh.n_vertices(), k_max_integer_text + k_max_point_text + 2, [&](std::uint64_t i, char* at) {
    at = put_integer_text(at, static_cast<std::int64_t>(i + 1));
    *at++ = ' ';
    at = put_point_text(at, mesh.points.raw()[i]);
    *at++ = '\n';
    return at;
  }));
  sections.push_back(fixed_section("$EndNodes\n$Elements\n" + std::to_string(mesh.n_triangles()) + "\n"));
  std::uint64_t first = 1;
  for (const PatchId patch : triangles.used_patches()) {
    const std::string tag = std::to_string(patch.value() + 1);
    sections.push_back(element_lines(mesh, triangles.of(patch), first, " 2 2 " + tag + " " + tag + " "));
    first += triangles.of(patch).size();
  }
  sections.push_back(fixed_section("$EndElements\n"));
  write_file(path, sections, context);
}

}  // namespace sterna::io
