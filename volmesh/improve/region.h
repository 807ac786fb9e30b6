// A few hundred tetrahedra extracted from a mesh, with the operations that improve them. The rest of the mesh does not change.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "geom/base/vec3.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {

enum class VertexRole : std::uint8_t {
  kept,           ///< fixed, because some of its tetrahedra are outside the region
  free,           ///< may move or be removed
  boundary,       ///< fixed, because it is on the boundary of the domain
  kept_boundary,  ///< on the boundary of the domain, and some of its tetrahedra are outside the region
};
inline bool is_of_boundary(VertexRole role) { return role >= VertexRole::boundary; }

/// Returns the number of failed attempts after which a tetrahedron is not tried again. Away from the boundary all tetrahedra can be improved eventually.
/// Slender tetrahedra at the boundary can hardly ever be improved, and there are many of them.
int max_failures(const std::array<Vec3, 4>& corners, bool is_at_boundary);

/// A boundary triangle with a layer below it.
struct LayerFace {
  std::array<std::uint32_t, 3> corners;  ///< vertices, ascending
  /// This value times six times the volume of the tetrahedron on the face is the ratio of its volume to the volume that fits the last prism.
  double weight = 0.0;
  friend bool operator<(const LayerFace& a, const LayerFace& b) { return a.corners < b.corners; }
};
/// Returns the quality of a tetrahedron on top of the layer relative to the last prisms below it; nothing for other tetrahedra. \p faces sorted. \p n_boundary
/// all corners of the faces are below this number
std::optional<double> quality_on_layer(const TetShape& shape, const std::array<std::uint32_t, 4>& corners, std::span<const LayerFace> faces,
                                       std::uint32_t n_boundary, const QualityLimits& limits);

/// Local mesh, whose corners are local vertices. Each tetrahedron below twice the target has a cost (cost()). The cost is higher beyond the hard limits. It is
/// also higher for tetrahedra without a vertex on the domain's boundary, because the angles of the boundary do not force those. Every operation replaces some
/// tetrahedra by others that fill the same space. All new tetrahedra are proved positive (exact test) and have a smaller sum of costs. None of them is worse
/// than the worst tetrahedron removed, or than the floor of the limits.
class Region {
 public:
  using Corners = std::array<std::uint32_t, 4>;
  struct Tet {
    Corners corners;
    double angle_quality = 0.0;  ///< quality of its angles, tet_quality()
    double quality = 0.0;        ///< quality of its angles and of its size
    double cost = 0.0;
    std::uint32_t tried = 0;      ///< time of the last failed attempt
    std::uint8_t n_failures = 0;  ///< number of failed attempts
    bool is_alive = true;
  };

  /// Reference sizes; empty if sizes are not limited.
  struct Sizes {
    std::span<const double> vertex_weights;  ///< size_weight() of each vertex
    std::span<const LayerFace> layer_faces;  ///< sorted; the vertices of the boundary come first
  };

