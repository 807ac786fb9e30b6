#include <array>
#include <map>

#include "io/grammar/ugrid_source.h"
#include "io/mesh/orientation.h"
#include "io/mesh/surface_builder.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_ugrid.h"

namespace sterna::io {
namespace {

using Order = std::array<std::uint8_t, 8>;
constexpr Order k_same = {0, 1, 2, 3, 4, 5, 6, 7};

class UgridReader {
 public:
  UgridReader(const FileBuffer& buffer, const UgridVariant& variant, std::map<std::int64_t, UgridPatch> patches)
      : source_(buffer, variant), patches_(std::move(patches)) {}

  HybridMesh read(const RunContext& context) {
    source_.require_integers(7, 1, "the numbers of nodes, triangles, quads, tetrahedra, pyramids, prisms and hexahedra");
    std::array<std::uint64_t, 7> n{};
    for (std::uint64_t& count : n) count = source_.count("the number of points, faces or cells");
    read_points(n[0]);
    read_elements(
        mesh_.boundary_triangles, n[1], k_same, [](BoundaryTriangle & face) -> auto& { return face.nodes; });
    read_elements(
        mesh_.boundary_quads, n[2], k_same, [](BoundaryQuad & face) -> auto& { return face.nodes; });
    read_patches(n[1] + n[2]);
    context.progress(0.4);
    const auto same = [](auto& nodes) -> auto& { return nodes; };
    read_elements(mesh_.tetrahedra, n[3], k_same, same);
    read_elements(mesh_.pyramids, n[4], k_ugrid_pyramid, same);
    read_elements(mesh_.prisms, n[5], k_same, same);
    read_elements(mesh_.hexahedra, n[6], k_same, same);
    return std::move(mesh_);
  }

 private:
  void read_points(std::uint64_t n) {
    source_.require_reals(n, 3, "coordinates of the nodes");
    if (n >= NodeId::k_invalid) throw_id_overflow(n);
    mesh_.points.resize(n);
    for (std::uint64_t i = 0; i < n; ++i) mesh_.points.raw()[i] = source_.point(i);
  }

  template <class Element, class NodesOf>
  void read_elements(std::vector<Element>& elements, std::uint64_t n, const Order& order, const NodesOf& nodes_of) {
    Element first{};
    source_.require_integers(n, nodes_of(first).size(), "nodes of the elements");
    elements.resize(n);
    for (Element& element : elements) {
      auto& nodes = nodes_of(element);
      for (std::size_t k = 0; k < nodes.size(); ++k) nodes[order[k]] = NodeId(source_.node(mesh_.points.size()));
    }
  }

  void read_patches(std::uint64_t n) {
    source_.require_integers(n, 1, "patch numbers of the boundary faces");
    std::map<std::int64_t, PatchId> by_number;
    const auto take = [&] {
      const std::int64_t number = source_.integer("the patch number of a face");
      const auto [entry, is_new] = by_number.try_emplace(number);
      if (is_new) entry->second = patch_of(number);
      return entry->second;
    };
    for (BoundaryTriangle& face : mesh_.boundary_triangles) face.patch = take();
    for (BoundaryQuad& face : mesh_.boundary_quads) face.patch = take();
  }

  PatchId patch_of(std::int64_t number) {
    const auto found = patches_.find(number);
    const bool is_named = found != patches_.end() && !found->second.name.empty();
    const PatchId patch = find_or_add_patch(mesh_.patches, is_named ? found->second.name : numbered_patch(number));
    if (found != patches_.end())
      if (const auto kind = kind_of_condition(found->second.condition)) mesh_.patches[patch].kind = *kind;
    return patch;
  }

  UgridSource source_;
  std::map<std::int64_t, UgridPatch> patches_;
  HybridMesh mesh_;
};

}  // namespace

HybridMesh read_volume_ugrid(const std::filesystem::path& path, const RunContext& context) {
  const UgridVariant variant = ugrid_variant(path);
  const FileBuffer buffer = load_file(path, context);
  HybridMesh mesh = UgridReader(buffer, variant, read_mapbc(path, context)).read(context);
  context.progress(0.7);
  orient_mesh(mesh, context);
  return mesh;
}

std::filesystem::path ugrid_kinds_path(const std::filesystem::path& path) { return found_mapbc(path); }

}  // namespace sterna::io
