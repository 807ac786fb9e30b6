#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>

#include "io/input/text_limits.h"
#include "io/mesh/surface_boundary.h"
#include "io/names/names_file.h"
#include "io/output/cell_sections.h"
#include "io/output/section_output.h"
#include "io/volume/medit.h"

namespace sterna::io {
namespace {

constexpr std::int64_t k_fluid = 1;  // reference of all cells
constexpr std::size_t k_max_row = 9 * (k_max_integer_text + 1);
constexpr std::array<std::pair<MeditSection, CellKind>, 4> k_cell_sections = {{{k_medit_tetrahedra, CellKind::tetrahedron},
                                                                               {k_medit_prisms, CellKind::prism},
                                                                               {k_medit_pyramids, CellKind::pyramid},
                                                                               {k_medit_hexahedra, CellKind::hexahedron}}};

class MeditWriter {
 public:
  MeditWriter(const HybridMesh& mesh, const std::filesystem::path& path) : mesh_(mesh), cells_(mesh) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    is_text_ = name.ends_with(".mesh");
    const bool fits_32 = mesh.points.size() <= k_max_int32 && cells_.total() <= k_max_int32;
    for (const int version : {2, 3, 4})
      if (name.ends_with(".v" + std::to_string(version) + ".meshb")) version_ = version;
    const bool is_given = version_ != 0;
    if (!is_given) version_ = !fits_32 ? 4 : 2;
    if (is_text_) return;
    if (!is_given && version_ == 2 && total_bytes() > k_max_int32) version_ = 3;
    if (version_ < 4)
      require_count(std::max<std::uint64_t>(mesh.points.size(), cells_.total()), k_max_int32, "vertices or cells",
                    "Medit's version " + std::to_string(version_), path.string());
    if (version_ == 2) require_count(total_bytes(), k_max_int32, "bytes", "Medit's version 2", path.string());
  }

  std::vector<OutputSection> sections() {
    if (is_text_) {
      raw("MeshVersionFormatted 2\nDimension 3\n");
    } else {
      number(1, 4);
      number(static_cast<std::uint64_t>(version_), 4);
      begin_section(k_medit_dimension, 4);
      number(3, 4);
    }
    add_vertices();
    add_faces(k_medit_triangles, mesh_.boundary_triangles);
    add_faces(k_medit_quads, mesh_.boundary_quads);
    for (const auto& [section, kind] : k_cell_sections) add_cells(section, kind);
    if (is_text_) {
      raw("End\n");
    } else {
      number(static_cast<std::uint64_t>(k_medit_end), 4);
      number(0, offset_bytes());
    }
    flush();
    return std::move(sections_);
  }

 private:
  std::size_t offset_bytes() const { return version_ >= 3 ? 8 : 4; }
  std::size_t integer_bytes() const { return version_ >= 4 ? 8 : 4; }
  std::uint64_t section_bytes(std::uint64_t n, std::uint64_t row_bytes) const { return n == 0 ? 0 : 4 + offset_bytes() + integer_bytes() + n * row_bytes; }
  std::uint64_t row_bytes(const MeditSection& section) const {
    return (section.n_nodes + 1) * integer_bytes() + (section.n_nodes == 0 ? 3 * sizeof(double) : 0);
  }

  std::uint64_t total_bytes() const {
    std::uint64_t n = 8 + (4 + offset_bytes() + 4) + (4 + offset_bytes());
    n += section_bytes(mesh_.points.size(), row_bytes(k_medit_vertices));
    n += section_bytes(mesh_.boundary_triangles.size(), row_bytes(k_medit_triangles)) + section_bytes(mesh_.boundary_quads.size(), row_bytes(k_medit_quads));
    for (const auto& [section, kind] : k_cell_sections) n += section_bytes(cells_.count(kind), row_bytes(section));
    return n;
  }

