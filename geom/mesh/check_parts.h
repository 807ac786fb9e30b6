// Shared by the check_*.cpp files only: numbers of the cells and faces of a HybridMesh, the list of findings, and the steps of the walker.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/parallel.h"
#include "geom/mesh/check.h"
#include "geom/mesh/dual_metrics.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/quality.h"

namespace sterna::check_parts {

inline constexpr std::size_t k_n_violations = static_cast<std::size_t>(Violation::periodic_mismatch) + 1;

/// Appends `more` to `all`; the combine function of every list that is gathered chunk by chunk.
template <class T>
std::vector<T> concatenate(std::vector<T> all, std::vector<T> more) {
  if (all.empty()) return more;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Counts all violations and keeps the first few of each kind. Serial; parallel steps hand over compact records in a fixed order.
class Findings {
 public:
  explicit Findings(int per_kind) : per_kind_(per_kind) {}
  /// Counts one violation. `describe()` returns a Point and a string for the finding; it is called only if the finding is kept.
  template <class Describe>
  void add(Violation violation, const Describe& describe) {
    if (counts_[index(violation)]++ >= per_kind_) return;
    auto [position, what] = describe();
    kept_.push_back({violation, position, std::move(what)});
  }
  /// Counts n violations without a description, after those that have one.
  void add_more(Violation violation, std::int64_t n) { counts_[index(violation)] += n; }
  /// Returns true if a gate ("G1", ...) has any violation so far.
  bool has_any_of(std::string_view gate) const;
  void store(CheckReport& report);

 private:
  static std::size_t index(Violation violation) { return static_cast<std::size_t>(violation); }
  int per_kind_;
  std::array<std::int64_t, k_n_violations> counts_{};
  std::vector<CheckFinding> kept_;
};

/// Numbers the cells: column * n_layers + layer, then prisms, pyramids, hexahedra, tetrahedra. Fully collapsed columns, and columns of fewer than n_layers
/// layers, hold numbers without cells.
class CellNumbers {
 public:
  explicit CellNumbers(Borrowed<const HybridMesh> mesh);
  std::uint64_t first_prism() const { return first_[0]; }
  std::uint64_t first_pyramid() const { return first_[1]; }
  std::uint64_t first_hexahedron() const { return first_[2]; }
  std::uint64_t first_tetrahedron() const { return first_[3]; }
  bool is_layer(std::uint64_t number) const { return number < first_[3]; }
  /// \pre the number has a cell.
  Cell cell(std::uint64_t number) const;
  /// Returns the mean of the cell's nodes.
  Point center(std::uint64_t number) const;
  /// Returns "prism 12 (column 3, layer 0)". The number counts cells of one kind in file order, so it is the same for columns and explicit cells.
  std::string name(std::uint64_t number) const;

 private:
  const HybridMesh& mesh_;
  std::array<std::uint64_t, 4> first_;
};

/// A face with three or four nodes, right-hand normal out of the cell (or out of the fluid); size 0: there is no such face.
struct Face {
  std::array<NodeId, 4> nodes{};
  std::uint8_t size = 0;
};

/// A side of a column that is not shared with exactly one other column. `corner` c means the base edge from line c to line c + 1.
struct OpenSide {
  std::uint32_t column = 0;
  std::uint8_t corner = 0;
};

/// Numbers every face that the columns do not prove to be inside: bottoms and tops of columns, their open sides, faces of explicit cells, boundary faces.
class FaceSlots {
 public:
  /// \throws Error(overflow) when the slots do not fit 31 bits (some 500 million tets).
  FaceSlots(Borrowed<const HybridMesh> mesh, Borrowed<const CellNumbers> cells, std::vector<OpenSide> open_sides);

  std::uint32_t size() const { return first_.back(); }
  std::uint32_t first_boundary() const { return first_[k_boundary_triangles]; }
  bool is_boundary(std::uint32_t slot) const { return slot >= first_boundary(); }
  Face face(std::uint32_t slot) const;
  Point center(std::uint32_t slot) const;
  /// Returns the number of the cell that has the face.
  /// \pre !is_boundary(slot)
  std::uint64_t owner(std::uint32_t slot) const;
  bool is_layer(std::uint32_t slot) const { return slot < first_[k_tetrahedra]; }
  /// Returns the number of the explicit tet that has the face.
  /// \pre !is_layer(slot), !is_boundary(slot)
  std::uint32_t tet_of(std::uint32_t slot) const { return (slot - first_[k_tetrahedra]) / 4; }
  /// Returns the column whose bottom the face is, if any.
  std::optional<std::uint32_t> column_under(std::uint32_t slot) const {
    if (slot >= first_[k_sides] || slot % 2 != 0) return std::nullopt;
    return slot / 2;
  }
  /// Returns the column whose top the face is, if any.
  std::optional<std::uint32_t> column_over(std::uint32_t slot) const {
    if (slot >= first_[k_sides] || slot % 2 == 0) return std::nullopt;
    return slot / 2;
  }
  /// Returns the existing tops of columns, ascending.
  std::vector<std::uint32_t> column_tops() const;
  std::size_t n_prism_caps() const { return 2 * ((first_[k_pyramids] - first_[k_prisms]) / 5); }
  /// Returns twice the number of the explicit prism whose bottom the face is, plus one if the face is its top; nothing for other faces.
  std::optional<std::uint32_t> prism_cap(std::uint32_t slot) const {
    if (slot < first_[k_prisms] || slot >= first_[k_pyramids] || (slot - first_[k_prisms]) % 5 < 3) return std::nullopt;
    return (slot - first_[k_prisms]) / 5 * 2 + ((slot - first_[k_prisms]) % 5 == 4 ? 1 : 0);
  }
  /// Returns the patch of a boundary face.
  PatchId patch(std::uint32_t slot) const;
  /// Returns "boundary triangle 12, patch wing", or the name of the face's cell.
  std::string name(std::uint32_t slot) const;

  /// Calls f(slot, Face) for every existing face, in parallel, in no particular order.
  template <class F>
  void for_each(const RunContext& context, const F& f) const;

 private:
  enum Block { k_caps, k_sides, k_prisms, k_pyramids, k_hexahedra, k_tetrahedra, k_boundary_triangles, k_boundary_quads, k_n_blocks };
  Face column_cap(std::uint32_t i) const;
  Face column_side(std::uint32_t i) const;
  template <class Cells, class F>
  void for_each_of(const RunContext& context, CellKind kind, Block block, const Cells& cells, const F& f) const;

  const HybridMesh& mesh_;
  const CellNumbers& cells_;
  std::vector<OpenSide> open_sides_;
  std::array<std::uint32_t, k_n_blocks + 1> first_{};
};

template <class Cells, class F>
void FaceSlots::for_each_of(const RunContext& context, CellKind kind, Block block, const Cells& cells, const F& f) const {
  const auto local_faces = cell_faces(kind);
  parallel_for(context, cells.size(), [&, local_faces](std::size_t c) {
    auto slot = static_cast<std::uint32_t>(first_[block] + c * local_faces.size());
    for (const LocalFace& local : local_faces) {
      Face face;
      face.size = local.size;
      for (std::size_t k = 0; k < local.size; ++k) face.nodes[k] = cells[c][local.nodes[k]];
      f(slot++, face);
    }
  });
}

template <class F>
void FaceSlots::for_each(const RunContext& context, const F& f) const {
  const auto visit = [&](std::size_t slot) {
    const Face one = face(static_cast<std::uint32_t>(slot));
    if (one.size > 0) f(static_cast<std::uint32_t>(slot), one);
  };
  parallel_for(context, first_[k_prisms], visit);
  for_each_of(context, CellKind::prism, k_prisms, mesh_.prisms, f);
  for_each_of(context, CellKind::pyramid, k_pyramids, mesh_.pyramids, f);
  for_each_of(context, CellKind::hexahedron, k_hexahedra, mesh_.hexahedra, f);
  for_each_of(context, CellKind::tetrahedron, k_tetrahedra, mesh_.tetrahedra, f);
  parallel_for(context, size() - first_boundary(), [&](std::size_t i) { visit(first_boundary() + i); });
}

/// Returns the patch whose boundary face is nearest to a point (by centroid), for messages: ", near patch wing" or "".
std::string near_patch(const HybridMesh& mesh, const Point& p);
/// Returns the name of a patch; also valid for an index out of range.
std::string patch_name(const HybridMesh& mesh, PatchId patch);

struct FaceIssue {
  Violation violation;
  std::uint32_t n_cells;      ///< number of cells that have the face
  std::uint32_t slot, other;  ///< slots of the face and of the second face concerned (or twice the same slot)
  friend auto operator<=>(const FaceIssue&, const FaceIssue&) = default;
};

struct FaceMatch {
  std::vector<FaceIssue> issues;              ///< sorted
  std::vector<std::uint32_t> outer;           ///< slots of cell faces that are covered by a boundary face
  std::vector<std::uint32_t> outer_boundary;  ///< slot of that boundary face, for each of `outer`
  std::vector<std::uint32_t> interface;       ///< slots of the envelope: faces that a layer cell and a tet share with opposite sense
  std::vector<std::uint32_t> interface_tets;  ///< slot of the tet's face, for each of `interface`
  std::optional<GateScan> tet_growth;         ///< volume ratios; ids are slots; only if requested
  bool with_pairs = false;
  std::vector<std::array<std::uint32_t, 2>> pairs;  ///< slots of faces that two cells share; only if requested
  std::vector<std::uint32_t> cap_neighbours;        ///< per bottom and top of explicit prisms: slot of the same face on the other side, or k_none if no
                                                    ///< other cell has it
};

/// Result of one pass over all cells.
struct CellScan {
  explicit CellScan(const GateTable& limits);
  std::vector<std::uint64_t> invalid;          ///< cell numbers, ascending
  std::vector<std::uint64_t> within_rounding;  ///< valid cells that are not above k_solver_margin; ascending
  CompensatedSum layer_volume, tet_volume;
  QualityScan quality;
  GateScan scaled_jacobian, min_dihedral, max_dihedral;  ///< ids are cell numbers
};

// The steps of the walker, each in its own file.

/// Reports bad_index, bad_point, broken_line, unused_node. Returns true if every index is valid and every point is finite.
bool check_indices(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, Findings& findings);
/// Returns the base edges that are not shared by exactly two columns of opposite sense. Edges between two collapsed lines have no faces and do not count.
/// `neighbours`: receives for each column and corner the column on the other side, or k_none if there is not exactly one.
std::vector<OpenSide> find_open_sides(const LayerBlock& layers, const RunContext& context, std::vector<std::uint32_t>* neighbours = nullptr);
/// Matches the faces of cells and boundary. Holds at most `faces_at_a_time` faces at a time, or the faces of one lowest node if they are more.
/// Measures volume ratios over the faces between explicit tets if `tet_volumes` holds the volumes of the tets.
FaceMatch match_faces(const FaceSlots& slots, std::size_t n_points, std::uint64_t faces_at_a_time, std::span<const double> tet_volumes, bool with_pairs,
                      const GateTable& limits, const RunContext& context);
void report_faces(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, Findings& findings);
CellScan scan_columns(const HybridMesh& mesh, bool with_quality, const GateTable& limits, const RunContext& context);
/// Adds the explicit cells to the scan of the columns.
CellScan scan_explicit_cells(CellScan columns, const HybridMesh& mesh, const CellNumbers& cells, bool with_quality, const GateTable& limits,
                             const RunContext& context);
/// Reports invalid_cell, cell_within_rounding (G3).
void report_cells(const HybridMesh& mesh, const CellNumbers& cells, const CellScan& scan, Findings& findings);
/// Returns the volumes of the explicit tets, m^3; zero if not positive.
std::vector<double> tet_volumes(const HybridMesh& mesh, const RunContext& context);
/// Compares the cell volumes with the flux through outer faces and envelope; fills the volumes of the report.
void check_volumes(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const CellScan& scan, const RunContext& context, CheckReport& report,
                   Findings& findings);
/// Triangles of one test for crossings: boundary faces, then the envelope.
struct CrossingCandidates {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> slots;  ///< slot of the face that each triangle represents
};
/// Result of a completed test for crossings.
struct CrossingTest {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  CrossingPairs crossings;
};
/// Returns all boundary faces except \p doubled, and \p envelope; both lists ascending.
CrossingCandidates crossing_candidates(const HybridMesh& mesh, const FaceSlots& slots, std::span<const std::uint32_t> doubled,
                                       std::span<const std::uint32_t> envelope);
/// Reports boundary_intersection, envelope_intersection. Reuses the result of `ahead` if it covers the same triangles.
void check_crossings(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const CrossingTest* ahead, const RunContext& context,
                     Findings& findings);
/// Reports overlapping_parts. Does nothing if faces or crossings are faulty, since then the fluid side of a boundary is undefined.
void check_cover(const HybridMesh& mesh, const FaceSlots& slots, const RunContext& context, Findings& findings);

/// Reports negative_sub_volume, open_dual_cell (G4), and returns the node statistics.
/// \pre no G1 violation
DualScan check_dual(const HybridMesh& mesh, const CellNumbers& cells, const DualScan* ahead, const GateTable& limits, const RunContext& context,
                    Findings& findings);
/// Reports off_symmetry_plane (G20).
void check_symmetry(const HybridMesh& mesh, const RunContext& context, Findings& findings);
/// Checks each pair of HybridMesh::periodic within periodic_tolerance(); adds matching pairs to the report.
void check_periodic(const HybridMesh& mesh, CheckReport& report, Findings& findings);
class GivenLayer;
/// Data for proofs that layer values are forced by the input surface; computed at the first call of get().
class LazyGivenLayer {
 public:
  explicit LazyGivenLayer(Borrowed<const HybridMesh> mesh);
  ~LazyGivenLayer();
  const GivenLayer& get();

 private:
  const HybridMesh& mesh_;
  std::unique_ptr<const GivenLayer> given_;
};

/// Evaluates the gates of layers, G8 and G10 - G13, and the coverage by patch. G9 is measured face by face at the interface. Returns the height along the
/// wall normal that a gap permits each line of the columns, m, infinite if no gap limits the line; empty if the layer request is unknown.
std::vector<double> judge_layers(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const GateTable& limits, const RunContext& context,
                                 CheckReport& report);
/// Evaluates G9. `gaps`: result of judge_layers().
void judge_interface(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, std::span<const double> gaps,
                     const GateTable& limits, LazyGivenLayer& given, const RunContext& context, CheckReport& report);
/// Evaluates the QUALITY gates and adds them to the report.
void judge_gates(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, const CellScan& scan, const DualScan* dual,
                 const GateTable& limits, LazyGivenLayer& given, const RunContext& context, CheckReport& report);
/// Returns the location and name of a node for the location list of a gate, with its line and layer if it has any.
std::pair<Point, std::string> describe_node(const HybridMesh& mesh, std::uint64_t node);

}  // namespace sterna::check_parts
