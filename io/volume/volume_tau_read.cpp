// TAU reader. It reads points, cells by kind, surface elements with their markers, and marker names.
#include <cmath>
#include <map>

#include "geom/base/parallel.h"
#include "io/container/container_file.h"
#include "io/input/file_buffer.h"
#include "io/mesh/orientation.h"
#include "io/mesh/surface_builder.h"
#include "io/names/tau_mapping.h"
#include "io/names/tau_names.h"
#include "io/volume/volume_tau.h"

namespace sterna::io {
namespace {

enum class TauContents { volume, boundary };

class TauReader {
 public:
  TauReader(const ContainerImage& image, TauContents contents, std::map<std::int64_t, TauMarker> mapping, const RunContext& context)
      : image_(image), contents_(contents), mapping_(std::move(mapping)), context_(context) {}

  HybridMesh read() {
    read_points();
    read_cells(CellKind::tetrahedron, mesh_.tetrahedra);
    read_cells(CellKind::prism, mesh_.prisms);
    read_cells(CellKind::pyramid, mesh_.pyramids);
    read_cells(CellKind::hexahedron, mesh_.hexahedra);
    n_cells_ = static_cast<std::uint64_t>(count_cells(mesh_).total());
    if (contents_ == TauContents::boundary) mesh_.tetrahedra = {}, mesh_.prisms = {}, mesh_.pyramids = {}, mesh_.hexahedra = {};
    read_faces();
    return std::move(mesh_);
  }

  std::uint64_t n_cells() const { return n_cells_; }  ///< in the file; \pre read()

 private:
  bool has(const std::string& variable) const { return image_.root().find(variable) != nullptr; }
  static std::string where_of(const std::string& variable) { return "variable \"" + variable + "\""; }
  NumberArray data(const std::string& variable) const {
    NumberArray array = image_.data(image_.child(image_.root(), variable));
    array.where = where_of(variable);
    return array;
  }

  void read_points() {
    std::array<NumberArray, 3> values;
    constexpr std::array<const char*, 3> k_names = {"points_xc", "points_yc", "points_zc"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!has(k_names[axis])) throw_malformed(image_.source(), where_of(k_names[axis]), "there is none, so this is not a primary grid of TAU");
      values[axis] = data(k_names[axis]);
      values[axis].require_reals(values[0].count(), "coordinates of the points");
    }
    const std::size_t n = values[0].count();
    if (n >= NodeId::k_invalid) throw_id_overflow(n);
    mesh_.points.resize(n);
    parallel_for(context_, n, [&](std::size_t i) {
      const Point p = {values[0].real(i), values[1].real(i), values[2].real(i)};
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!std::isfinite(p[axis]) && contents_ == TauContents::volume) values[axis].fail("the coordinate of point " + std::to_string(i) + " is not finite");
      mesh_.points.raw()[i] = p;
    });
  }

  /// Reads the corners of elements of N nodes; empty if the file has no such elements.
  template <std::size_t N>
  std::vector<std::array<NodeId, N>> corners_of(const TauElement& element) {
    context_.check_stop();
    std::vector<std::array<NodeId, N>> elements;
    const std::string name = "points_of_" + std::string(element.plural);
    if (!has(name)) return elements;
    const NumberArray corners = data(name);
    const std::uint64_t n = corners.count() / N;
    corners.require_integers(n * N, "corners of elements of " + std::to_string(N) + " points");
    elements.resize(n);
    const std::int64_t n_points = static_cast<std::int64_t>(mesh_.points.size());
    parallel_for(context_, n, [&](std::size_t i) {
      for (std::size_t k = 0; k < N; ++k) {
        const std::int64_t node = corners.integer(i * N + k);
        if (node < 0 || node >= n_points)
          corners.fail("element " + std::to_string(i) + " has point " + std::to_string(node) + ", expected 0 to " + std::to_string(n_points - 1));
        elements[i][k] = NodeId(static_cast<std::uint32_t>(node));
      }
    });
    return elements;
  }

