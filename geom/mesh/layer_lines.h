// Growth lines of layers for any form of mesh: its columns, or stacks of explicit prisms found by walking from the walls cap by cap.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Growth lines above the wall triangles of patches that carry layers. A wall vertex without a layer has a line of one node.
class LayerLines {
 public:
  LayerLines(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const RunContext& context);

  /// Returns why there are no lines; empty if there are lines.
  const std::string& reason() const { return reason_; }
  /// Returns true if the lines are the mesh's own columns, so that HybridMesh::request refers to them.
  bool are_columns() const { return layers_ != nullptr; }
  std::size_t n_lines() const { return n_lines_; }
  /// Returns the lines of each wall triangle, normal into the fluid.
  std::span<const std::array<std::uint32_t, 3>> triangles() const { return triangles_; }
  /// Returns the patch of each wall triangle; invalid if the boundary has no such face.
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
  std::vector<std::uint64_t> first_;  ///< for stacks: nodes of a line
  std::vector<std::uint32_t> nodes_;
};

}  // namespace sterna::check_parts
