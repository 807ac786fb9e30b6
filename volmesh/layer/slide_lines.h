// Last prisms and the tetrahedra on them brought to fit each other: tops of lines move a little after the tetrahedra were made.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/case/improve_options.h"
#include "volmesh/improve/tet_quality.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Improvement of tetrahedra keeps the boundary; where the boundary itself is at fault (folds of the layer's top, sides of prisms that cannot be cut, columns
/// that get narrow), a line ends a little lower, higher or aside instead. Its nodes follow: the first cell stays to the bit, the others keep their kind of
/// growth.
class LineSlider {
 public:
  /// \p layers: of assemble_layers(), without tetrahedra; \p boundary: boundary_of() it. Both must outlive this and are changed by slide().
  LineSlider(HybridMesh& layers, FillBoundary& boundary, const ImproveOptions& options, const RunContext& context);

  /// One round over the lines at the worst places: each moves, by a pattern search of smaller and smaller steps within `slide_share` of its height (half of it
  /// up), where the costs around it are lower (k_far_reach times as far from the second round on where a hard limit is missed): of angles beyond the limits of
  /// improvement, of steps of volume and height between last prisms and tetrahedra and among these, of face weights (OpenFOAM), of sides that can hardly be
  /// cut. Lines at rims, beside collapsed ones, and those that end on outer faces stay.
  /// \pre tets fill the boundary, every cell valid. \post the same, by exact tests of all cells at lines that moved; no line grows faster than before or than
  /// was asked for.
  /// Returns the lines that moved, ascending. Parallel: lines that do not see each other move at the same time. At most k_most_lines; some ms each.
  std::vector<std::uint32_t> slide(const TetraResult& tets);
  std::size_t n_moved() const { return moved_.size(); }  ///< lines, in all rounds

  static constexpr std::size_t k_most_lines = 4000;

 private:
  using Line = std::uint32_t;
  struct Side {
    std::array<Line, 2> ends;  ///< ascending
    std::uint32_t column;
    friend auto operator<=>(const Side&, const Side&) = default;
  };
  /// All that depends on a line's height.
  struct Star {
    std::vector<std::uint32_t> columns, tets;
    std::vector<std::uint32_t> tet_on;                     ///< of each column: the tetrahedron on its top
    std::vector<std::array<std::uint32_t, 2>> neighbours;  ///< pairs of the tetrahedra with a common face
  };
  struct Fault {
    double excess;  ///< the worst at the line, over its limit
    Line line;
  };
  /// How a line was when the first round began, and where it is now.
  struct Moved {
    std::vector<Point> nodes;
    double share = 1.0;  ///< of that height
    Vec3 shift;          ///< of its top beside that, m
    double reach = 0.0;  ///< how far share and shift may go, over the height
  };
  struct Interface {
    double volume, height, weight;  ///< each over its limit
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
  double largest_step_ = 0.0;  ///< of the volumes of tetrahedra with a common face; the weight of a face is that of their volumes
  const RunContext& context_;
  std::vector<std::uint8_t> is_locked_;  ///< of each line
  std::vector<Side> sides_;              ///< of all columns, sorted
  std::map<Line, Moved> moved_;
  int n_rounds_ = 0;
};

}  // namespace sterna::volmesh
