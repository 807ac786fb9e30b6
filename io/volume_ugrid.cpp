#include "io/volume_ugrid.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "geom/base/error.h"
#include "io/byte_reader.h"
#include "io/orientation.h"
#include "io/patch_names.h"

namespace sterna::io {
namespace {

std::endian order_of(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  if (name.ends_with(".lb8.ugrid")) return std::endian::little;
  if (name.ends_with(".b8.ugrid")) return std::endian::big;
  throw_unsupported(path.string(), "this kind of UGRID file is not read as a volume mesh", "write it as .lb8.ugrid or .b8.ugrid");
}

class UgridReader {
 public:
  UgridReader(const FileBuffer& buffer, std::endian order) : reader_(buffer, order) {}

  HybridMesh read(const RunContext& context) {
    reader_.require(7, sizeof(std::int32_t), "the numbers of nodes, triangles, quads, tetrahedra, pyramids, prisms and hexahedra");
    std::array<std::uint64_t, 7> n{};
    for (std::uint64_t& count : n) count = take_count();
    read_points(n[0]);
    read_elements(mesh_.boundary_triangles, n[1], k_same, [](BoundaryTriangle& face) -> auto& { return face.nodes; });
    read_elements(mesh_.boundary_quads, n[2], k_same, [](BoundaryQuad& face) -> auto& { return face.nodes; });
    read_patches(n[1] + n[2]);
    context.progress(0.4);
    read_elements(mesh_.tetrahedra, n[3], k_same, [](auto& nodes) -> auto& { return nodes; });
    read_elements(mesh_.pyramids, n[4], k_pyramid, [](auto& nodes) -> auto& { return nodes; });
    read_elements(mesh_.prisms, n[5], k_same, [](auto& nodes) -> auto& { return nodes; });
    read_elements(mesh_.hexahedra, n[6], k_same, [](auto& nodes) -> auto& { return nodes; });
    return std::move(mesh_);
  }

 private:
  using Order = std::array<std::uint8_t, 8>;
  static constexpr Order k_same = {0, 1, 2, 3, 4, 5, 6, 7};
  static constexpr Order k_pyramid = {0, 3, 4, 1, 2};  // the quad is 0 1 4 3, the apex 2; its own inverse

  std::uint64_t take_count() {
    const std::int32_t n = reader_.take<std::int32_t>();
    if (n < 0) reader_.fail("found the count " + std::to_string(n), "is the byte order the one that the file's name says?");
    return static_cast<std::uint64_t>(n);
  }

  void read_points(std::uint64_t n) {
    reader_.require(n, 3 * sizeof(double), "coordinates of the nodes");
    mesh_.points.resize(n);
    for (Point& p : mesh_.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = reader_.take<double>();
      if (!is_finite(p)) reader_.fail("the coordinates of a node, which end here, are not finite");
    }
  }

  template <class Element, class NodesOf>
  void read_elements(std::vector<Element>& elements, std::uint64_t n, const Order& order, const NodesOf& nodes_of) {
    Element first{};
    reader_.require(n, nodes_of(first).size() * sizeof(std::int32_t), "nodes of the elements");
    elements.resize(n);
    for (Element& element : elements) {
      auto& nodes = nodes_of(element);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const std::int32_t node = reader_.take<std::int32_t>();
        if (node < 1 || static_cast<std::uint64_t>(node) > mesh_.points.size())
          reader_.fail("found the node " + std::to_string(node) + ", expected 1 to " + std::to_string(mesh_.points.size()));
        nodes[order[k]] = NodeId(static_cast<std::uint32_t>(node - 1));
      }
    }
  }

  void read_patches(std::uint64_t n) {
    reader_.require(n, sizeof(std::int32_t), "patch numbers of the boundary faces");
    std::map<std::int32_t, PatchId> by_number;
    const auto take = [&] {
      const std::int32_t number = reader_.take<std::int32_t>();
      const auto [entry, is_new] = by_number.try_emplace(number);
      if (is_new) entry->second = find_or_add_patch(mesh_.patches, "patch_" + std::to_string(number));
      return entry->second;
    };
    for (BoundaryTriangle& face : mesh_.boundary_triangles) face.patch = take();
    for (BoundaryQuad& face : mesh_.boundary_quads) face.patch = take();
  }

  ByteReader reader_;
  HybridMesh mesh_;
};

}  // namespace

HybridMesh read_volume_ugrid(const std::filesystem::path& path, const RunContext& context) {
  const std::endian order = order_of(path);
  const FileBuffer buffer = load_file(path, context);
  HybridMesh mesh = UgridReader(buffer, order).read(context);
  context.progress(0.7);
  orient_mesh(mesh, context);
  return mesh;
}

}  // namespace sterna::io
