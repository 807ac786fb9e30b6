#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "geom/base/error.h"
#include "io/container/chunked_file.h"
#include "io/grammar/sterna_parts.h"
#include "io/mesh/surface_boundary.h"
#include "io/mesh/surface_builder.h"
#include "io/volume/sterna_file.h"

namespace sterna::io {
namespace {

class PartReader {
 public:
  /// \param prefix prefix of all array names
  PartReader(const ChunkedReader& file, std::string prefix, const RunContext& context) : file_(file), prefix_(std::move(prefix)), context_(context) {}

  SternaContent read() {
    SternaContent content;
    if (has(part::k_surface.points)) content.surface = surface(part::k_surface);
    if (has(part::k_farfield.points)) content.farfield = surface(part::k_farfield);
    if (has(part::k_direction)) {
      if (!content.surface) fail(part::k_direction, "exists without a surface");
      content.envelope = envelope(content.surface->n_vertices());
    }
    if (has(part::k_engine_tetrahedra)) content.tetrahedra = tetrahedra();
    if (has(part::k_points)) content.mesh = mesh();
    const PartReader opened(file_, std::string(part::k_opened), context_);
    if (opened.has(part::k_points)) content.opened = opened.mesh();
    content.manifest = text(part::k_manifest);
    content.certificate = text(part::k_certificate);
    content.quality = text(part::k_quality);
    return content;
  }

 private:
  std::string named(std::string_view name) const { return prefix_ + std::string(name); }
  bool has(std::string_view name) const { return file_.has(named(name)); }
  const StoredArray& at(std::string_view name) const { return file_.at(named(name)); }
  [[noreturn]] void fail(std::string_view name, const std::string& problem) const { file_.fail(named(name), problem); }

  /// Reads all values of an array with n_components per `Item`. Fails if the array is missing.
  template <class Item>
  std::vector<Item> items(std::string_view name, NumberType type, std::uint32_t n_components) const {
    static_assert(std::is_standard_layout_v<Item> && std::is_trivially_copyable_v<Item>);  // it is filled with bytes of the file
    if (!has(name)) fail(name, "is missing");
    const StoredArray& array = at(name);
    if (array.type != type || array.n_components != n_components)
      fail(name, "found the type " + std::to_string(static_cast<int>(array.type)) + " with " + std::to_string(array.n_components) + " components, expected " +
                     std::to_string(static_cast<int>(type)) + " with " + std::to_string(n_components));
    std::vector<Item> values(array.n_values / n_components);
    file_.read(named(name), reinterpret_cast<char*>(values.data()), context_);
    return values;
  }

  void require_size(std::string_view name, std::size_t found, std::size_t expected) const {
    if (found != expected) fail(name, "found " + std::to_string(found) + " items, expected " + std::to_string(expected));
  }

  std::vector<Vec3> points(std::string_view name) const {
    std::vector<Vec3> values = items<Vec3>(name, NumberType::f64, 3);
    if (values.size() >= NodeId::k_invalid) throw_id_overflow(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!is_finite(values[i])) fail(name, "item " + std::to_string(i) + " is not finite");
    return values;
  }

  std::vector<double> reals(std::string_view name, std::size_t expected) const {
    std::vector<double> values = items<double>(name, NumberType::f64, 1);
    require_size(name, values.size(), expected);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!std::isfinite(values[i])) fail(name, "value " + std::to_string(i) + " is not finite");
    return values;
  }

  template <class Ids>
  void require_below(std::string_view name, const std::vector<Ids>& values, std::uint64_t limit) const {
    constexpr std::size_t k_per_item = sizeof(Ids) / sizeof(std::uint32_t);
    static_assert(sizeof(Ids) == k_per_item * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto numbers = std::bit_cast<std::array<std::uint32_t, k_per_item>>(values[i]);
      for (std::size_t k = 0; k < k_per_item; ++k)
        if (numbers[k] >= limit)
          fail(name, "value " + std::to_string(k_per_item * i + k) + " is " + std::to_string(numbers[k]) + ", expected below " + std::to_string(limit));
    }
  }

