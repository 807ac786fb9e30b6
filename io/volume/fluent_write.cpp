#include <algorithm>
#include <charconv>
#include <limits>

#include "io/grammar/fluent_parser.h"
#include "io/input/text_limits.h"
#include "io/names/name_rules.h"
#include "io/output/cell_sections.h"
#include "io/output/face_connectivity.h"
#include "io/output/section_output.h"
#include "io/volume/fluent.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_most_faces_of_cell = 6;
constexpr std::size_t k_max_hex = 9;                        // digits of 32 bits and a blank
constexpr std::size_t k_max_face_line = 2 + 6 * k_max_hex;  // "4 n n n n c c\n"
constexpr std::size_t k_max_point_line = 3 * (k_max_real_text + 1);
constexpr int k_fluid_zone = 2, k_interior_zone = 3, k_first_patch_zone = 4;
constexpr std::uint64_t k_types_per_line = 40;

std::string hex(std::uint64_t value) {
  char text[17];
  return {text, std::to_chars(text, text + sizeof text, value, 16).ptr};
}

char* put_hex(char* at, std::uint64_t value, char separator) {
  at = std::to_chars(at, at + k_max_hex, value, 16).ptr;
  *at++ = separator;
  return at;
}

/// Number and name of a zone type.
struct ZoneType {
  int number;
  std::string_view word;
};

ZoneType zone_type(PatchKind kind) {
  switch (kind) {
    case PatchKind::wall:
    case PatchKind::slip: break;
    case PatchKind::symmetry: return {7, "symmetry"};
    case PatchKind::inflow: return {4, "pressure-inlet"};
    case PatchKind::outflow: return {5, "pressure-outlet"};
    case PatchKind::farfield: return {9, "pressure-far-field"};
    case PatchKind::interface: return {24, "interface"};
  }
  return {3, "wall"};
}

char fluent_type(CellKind kind) {
  switch (kind) {
    case CellKind::tetrahedron: return '2';
    case CellKind::hexahedron: return '4';
    case CellKind::pyramid: return '5';
    case CellKind::prism: break;
  }
  return '6';
}

/// Writes the nodes (from 1), reversed so that the normal points into the first cell; then the two cells, with 0 for the outside.
char* put_face(char* at, std::span<const NodeId> nodes, std::uint64_t inner, std::uint64_t outer) {
  *at++ = static_cast<char>('0' + nodes.size());
  *at++ = ' ';
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) at = put_hex(at, std::uint64_t{node->value()} + 1, ' ');
  at = put_hex(at, inner, ' ');
  return put_hex(at, outer, '\n');
}

class FluentWriter {
 public:
  FluentWriter(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context)
      : mesh_(mesh), faces_(mesh, context.part("faces", 0.0, 0.3)), by_patch_(mesh) {
    if (numbering != Numbering::lines) faces_.order_cells(numbering, context.part("numbering", 0.3, 0.3));
    n_faces_ = faces_.n_internal() + mesh.boundary_triangles.size() + mesh.boundary_quads.size();
    require_count(mesh.points.size(), k_max_int32, "nodes", "Fluent", path.string());
    require_count(n_faces_, k_max_int32, "faces", "Fluent", path.string());
  }

  std::vector<OutputSection> sections(const std::vector<std::string>& names) {
    const std::string n_points = hex(mesh_.points.size()), n_cells = hex(faces_.n_cells());
    fixed("(0 \"sterna\")\n(2 3)\n(10 (0 1 " + n_points + " 0 3))\n(12 (0 1 " + n_cells + " 0))\n(13 (0 1 " + hex(n_faces_) + " 0))\n");
    fixed("(10 (1 1 " + n_points + " 1 3)(\n");
    add_points();
    fixed("))\n(12 (" + hex(k_fluid_zone) + " 1 " + n_cells + " 1 0)(\n");
    add_cell_types();
    fixed("\n))\n");
    std::string zones = "(45 (" + std::to_string(k_fluid_zone) + " fluid fluid)())\n";
    std::uint64_t next = 1;
    if (faces_.n_internal() > 0) {
      begin_faces(k_interior_zone, 2, next, faces_.n_internal());
      add_internal_faces();
      fixed("))\n");
      zones += "(45 (" + std::to_string(k_interior_zone) + " interior interior-fluid)())\n";
    }
    for (const PatchId patch : mesh_.patches.ids()) {
      if (by_patch_.count(patch) == 0) continue;
      const int zone = k_first_patch_zone + static_cast<int>(patch.value());
      const ZoneType type = zone_type(mesh_.patches[patch].kind);
      begin_faces(zone, type.number, next, by_patch_.count(patch));
      add_faces(mesh_.boundary_triangles, by_patch_.triangles(patch), [this](std::size_t i) { return faces_.cell_of_triangle(i); });
      add_faces(mesh_.boundary_quads, by_patch_.quads(patch), [this](std::size_t i) { return faces_.cell_of_quad(i); });
      fixed("))\n");
      zones += "(45 (" + std::to_string(zone) + " " + std::string(type.word) + " " + names[patch.index()] + ")())\n";
    }
    fixed(zones);
    return std::move(sections_);
  }

