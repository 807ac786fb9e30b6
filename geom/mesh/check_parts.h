// Shared by the check_*.cpp files only: numbering of cells and faces of a HybridMesh, collection of findings, and the steps of the walker.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

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
  /// Counts one violation; `describe() -> CheckFinding-like {Point, string}` is called only when it is kept.
  template <class Describe>
  void add(Violation violation, const Describe& describe) {
    if (counts_[index(violation)]++ >= per_kind_) return;
    auto [position, what] = describe();
    kept_.push_back({violation, position, std::move(what)});
  }
  /// Counts n violations without a description, after those that have one.
  void add_more(Violation violation, std::int64_t n) { counts_[index(violation)] += n; }
  /// Whether a gate ("G1", ...) has any violation so far.
  bool has_any_of(std::string_view gate) const;
  void store(CheckReport& report);

 private:
  static std::size_t index(Violation violation) { return static_cast<std::size_t>(violation); }
  int per_kind_;
  std::array<std::int64_t, k_n_violations> counts_{};
  std::vector<CheckFinding> kept_;
};

/// Numbers the cells: column * n_layers + layer (fully collapsed columns, and those of fewer than n_layers layers, hold numbers without cells), then prisms,
/// pyramids, hexahedra, tetrahedra.
class CellNumbers {
 public:
  explicit CellNumbers(const HybridMesh& mesh);
  std::uint64_t first_prism() const { return first_[0]; }
  std::uint64_t first_pyramid() const { return first_[1]; }
  std::uint64_t first_hexahedron() const { return first_[2]; }
  std::uint64_t first_tetrahedron() const { return first_[3]; }
  bool is_layer(std::uint64_t number) const { return number < first_[3]; }
  /// \pre the number has a cell.
  Cell cell(std::uint64_t number) const;
  /// Mean of the cell's nodes.
  Point center(std::uint64_t number) const;
  /// "prism 12 (column 3, layer 0)": the number counts cells of one kind in file order, so it is the same for columns and explicit cells.
  std::string name(std::uint64_t number) const;

 private:
  const HybridMesh& mesh_;
  std::array<std::uint64_t, 4> first_;
};

/// Three or four nodes, right-hand normal out of the cell (or out of the fluid); size 0: there is no such face.
struct Face {
  std::array<NodeId, 4> nodes{};
  std::uint8_t size = 0;
};

/// A side of a column that no single other column shares: `corner` c is the base edge from line c to line c + 1.
struct OpenSide {
  std::uint32_t column = 0;
  std::uint8_t corner = 0;
};

/// Numbers every face that is not proved inside the columns: bottoms and tops of columns, their open sides, faces of explicit cells, boundary faces.
class FaceSlots {
 public:
  /// \throws Error(overflow) when the slots do not fit 31 bits (some 500 million tets).
  FaceSlots(const HybridMesh& mesh, const CellNumbers& cells, std::vector<OpenSide> open_sides);

