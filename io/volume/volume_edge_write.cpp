// Writer of .bmsh. Tables are column-major: all first nodes of a group, then all second nodes. A node's header states the number of children before they are
// written, so the tree is laid out first.
#include <algorithm>
#include <cctype>
#include <limits>
#include <map>

#include "io/input/text_limits.h"
#include "io/names/edge_conditions.h"
#include "io/names/name_rules.h"
#include "io/output/cell_sections.h"
#include "io/output/section_output.h"
#include "io/volume/volume_edge.h"

namespace sterna::io {
namespace {

/// Largest record, in bytes. Fortran record markers are signed: longer records would be split into parts, which most readers do not support.
constexpr std::uint64_t k_max_record = k_max_int32 - 8;
constexpr std::size_t k_name_bytes = 16, k_type_bytes = 4, k_text_bytes = 72;
constexpr std::array<CellKind, 4> k_edge_kinds = {CellKind::hexahedron, CellKind::prism, CellKind::pyramid, CellKind::tetrahedron};

std::string_view edge_type(CellKind kind) {
  switch (kind) {
    case CellKind::tetrahedron: return "tetra4";
    case CellKind::pyramid: return "penta5";
    case CellKind::prism: return "penta6";
    case CellKind::hexahedron: break;
  }
  return "hexa8";
}

std::string padded(std::string_view text, std::size_t n) {
  std::string result(text.substr(0, n));
  result.resize(n, ' ');
  return result;
}

class EdgeWriter {
 public:
  EdgeWriter(const HybridMesh& mesh, bool is_v2, const std::filesystem::path& path, const std::vector<std::string>& names)
      : mesh_(mesh), is_v2_(is_v2), path_(path.string()), cells_(mesh), faces_(mesh), names_(names), is_wide_(is_v2 && mesh.points.size() > k_max_int32) {
    if (is_v2) return;
    require_count(mesh.points.size(), k_max_int32, "nodes", "Edge's version 1", path_ + " (64-bit: .v2.bmsh)");
    require_count(3 * sizeof(double) * mesh.points.size(), k_max_record, "bytes of coordinates", "a record of Edge's version 1", path_ + " (64-bit: .v2.bmsh)");
  }

  std::vector<OutputSection> sections() {
    if (is_v2_) raw(padded("FFA-format-v2", 32));
    node("unstr_grid_data", 'N', 0, 0, 2);
    text("title", "sterna");
    std::uint64_t n_children = 2;  // name, coordinates
    for (const CellKind kind : k_edge_kinds) n_children += groups(cells_.count(kind), static_cast<std::uint64_t>(n_nodes(kind))).size();
    for (const PatchId patch : mesh_.patches.ids()) n_children += faces_.count(patch) > 0 ? 1 : 0;
    node("region", 'N', 0, 0, n_children);
    text("region_name", "fluid domain");
    coordinates();
    for (const CellKind kind : k_edge_kinds) cell_groups(kind);
    for (const PatchId patch : mesh_.patches.ids())
      if (faces_.count(patch) > 0) boundary(patch);
    flush();
    return std::move(sections_);
  }

 private:
  struct Group {
    std::uint64_t begin, end;
  };

  /// Splits the elements [0, n) into as few groups as the record limit allows.
  std::vector<Group> groups(std::uint64_t n, std::uint64_t n_nodes) const {
    const std::uint64_t most = is_v2_ ? std::max<std::uint64_t>(n, 1) : k_max_record / (n_nodes * sizeof(std::int32_t));
    std::vector<Group> result;
    for (std::uint64_t begin = 0; begin < n; begin += most) result.push_back({begin, std::min(begin + most, n)});
    return result;
  }

  void raw(std::string_view bytes) { pending_ += bytes; }
  void number(std::uint64_t value) {
    std::array<char, 8> bytes;
    raw({bytes.data(), static_cast<std::size_t>((is_v2_ ? put_bytes(bytes.data(), static_cast<std::int64_t>(value), std::endian::big)
                                                        : put_bytes(bytes.data(), static_cast<std::int32_t>(value), std::endian::big)) -
                                                bytes.data())});
  }
  void flush() {
    if (!pending_.empty()) sections_.push_back(fixed_section(std::move(pending_)));
    pending_.clear();
  }

  void node(std::string_view name, char type, std::uint64_t n_columns, std::uint64_t n_rows, std::uint64_t n_children) {
    const bool is_number = type != 'N' && type != 'L';
    const std::string type_text = std::string(1, type) + (is_number && n_columns * n_rows > 1 ? "F" : "");
    if (!is_v2_) number(k_name_bytes + k_type_bytes + 12);
    raw(padded(name, k_name_bytes));
    raw(padded(type_text, k_type_bytes));
    number(n_columns);
    number(n_rows);
    number(n_children);
    if (!is_v2_) number(k_name_bytes + k_type_bytes + 12);
  }

  void text(std::string_view name, std::string_view value) {
    node(name, 'L', 1, 1, 0);
    number(k_text_bytes);
    raw(padded(value, k_text_bytes));
    if (!is_v2_) number(k_text_bytes);
  }