  explicit Region(const QualityLimits& limits) : limits_(limits) {}
  /// Resets the region to new data. The allocated memory is kept.
  /// \pre tetrahedra are positive
  void assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets, const Sizes& sizes);
  void assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets) { assign(points, roles, tets, Sizes{}); }
  /// Improves the bad ones of these tetrahedra, and all bad ones that replace them, worst first. A tetrahedron is finished if it reaches the target, if no
  /// operation helps with its current neighbours, or after max_failures() failed attempts. Attempts count only if all neighbours are in the region, because one
  /// flip with a tetrahedron outside may be sufficient. \p n_failures numbers of failed attempts of the given tetrahedra so far. Ends early once `most_effort`
  /// tetrahedra were graded. Returns true if something changed.
  bool improve(std::span<const std::uint32_t> tets, std::span<const std::uint8_t> n_failures, std::uint64_t most_effort = k_endless);
  static constexpr std::uint64_t k_endless = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t effort() const { return effort_; }  ///< number of tetrahedra graded since assign()
  const QualityLimits& limits() const { return limits_; }
  std::span<const Vec3> points() const { return points_; }  ///< given points, some of them moved, then new points
  std::span<const double> size_weights() const { return size_weights_; }
  std::span<const Tet> tets() const { return tets_; }  ///< given tetrahedra, some of them deleted, then new ones

 private:
  using Face = std::array<std::uint32_t, 3>;
  struct Change {
    double drop = 0.0;  ///< decrease of the sum of costs
    std::vector<std::uint32_t> removed;
    std::vector<Corners> added;
    std::uint32_t moved = k_none;  ///< vertex that moves to `location`; if it is points().size(), a new vertex
    Vec3 location;
    double size_weight = 1.0;  ///< size weight of that vertex
  };
  static constexpr std::uint32_t k_none = 0xffffffffu;
  /// Smallest decrease of the sum of costs by a change. It guarantees termination.
  static constexpr double k_least_drop = 0.01;
  static constexpr double k_infinite = std::numeric_limits<double>::infinity();

  bool touches_boundary(const Corners& c) const;
  bool touches_boundary(const Face& face) const;
  struct Grade {
    double of_angles = -1.0;
    double quality = -1.0;  ///< quality, including that of the size
  };
  Grade grade(const TetShape& shape, const Corners& c, double weights) const;
  Grade grade(const Corners& c) const;
  Grade grade(const Face& face, const Vec3& apex) const;
  void add(const Corners& c);
  /// Returns the size weight of a vertex that is added within a tetrahedron.
  double mean_weight(const Corners& c) const;
  double cost_of(double quality, bool is_boundary) const;
  /// Returns the cost factor of a tetrahedron below the target.
  double weight_of(double quality, bool is_boundary) const;
  /// Returns the derivative of the cost with respect to a decrease of quality.
  double slope_of_cost(double quality, bool is_boundary) const;
  /// Sets the reference for new tetrahedra: the sum of the costs of the tetrahedra that a change removes, and the lowest quality allowed after it.
  void compare_with(std::span<const std::uint32_t> removed);
  /// Returns the cost; infinite for a tetrahedron that the change must not create.
  double cost(const Corners& c) const;
  double cost(const Face& face, const Vec3& apex) const;
  /// Applies a change if it is proved valid and lowers the sum of costs by more than `least_drop`.
  bool apply(const Change& change, double least_drop = k_least_drop);
  /// Reverts all changes that were applied since `log_` had this length.
  void undo(std::size_t log_size);
  /// Applies the best change of each kind even if it increases the cost, then improves bad tetrahedra around it. The result is kept if the total cost is lower.
  bool detour(std::uint32_t tet);
  bool settle(const Change& change);

  /// Returns true if no operation helps this tetrahedron with its current neighbours.
  bool is_stuck(std::uint32_t tet) const;
  bool is_given_up(std::uint32_t tet) const;
  bool has_all_neighbours(std::uint32_t tet) const;
  bool help(std::uint32_t tet);
  bool help_with_what_is_there(std::uint32_t tet);
  // Defined in region_flips.cpp.
  void try_edge(std::uint32_t a, std::uint32_t b, Change& best);
  void try_faces(std::uint32_t tet, std::size_t corner, Change& best);
  double extend_faces(std::uint32_t u, std::uint32_t v, std::uint32_t above, std::uint32_t below, std::uint32_t from_above, int depth, Change& change) const;
  std::uint32_t across(std::uint32_t tet, const Face& face) const;
  void try_edges_and_faces(std::uint32_t tet, Change& best);
  // Defined in region_points.cpp.
  void try_smoothing(std::uint32_t tet, Change& best);
  void try_contractions(std::uint32_t tet, Change& best);
  void try_insertions(std::uint32_t tet, Change& best);
  /// Tetrahedra that a new point may replace.
  struct Cavity {
    std::vector<std::uint32_t> tets;
    std::vector<Face> faces;  ///< outer faces of these tetrahedra
    Vec3 location;
    double drop = 0.0;  ///< decrease of the sum of costs with the point at this location
  };
  /// Returns the best cavity around a tetrahedron for a point at `location`; nothing if there is none.
  std::optional<Cavity> cavity_of(std::uint32_t tet, const Vec3& location) const;
  void try_insertion(const Cavity& cavity, Change& best);
  /// Returns the location near `start` with the lowest cost. The cost is the sum over the tetrahedra between the location and the faces.
  std::pair<Vec3, double> best_location(std::span<const Face> faces, const Vec3& start) const;
  double sum_of_costs(std::span<const Face> faces, const Vec3& apex, double stop_above) const;
  /// Returns the face opposite a corner, oriented so that the corner lies on its positive side.
  static Face opposite(const Corners& c, std::size_t corner);

  QualityLimits limits_;
  double cost_before_ = 0.0;
  double worst_allowed_ = 0.0;
  double apex_weight_ = 1.0;  ///< size weight of the vertex whose location is optimised
  std::vector<Vec3> points_;
  std::vector<VertexRole> roles_;
  std::vector<double> size_weights_;
  std::vector<LayerFace> layer_faces_;
  std::uint32_t n_boundary_ = 0;  ///< number of boundary vertices, which come first; set if there are layer faces
  std::vector<Tet> tets_;
  std::vector<std::vector<std::uint32_t>> incident_;  ///< existing tetrahedra at each vertex
  std::vector<std::uint32_t> changed_;                ///< time of the last change at each vertex
  std::uint32_t clock_ = 1;
  mutable std::uint64_t effort_ = 0;  ///< number of tetrahedra graded since assign()
  struct Applied {
    std::vector<std::uint32_t> removed;
    std::size_t n_added = 0;
    std::uint32_t moved = k_none;
    bool is_new = false;
    Vec3 location;  ///< previous location of `moved`
    double drop = 0.0;
  };
  std::vector<Applied> log_;  ///< changes during a detour
  bool is_logging_ = false;
};

}  // namespace sterna::volmesh
