// TAU writer: the head of a classic NetCDF file (dimensions, attributes, variables with their places), then each variable's values, big endian.
#include <algorithm>
#include <cctype>
#include <limits>

#include "io/cell_sections.h"
#include "io/section_output.h"
#include "io/tau_mapping.h"
#include "io/tau_names.h"
#include "io/volume_tau.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_max_cdf2_variable = (std::uint64_t{1} << 32) - 4;
constexpr std::uint32_t k_int = 4;
constexpr std::uint32_t k_double = 6;
constexpr std::uint32_t k_char = 2;

struct Dimension {
  std::string name;
  std::uint64_t length = 0;
};
struct Variable {
  std::string name;
  std::vector<std::size_t> dimensions;
  std::uint32_t type = k_int;
  std::uint64_t n_bytes = 0;
  OutputSection content;
};

/// The head in CDF-2 or CDF-5, whose counts have 64 bits.
class HeadWriter {
 public:
  explicit HeadWriter(bool is_cdf5) : is_cdf5_(is_cdf5) { bytes_ = is_cdf5 ? "CDF\5" : "CDF\2"; }

  std::string write(const std::vector<Dimension>& dimensions, const std::vector<std::pair<std::string, std::string>>& attributes, const std::vector<Variable>& variables) {
    wide(0);  // no records
    list(10, dimensions.size());
    for (const Dimension& dimension : dimensions) {
      text(dimension.name);
      wide(dimension.length);
    }
    list(12, attributes.size());
    for (const auto& [name, value] : attributes) {
      text(name);
      narrow(k_char);
      text(value);
    }
    list(11, variables.size());
    std::uint64_t begin = bytes_.size();
    for (const Variable& variable : variables) begin += entry_size(variable);
    for (const Variable& variable : variables) {
      text(variable.name);
      wide(variable.dimensions.size());
      for (const std::size_t dimension : variable.dimensions) wide(dimension);
      list(0, 0);
      narrow(variable.type);
      wide(variable.n_bytes);
      put(begin, 8);
      begin += variable.n_bytes;
    }
    return std::move(bytes_);
  }

 private:
  void put(std::uint64_t value, unsigned n) {
    for (unsigned k = n; k-- > 0;) bytes_ += static_cast<char>(value >> (8 * k) & 0xff);
  }
  void narrow(std::uint32_t value) { put(value, 4); }
  void wide(std::uint64_t value) { put(value, is_cdf5_ ? 8 : 4); }
  void list(std::uint32_t tag, std::uint64_t n) {
    narrow(tag);
    wide(n);
  }
  void text(const std::string& value) {
    wide(value.size());
    bytes_ += value;
    bytes_.append((4 - value.size() % 4) % 4, '\0');
  }
  std::uint64_t entry_size(const Variable& variable) const {
    const std::uint64_t n_wide = is_cdf5_ ? 8 : 4;
    return n_wide + (variable.name.size() + 3) / 4 * 4 + n_wide + n_wide * variable.dimensions.size() + 4 + n_wide + 4 + n_wide + 8;
  }

  bool is_cdf5_;
  std::string bytes_;
};

class TauWriter {
 public:
  TauWriter(const HybridMesh& mesh, const std::string& path, TauNetcdf kind, const RunContext& context) : mesh_(mesh), cells_(mesh), context_(context) {
    constexpr std::uint64_t k_max_number = std::numeric_limits<std::int32_t>::max();
    require_count(mesh.points.size(), k_max_number, "points", "TAU (32-bit numbers of points)", path);
    const FacesByPatch faces(mesh);
    marker_of_patch_.assign(mesh.patches.size(), 0);
    for (const PatchId patch : mesh.patches.ids()) {
      if (faces.count(patch) == 0) continue;
      markers_.push_back(marker(patch, static_cast<std::int64_t>(markers_.size()) + 1));
      marker_of_patch_[patch.index()] = static_cast<std::int32_t>(markers_.size());
    }
    add_cells();
    add_faces();
    add_points();
    is_cdf5_ = std::any_of(variables_.begin(), variables_.end(), [](const Variable& variable) { return variable.n_bytes > k_max_cdf2_variable; }) ||
               std::any_of(dimensions_.begin(), dimensions_.end(), [](const Dimension& dimension) { return dimension.length > k_max_number; });
    if (is_cdf5_) context.warn(path + ": an array exceeds the 4 GiB of NetCDF's 64-bit offset files; it is written as CDF-5, which not every TAU reads");
    is_cdf5_ = is_cdf5_ || kind == TauNetcdf::cdf5;
  }

  std::vector<OutputSection> sections() const {
    std::vector<std::pair<std::string, std::string>> attributes = {{"type", "Primary Grid: Tau Format"}};
    for (const TauMarker& marker : markers_) attributes.emplace_back("marker_" + std::to_string(marker.number), marker.name);
    std::vector<OutputSection> sections{fixed_section(HeadWriter(is_cdf5_).write(dimensions_, attributes, variables_))};
    for (const Variable& variable : variables_) sections.push_back(variable.content);
    return sections;
  }

