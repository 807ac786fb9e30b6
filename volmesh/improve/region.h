// Some hundred tetrahedra taken out of a mesh, with the operations that improve them; what lies outside does not change.
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
  kept,           ///< some of its tetrahedra are elsewhere
  free,           ///< may move or vanish
  boundary,       ///< of the domain: stays
  kept_boundary,  ///< of the domain, and some of its tetrahedra are elsewhere
};
inline bool is_of_boundary(VertexRole role) { return role >= VertexRole::boundary; }

/// How often nothing may help a tetrahedron before it is given up. Away from the boundary all can be helped, sooner or later; slender ones at it hardly ever,
/// and they are many.
int max_failures(const std::array<Vec3, 4>& corners, bool is_at_boundary);

/// A boundary triangle with a layer under it.
struct LayerFace {
  std::array<std::uint32_t, 3> corners;  ///< ascending
  double weight = 0.0;                   ///< six volumes of the tetrahedron on it, times this, are its volume over the one that fits the last prism
  friend bool operator<(const LayerFace& a, const LayerFace& b) { return a.corners < b.corners; }
};
/// The quality of a tetrahedron on top of the layer by the last prisms under it; nothing for others. \p faces sorted, \p n_boundary: all their corners are
/// below
std::optional<double> quality_on_layer(const TetShape& shape, const std::array<std::uint32_t, 4>& corners, std::span<const LayerFace> faces,
                                       std::uint32_t n_boundary, const QualityLimits& limits);

/// Local mesh. Corners are local vertices. Each tetrahedron below twice the target has a cost (cost()), more for one beyond the hard limits, and for one
/// without a vertex on the domain's boundary, where its angles may force bad ones. Every operation replaces some tetrahedra by others that fill the same space,
/// all proven positive (exact), of a smaller sum of costs, and none worse than the worst that it removes or than the floor of the limits.
class Region {
 public:
  using Corners = std::array<std::uint32_t, 4>;
  struct Tet {
    Corners corners;
    double angle_quality = 0.0;  ///< tet_quality()
    double quality = 0.0;        ///< of its angles and of its size
    double cost = 0.0;
    std::uint32_t tried = 0;      ///< clock when nothing helped it
    std::uint8_t n_failures = 0;  ///< how often nothing helped it
    bool is_alive = true;
  };

  /// What sizes are compared with; empty where they are not limited.
  struct Sizes {
    std::span<const double> vertex_weights;  ///< size_weight() of each vertex
    std::span<const LayerFace> layer_faces;  ///< sorted; vertices of the boundary come first
  };

