// TAU writer. The dimensions, attributes and variables of the NetCDF file are described first, then streamed.
#include <algorithm>
#include <cctype>
#include <limits>

#include "io/container/netcdf_output.h"
#include "io/names/tau_mapping.h"
#include "io/names/tau_names.h"
#include "io/output/cell_sections.h"
#include "io/volume/volume_tau.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_max_cdf2_variable = (std::uint64_t{1} << 32) - 4;

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
    const auto is_too_large = [](const NetcdfOutput::Variable& variable) {
      return count_of(variable.array) * byte_size(variable.array.kind) > k_max_cdf2_variable;
    };
    contents_.is_cdf5 = std::any_of(contents_.variables.begin(), contents_.variables.end(), is_too_large) ||
                        std::any_of(contents_.dimensions.begin(), contents_.dimensions.end(),
                                    [](const NetcdfOutput::Dimension& dimension) { return dimension.length > k_max_number; });
    if (contents_.is_cdf5)
      context.warn(path + ": an array exceeds the 4 GiB of NetCDF's 64-bit offset files; it is written as CDF-5, which some versions of TAU cannot read");
    contents_.is_cdf5 = contents_.is_cdf5 || kind == TauNetcdf::cdf5;
    contents_.attributes = {{"type", "Primary Grid: Tau Format"}};
    for (const TauMarker& marker : markers_) contents_.attributes.emplace_back("marker_" + std::to_string(marker.number), marker.name);
  }

  const NetcdfOutput& contents() const { return contents_; }

  /// Returns the mapping file. Comment characters and line ends in names cannot be stored.
  std::string mapping() const {
    std::vector<TauMarker> markers = markers_;
    for (TauMarker& marker : markers) {
      const std::string whole = marker.name;
      std::replace_if(
          marker.name.begin(), marker.name.end(), [](char c) { return c == '#' || std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '_');
      if (marker.name != whole) context_.warn("patch \"" + whole + "\" is named \"" + marker.name + "\" in the boundary mapping");
    }
    return bmap_text(markers);
  }

 private:
  TauMarker marker(PatchId patch, std::int64_t number) const {
    const Patch& data = mesh_.patches[patch];
    TauMarker marker{.number = number, .name = data.name, .condition = tau_condition(data.kind)};
    if (marker.name.empty()) marker.name = "patch_" + std::to_string(patch.value() + 1);
    if (data.kind == PatchKind::interface)
      context_.warn("patch \"" + data.name + "\" is an interface, for which TAU has no condition; it is written as an euler wall");
    return marker;
  }

  std::size_t dimension(std::string name, std::uint64_t length) {
    contents_.dimensions.push_back({std::move(name), length});
    return contents_.dimensions.size() - 1;
  }

  void add_variable(std::string name, std::vector<std::size_t> dimensions, NumberKind kind, OutputSection content) {
    NetcdfOutput::Variable variable{
        .name = std::move(name), .dimensions = std::move(dimensions), .array = {.kind = kind, .extents = {}, .content = {std::move(content)}}};
    for (const std::size_t dimension : variable.dimensions) variable.array.extents.push_back(contents_.dimensions[dimension].length);
    contents_.variables.push_back(std::move(variable));
  }

  static char* put_nodes(char* at, std::span<const NodeId> nodes) {
    for (const NodeId node : nodes) at = put_bytes(at, static_cast<std::int32_t>(node.value()), std::endian::little);  // the range was checked
    return at;
  }

  /// Adds elements. Kinds without elements have neither dimension nor variable: a length of 0 means "unlimited".
  void add_elements(const TauElement& element, std::uint64_t n, std::uint64_t size, decltype(OutputSection::format) format) {
    if (n == 0) return;
    const std::size_t count = dimension("no_of_" + std::string(element.plural), n), width = dimension("points_per_" + std::string(element.singular), size);
    add_variable("points_of_" + std::string(element.plural), {count, width}, NumberKind::i4, {.n_items = n, .format = std::move(format)});
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
        at = put_bytes(at, marker_of_patch_[patch.index()], std::endian::little);
      }
      out.end_at(at);
    };
    add_variable("boundarymarker_of_surfaces", {count}, NumberKind::i4, {.n_items = n, .format = format_markers});
    std::string numbers(4 * markers_.size(), '\0');
    char* at = numbers.data();
    for (const TauMarker& marker : markers_) at = put_bytes(at, static_cast<std::int32_t>(marker.number), std::endian::little);
    add_variable("marker", {dimension("no_of_markers", markers_.size())}, NumberKind::i4, fixed_section(std::move(numbers)));
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
          at = put_bytes(at, p[axis], std::endian::little);
        }
        out.end_at(at);
      };
      add_variable(k_names[axis], {count}, NumberKind::f8, {.n_items = n, .format = format});
    }
  }

  const HybridMesh& mesh_;
  CellSections cells_;
  const RunContext& context_;
  std::vector<TauMarker> markers_;
  std::vector<std::int32_t> marker_of_patch_;  ///< 0 = no faces
  NetcdfOutput contents_;
};

}  // namespace

void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_tau(mesh, path, TauNetcdf::as_needed, context);
}

void write_volume_tau(const HybridMesh& mesh, const std::filesystem::path& path, TauNetcdf kind, const RunContext& context) {
  const TauWriter writer(mesh, path.string(), kind, context);
  AtomicFile mapping(bmap_path(path));
  mapping.append(writer.mapping());
  write_netcdf(writer.contents(), path, context);
  mapping.commit();
}

}  // namespace sterna::io
