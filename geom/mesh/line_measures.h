// What the checks and the fields of surfaces measure along lines of layers, in one place.
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

/// Unit normals of the symmetry patches at the feet of lines that stand on them: the body goes on behind with its mirror image, so normals there are means with
/// theirs.
class MirrorFeet {
 public:
  explicit MirrorFeet(const HybridMesh& mesh);
  /// The part of a normal at a node that lies in the planes that the node is on, as a unit.
  Vec3 mirrored(NodeId node, Vec3 normal) const;
  /// Adds the images of the facets' normals behind the planes that the node is on.
  void add_images(NodeId node, std::vector<Vec3>& normals) const;

 private:
  struct Foot {
    NodeId node;
    PatchId patch;
    Vec3 normal;
  };
  std::span<const Foot> of(NodeId node) const;
  std::vector<Foot> feet_;  ///< ascending by node and patch
};

/// Facets around the feet of columns' lines that carry explicit prisms and no column: of wake sheets, and of walls beside lines that were added. A line sees
/// them, too. None where lines are no columns.
class FacetsOfExplicitPrisms {
 public:
  struct Facet {
    std::uint32_t line;
    Vec3 normal;   ///< unit, into the prism
    double angle;  ///< of the facet's corner at the foot
  };
  FacetsOfExplicitPrisms(const HybridMesh& mesh, const LayerLines& lines);
  std::span<const Facet> around(std::uint32_t line) const;

 private:
  std::vector<Facet> facets_;  ///< ascending by line
};

/// The larger over the smaller of consecutive heights, at worst (G8); 1 for fewer than two.
double worst_growth(std::span<const double> heights);
/// Angle of the steepest of the first cells against the facets around the foot, less the best possible, radians (G10); `normals` are the facets' units.
double stack_angle(const HybridMesh& mesh, const LayerLines& lines, std::uint32_t line, const std::vector<Vec3>& normals);
/// The larger over the smaller of a ratio's two sides; infinite where it is not positive.
double deviation(double ratio);
/// Last height of a column against that of a regular tet on the envelope's mean edge: deviation of their ratio (G9), at least 1.
double interface_jump(double last_height, double mean_edge);
/// Whether the last height is below that of the regular tet.
bool is_interface_low(double last_height, double mean_edge);
/// Whether HybridMesh::request has one entry per line of the columns.
bool is_request_usable(const HybridMesh& mesh);

}  // namespace sterna::check_parts