  explicit Region(const QualityLimits& limits) : limits_(limits) {}
  /// Starts anew; memory is kept.
  /// \pre tetrahedra positive.
  void assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets, const Sizes& sizes);
  void assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets) { assign(points, roles, tets, Sizes{}); }
  /// Works on the bad ones of these tetrahedra and on all bad ones that take their place, worst first, until they reach the target, nothing helps as they and
  /// their neighbours are, or nothing helped max_failures() times; only tries with all neighbours here count, for one flip with a tetrahedron elsewhere may be
  /// all that it takes. `n_failures` of the given ones so far. Ends early once `most_effort` tetrahedra were graded. True when something changed.
  bool improve(std::span<const std::uint32_t> tets, std::span<const std::uint8_t> n_failures, std::uint64_t most_effort = k_endless);
  static constexpr std::uint64_t k_endless = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t effort() const { return effort_; }  ///< tetrahedra graded since assign()
  const QualityLimits& limits() const { return limits_; }
  std::span<const Vec3> points() const { return points_; }  ///< those given, moved perhaps, then new ones
  std::span<const double> size_weights() const { return size_weights_; }
  std::span<const Tet> tets() const { return tets_; }  ///< those given, dead perhaps, then new ones

 private:
  using Face = std::array<std::uint32_t, 3>;
  struct Change {
    double drop = 0.0;  ///< of the sum of costs
    std::vector<std::uint32_t> removed;
    std::vector<Corners> added;
    std::uint32_t moved = k_none;  ///< vertex that goes to `place`; points().size(): a new one
    Vec3 place;
    double size_weight = 1.0;  ///< of that vertex
  };
  static constexpr std::uint32_t k_none = 0xffffffffu;
  /// A change must lower the sum of costs by this much: progress that cannot go on for ever.
  static constexpr double k_least_drop = 0.01;
  static constexpr double k_infinite = std::numeric_limits<double>::infinity();

  bool touches_boundary(const Corners& c) const;
  bool touches_boundary(const Face& face) const;
  struct Grade {
    double of_angles = -1.0;
    double quality = -1.0;  ///< of the size, too
  };
  Grade grade(const TetShape& shape, const Corners& c, double weights) const;
  Grade grade(const Corners& c) const;
  Grade grade(const Face& face, const Vec3& apex) const;
  void add(const Corners& c);
  /// Of a vertex that is added within a tetrahedron.
  double mean_weight(const Corners& c) const;
  double cost_of(double quality, bool is_boundary) const;
  /// Of what is below the target.
  double weight_of(double quality, bool is_boundary) const;
  /// How fast the cost falls with quality.
  double slope_of_cost(double quality, bool is_boundary) const;
  /// Sets what new tetrahedra are compared with: the sum of the costs of those that a change removes, and the worst quality allowed after it.
  void compare_with(std::span<const std::uint32_t> removed);
  /// Infinite for a tetrahedron that the change must not make.
  double cost(const Corners& c) const;
  double cost(const Face& face, const Vec3& apex) const;
  /// Carries a change out if it is proven valid and lowers the sum of costs by more than `least_drop`.
  bool apply(const Change& change, double least_drop = k_least_drop);
  /// Takes back all that was applied since `log_` had this length.
  void undo(std::size_t log_size);
  /// Carries out the best change of each kind even if it costs, then helps what is bad around it: kept when all in all the costs are lower.
  bool detour(std::uint32_t tet);
  bool settle(const Change& change);

  /// Whether nothing helps this tetrahedron as it and its neighbours are now.
  bool is_stuck(std::uint32_t tet) const;
  bool is_given_up(std::uint32_t tet) const;
  bool has_all_neighbours(std::uint32_t tet) const;
  bool help(std::uint32_t tet);
  bool help_with_what_is_there(std::uint32_t tet);
  // region_flips.cpp
  void try_edge(std::uint32_t a, std::uint32_t b, Change& best);
  void try_faces(std::uint32_t tet, std::size_t corner, Change& best);
  double extend_faces(std::uint32_t u, std::uint32_t v, std::uint32_t above, std::uint32_t below, std::uint32_t from_above, int depth, Change& change) const;
  std::uint32_t across(std::uint32_t tet, const Face& face) const;
  void try_edges_and_faces(std::uint32_t tet, Change& best);
  // region_points.cpp
  void try_smoothing(std::uint32_t tet, Change& best);
  void try_contractions(std::uint32_t tet, Change& best);
  void try_insertions(std::uint32_t tet, Change& best);
  /// Tetrahedra that a new point may take the place of.
  struct Cavity {
    std::vector<std::uint32_t> tets;
    std::vector<Face> faces;  ///< around them
    Vec3 place;
    double drop = 0.0;  ///< of the sum of costs with the point there
  };
  /// The best around a tetrahedron for a point there, if any.
  std::optional<Cavity> cavity_of(std::uint32_t tet, const Vec3& place) const;
  void try_insertion(const Cavity& cavity, Change& best);
  /// The place near `start` where the sum of the costs of the tetrahedra between it and the faces is lowest.
  std::pair<Vec3, double> best_place(std::span<const Face> faces, const Vec3& start) const;
  double sum_of_costs(std::span<const Face> faces, const Vec3& apex, double stop_above) const;
  /// The face opposite a corner, from which that corner lies on the positive side.
  static Face opposite(const Corners& c, std::size_t corner);

  QualityLimits limits_;
  double cost_before_ = 0.0;
  double worst_allowed_ = 0.0;
  double apex_weight_ = 1.0;  ///< size weight of the vertex whose place is looked for
  std::vector<Vec3> points_;
  std::vector<VertexRole> roles_;
  std::vector<double> size_weights_;
  std::vector<LayerFace> layer_faces_;
  std::uint32_t n_boundary_ = 0;  ///< vertices, the first ones; where there are layer faces
  std::vector<Tet> tets_;
  std::vector<std::vector<std::uint32_t>> incident_;  ///< living tetrahedra of each vertex
  std::vector<std::uint32_t> changed_;                ///< clock of the last change at each vertex
  std::uint32_t clock_ = 1;
  mutable std::uint64_t effort_ = 0;  ///< tetrahedra graded since assign()
  struct Applied {
    std::vector<std::uint32_t> removed;
    std::size_t n_added = 0;
    std::uint32_t moved = k_none;
    bool is_new = false;
    Vec3 place;  ///< of `moved` before
    double drop = 0.0;
  };
  std::vector<Applied> log_;  ///< while a detour is under way
  bool is_logging_ = false;
};

}  // namespace sterna::volmesh
