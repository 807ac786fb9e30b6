// SU2 writer. The file is a sequence of sections of uniform lines; sections are cut into chunks of lines, formatted in parallel, written in order.
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>

#include "geom/base/error.h"
#include "io/atomic_file.h"
#include "io/cell_sections.h"
#include "io/ordered_output.h"
#include "io/patch_names.h"
#include "io/volume_su2.h"
#include "io/vtk_cells.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_max_count = std::numeric_limits<std::int32_t>::max();  // SU2 reads counts with atoi
constexpr std::size_t k_lines_per_chunk = 4096;                                  // about 250 kB of text
constexpr std::size_t k_max_real = 24;                                           // "-2.2250738585072014e-308"
constexpr std::size_t k_max_id = 10;
constexpr std::size_t k_max_point_line = 3 * (k_max_real + 1);
constexpr std::size_t k_max_cell_line = 2 + 8 * (k_max_id + 1) + 1;
constexpr std::size_t k_max_face_line = 1 + 4 * (k_max_id + 1) + 1;

/// Lines that are formatted alike: `format` appends lines [begin, end).
struct Section {
  std::uint64_t n_lines = 0;
  std::function<void(std::uint64_t begin, std::uint64_t end, ByteBuffer& out)> format;
};

void check_count(std::uint64_t n, const std::string& what, const std::filesystem::path& path) {
  if (n <= k_max_count) return;
  throw Error({.code = ErrorCode::overflow,
               .attempted = "writing " + path.string(),
               .problem = std::to_string(n) + " " + what + ", but SU2 counts no further than " + std::to_string(k_max_count),
               .hint = "use a coarser mesh or a format with 64-bit counts"});
}

char* put_id(char* at, NodeId node) {
  *at++ = ' ';
  return std::to_chars(at, at + k_max_id, node.value()).ptr;
}

char* put_real(char* at, double value) { return std::to_chars(at, at + k_max_real, value).ptr; }

Section text_section(std::string text) {
  return {.n_lines = 1, .format = [text = std::move(text)](std::uint64_t, std::uint64_t, ByteBuffer& out) { out.append(text); }};
}

[[noreturn]] void throw_not_finite(std::uint64_t node) {
  throw Error({.code = ErrorCode::mesh_invalid,
               .attempted = "writing a volume mesh",
               .problem = "the coordinates of node " + std::to_string(node) + " are not finite"});
}

Section point_section(const HybridMesh& mesh) {
  return {.n_lines = mesh.points.size(), .format = [&mesh](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * k_max_point_line);
            for (std::uint64_t i = begin; i < end; ++i) {
              const Point& p = mesh.points.raw()[i];
              if (!is_finite(p)) throw_not_finite(i);
              at = put_real(at, p.x);
              *at++ = ' ';
              at = put_real(at, p.y);
              *at++ = ' ';
              at = put_real(at, p.z);
              *at++ = '\n';
            }
            out.end_at(at);
          }};
}

Section cell_section(const CellSections& cells, CellKind kind) {
  return {.n_lines = cells.count(kind), .format = [&cells, kind](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
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

/// Faces `which` of `faces`, all of one patch.
template <class Face>
Section face_section(const std::vector<Face>& faces, std::span<const std::uint32_t> which, int type) {
  return {.n_lines = which.size(), .format = [&faces, which, type](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * k_max_face_line);
            for (std::uint64_t i = begin; i < end; ++i) {
              *at++ = static_cast<char>('0' + type);
              for (const NodeId node : faces[which[i]].nodes) at = put_id(at, node);
              *at++ = '\n';
            }
            out.end_at(at);
          }};
}

std::vector<Section> sections_of(const HybridMesh& mesh, const CellSections& cells, const FacesByPatch& faces,
                                 const std::vector<std::string>& names, const std::filesystem::path& path) {
  check_count(mesh.points.size(), "nodes", path);
  check_count(cells.total(), "cells", path);
  std::vector<Section> sections;
  sections.push_back(text_section("NDIME= 3\nNPOIN= " + std::to_string(mesh.points.size()) + "\n"));
  sections.push_back(point_section(mesh));
  sections.push_back(text_section("NELEM= " + std::to_string(cells.total()) + "\n"));
  for (const CellKind kind : k_kinds_in_file) sections.push_back(cell_section(cells, kind));
  std::size_t n_markers = 0;
  for (const PatchId patch : mesh.patches.ids()) n_markers += faces.count(patch) > 0 ? 1 : 0;
  sections.push_back(text_section("NMARK= " + std::to_string(n_markers) + "\n"));
  for (const PatchId patch : mesh.patches.ids()) {
    const std::uint64_t n_faces = faces.count(patch);
    if (n_faces == 0) continue;  // SU2 accepts empty markers, meshio does not
    check_count(n_faces, "faces of patch " + names[patch.index()], path);
    sections.push_back(text_section("MARKER_TAG= " + names[patch.index()] + "\nMARKER_ELEMS= " + std::to_string(n_faces) + "\n"));
    sections.push_back(face_section(mesh.boundary_triangles, faces.triangles(patch), k_vtk_triangle));
    sections.push_back(face_section(mesh.boundary_quads, faces.quads(patch), k_vtk_quad));
  }
  return sections;
}

/// A chunk of lines of one section.
struct Chunk {
  const Section* section;
  std::uint64_t begin, end;
};

std::vector<Chunk> chunks_of(const std::vector<Section>& sections) {
  std::vector<Chunk> chunks;
  for (const Section& section : sections)
    for (std::uint64_t begin = 0; begin < section.n_lines; begin += k_lines_per_chunk)
      chunks.push_back({&section, begin, std::min<std::uint64_t>(begin + k_lines_per_chunk, section.n_lines)});
  return chunks;
}

}  // namespace

void write_volume_su2(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const CellSections cells(mesh);
  const FacesByPatch faces(mesh);
  const std::vector<std::string> names = su2_marker_names(mesh.patches, context);
  const std::vector<Section> sections = sections_of(mesh, cells, faces, names, path);
  const std::vector<Chunk> chunks = chunks_of(sections);
  AtomicFile file(path);
  write_ordered(
      file, chunks.size(),
      [&](std::size_t i, ByteBuffer& out) { chunks[i].section->format(chunks[i].begin, chunks[i].end, out); }, context);
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
