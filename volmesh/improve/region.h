// A few hundred tetrahedra taken out of a mesh, with the operations that improve them; what lies outside does not change.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Limits that an improved tetrahedron keeps to, as one threshold on tet_quality().
struct QualityLimits {
  double target = 0.0;         ///< tetrahedra below are worked on
  double obtuse_weight = 1.0;  ///< of tet_quality(), such that both angle limits give the target
};
/// \p min_angle, \p max_angle of a dihedral, radians.
QualityLimits quality_limits(double min_angle, double max_angle);

/// Local mesh. Corners are local vertices; a vertex is free when all its tetrahedra are here and it is not of the boundary: it may move or vanish.
/// Every operation replaces some tetrahedra by others that fill the same space, all proven positive (exact), the worst of them better than the worst before.
class Region {
 public:
  using Corners = std::array<std::uint32_t, 4>;
  struct Tet {
    Corners corners;
    double quality = 0.0;
    bool is_alive = true;
    bool is_stuck = false;  ///< nothing helped since the region last changed
  };

  explicit Region(const QualityLimits& limits) : limits_(limits) {}
  /// Starts anew; memory is kept. \pre tetrahedra positive.
  void assign(std::span<const Vec3> points, std::span<const std::uint8_t> is_free, std::span<const Corners> tets);
  /// Worst first, until all reach the target or nothing helps. True when something changed.
  bool improve();

  std::span<const Vec3> points() const { return points_; }  ///< those given, moved perhaps, then new ones
  std::span<const Tet> tets() const { return tets_; }
  /// Unused: a free vertex that has vanished.
  bool is_used(std::uint32_t vertex) const { return !incident_[vertex].empty(); }

 private:
  using Face = std::array<std::uint32_t, 3>;
  struct Change {
    double quality = -1.0;                ///< of the worst new tetrahedron
    std::vector<std::uint32_t> removed;
    std::vector<Corners> added;
    std::uint32_t moved = k_none;         ///< vertex that goes to `place`; points().size(): a new one
    Vec3 place;
  };
  static constexpr std::uint32_t k_none = 0xffffffffu;

  double quality(const Corners& c) const;
  double quality(const Face& face, const Vec3& apex) const;
  double worst(std::span<const std::uint32_t> tets) const;
  bool is_better(double after, double before) const;
  /// Carries a change out if it is proven valid.
  bool apply(const Change& change);

  bool help(std::uint32_t tet);
  // region_flips.cpp
  bool remove_edge_or_faces(std::uint32_t tet);
  void try_edge(std::uint32_t a, std::uint32_t b, Change& best);
  void try_faces(std::uint32_t tet, std::size_t corner, Change& best);
  double extend_faces(std::uint32_t u, std::uint32_t v, std::uint32_t above, std::uint32_t below, std::uint32_t from_above, int depth, Change& change) const;
  std::uint32_t across(std::uint32_t tet, const Face& face) const;
  // region_points.cpp
  bool smooth(std::uint32_t tet);
  bool contract(std::uint32_t tet);
  bool insert(std::uint32_t tet);
  /// The place near `start` that makes the worst tetrahedron between it and the faces best.
  std::pair<Vec3, double> best_place(std::span<const Face> faces, const Vec3& start) const;
  double worst_from(std::span<const Face> faces, const Vec3& apex) const;
  /// The face opposite a corner, from which that corner lies on the positive side.
  static Face opposite(const Corners& c, std::size_t corner);

  QualityLimits limits_;
  std::vector<Vec3> points_;
  std::vector<std::uint8_t> is_free_;
  std::vector<Tet> tets_;
  std::vector<std::vector<std::uint32_t>> incident_;  ///< living tetrahedra of each vertex
};

}  // namespace sterna::volmesh
