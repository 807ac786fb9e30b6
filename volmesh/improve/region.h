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

enum class VertexRole : std::uint8_t {
  kept,      ///< some of its tetrahedra are elsewhere
  free,      ///< may move or vanish
  boundary,  ///< of the domain: stays
};

/// Local mesh. Corners are local vertices. Tetrahedra with a vertex on the domain's boundary, where its angles may force bad ones, are a class of their own.
/// Every operation replaces some tetrahedra by others that fill the same space, all proven positive (exact): of the class that is worked on the worst gets better, of the
/// other class it does not get worse (unless it stays above the target).
class Region {
 public:
  using Corners = std::array<std::uint32_t, 4>;
  struct Tet {
    Corners corners;
    double quality = 0.0;
    bool is_alive = true;
  };

  explicit Region(const QualityLimits& limits) : limits_(limits) {}
  /// Starts anew; memory is kept. \pre tetrahedra positive.
  void assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets);
  /// Works on one tetrahedron and, worst first, on those that take its place, until they reach the target or nothing helps. True when something changed.
  bool improve(std::uint32_t tet);

  const QualityLimits& limits() const { return limits_; }
  std::span<const Vec3> points() const { return points_; }  ///< those given, moved perhaps, then new ones
  std::span<const Tet> tets() const { return tets_; }      ///< those given, dead perhaps, then new ones

 private:
  using Face = std::array<std::uint32_t, 3>;
  struct Change {
    double gain = -1.0;                   ///< smallest of the new tetrahedra
    std::vector<std::uint32_t> removed;
    std::vector<Corners> added;
    std::uint32_t moved = k_none;         ///< vertex that goes to `place`; points().size(): a new one
    Vec3 place;
  };
  static constexpr std::uint32_t k_none = 0xffffffffu;

  bool touches_boundary(const Corners& c) const;
  double quality(const Corners& c) const;
  /// Sets what new tetrahedra are compared with: the worst of each class among those that a change removes.
  void compare_with(std::span<const std::uint32_t> removed);
  /// Quality of a new tetrahedron over the worst removed one of its class; -1 when it is not allowed at all.
  double gain(const Corners& c) const { return gain_of(quality(c), touches_boundary(c)); }
  double gain(const Face& face, const Vec3& apex, bool is_boundary) const;
  double gain_of(double quality, bool is_boundary) const;
  /// Carries a change out if it is proven valid and better.
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
  double worst_gain(std::span<const Face> faces, std::span<const std::uint8_t> is_boundary, const Vec3& apex, double stop_below) const;
  bool touches_boundary(const Face& face) const;
  /// The face opposite a corner, from which that corner lies on the positive side.
  static Face opposite(const Corners& c, std::size_t corner);

  QualityLimits limits_;
  bool is_for_boundary_ = false;      ///< class of the tetrahedron that is worked on
  std::array<double, 2> before_{};    ///< worst removed quality of both classes, at most the target
  std::vector<Vec3> points_;
  std::vector<VertexRole> roles_;
  std::vector<Tet> tets_;
  std::vector<std::vector<std::uint32_t>> incident_;  ///< living tetrahedra of each vertex
};

}  // namespace sterna::volmesh