 private:
  void fixed(std::string text) { sections_.push_back(fixed_section(std::move(text))); }

  void begin_faces(int zone, int type, std::uint64_t& next, std::uint64_t n) {
    fixed("(13 (" + hex(static_cast<std::uint64_t>(zone)) + " " + hex(next) + " " + hex(next + n - 1) + " " + hex(static_cast<std::uint64_t>(type)) + " 0)(\n");
    next += n;
  }

  void add_points() {
    sections_.push_back({.n_items = mesh_.points.size(), .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve((end - begin) * k_max_point_line);
                           for (std::uint64_t i = begin; i < end; ++i) {
                             const Point& p = mesh_.points.raw()[i];
                             if (!is_finite(p)) throw_node_not_finite(i);
                             for (std::size_t axis = 0; axis < 3; ++axis) {
                               at = put_real_text(at, p[axis]);
                               *at++ = axis < 2 ? ' ' : '\n';
                             }
                           }
                           out.end_at(at);
                         }});
  }

  void add_cell_types() {
    sections_.push_back({.n_items = faces_.n_cells(), .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve(2 * (end - begin));
                           for (std::uint64_t cell = begin; cell < end; ++cell) {
                             if (cell > 0) *at++ = cell % k_types_per_line == 0 ? '\n' : ' ';
                             *at++ = fluent_type(faces_.kind(cell));
                           }
                           out.end_at(at);
                         }});
  }

  void add_internal_faces() {
    sections_.push_back({.n_items = faces_.n_cells(), .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve((end - begin) * k_most_faces_of_cell * k_max_face_line);
                           faces_.for_each_internal(
                               begin, end, [&](std::uint64_t cell, const CellFace& face) { at = put_face(at, face.span(), cell + 1, face.neighbour + 1ull); });
                           out.end_at(at);
                         }});
  }

  template <class Face, class CellOf>
  void add_faces(const std::vector<Face>& faces, std::span<const std::uint32_t> which, const CellOf& cell_of) {
    sections_.push_back({.n_items = which.size(), .format = [&faces, which, cell_of](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve((end - begin) * k_max_face_line);
                           for (std::uint64_t i = begin; i < end; ++i) at = put_face(at, faces[which[i]].nodes, cell_of(which[i]) + 1ull, 0);
                           out.end_at(at);
                         }});
  }

  const HybridMesh& mesh_;
  MeshFaces faces_;
  FacesByPatch by_patch_;
  std::uint64_t n_faces_ = 0;
  std::vector<OutputSection> sections_;
};

void warn_of_lost_kinds(const HybridMesh& mesh, const std::vector<std::string>& names, const RunContext& context) {
  for (const PatchId patch : mesh.patches.ids()) {
    const PatchKind kind = mesh.patches[patch].kind;
    const ZoneType type = zone_type(kind);
    const PatchKind back = kind_of_fluent_zone(type.number, names[patch.index()]);
    if (back == kind) continue;
    context.warn("patch \"" + names[patch.index()] + "\" (" + std::string(to_string(kind)) + ") is written as a Fluent zone of type " + std::string(type.word) +
                 ", which is read as " + std::string(to_string(back)) + (kind == PatchKind::slip ? ": set its shear stress to zero in Fluent" : ""));
  }
}

}  // namespace

void write_volume_fluent(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_numbered_fluent(mesh, path, Numbering::lines, context);
}

void write_numbered_fluent(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context) {
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "Fluent", .forbidden = "()\"'`,;\\#|", .may_have_blanks = false}, context);
  warn_of_lost_kinds(mesh, names, context);
  FluentWriter writer(mesh, path, numbering, context);
  const std::vector<OutputSection> sections = writer.sections(names);
  AtomicFile file(path);
  write_sections(file, sections, context.part("write", 0.3, 1.0));
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