  template <std::size_t N>
  void read_cells(CellKind kind, std::vector<std::array<NodeId, N>>& cells) {
    cells = corners_of<N>(tau_element(kind));
  }

  void read_faces() {
    const auto triangles = corners_of<3>(k_tau_triangle);
    const auto quads = corners_of<4>(k_tau_quad);
    const std::uint64_t n = triangles.size() + quads.size();
    constexpr const char* k_markers = "boundarymarker_of_surfaces";
    NumberArray markers;
    if (n > 0) {
      if (!has(k_markers)) throw_malformed(image_.source(), where_of(k_markers), "there is none, so the faces belong to no patch");
      markers = data(k_markers);
      markers.require_integers(n, "markers of all triangles, then of all quads");
    }
    add_patches(markers, n);
    mesh_.boundary_triangles.reserve(triangles.size());
    mesh_.boundary_quads.reserve(quads.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) mesh_.boundary_triangles.push_back({triangles[i], patches_.at(markers.integer(i))});
    for (std::size_t i = 0; i < quads.size(); ++i) mesh_.boundary_quads.push_back({quads[i], patches_.at(markers.integer(triangles.size() + i))});
  }

  /// Adds the markers that have faces, first those listed in the file, in its order, then the others by number.
  void add_patches(const NumberArray& markers, std::uint64_t n) {
    std::map<std::int64_t, bool> is_added;
    for (std::uint64_t i = 0; i < n; ++i) is_added.emplace(markers.integer(i), false);
    const auto add = [&](std::int64_t number) {
      const auto found = is_added.find(number);
      if (found == is_added.end() || std::exchange(found->second, true)) return;
      TauMarker marker = marker_of(number);
      patches_.emplace(number, mesh_.patches.push_back({.name = marker.name, .kind = kind_of_tau(marker)}));
    };
    if (has("marker")) {
      const NumberArray listed = data("marker");
      listed.require_integers(listed.count(), "numbers of the markers");
      for (std::uint64_t i = 0; i < listed.count(); ++i) add(listed.integer(i));
    }
    std::vector<std::int64_t> rest;
    for (const auto& [number, done] : is_added)
      if (!done) rest.push_back(number);
    for (const std::int64_t number : rest) add(number);
  }

  TauMarker marker_of(std::int64_t number) const {
    TauMarker marker{.number = number, .name = {}, .condition = {}};
    const auto mapped = mapping_.find(number);
    if (mapped != mapping_.end()) marker = mapped->second;
    const NumberArray* const named = image_.root().attribute("marker_" + std::to_string(number));
    if (named && named->kind == NumberKind::text && !named->text().empty()) marker.name = named->text();
    if (marker.name.empty()) marker.name = numbered_patch(number);
    return marker;
  }

  const ContainerImage& image_;
  TauContents contents_;
  std::uint64_t n_cells_ = 0;
  std::map<std::int64_t, TauMarker> mapping_;
  const RunContext& context_;
  std::map<std::int64_t, PatchId> patches_;
  HybridMesh mesh_;
};

FileBoundary read_grid(const std::filesystem::path& path, TauContents contents, const RunContext& context) {
  const ContainerImage image = read_container(path, ContainerFormat::netcdf, {}, context);
  TauReader reader(image, contents, read_bmap(path, context), context);
  FileBoundary result;
  result.mesh = reader.read();
  result.n_cells = reader.n_cells();
  return result;
}

}  // namespace

HybridMesh read_volume_tau(const std::filesystem::path& path, const RunContext& context) {
  HybridMesh mesh = read_grid(path, TauContents::volume, context).mesh;
  context.progress(0.7);
  orient_mesh(mesh, context);
  return mesh;
}

FileBoundary read_boundary_tau(const std::filesystem::path& path, const RunContext& context) { return read_grid(path, TauContents::boundary, context); }

}  // namespace sterna::io