  template <std::size_t N>
  std::vector<std::array<NodeId, N>> cells(std::string_view name, std::size_t n_points) const {
    auto values = items<std::array<NodeId, N>>(name, NumberType::u32, N);
    require_below(name, values, n_points);
    return values;
  }

  std::vector<std::uint8_t> bytes(std::string_view name, std::size_t expected) const {
    std::vector<std::uint8_t> values = items<std::uint8_t>(name, NumberType::u8, 1);
    require_size(name, values.size(), expected);
    return values;
  }

  std::int64_t integer(std::string_view name) const {
    const auto values = items<std::int64_t>(name, NumberType::i64, 1);
    require_size(name, values.size(), 1);
    return values[0];
  }

  std::string text(std::string_view name) const {
    if (!has(name)) return {};
    const auto values = items<char>(name, NumberType::u8, 1);
    return {values.begin(), values.end()};
  }

  std::vector<std::string> strings(std::string_view name) const {
    if (!has(name)) fail(name, "is missing");
    const std::string all = text(name);
    std::vector<std::string> result;
    for (std::size_t at = 0; at < all.size();) {
      const std::size_t end = all.find('\0', at);
      if (end == std::string::npos) fail(name, "the last string has no end");
      result.push_back(all.substr(at, end - at));
      at = end + 1;
    }
    return result;
  }

  Column<PatchId, Patch> patches(std::string_view name) const {
    const std::vector<std::string> words = strings(name);
    if (words.size() % 2 != 0) fail(name, "a patch has a kind but no name");
    Column<PatchId, Patch> result;
    for (std::size_t i = 0; i < words.size(); i += 2) {
      const auto kind = std::find_if(part::k_patch_kinds.begin(), part::k_patch_kinds.end(), [&](PatchKind k) { return to_string(k) == words[i]; });
      if (kind == part::k_patch_kinds.end()) fail(name, "found " + quoted_excerpt(words[i]) + " as the kind of a patch");
      result.push_back({words[i + 1], *kind});
    }
    return result;
  }

  TriMesh surface(const part::SurfaceNames& names) const {
    TriMesh mesh;
    mesh.points.raw() = points(names.points);
    mesh.triangles.raw() = items<TriangleVertices>(names.triangles, NumberType::u32, 3);
    require_below(names.triangles, mesh.triangles.raw(), mesh.points.size());
    mesh.patches = patches(names.patches);
    mesh.triangle_patch.raw() = items<PatchId>(names.triangle_patch, NumberType::u32, 1);
    require_size(names.triangle_patch, mesh.triangle_patch.size(), mesh.n_triangles());
    require_below(names.triangle_patch, mesh.triangle_patch.raw(), mesh.patches.size());
    return mesh;
  }

  StoredEnvelope envelope(std::size_t n_surface_vertices) const {
    StoredEnvelope envelope;
    envelope.direction.raw() = points(part::k_direction);
    const std::size_t n = envelope.direction.size();  // number of vertices of walls with layers, with actuator discs cut in; callers that continue the run
                                                      // compare this number
    envelope.height.raw() = reals(part::k_height, n);
    envelope.target.raw() = reals(part::k_target, n);
    envelope.eq1.raw() = reals(part::k_eq1, n);
    envelope.cap.raw() = reals(part::k_cap, n);
    envelope.limit.raw() = bytes(part::k_limit, n);
    if (has(part::k_first_height)) envelope.first_height = reals(part::k_first_height, n_surface_vertices);
    return envelope;
  }

  StoredTetrahedra tetrahedra() const {
    StoredTetrahedra result;
    result.new_points = points(part::k_new_points);
    const std::int64_t n = integer(part::k_boundary_points);
    if (n < 0 || static_cast<std::uint64_t>(n) >= NodeId::k_invalid) fail(part::k_boundary_points, "found " + std::to_string(n));
    result.n_boundary_points = static_cast<std::uint64_t>(n);
    result.tetrahedra = items<std::array<std::uint32_t, 4>>(part::k_engine_tetrahedra, NumberType::u32, 4);
    require_below(part::k_engine_tetrahedra, result.tetrahedra, result.n_boundary_points + result.new_points.size());
    if (!has(part::k_moved_nodes)) return result;
    result.moved_nodes = items<std::uint32_t>(part::k_moved_nodes, NumberType::u32, 1);
    result.moved_points = points(part::k_moved_points);
    if (result.moved_points.size() != result.moved_nodes.size())
      fail(part::k_moved_points,
           "found " + std::to_string(result.moved_points.size()) + " locations for " + std::to_string(result.moved_nodes.size()) + " nodes");
    return result;
  }

