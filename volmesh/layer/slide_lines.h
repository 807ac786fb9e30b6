// Adapts the last prisms and the tetrahedra on them to each other. After the tetrahedra were made, tops of growth lines move slightly.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/case/improve_options.h"
#include "volmesh/improve/tet_quality.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// The improvement of tetrahedra keeps the boundary. If the boundary itself is the cause of bad cells, the LineSlider moves the end of a growth line slightly
/// lower, higher or sideways. Such causes are folds of the layer's top, sides of prisms that cannot be decomposed, and columns that get narrow. The nodes of
/// the growth line follow: the first cell stays bit-exactly the same, and the other cells keep their growth law.
class LineSlider {
 public:
  /// \p layers made by assemble_layers(), without tetrahedra; \p boundary is boundary_of(layers). slide() changes both.
  LineSlider(Borrowed<HybridMesh> layers, Borrowed<FillBoundary> boundary, const ImproveOptions& options, const RunContext& context);

  /// Makes one round over the growth lines at the worst locations. Each growth line moves to where the costs around it are lower. This is a pattern search with
  /// decreasing steps within `slide_share` of its height (half of it upwards). From the second round on, the range is k_far_reach times larger if a hard limit
  /// is missed. Costs are: angles beyond the limits of improvement; steps of volume and height between last prisms and tetrahedra, and among tetrahedra; face
  /// weights (OpenFOAM); sides that are nearly impossible to decompose. Growth lines at open boundaries, beside collapsed ones, and those that end on outer
  /// faces do not move.
  /// \pre the tetrahedra fill the boundary, and every cell is valid
  /// \post the same, checked by exact tests of all cells at growth lines that moved; no growth line grows faster than before or than requested. Returns the
  /// growth lines that moved, ascending. Parallel: growth lines that do not affect each other's costs move at the same time. Moves at most k_most_lines growth
  /// lines, which take some ms each
  std::vector<std::uint32_t> slide(const TetraResult& tets);
  std::size_t n_moved() const { return moved_.size(); }  ///< number of growth lines that moved in all rounds

  static constexpr std::size_t k_most_lines = 4000;

 private:
  using Line = std::uint32_t;
  struct Side {
    std::array<Line, 2> ends;  ///< ascending
    std::uint32_t column;
    friend auto operator<=>(const Side&, const Side&) = default;
  };
  /// All entities that depend on the height of a growth line.
  struct Star {
    std::vector<std::uint32_t> columns, tets;
    std::vector<std::uint32_t> tet_on;                     ///< for each column the tetrahedron on its top
    std::vector<std::array<std::uint32_t, 2>> neighbours;  ///< pairs of these tetrahedra with a common face
  };
  struct Fault {
    double excess;  ///< the worst value at the growth line, relative to its limit
    Line line;
  };
  /// State of a growth line at the beginning of the first round, and its displacement since.
  struct Moved {
    std::vector<Point> nodes;
    double share = 1.0;  ///< fraction of the original height
    Vec3 shift;          ///< m, additional displacement of its top
    double reach = 0.0;  ///< limit of the height change and of the displacement, relative to the height
  };
  struct Interface {
    double volume, height, weight;  ///< ratio of each value to its limit
    double worst() const { return std::max({volume, height, weight}); }
  };

  void lock_lines();
  void list_sides();
  const Vec3& point(const TetraResult& tets, std::uint32_t v) const;
  std::array<Vec3, 4> corners(const TetraResult& tets, std::uint32_t t) const;
  std::vector<std::array<std::uint32_t, 2>> neighbours_in(const TetraResult& tets, const std::vector<std::uint32_t>& star) const;
  double excess_of_step(const TetraResult& tets, const std::array<std::uint32_t, 2>& pair) const;
  std::vector<Fault> steps_beyond(const TetraResult& tets) const;
  double excess_of_tet(const TetraResult& tets, std::uint32_t t) const;
  Interface interface_of(const TetraResult& tets, std::uint32_t column, std::uint32_t tet) const;
  double excess_of_side(std::size_t side) const;
  std::size_t side_of(std::uint32_t column, std::size_t k) const;
  std::size_t partner(std::size_t side) const;
  std::vector<std::uint32_t> tets_on_columns(const TetraResult& tets) const;
  std::vector<Fault> find_faults(const TetraResult& tets, const std::vector<std::uint32_t>& tet_on) const;
  std::vector<Star> stars_of(const TetraResult& tets, const std::vector<Fault>& faults, const std::vector<std::uint32_t>& tet_on) const;
  double cost(const TetraResult& tets, const Star& star, double stop_at) const;
  bool is_valid(const TetraResult& tets, const Star& star) const;
  std::vector<Point> nodes_of(Line line) const;
  void put(Line line, const std::vector<Point>& nodes);
  Vec3 to_middle(Line line, const Star& star) const;
  bool help(const TetraResult& tets, Line line, const Star& star, Moved& state);
  std::vector<Line> lines_seen_from(const TetraResult& tets, const Star& star) const;
  std::vector<std::vector<std::uint32_t>> faults_seen(const TetraResult& tets, const std::vector<Fault>& faults, const std::vector<Star>& stars) const;
  std::vector<std::vector<std::uint32_t>> independent_groups(const std::vector<Star>& stars, const std::vector<std::vector<std::uint32_t>>& seen) const;
  double allowed_growth(Line line) const;

  HybridMesh& mesh_;
  FillBoundary& boundary_;
  GateTable gates_;
  QualityLimits limits_;
  double share_;
  double largest_step_ = 0.0;  ///< largest ratio of the volumes of tetrahedra with a common face; these volumes also determine the weight of the face
  RunContext context_;
  std::vector<std::uint8_t> is_locked_;  ///< flag of each growth line
  std::vector<Side> sides_;              ///< sides of all columns, sorted
  std::map<Line, Moved> moved_;
  int n_rounds_ = 0;
};

}  // namespace sterna::volmesh
