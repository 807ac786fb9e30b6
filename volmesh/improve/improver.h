// Passes over the bad tetrahedra of a mesh, in disjoint groups that are processed in parallel.
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

/// Improves a mesh in passes. Each pass takes the bad tetrahedra along a space-filling curve, in groups of fixed size. A group owns the vertices around its bad
/// tetrahedra unless an earlier group owns them. The tetrahedra between vertices of one group form a Region. The results are put back in order. A tetrahedron
/// that could not be improved in its nearest neighbourhood gets a wider one. If this fails, too, the tetrahedron is left until a neighbour changes.
class Improver {
 public:
  using Corners = std::array<std::uint32_t, 4>;

  /// \pre verify_tetrahedra() passes
  Improver(const TetraBoundary& boundary, TetraResult& tets, const QualityLimits& limits, const RunContext& context);
  /// Selects the tetrahedra to improve. Called before run(); all of them are below the target.
  void work_on(std::span<const std::uint32_t> bad);
  /// Selects all tetrahedra below the target except those in `left` (ascending). Called before run().
  void work_on_all_but(std::span<const std::uint32_t> left);
  /// Selects the tetrahedra of `some` that are below the target. Called before run().
  void work_on_bad_of(std::span<const std::uint32_t> some);
  /// Runs passes until no selected tetrahedron is left, nothing improves, or the cost of the passes exceeds their benefit. Returns the number of passes.
  int run(int max_passes);
  std::uint64_t effort() const { return effort_; }  ///< sum of Region::effort() over all passes
  /// Removes deleted tetrahedra and vertices. The others are renumbered in their order.
  void finish(TetraResult& result);

 private:
  struct Bad {
    double quality;
    std::uint32_t tet;
  };
  struct Job {
    std::vector<std::uint32_t> bad;        ///< bad tetrahedra of the group
    std::vector<std::uint32_t> vertices;   ///< global numbers of the local vertices, ascending at the end
    std::size_t n_inner = 0;               ///< number of vertices in all rings except the last
    std::vector<std::uint32_t> tets;       ///< global numbers of the tetrahedra, ascending
    std::vector<std::uint32_t> worked;     ///< indices in `tets` of the bad tetrahedra
    std::vector<std::uint8_t> n_failures;  ///< number of failed attempts for each of `worked`
    bool has_changed = false;
    std::uint64_t effort = 0;            ///< Region::effort() of this job
    std::vector<Vec3> points;            ///< points of the local vertices, new ones at the end
    std::vector<double> size_weights;    ///< weights of the local vertices, new ones at the end
    std::vector<std::uint32_t> removed;  ///< indices in `tets`
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
  /// Calls f for every existing tetrahedron at a vertex, possibly twice.
  template <class F>
  void for_each_at(std::uint32_t vertex, const F& f) const;

  QualityLimits limits_;
  std::uint64_t effort_ = 0;  ///< number of tetrahedra graded in all passes
  std::size_t n_fixed_;
  std::size_t n_about_;  ///< number of tetrahedra among which bad ones are searched
  std::vector<Corners>& tets_;
  RunContext context_;
  std::vector<Vec3> points_;
  std::vector<double> size_weights_;               ///< weight of each vertex; empty if sizes are not limited
  std::vector<LayerFace> layer_faces_;             ///< layer faces of the whole boundary, sorted; empty if sizes are not limited
  std::vector<std::uint8_t> n_failures_;           ///< for each tetrahedron: number of failed attempts
  std::vector<Bad> bad_;                           ///< until drop_good(), it may contain tetrahedra twice, or good ones
  std::vector<std::uint32_t> first_, incident_;    ///< initial tetrahedra at each vertex
  std::vector<std::vector<std::uint32_t>> later_;  ///< tetrahedra that were added later at each vertex
  std::vector<std::uint32_t> owner_;  ///< for each vertex: its ring around the bad tetrahedra in the highest bits, and the number of the job in the other bits
  std::vector<std::uint32_t> local_;  ///< for each vertex: index among its job's vertices
};

}  // namespace sterna::volmesh
