// Passes over the bad tetrahedra of a mesh, in disjoint groups that are worked on in parallel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "volmesh/improve/region.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Each pass: the bad tetrahedra along a space-filling curve, so many to a group; a group owns the vertices around its bad ones unless a group before it does;
/// the tetrahedra between vertices of one group are a Region of their own; the results are put back in order. A tetrahedron that its nearest neighbourhood
/// could not help gets a wider one; one that this cannot help either is left until something changes beside it.
class Improver {
 public:
  using Corners = std::array<std::uint32_t, 4>;

  /// \pre verify_tetrahedra() passes.
  Improver(const TetraBoundary& boundary, TetraResult& tets, const QualityLimits& limits, const RunContext& context);
  /// Before run(): what to work on, all of it below the target.
  void work_on(std::span<const std::uint32_t> bad);
  /// The same: all that is below the target but these (ascending).
  void work_on_all_but(std::span<const std::uint32_t> left);
  /// The same: those of some that are below the target.
  void work_on_bad_of(std::span<const std::uint32_t> some);
  /// Until nothing is left to work on, nothing helps, or passes take more than they bring. Number of passes made.
  int run(int max_passes);
  std::uint64_t effort() const { return effort_; }  ///< Region::effort() of all passes
  /// Removes what has vanished: numbers close up in order.
  void finish(TetraResult& result);

 private:
  struct Bad {
    double quality;
    std::uint32_t tet;
  };
  struct Job {
    std::vector<std::uint32_t> bad;        ///< that the group is for
    std::vector<std::uint32_t> vertices;   ///< ascending in the end: local to global
    std::size_t n_inner = 0;               ///< of these, of all rings but the last
    std::vector<std::uint32_t> tets;       ///< ascending
    std::vector<std::uint32_t> worked;     ///< places in `tets` of its bad ones
    std::vector<std::uint8_t> n_failures;  ///< of these
    bool has_changed = false;
    std::uint64_t effort = 0;            ///< Region::effort()
    std::vector<Vec3> points;            ///< of the local vertices, new ones at the end
    std::vector<double> size_weights;    ///< likewise
    std::vector<std::uint32_t> removed;  ///< of `tets`
    std::vector<Corners> added;          ///< local corners
  };

  double quality(const Corners& c) const;
  void find_sizes(const TetraBoundary& boundary);
  void find_layer_faces(const TetraBoundary& boundary);
  std::vector<LayerFace> local_layer_faces(const Job& job, std::uint32_t number) const;
  bool is_alive(std::uint32_t tet) const;
  std::uint32_t owner_of(std::uint32_t vertex) const { return owner_[vertex] & 0x0fffffffu; }
  void drop_good();
  double amount_of_bad() const;
  bool is_dear(std::span<const std::uint64_t> left_after, std::span<const double> bad_after) const;
  void list_incident();
  std::vector<Job> choose_jobs(int pass) const;
  void claim_ring(Job& job, std::uint32_t number, std::uint32_t ring);
  void work(Job& job, std::uint32_t number, std::uint64_t most_effort, Region& region);
  void put_back(const Job& job);
  /// Calls f for every living tetrahedron at a vertex, perhaps twice.
  template <class F>
  void for_each_at(std::uint32_t vertex, const F& f) const;

  QualityLimits limits_;
  std::uint64_t effort_ = 0;  ///< tetrahedra graded in all passes
  std::size_t n_fixed_;
  std::size_t n_about_;  ///< tetrahedra among which bad ones were looked for
  std::vector<Corners>& tets_;
  const RunContext& context_;
  std::vector<Vec3> points_;
  std::vector<double> size_weights_;               ///< of each vertex; empty where sizes are not limited
  std::vector<LayerFace> layer_faces_;             ///< likewise, of all the boundary; sorted
  std::vector<std::uint8_t> n_failures_;           ///< of each tetrahedron: how often nothing helped it
  std::vector<Bad> bad_;                           ///< may name tetrahedra twice, or good ones, until drop_good()
  std::vector<std::uint32_t> first_, incident_;    ///< tetrahedra at each vertex as they were at first
  std::vector<std::vector<std::uint32_t>> later_;  ///< and those that came to it since
  std::vector<std::uint32_t> owner_;               ///< of each vertex: ring around the bad ones in the highest bits, number of the job in the others
  std::vector<std::uint32_t> local_;               ///< of each vertex: place among its job's vertices
};

}  // namespace sterna::volmesh
