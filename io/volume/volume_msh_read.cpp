#include <algorithm>

#include "geom/base/error.h"
#include "io/grammar/msh_parser.h"
#include "io/mesh/orientation.h"
#include "io/names/patch_names.h"
#include "io/volume/volume_msh.h"

namespace sterna::io {
namespace {

template <std::size_t N>
std::array<NodeId, N> node_ids(std::span<const std::uint32_t> nodes) {
  std::array<NodeId, N> result;
  for (std::size_t k = 0; k < N; ++k) result[k] = NodeId(nodes[k]);
  return result;
}

class MeshSink final : public MshSink {
 public:
  explicit MeshSink(const std::string& source) : source_(source) {}
  void reserve_points(std::size_t n) override { mesh_.points.reserve(n); }
  void add_point(const Vec3& p) override { mesh_.points.push_back(p); }
  void set_patch(std::string_view name) override {
    if (patch_.is_valid() && mesh_.patches[patch_].name == name) return;
    patch_ = find_or_add_patch(mesh_.patches, name);
  }
  void add_face(std::span<const std::uint32_t> corners) override {
    if (corners.size() == 3) mesh_.boundary_triangles.push_back({node_ids<3>(corners), patch_});
    else mesh_.boundary_quads.push_back({node_ids<4>(corners), patch_});
  }
  void add_cell(std::int64_t type, std::span<const std::uint32_t> nodes) override {
    if (type == k_msh_tetrahedron) mesh_.tetrahedra.push_back(node_ids<4>(nodes));
    else if (type == k_msh_hexahedron) mesh_.hexahedra.push_back(node_ids<8>(nodes));
    else if (type == k_msh_prism) mesh_.prisms.push_back(node_ids<6>(nodes));
    else mesh_.pyramids.push_back(node_ids<5>(nodes));
  }
  void add_curved_cell() override { throw_unsupported(source_, "volume elements of second order", "save linear elements"); }
  HybridMesh take() { return std::move(mesh_); }

 private:
  std::string source_;
  HybridMesh mesh_;
  PatchId patch_;
};

}  // namespace

HybridMesh read_volume_msh(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  MeshSink sink(buffer.source);
  parse_msh(buffer, context, sink);
  context.progress(0.7);
  HybridMesh mesh = sink.take();
  orient_mesh(mesh, context);
  return mesh;
}

}  // namespace sterna::io