  /// Adds a table filled by `format`, value by value in column-major order.
  void table(std::string_view name, char type, std::size_t value_bytes, std::uint64_t n_columns, std::uint64_t n_rows, OutputSection values) {
    node(name, type, n_columns, n_rows, 0);
    const std::uint64_t n = n_columns * n_rows;
    number(is_v2_ ? n : n * value_bytes);
    flush();
    values.n_items = n;
    sections_.push_back(std::move(values));
    if (!is_v2_) number(n * value_bytes);
  }

  /// Splits the values [begin, end) of a table by column: f(column, first row, end row).
  template <class F>
  static void by_column(std::uint64_t begin, std::uint64_t end, std::uint64_t n_rows, const F& f) {
    while (begin < end) {
      const std::uint64_t column = begin / n_rows, stop = std::min(end, (column + 1) * n_rows);
      f(column, begin - column * n_rows, stop - column * n_rows);
      begin = stop;
    }
  }

  void coordinates() {
    const std::uint64_t n = mesh_.points.size();
    table("coordinates", 'D', sizeof(double), 3, n, {.format = [this, n](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * sizeof(double));
            by_column(begin, end, n, [&](std::uint64_t axis, std::uint64_t from, std::uint64_t to) {
              for (std::uint64_t i = from; i < to; ++i) {
                const Point& p = mesh_.points.raw()[i];
                if (!is_finite(p)) throw_node_not_finite(i);
                at = put_bytes(at, p[axis], std::endian::big);
              }
            });
            out.end_at(at);
          }});
  }

  char* put_node(char* at, NodeId node) const {
    return is_wide_ ? put_bytes(at, std::int64_t{node.value()} + 1, std::endian::big)
                    : put_bytes(at, static_cast<std::int32_t>(node.value() + 1), std::endian::big);
  }
  char integer_type() const { return is_wide_ ? 'J' : 'I'; }
  std::size_t integer_bytes() const { return is_wide_ ? 8 : 4; }

  void cell_groups(CellKind kind) {
    const auto n_columns = static_cast<std::uint64_t>(n_nodes(kind));
    for (const Group& group : groups(cells_.count(kind), n_columns)) {
      node("element_group", 'N', 0, 0, 2);
      text("element_type", edge_type(kind));
      const std::uint64_t n_rows = group.end - group.begin;
      table("element_nodes", integer_type(), integer_bytes(), n_columns, n_rows,
            {.format = [this, kind, group, n_rows](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
              char* at = out.reserve((end - begin) * sizeof(std::int64_t));
              by_column(begin, end, n_rows, [&](std::uint64_t column, std::uint64_t from, std::uint64_t to) {
                cells_.for_each(kind, group.begin + from, group.begin + to, [&](std::span<const NodeId> nodes, int) { at = put_node(at, nodes[column]); });
              });
              out.end_at(at);
            }});
    }
  }

  /// Returns the nodes reversed: the normal points into the fluid.
  template <class Face>
  void face_groups(std::string_view type, const std::vector<Face>& faces, std::span<const std::uint32_t> which) {
    constexpr std::size_t n_columns = std::tuple_size_v<decltype(Face{}.nodes)>;
    for (const Group& group : groups(which.size(), n_columns)) {
      node("belem_group", 'N', 0, 0, 2);
      text("bound_elem_type", type);
      const std::uint64_t n_rows = group.end - group.begin;
      table("bound_elem_nodes", integer_type(), integer_bytes(), n_columns, n_rows,
            {.format = [this, &faces, which, group, n_rows](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
              char* at = out.reserve((end - begin) * sizeof(std::int64_t));
              by_column(begin, end, n_rows, [&](std::uint64_t column, std::uint64_t from, std::uint64_t to) {
                for (std::uint64_t i = from; i < to; ++i) at = put_node(at, faces[which[group.begin + i]].nodes[n_columns - 1 - column]);
              });
              out.end_at(at);
            }});
    }
  }

  void boundary(PatchId patch) {
    const auto triangles = faces_.triangles(patch), quads = faces_.quads(patch);
    node("boundary", 'N', 0, 0, 1 + groups(triangles.size(), 3).size() + groups(quads.size(), 4).size());
    text("boundary_name", names_[patch.index()]);
    face_groups("tria3", mesh_.boundary_triangles, triangles);
    face_groups("quad4", mesh_.boundary_quads, quads);
  }

  const HybridMesh& mesh_;
  bool is_v2_;
  std::string path_;
  CellSections cells_;
  FacesByPatch faces_;
  const std::vector<std::string>& names_;
  bool is_wide_;
  std::string pending_;
  std::vector<OutputSection> sections_;
};

}  // namespace

void write_volume_edge(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  std::string lower = path.filename().string();
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "Edge", .forbidden = "'*", .max_bytes = k_text_bytes}, context);
  EdgeWriter writer(mesh, lower.ends_with(".v2.bmsh"), path, names);
  const std::vector<OutputSection> sections = writer.sections();
  const FacesByPatch faces(mesh);
  std::vector<std::string> written = names;
  for (const PatchId patch : mesh.patches.ids())
    if (faces.count(patch) == 0) written[patch.index()].clear();
  AtomicFile conditions(edge_conditions_path(path));
  conditions.append(edge_conditions_text(mesh.patches, written, context));
  AtomicFile file(path);
  write_sections(file, sections, context);
  const StageTimer timer(context, "sync");
  file.commit();
  conditions.commit();
}

}  // namespace sterna::io