  void raw(std::string_view bytes) { pending_ += bytes; }
  void number(std::uint64_t value, std::size_t n_bytes) {
    std::array<char, 8> bytes;
    char* const end =
        n_bytes == 8 ? put_bytes(bytes.data(), value, std::endian::little) : put_bytes(bytes.data(), static_cast<std::uint32_t>(value), std::endian::little);
    raw({bytes.data(), static_cast<std::size_t>(end - bytes.data())});
  }
  void flush() {
    offset_ += pending_.size();
    if (!pending_.empty()) sections_.push_back(fixed_section(std::move(pending_)));
    pending_.clear();
  }

  void begin_section(std::int32_t code, std::uint64_t payload_bytes) {
    flush();
    number(static_cast<std::uint64_t>(code), 4);
    number(offset_ + 4 + offset_bytes() + payload_bytes, offset_bytes());
  }

  /// Adds rows written by put(at, i).
  void add_rows(const MeditSection& section, std::uint64_t n, OutputSection rows) {
    if (n == 0) return;
    if (is_text_) {
      raw(std::string(section.keyword) + "\n" + std::to_string(n) + "\n");
    } else {
      begin_section(section.code, integer_bytes() + n * row_bytes(section));
      number(n, integer_bytes());
    }
    flush();
    rows.n_items = n;
    sections_.push_back(std::move(rows));
    if (!is_text_) offset_ += n * row_bytes(section);
  }

  char* put_integer(char* at, std::int64_t value, char separator) const {
    if (is_text_) {
      at = put_integer_text(at, value);
      *at++ = separator;
      return at;
    }
    return version_ >= 4 ? put_bytes(at, value, std::endian::little) : put_bytes(at, static_cast<std::int32_t>(value), std::endian::little);
  }

  char* put_row(char* at, std::span<const NodeId> nodes, std::int64_t reference) const {
    for (const NodeId node : nodes) at = put_integer(at, std::int64_t{node.value()} + 1, ' ');
    return put_integer(at, reference, '\n');
  }

  void add_vertices() {
    add_rows(k_medit_vertices, mesh_.points.size(), {.format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
               char* at = out.reserve((end - begin) * k_max_row);
               for (std::uint64_t i = begin; i < end; ++i) {
                 const Point& p = mesh_.points.raw()[i];
                 if (!is_finite(p)) throw_node_not_finite(i);
                 for (std::size_t axis = 0; axis < 3; ++axis) {
                   if (!is_text_) {
                     at = put_bytes(at, p[axis], std::endian::little);
                     continue;
                   }
                   at = put_real_text(at, p[axis]);
                   *at++ = ' ';
                 }
                 at = put_integer(at, 0, '\n');
               }
               out.end_at(at);
             }});
  }

  template <class Face>
  void add_faces(const MeditSection& section, const std::vector<Face>& faces) {
    add_rows(section, faces.size(), {.format = [this, &faces](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
               char* at = out.reserve((end - begin) * k_max_row);
               for (std::uint64_t i = begin; i < end; ++i) at = put_row(at, faces[i].nodes, std::int64_t{faces[i].patch.value()} + 1);
               out.end_at(at);
             }});
  }

  void add_cells(const MeditSection& section, CellKind kind) {
    add_rows(section, cells_.count(kind), {.format = [this, kind](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
               char* at = out.reserve((end - begin) * k_max_row);
               cells_.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) { at = put_row(at, nodes, k_fluid); });
               out.end_at(at);
             }});
  }

  const HybridMesh& mesh_;
  CellSections cells_;
  bool is_text_ = false;
  int version_ = 0;
  std::uint64_t offset_ = 0;  ///< bytes before `pending_`
  std::string pending_;
  std::vector<OutputSection> sections_;
};

}  // namespace

void write_volume_medit(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const FacesByPatch checked(mesh);  // rejects faces without patch
  MeditWriter writer(mesh, path);
  const std::vector<OutputSection> sections = writer.sections();
  AtomicFile names(names_path(path));
  names.append(names_text(mesh.patches, context));
  AtomicFile file(path);
  write_sections(file, sections, context);
  const StageTimer timer(context, "sync");
  file.commit();
  names.commit();
}

void write_surface_medit(const TriMesh& surface, const std::filesystem::path& path, const RunContext& context) {
  write_volume_medit(as_boundary(surface, Winding::kept), path, context);
}

}  // namespace sterna::io
