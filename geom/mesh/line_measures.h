// Measures along growth lines of layers, shared by the checks and the surface fields.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/layer_lines.h"

namespace sterna::check_parts {

/// Wall triangles around each line.
class Fans {
 public:
  explicit Fans(const LayerLines& lines);
  std::span<const std::uint32_t> around(std::uint32_t line) const { return {triangles_.data() + first_[line], first_[line + 1] - first_[line]}; }

 private:
  std::vector<std::uint32_t> first_, triangles_;
};

/// Unit normals of the symmetry patches at the base vertices of lines that stand on them. The body continues behind a symmetry plane as its mirror image, so
/// normals there are averaged with their images.
class MirrorNormals {
 public:
  explicit MirrorNormals(const HybridMesh& mesh);
  /// Returns the component of a normal at a node that lies in the symmetry planes through the node, normalised.
  Vec3 mirrored(NodeId node, Vec3 normal) const;
  /// Adds the images of the facet normals behind the symmetry planes through the node.
  void add_images(NodeId node, std::vector<Vec3>& normals) const;

 private:
  struct BaseNormal {
    NodeId node;
    PatchId patch;
    Vec3 normal;
  };
  std::span<const BaseNormal> of(NodeId node) const;
  std::vector<BaseNormal> base_normals_;  ///< ascending by node and patch
};

/// Facets around base vertices of column lines that belong to explicit prisms, not to columns: facets of wake sheets, and of walls beside lines that were
/// added. A line must also see these facets. Empty if the lines are not columns.
class FacetsOfExplicitPrisms {
 public:
  struct Facet {
    std::uint32_t line;
    Vec3 normal;   ///< unit, into the prism
    double angle;  ///< corner angle of the facet at the base vertex
  };
  FacetsOfExplicitPrisms(const HybridMesh& mesh, const LayerLines& lines);
  std::span<const Facet> around(std::uint32_t line) const;

 private:
  std::vector<Facet> facets_;  ///< ascending by line
};

/// Returns the worst ratio of consecutive heights, larger over smaller (G8); 1 for fewer than two heights.
double worst_growth(std::span<const double> heights);
/// Returns the angle of the steepest of the first cells against the facets around the base vertex, minus the best possible angle, radians (G10); `normals`:
/// unit normals of the facets.
double stack_angle(const HybridMesh& mesh, const LayerLines& lines, std::uint32_t line, const std::vector<Vec3>& normals);
/// Returns the larger of a ratio and its inverse; infinite if the ratio is not positive.
double deviation(double ratio);
/// Returns the deviation of a column's last height from the height of a regular tet on the mean envelope edge, as a ratio of at least 1 (G9).
double interface_jump(double last_height, double mean_edge);
/// Returns true if the last height is below that of the regular tet.
bool is_interface_low(double last_height, double mean_edge);
/// Returns true if HybridMesh::request has one entry per line of the columns.
bool is_request_usable(const HybridMesh& mesh);

}  // namespace sterna::check_parts