  std::uint32_t size() const { return first_.back(); }
  std::uint32_t first_boundary() const { return first_[k_boundary_triangles]; }
  bool is_boundary(std::uint32_t slot) const { return slot >= first_boundary(); }
  Face face(std::uint32_t slot) const;
  Point center(std::uint32_t slot) const;
  /// Number of the cell that has the face.
  /// \pre !is_boundary(slot)
  std::uint64_t owner(std::uint32_t slot) const;
  bool is_layer(std::uint32_t slot) const { return slot < first_[k_tetrahedra]; }
  /// Number of the explicit tet that has the face.
  /// \pre !is_layer(slot), !is_boundary(slot)
  std::uint32_t tet_of(std::uint32_t slot) const { return (slot - first_[k_tetrahedra]) / 4; }
  /// Column whose bottom the face is, if it is one.
  std::optional<std::uint32_t> column_under(std::uint32_t slot) const {
    if (slot >= first_[k_sides] || slot % 2 != 0) return std::nullopt;
    return slot / 2;
  }
  /// Column whose top the face is, if it is one.
  std::optional<std::uint32_t> column_over(std::uint32_t slot) const {
    if (slot >= first_[k_sides] || slot % 2 == 0) return std::nullopt;
    return slot / 2;
  }
  /// Existing tops of columns, ascending.
  std::vector<std::uint32_t> column_tops() const;
  std::size_t n_prism_caps() const { return 2 * ((first_[k_pyramids] - first_[k_prisms]) / 5); }
  /// Twice the number of the explicit prism that has the face as its bottom, one more as its top; nothing for other faces.
  std::optional<std::uint32_t> prism_cap(std::uint32_t slot) const {
    if (slot < first_[k_prisms] || slot >= first_[k_pyramids] || (slot - first_[k_prisms]) % 5 < 3) return std::nullopt;
    return (slot - first_[k_prisms]) / 5 * 2 + ((slot - first_[k_prisms]) % 5 == 4 ? 1 : 0);
  }
  /// Patch of a boundary face.
  PatchId patch(std::uint32_t slot) const;
  /// "boundary triangle 12, patch wing", or the face's cell.
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

/// Name of the patch whose nearest boundary face (by centroid) is next to a point, for messages: ", near patch wing" or "".
std::string near_patch(const HybridMesh& mesh, const Point& p);
/// Name of a patch, also for an index out of range.
std::string patch_name(const HybridMesh& mesh, PatchId patch);

struct FaceIssue {
  Violation violation;
  std::uint32_t n_cells;      ///< that have the face
  std::uint32_t slot, other;  ///< of the face itself and of the second one concerned (or the same)
  friend auto operator<=>(const FaceIssue&, const FaceIssue&) = default;
};

struct FaceMatch {
  std::vector<FaceIssue> issues;              ///< sorted
  std::vector<std::uint32_t> outer;           ///< cell faces with a boundary face
  std::vector<std::uint32_t> outer_boundary;  ///< the boundary face of each of them
  std::vector<std::uint32_t> interface;       ///< faces of layer cells that a tet shares with opposite sense: the envelope
  std::vector<std::uint32_t> interface_tets;  ///< the tet's face of each of them
  std::optional<GateScan> tet_growth;         ///< ids are slots; only when asked for
  bool with_pairs = false;
  std::vector<std::array<std::uint32_t, 2>> pairs;  ///< faces that two cells share; only when asked for
  std::vector<std::uint32_t> cap_neighbours;  ///< of explicit prisms, bottom and top: slot on the other side of a face that two cells share, else k_no_slot
};
inline constexpr std::uint32_t k_no_slot = 0xffffffffu;

/// What one pass over all cells finds.
struct CellScan {
  explicit CellScan(const GateTable& limits);
  std::vector<std::uint64_t> invalid;          ///< cell numbers, ascending
  std::vector<std::uint64_t> within_rounding;  ///< of valid cells that are not above k_solver_margin; ascending
  CompensatedSum layer_volume, tet_volume;
  QualityScan quality;
  GateScan scaled_jacobian, min_dihedral, max_dihedral;  ///< ids are cell numbers
};

// The steps, each in its own file.

/// bad_index, bad_point, broken_line, unused_node. Returns whether every index can be used and every point is finite.
bool check_indices(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, Findings& findings);
/// Base edges that are not shared by exactly two columns of opposite sense; edges between two collapsed lines have no faces and do not count.
/// `neighbours`: gets for each column and corner the column on the other side, k_no_slot where there is not exactly one.
std::vector<OpenSide> find_open_sides(const LayerBlock& layers, const RunContext& context, std::vector<std::uint32_t>* neighbours = nullptr);
/// At most `faces_at_a_time` faces are held at a time, or those of one lowest node if they are more.
/// Volume ratios over the faces between explicit tets are measured when `tet_volumes` has the tets' volumes.
FaceMatch match_faces(const FaceSlots& slots, std::size_t n_points, std::uint64_t faces_at_a_time, std::span<const double> tet_volumes, bool with_pairs,
                      const GateTable& limits, const RunContext& context);
void report_faces(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, Findings& findings);
CellScan scan_columns(const HybridMesh& mesh, bool with_quality, const GateTable& limits, const RunContext& context);
/// Adds the explicit cells to what was found in the columns.
CellScan scan_explicit_cells(CellScan columns, const HybridMesh& mesh, const CellNumbers& cells, bool with_quality, const GateTable& limits,
                             const RunContext& context);
/// invalid_cell, cell_within_rounding (G3).
void report_cells(const HybridMesh& mesh, const CellNumbers& cells, const CellScan& scan, Findings& findings);
/// Volumes of the explicit tets, m^3; zero where not positive.
std::vector<double> tet_volumes(const HybridMesh& mesh, const RunContext& context);
/// Compares the cells' volumes with the flux through outer faces and envelope; fills the report's volumes.
void check_volumes(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const CellScan& scan, const RunContext& context, CheckReport& report,
                   Findings& findings);
/// The triangles of one test for crossings: boundary faces, then the envelope.
struct CrossingCandidates {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> slots;  ///< of the face that each triangle stands for
};
/// A test for crossings that has been made.
struct CrossingTest {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  CrossingPairs crossings;
};
/// All boundary faces but \p doubled ones, and \p envelope; both ascending.
CrossingCandidates crossing_candidates(const HybridMesh& mesh, const FaceSlots& slots, std::span<const std::uint32_t> doubled,
                                       std::span<const std::uint32_t> envelope);
/// boundary_intersection, envelope_intersection. Takes the result of `ahead` if that was about the same triangles.
void check_crossings(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const CrossingTest* ahead, const RunContext& context,
                     Findings& findings);
/// overlapping_parts; does nothing when faces or crossings were found wrong, since then no side of a boundary is the fluid's.
void check_cover(const HybridMesh& mesh, const FaceSlots& slots, const RunContext& context, Findings& findings);

/// negative_sub_volume, open_dual_cell (G4), and the nodes' statistics.
/// \pre no G1 violation
DualScan check_dual(const HybridMesh& mesh, const CellNumbers& cells, const DualScan* ahead, const GateTable& limits, const RunContext& context,
                    Findings& findings);
/// off_symmetry_plane (G20).
void check_symmetry(const HybridMesh& mesh, const RunContext& context, Findings& findings);
/// Each of HybridMesh::periodic, within periodic_tolerance(); fills the report's list of those that match.
void check_periodic(const HybridMesh& mesh, CheckReport& report, Findings& findings);
class GivenLayer;
/// What proves that values of layers are forced, made when it is first asked for.
class LazyGivenLayer {
 public:
  explicit LazyGivenLayer(const HybridMesh& mesh);
  ~LazyGivenLayer();
  const GivenLayer& get();

 private:
  const HybridMesh& mesh_;
  std::unique_ptr<const GivenLayer> given_;
};

/// Gates of layers: G8, G10 - G13, and the coverage by patch. G9 is measured face by face at the interface. Returns the height along the wall's normal that a
/// gap permits each line of the columns, m, infinite where none limits it; nothing where it is not known what was asked for.
std::vector<double> judge_layers(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const GateTable& limits, const RunContext& context,
                                 CheckReport& report);
/// `gaps`: of judge_layers.
void judge_interface(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, std::span<const double> gaps,
                     const GateTable& limits, LazyGivenLayer& given, const RunContext& context, CheckReport& report);
/// The QUALITY gates into the report.
void judge_gates(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, const CellScan& scan, const DualScan* dual,
                 const GateTable& limits, LazyGivenLayer& given, const RunContext& context, CheckReport& report);
/// Middle of an entity and its name for a place of a gate: of a node, with its line and layer if it has any.
std::pair<Point, std::string> describe_node(const HybridMesh& mesh, std::uint64_t node);

}  // namespace sterna::check_parts