  LayerBlock layers(std::size_t n_points) const {
    LayerBlock block;
    const std::int64_t n_layers = integer(part::k_n_layers);
    if (n_layers < 0 || static_cast<std::uint64_t>(n_layers) > n_points)
      fail(part::k_n_layers, "found " + std::to_string(n_layers) + ", expected 0 to the number of points");
    block.n_layers = static_cast<int>(n_layers);
    block.first_node = items<std::uint32_t>(part::k_first_node, NumberType::u32, 1);
    block.is_collapsed = bytes(part::k_is_collapsed, block.n_lines());
    if (has(part::k_line_layers)) block.line_layers = line_layers(part::k_line_layers, block.n_lines(), block.n_layers);
    for (std::size_t k = 0; k < block.n_lines(); ++k) {
      if (block.is_collapsed[k] > 1)
        fail(part::k_is_collapsed, "value " + std::to_string(k) + " is " + std::to_string(block.is_collapsed[k]) + ", expected 0 or 1");
      const std::uint64_t last = std::uint64_t{block.first_node[k]} + static_cast<std::uint64_t>(block.n_steps(k));
      if (last >= n_points)
        fail(part::k_first_node, "line " + std::to_string(k) + " ends at node " + std::to_string(last) + ", there are " + std::to_string(n_points));
    }
    block.base = items<std::array<std::uint32_t, 3>>(part::k_base, NumberType::u32, 3);
    require_below(part::k_base, block.base, block.n_lines());
    for (std::size_t c = 0; c < (block.is_uniform() ? 0 : block.n_columns()); ++c)
      for (const std::uint32_t line : block.base[c])
        if (block.is_collapsed[line] == 0 && block.layers_of_line(line) + 1 < block.layers_of_column(c))
          fail(part::k_line_layers, "the lines of column " + std::to_string(c) + " differ by more than one layer");
    return block;
  }

  std::vector<std::uint16_t> line_layers(std::string_view name, std::size_t n_lines, int most) const {
    const auto numbers = items<std::uint32_t>(name, NumberType::u32, 1);
    require_size(name, numbers.size(), n_lines);
    std::vector<std::uint16_t> result(n_lines);
    for (std::size_t i = 0; i < n_lines; ++i) {
      if (numbers[i] < 1 || numbers[i] > static_cast<std::uint32_t>(most) || numbers[i] > std::numeric_limits<std::uint16_t>::max())
        fail(name, "value " + std::to_string(i) + " is " + std::to_string(numbers[i]) + ", expected 1 to " + std::to_string(most));
      result[i] = static_cast<std::uint16_t>(numbers[i]);
    }
    return result;
  }

  LayerRequest request(std::size_t n_lines) const {
    LayerRequest result;
    const std::vector<double> numbers = reals(part::k_request, 2);
    result.first_height = numbers[0];
    result.max_growth = numbers[1];
    result.target_height = reals(part::k_request_target, n_lines);
    result.reasons = strings(part::k_request_reasons);
    result.reason = bytes(part::k_request_reason, n_lines);
    if (has(part::k_request_first_height)) result.line_first_height = reals(part::k_request_first_height, n_lines);
    if (has(part::k_request_first_room)) result.line_first_room = reals(part::k_request_first_room, n_lines);
    if (has(part::k_request_boundary_layer)) result.line_boundary_layer = reals(part::k_request_boundary_layer, n_lines);
    if (has(part::k_request_max_growth)) result.line_max_growth = reals(part::k_request_max_growth, n_lines);
    if (has(part::k_request_layers)) result.line_layers = line_layers(part::k_request_layers, n_lines, std::numeric_limits<std::uint16_t>::max());
    for (std::size_t i = 0; i < result.reason.size(); ++i)
      if (result.reason[i] >= result.reasons.size())
        fail(part::k_request_reason,
             "value " + std::to_string(i) + " is " + std::to_string(result.reason[i]) + ", there are " + std::to_string(result.reasons.size()) + " reasons");
    return result;
  }

