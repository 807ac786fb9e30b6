// SU2 writer. The file is a sequence of sections of uniform lines.
#include <charconv>
#include <limits>

#include "io/grammar/vtk_cells.h"
#include "io/input/text_limits.h"
#include "io/names/patch_names.h"
#include "io/output/cell_sections.h"
#include "io/output/section_output.h"
#include "io/volume/volume_su2.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_max_id = 10;
constexpr std::size_t k_max_su2_point_line = 3 * (k_max_real_text + 1);
constexpr std::size_t k_max_cell_line = 2 + 8 * (k_max_id + 1) + 1;
constexpr std::size_t k_max_su2_face_line = 1 + 4 * (k_max_id + 1) + 1;

void check_count(std::uint64_t n, const std::string& what, const std::filesystem::path& path) { require_count(n, k_max_int32, what, "SU2", path.string()); }

char* put_id(char* at, NodeId node) {
  *at++ = ' ';
  return std::to_chars(at, at + k_max_id, node.value()).ptr;
}

OutputSection point_section(const HybridMesh& mesh) {
  return {.n_items = mesh.points.size(), .format = [&mesh](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * k_max_su2_point_line);
            for (std::uint64_t i = begin; i < end; ++i) {
              const Point& p = mesh.points.raw()[i];
              if (!is_finite(p)) throw_node_not_finite(i);
              at = put_real_text(at, p.x);
              *at++ = ' ';
              at = put_real_text(at, p.y);
              *at++ = ' ';
              at = put_real_text(at, p.z);
              *at++ = '\n';
            }
            out.end_at(at);
          }};
}

OutputSection cell_section(const CellSections& cells, CellKind kind) {
  return {.n_items = cells.count(kind), .format = [&cells, kind](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * k_max_cell_line);
            const int type = vtk_type(kind);
            const auto order = vtk_order(kind);
            cells.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) {
              *at++ = static_cast<char>('0' + type / 10);
              *at++ = static_cast<char>('0' + type % 10);
              for (std::size_t i = 0; i < nodes.size(); ++i) at = put_id(at, nodes[order[i]]);
              *at++ = '\n';
            });
            out.end_at(at);
          }};
}

/// Returns the section of the faces `which` of `faces`, all of one patch.
template <class Face>
OutputSection face_section(const std::vector<Face>& faces, std::span<const std::uint32_t> which, int type) {
  return {.n_items = which.size(), .format = [&faces, which, type](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * k_max_su2_face_line);
            for (std::uint64_t i = begin; i < end; ++i) {
              *at++ = static_cast<char>('0' + type);
              for (const NodeId node : faces[which[i]].nodes) at = put_id(at, node);
              *at++ = '\n';
            }
            out.end_at(at);
          }};
}

std::vector<OutputSection> sections_of(const HybridMesh& mesh, const CellSections& cells, const FacesByPatch& faces, const std::vector<std::string>& names,
                                       const std::filesystem::path& path) {
  check_count(mesh.points.size(), "nodes", path);
  check_count(cells.total(), "cells", path);
  std::vector<OutputSection> sections;
  sections.push_back(fixed_section("NDIME= 3\nNPOIN= " + std::to_string(mesh.points.size()) + "\n"));
  sections.push_back(point_section(mesh));
  sections.push_back(fixed_section("NELEM= " + std::to_string(cells.total()) + "\n"));
  for (const CellKind kind : k_kinds_in_file) sections.push_back(cell_section(cells, kind));
  std::size_t n_markers = 0;
  for (const PatchId patch : mesh.patches.ids()) n_markers += faces.count(patch) > 0 ? 1 : 0;
  sections.push_back(fixed_section("NMARK= " + std::to_string(n_markers) + "\n"));
  for (const PatchId patch : mesh.patches.ids()) {
    const std::uint64_t n_faces = faces.count(patch);
    if (n_faces == 0) continue;  // SU2 accepts empty markers, meshio does not
    check_count(n_faces, "faces of patch " + names[patch.index()], path);
    sections.push_back(fixed_section("MARKER_TAG= " + names[patch.index()] + "\nMARKER_ELEMS= " + std::to_string(n_faces) + "\n"));
    sections.push_back(face_section(mesh.boundary_triangles, faces.triangles(patch), k_vtk_triangle));
    sections.push_back(face_section(mesh.boundary_quads, faces.quads(patch), k_vtk_quad));
  }
  return sections;
}

}  // namespace

void write_volume_su2(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const CellSections cells(mesh);
  const FacesByPatch faces(mesh);
  const std::vector<std::string> names = su2_marker_names(mesh.patches, context);
  const std::vector<OutputSection> sections = sections_of(mesh, cells, faces, names, path);
  AtomicFile file(path);
  write_sections(file, sections, context);
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
