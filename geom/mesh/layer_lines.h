// Lines of layers, whatever form the mesh has: its columns, or stacks of explicit prisms found by walking from the walls cap by cap.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Lines above the wall triangles of patches that carry layers. A wall vertex without a layer has a line of one node.
class LayerLines {
 public:
  LayerLines(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const RunContext& context);

  /// Why there are none; empty when there are some.
  const std::string& reason() const { return reason_; }
  /// Whether they are the mesh's own columns, so that HybridMesh::request speaks of them.
  bool are_columns() const { return layers_ != nullptr; }
  std::size_t n_lines() const { return n_lines_; }
  /// Lines of each wall triangle, normal into the fluid.
  std::span<const std::array<std::uint32_t, 3>> triangles() const { return triangles_; }
  /// Patch of each wall triangle; invalid where the boundary has no such face.
  PatchId patch(std::size_t triangle) const { return patches_[triangle]; }
  int n_layers(std::uint32_t line) const {
    if (layers_ != nullptr) return layers_->n_steps(line);
    return static_cast<int>(first_[line + 1] - first_[line]) - 1;
  }
  NodeId node(std::uint32_t line, int j) const {
    if (layers_ != nullptr) return layers_->node(line, j);
    return NodeId(nodes_[first_[line] + static_cast<std::uint64_t>(j)]);
  }

 private:
  void use_columns(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match);
  void find_stacks(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const RunContext& context);

  std::string reason_;
  const LayerBlock* layers_ = nullptr;
  std::size_t n_lines_ = 0;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::array<std::uint32_t, 3>> own_triangles_;
  std::vector<PatchId> patches_;
  std::vector<std::uint64_t> first_;  ///< of stacks: nodes of a line
  std::vector<std::uint32_t> nodes_;
};

}  // namespace sterna::check_parts
