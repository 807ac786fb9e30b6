#include "geom/mesh/layer_lines.h"

#include <algorithm>
#include <atomic>
#include <map>

namespace sterna::check_parts {
namespace {

constexpr std::uint32_t k_no_node = NodeId::k_invalid;

template <class Nodes>
std::array<std::uint32_t, 3> sorted_key(const Nodes& nodes) {
  std::array<std::uint32_t, 3> key = {nodes[0].value(), nodes[1].value(), nodes[2].value()};
  std::sort(key.begin(), key.end());
  return key;
}

/// One prism of a stack: nodes of its lower face (normal upwards) and upper face, and the slot above it.
struct Step {
  std::array<NodeId, 3> bottom, top;
  std::uint32_t beyond;
};

Step step_into(const HybridMesh& mesh, const FaceMatch& match, std::uint32_t cap) {
  const auto& p = mesh.prisms[cap / 2];
  if (cap % 2 == 0) return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, match.cap_neighbours[cap + 1]};
  return {{p[3], p[5], p[4]}, {p[0], p[2], p[1]}, match.cap_neighbours[cap - 1]};
}

/// Calls f(Step) for each prism of the stack that starts with a cap.
template <class F>
void walk_stack(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, std::uint32_t cap, const F& f) {
  for (std::size_t n = 0; n < mesh.prisms.size(); ++n) {
    const Step step = step_into(mesh, match, cap);
    f(step);
    if (step.beyond == k_no_slot) return;
    const auto next = slots.prism_cap(step.beyond);
    if (!next) return;
    cap = *next;
  }
}

}  // namespace

LayerLines::LayerLines(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const RunContext& context) {
  if (mesh.layers.n_columns() > 0) {
    use_columns(mesh, slots, match);
  } else if (!mesh.prisms.empty()) {
    find_stacks(mesh, slots, match, context);
  } else {
    reason_ = "the mesh has no prisms";
  }
}

void LayerLines::use_columns(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match) {
  layers_ = &mesh.layers;
  n_lines_ = mesh.layers.n_lines();
  triangles_ = mesh.layers.base;
  patches_.assign(triangles_.size(), PatchId{});
  for (std::size_t i = 0; i < match.outer.size(); ++i)
    if (const auto column = slots.column_under(match.outer[i])) patches_[*column] = slots.patch(match.outer_boundary[i]);
  // Columns without cells have no line: their wall triangle is a face of a tet.
  std::map<std::array<std::uint32_t, 3>, std::size_t> bare;
  for (std::size_t c = 0; c < triangles_.size(); ++c)
    if (mesh.layers.layers_of_column(c) == 0)
      bare.emplace(sorted_key(std::array{node(triangles_[c][0], 0), node(triangles_[c][1], 0), node(triangles_[c][2], 0)}), c);
  if (bare.empty()) return;
  for (const BoundaryTriangle& face : mesh.boundary_triangles)
    if (const auto found = bare.find(sorted_key(face.nodes)); found != bare.end()) patches_[found->second] = face.patch;
}

void LayerLines::find_stacks(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const RunContext& context) {
  std::vector<std::uint32_t> starts;  // caps on walls
  std::vector<std::uint8_t> has_layers(mesh.patches.size(), 0);
  for (std::size_t i = 0; i < match.outer.size(); ++i) {
    const auto cap = slots.prism_cap(match.outer[i]);
    const PatchId patch = slots.patch(match.outer_boundary[i]);
    if (!cap || patch.index() >= mesh.patches.size() || mesh.patches[patch].kind != PatchKind::wall) continue;
    starts.push_back(*cap);
    has_layers[patch.index()] = 1;
  }
  if (starts.empty()) {
    reason_ = "no prism has a face on a wall";
    return;
  }
  std::sort(starts.begin(), starts.end());
  std::vector<std::uint32_t> above(mesh.points.size(), k_no_node);
  parallel_for(context, starts.size(), [&](std::size_t i) {
    walk_stack(mesh, slots, match, starts[i], [&](const Step& step) {
      for (std::size_t k = 0; k < 3; ++k) std::atomic_ref<std::uint32_t>(above[step.bottom[k].index()]).store(step.top[k].value(), std::memory_order_relaxed);
    });
  });
  // Stacks around a node must agree on the node above it. If they do not, one of them finds a different node.
  const std::int64_t n_torn = parallel_reduce(
      context, starts.size(), std::int64_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::int64_t n = 0;
        for (std::size_t i = begin; i < end; ++i)
          walk_stack(mesh, slots, match, starts[i], [&](const Step& step) {
            for (std::size_t k = 0; k < 3; ++k) n += above[step.bottom[k].index()] != step.top[k].value();
          });
        return n;
      },
      [](std::int64_t a, std::int64_t b) { return a + b; });
  if (n_torn > 0) {
    reason_ = "the prisms on the walls do not form growth lines";
    return;
  }
  std::vector<std::uint32_t> line_of(mesh.points.size(), k_no_node);
  std::vector<std::uint32_t> base_nodes;
  for (const BoundaryTriangle& face : mesh.boundary_triangles) {
    if (has_layers[face.patch.index()] == 0) continue;
    std::array<std::uint32_t, 3> lines;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& line = line_of[face.nodes[k].index()];
      if (line == k_no_node) {
        line = static_cast<std::uint32_t>(base_nodes.size());
        base_nodes.push_back(face.nodes[k].value());
      }
      lines[k] = line;
    }
    own_triangles_.push_back({lines[0], lines[2], lines[1]});  // boundary faces point out of the fluid
    patches_.push_back(face.patch);
  }
  n_lines_ = base_nodes.size();
  triangles_ = own_triangles_;
  first_.assign(1, 0);
  for (const std::uint32_t base_node : base_nodes) {
    const std::size_t start = nodes_.size();
    nodes_.push_back(base_node);
    // Stacks between two walls are cut at the second wall; no line is longer than all stacks together.
    for (std::uint32_t node = above[base_node]; node != k_no_node && line_of[node] == k_no_node && nodes_.size() - start <= mesh.prisms.size();
         node = above[node])
      nodes_.push_back(node);
    first_.push_back(nodes_.size());
  }
}

}  // namespace sterna::check_parts
