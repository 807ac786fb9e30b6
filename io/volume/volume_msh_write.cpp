// MSH 4.1 writer. Entities carry the groups: there is one surface per patch, and one volume, to which all nodes belong.
#include <algorithm>
#include <cctype>
#include <limits>

#include "io/grammar/msh_parser.h"
#include "io/names/name_rules.h"
#include "io/output/cell_sections.h"
#include "io/output/section_output.h"
#include "io/volume/volume_msh.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_longest_msh_name = 127;  // Gmsh reads no more characters
constexpr std::int32_t k_fluid_group = 10;       // differs from all patch numbers, because some converters mix up equal numbers of a patch and the fluid
constexpr std::size_t k_max_msh_row = 9 * (k_max_integer_text + 1);

std::int64_t msh_type(CellKind kind) {
  switch (kind) {
    case CellKind::tetrahedron: return k_msh_tetrahedron;
    case CellKind::pyramid: return k_msh_pyramid;
    case CellKind::prism: return k_msh_prism;
    case CellKind::hexahedron: break;
  }
  return k_msh_hexahedron;
}

class MshWriter {
 public:
  MshWriter(const HybridMesh& mesh, const std::filesystem::path& path, std::vector<std::string> names)
      : mesh_(mesh), cells_(mesh), faces_(mesh), names_(std::move(names)) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    is_text_ = !name.ends_with(".bin.msh");
    require_count(mesh.patches.size(), std::numeric_limits<std::int32_t>::max() - 1, "patches", "Gmsh", path.string());
    fluid_group_ = std::max(k_fluid_group, static_cast<std::int32_t>(mesh.patches.size()) + 1);
    for (const PatchId patch : mesh.patches.ids())
      if (faces_.count(patch) > 0) used_.push_back(patch);
    for (const Point& p : mesh.points) box_.add(p);
    if (mesh.points.empty()) box_ = {.min = {}, .max = {}};
  }

  std::vector<OutputSection> sections() {
    raw(is_text_ ? "$MeshFormat\n4.1 0 8\n" : "$MeshFormat\n4.1 1 8\n");
    if (!is_text_) {
      small(1);
      raw("\n");
    }
    raw("$EndMeshFormat\n");
    add_names();
    add_entities();
    add_nodes();
    add_elements();
    flush();
    return std::move(sections_);
  }

 private:
  // ---- numbers, as text or bytes; a row of text ends with end_row()

  void raw(std::string_view bytes) { pending_ += bytes; }
  void small(std::int64_t value) {
    put([&](char* at) { return put_small(at, value); });
  }
  void large(std::uint64_t value) {
    put([&](char* at) { return put_large(at, value); });
  }
  void real(double value) {
    put([&](char* at) { return put_real(at, value); });
  }
  void end_row() {
    if (is_text_) pending_.back() = '\n';
  }
  template <class Put>
  void put(const Put& put_at) {
    std::array<char, k_max_real_text + 1> bytes;
    raw({bytes.data(), static_cast<std::size_t>(put_at(bytes.data()) - bytes.data())});
  }
  char* put_small(char* at, std::int64_t value) const {
    if (!is_text_) return put_bytes(at, static_cast<std::int32_t>(value), std::endian::little);
    at = put_integer_text(at, value);
    *at++ = ' ';
    return at;
  }
  char* put_large(char* at, std::uint64_t value) const {
    if (!is_text_) return put_bytes(at, value, std::endian::little);
    at = put_integer_text(at, static_cast<std::int64_t>(value));
    *at++ = ' ';
    return at;
  }
  char* put_real(char* at, double value) const {
    if (!is_text_) return put_bytes(at, value, std::endian::little);
    at = put_real_text(at, value);
    *at++ = ' ';
    return at;
  }
  void flush() {
    if (!pending_.empty()) sections_.push_back(fixed_section(std::move(pending_)));
    pending_.clear();
  }

  // ---- sections

  void add_names() {
    raw("$PhysicalNames\n" + std::to_string(used_.size() + 1) + "\n");
    for (const PatchId patch : used_) raw("2 " + std::to_string(patch.value() + 1) + " \"" + names_[patch.index()] + "\"\n");
    raw("3 " + std::to_string(fluid_group_) + " \"fluid\"\n$EndPhysicalNames\n");
  }

  void put_entity(std::int64_t tag, std::int64_t group) {
    small(tag);
    for (const Point& corner : {box_.min, box_.max})
      for (std::size_t axis = 0; axis < 3; ++axis) real(corner[axis]);
    large(1);
    small(group);
  }

  void add_entities() {
    raw("$Entities\n");
    for (const std::uint64_t n : {std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{used_.size()}, std::uint64_t{1}}) large(n);
    end_row();
    for (const PatchId patch : used_) {
      put_entity(patch.value() + 1, patch.value() + 1);
      large(0);
      end_row();
    }
    put_entity(1, fluid_group_);
    large(used_.size());
    for (const PatchId patch : used_) small(patch.value() + 1);
    end_row();
    end_section("$EndEntities\n");
  }

  void end_section(std::string_view end) {
    if (!is_text_) raw("\n");
    raw(end);
  }

  void add_nodes() {
    const std::uint64_t n = mesh_.points.size();
    raw("$Nodes\n");
    for (const std::uint64_t value : {std::uint64_t{1}, n, std::uint64_t{1}, n}) large(value);
    end_row();
    for (const int value : {3, 1, 0}) small(value);
    large(n);
    end_row();
    flush();
    sections_.push_back({.n_items = n, .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve((end - begin) * k_max_msh_row);
                           for (std::uint64_t i = begin; i < end; ++i) {
                             at = put_large(at, i + 1);
                             if (is_text_) at[-1] = '\n';
                           }
                           out.end_at(at);
                         }});
    sections_.push_back({.n_items = n, .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve((end - begin) * k_max_msh_row);
                           for (std::uint64_t i = begin; i < end; ++i) {
                             const Point& p = mesh_.points.raw()[i];
                             if (!is_finite(p)) throw_node_not_finite(i);
                             for (std::size_t axis = 0; axis < 3; ++axis) at = put_real(at, p[axis]);
                             if (is_text_) at[-1] = '\n';
                           }
                           out.end_at(at);
                         }});
    end_section("$EndNodes\n");
  }

  char* put_element(char* at, std::uint64_t tag, std::span<const NodeId> nodes) const {
    at = put_large(at, tag);
    for (const NodeId node : nodes) at = put_large(at, std::uint64_t{node.value()} + 1);
    if (is_text_) at[-1] = '\n';
    return at;
  }

  void begin_block(int dimension, std::int64_t entity, std::int64_t type, std::uint64_t n) {
    small(dimension);
    small(entity);
    small(type);
    large(n);
    end_row();
    flush();
  }

  template <class Face>
  void add_faces(PatchId patch, std::int64_t type, const std::vector<Face>& faces, std::span<const std::uint32_t> which, std::uint64_t& next) {
    if (which.empty()) return;
    begin_block(2, patch.value() + 1, type, which.size());
    sections_.push_back({.n_items = which.size(), .format = [this, &faces, which, first = next](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                           char* at = out.reserve((end - begin) * k_max_msh_row);
                           for (std::uint64_t i = begin; i < end; ++i) at = put_element(at, first + i, faces[which[i]].nodes);
                           out.end_at(at);
                         }});
    next += which.size();
  }

  void add_elements() {
    std::uint64_t n_blocks = 0;
    for (const PatchId patch : used_) n_blocks += (faces_.triangles(patch).empty() ? 0 : 1) + (faces_.quads(patch).empty() ? 0 : 1);
    for (const CellKind kind : k_kinds_in_file) n_blocks += cells_.count(kind) > 0 ? 1 : 0;
    const std::uint64_t n = mesh_.boundary_triangles.size() + mesh_.boundary_quads.size() + cells_.total();
    raw("$Elements\n");
    for (const std::uint64_t value : {n_blocks, n, std::uint64_t{1}, n}) large(value);
    end_row();
    std::uint64_t next = 1;
    for (const PatchId patch : used_) {
      add_faces(patch, k_msh_triangle, mesh_.boundary_triangles, faces_.triangles(patch), next);
      add_faces(patch, k_msh_quad, mesh_.boundary_quads, faces_.quads(patch), next);
    }
    for (const CellKind kind : k_kinds_in_file) {
      const std::uint64_t n_cells = cells_.count(kind);
      if (n_cells == 0) continue;
      begin_block(3, 1, msh_type(kind), n_cells);
      sections_.push_back({.n_items = n_cells, .format = [this, kind, first = next](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                             char* at = out.reserve((end - begin) * k_max_msh_row);
                             std::uint64_t tag = first + begin;
                             cells_.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) { at = put_element(at, tag++, nodes); });
                             out.end_at(at);
                           }});
      next += n_cells;
    }
    end_section("$EndElements\n");
  }

  const HybridMesh& mesh_;
  CellSections cells_;
  FacesByPatch faces_;
  std::vector<std::string> names_;
  bool is_text_ = true;
  std::int32_t fluid_group_ = 0;
  std::vector<PatchId> used_;  ///< patches with faces
  Box box_;
  std::string pending_;
  std::vector<OutputSection> sections_;
};

}  // namespace

void write_volume_msh(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  MshWriter writer(mesh, path, names_by_rules(mesh.patches, {.format = "Gmsh", .forbidden = "\"", .max_bytes = k_longest_msh_name}, context));
  const std::vector<OutputSection> sections = writer.sections();
  AtomicFile file(path);
  write_sections(file, sections, context);
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