  /// The mapping cannot spell comments and line ends in names.
  std::string mapping() const {
    std::vector<TauMarker> markers = markers_;
    for (TauMarker& marker : markers) {
      const std::string whole = marker.name;
      std::replace_if(marker.name.begin(), marker.name.end(), [](char c) { return c == '#' || std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '_');
      if (marker.name != whole) context_.warn("patch \"" + whole + "\" is named \"" + marker.name + "\" in the boundary mapping");
    }
    return bmap_text(markers);
  }

 private:
  TauMarker marker(PatchId patch, std::int64_t number) const {
    const Patch& data = mesh_.patches[patch];
    TauMarker marker{.number = number, .name = data.name, .condition = tau_condition(data.kind)};
    if (marker.name.empty()) marker.name = "patch_" + std::to_string(patch.value() + 1);
    if (data.kind == PatchKind::interface) context_.warn("patch \"" + data.name + "\" is an interface, for which TAU has no condition; it is written as an euler wall");
    return marker;
  }

  std::size_t dimension(std::string name, std::uint64_t length) {
    dimensions_.push_back({std::move(name), length});
    return dimensions_.size() - 1;
  }

  static char* put_nodes(char* at, std::span<const NodeId> nodes) {
    for (const NodeId node : nodes) at = put_bytes(at, static_cast<std::int32_t>(node.value()), std::endian::big);  // counts were checked
    return at;
  }

  /// Absent kinds have neither dimension nor variable: a length of 0 means "unlimited".
  void add_elements(const TauElement& element, std::uint64_t n, std::uint64_t size, decltype(OutputSection::format) format) {
    if (n == 0) return;
    const std::size_t count = dimension("no_of_" + std::string(element.plural), n), width = dimension("points_per_" + std::string(element.singular), size);
    variables_.push_back({.name = "points_of_" + std::string(element.plural), .dimensions = {count, width}, .type = k_int, .n_bytes = 4 * n * size, .content = {.n_items = n, .format = std::move(format)}});
  }

  void add_cells() {
    if (cells_.total() > 0) dimension("no_of_elements", cells_.total());
    for (const CellKind kind : k_tau_kinds) {
      const std::uint64_t size = static_cast<std::uint64_t>(n_nodes(kind));
      add_elements(tau_element(kind), cells_.count(kind), size, [this, kind, size](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
        char* at = out.reserve((end - begin) * size * 4);
        cells_.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) { at = put_nodes(at, nodes); });
        out.end_at(at);
      });
    }
  }

  template <class Face>
  static decltype(OutputSection::format) face_format(const std::vector<Face>& faces) {
    return [&faces](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
      char* at = out.reserve((end - begin) * 16);
      for (std::uint64_t i = begin; i < end; ++i) at = put_nodes(at, faces[i].nodes);
      out.end_at(at);
    };
  }

  void add_faces() {
    const std::uint64_t n_triangles = mesh_.boundary_triangles.size(), n = n_triangles + mesh_.boundary_quads.size();
    if (n == 0) return;
    const std::size_t count = dimension("no_of_surfaceelements", n);
    add_elements(k_tau_triangle, n_triangles, 3, face_format(mesh_.boundary_triangles));
    add_elements(k_tau_quad, mesh_.boundary_quads.size(), 4, face_format(mesh_.boundary_quads));
    const auto format_markers = [this, n_triangles](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
      char* at = out.reserve((end - begin) * 4);
      for (std::uint64_t i = begin; i < end; ++i) {
        const PatchId patch = i < n_triangles ? mesh_.boundary_triangles[i].patch : mesh_.boundary_quads[i - n_triangles].patch;
        at = put_bytes(at, marker_of_patch_[patch.index()], std::endian::big);
      }
      out.end_at(at);
    };
    variables_.push_back({.name = "boundarymarker_of_surfaces", .dimensions = {count}, .type = k_int, .n_bytes = 4 * n, .content = {.n_items = n, .format = format_markers}});
    std::string numbers(4 * markers_.size(), '\0');
    char* at = numbers.data();
    for (const TauMarker& marker : markers_) at = put_bytes(at, static_cast<std::int32_t>(marker.number), std::endian::big);
    variables_.push_back({.name = "marker", .dimensions = {dimension("no_of_markers", markers_.size())}, .type = k_int, .n_bytes = numbers.size(), .content = fixed_section(std::move(numbers))});
  }

  void add_points() {
    const std::uint64_t n = mesh_.points.size();
    if (n == 0) return;
    const std::size_t count = dimension("no_of_points", n);
    constexpr std::array<const char*, 3> k_names = {"points_xc", "points_yc", "points_zc"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto format = [this, axis](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
        char* at = out.reserve((end - begin) * 8);
        for (std::uint64_t i = begin; i < end; ++i) {
          const Point& p = mesh_.points.raw()[i];
          if (!is_finite(p)) throw_node_not_finite(i);
          at = put_bytes(at, p[axis], std::endian::big);
        }
        out.end_at(at);
      };
      variables_.push_back({.name = k_names[axis], .dimensions = {count}, .type = k_double, .n_bytes = 8 * n, .content = {.n_items = n, .format = format}});
    }
  }

  const HybridMesh& mesh_;
  CellSections cells_;
  const RunContext& context_;
  std::vector<TauMarker> markers_;
  std::vector<std::int32_t> marker_of_patch_;  ///< 0 = no faces
  std::vector<Dimension> dimensions_;
  std::vector<Variable> variables_;
  bool is_cdf5_ = false;
};

}  // namespace

void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write_volume_tau(mesh, path, TauNetcdf::as_needed, context); }

void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, TauNetcdf kind, const RunContext& context) {
  const TauWriter writer(mesh, path.string(), kind, context);
  AtomicFile mapping(bmap_path(path));
  mapping.append(writer.mapping());
  AtomicFile file(path);
  write_sections(file, writer.sections(), context);
  const StageTimer timer(context, "sync");
  file.commit();
  mapping.commit();
}

}  // namespace sterna::io