  template <class Face>
  std::vector<Face> faces(std::string_view nodes_name, std::string_view patch_name, const HybridMesh& mesh) const {
    const auto nodes = cells<std::tuple_size_v<decltype(Face{}.nodes)>>(nodes_name, mesh.points.size());
    const auto patch = items<PatchId>(patch_name, NumberType::u32, 1);
    require_size(patch_name, patch.size(), nodes.size());
    require_below(patch_name, patch, mesh.patches.size());
    std::vector<Face> result(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) result[i] = {nodes[i], patch[i]};
    return result;
  }

  std::vector<PeriodicSides> periodic(std::size_t n_patches) const {
    const auto patches = items<std::array<PatchId, 2>>(part::k_periodic_patches, NumberType::u32, 2);
    require_below(part::k_periodic_patches, patches, n_patches);
    const std::vector<Vec3> translations = points(part::k_periodic_translations);
    require_size(part::k_periodic_translations, translations.size(), patches.size());
    std::vector<PeriodicSides> result;
    for (std::size_t i = 0; i < patches.size(); ++i) result.push_back({patches[i][0], patches[i][1], translations[i]});
    return result;
  }

  HybridMesh mesh() const {
    HybridMesh mesh;
    mesh.points.raw() = points(part::k_points);
    const std::size_t n = mesh.points.size();
    mesh.patches = patches(part::k_patches);
    if (has(part::k_first_node)) mesh.layers = layers(n);
    if (has(part::k_request)) mesh.request = request(mesh.layers.n_lines());
    mesh.prisms = cells<6>(part::k_prisms, n);
    mesh.pyramids = cells<5>(part::k_pyramids, n);
    mesh.hexahedra = cells<8>(part::k_hexahedra, n);
    mesh.tetrahedra = cells<4>(part::k_tetrahedra, n);
    mesh.boundary_triangles = faces<BoundaryTriangle>(part::k_triangles, part::k_triangle_patch, mesh);
    mesh.boundary_quads = faces<BoundaryQuad>(part::k_quads, part::k_quad_patch, mesh);
    if (has(part::k_periodic_patches)) mesh.periodic = periodic(mesh.patches.size());
    return mesh;
  }

  const ChunkedReader& file_;
  std::string prefix_;
  RunContext context_;
};

}  // namespace

std::string SternaContent::names() const {
  std::string text;
  const auto add = [&](bool is_there, const char* name) {
    if (is_there) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(surface.has_value(), "surface");
  add(farfield.has_value(), "farfield");
  add(envelope.has_value(), "envelope");
  add(tetrahedra.has_value(), "tetrahedra");
  add(mesh.has_value(), "mesh");
  add(opened.has_value(), "opened layer");
  add(!manifest.empty(), "manifest");
  add(!certificate.empty(), "certificate");
  add(!quality.empty(), "quality");
  return text.empty() ? "nothing" : text;
}

SternaContent read_sterna(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const ChunkedReader file(buffer);
  return PartReader(file, {}, context).read();
}

HybridMesh read_volume_sterna(const std::filesystem::path& path, const RunContext& context) {
  SternaContent content = read_sterna(path, context);
  if (content.surface && !content.mesh && !content.envelope && !content.tetrahedra) return as_boundary(*content.surface, Winding::kept);
  if (!content.mesh) throw_malformed(path.string(), "byte 0", "found " + content.names() + ", expected a mesh");
  return std::move(*content.mesh);
}

SurfaceSoup read_surface_sterna(const std::filesystem::path& path, const RunContext& context) {
  const SternaContent content = read_sterna(path, context);
  if (!content.surface && !content.mesh) throw_malformed(path.string(), "byte 0", "found " + content.names() + ", expected a surface or a mesh");
  SurfaceSoup soup = boundary_soup(content.surface ? as_boundary(*content.surface, Winding::kept) : *content.mesh, path.string(), context);
  soup.has_names = true;
  return soup;
}

}  // namespace sterna::io
