// The invariant walker. Proves that a HybridMesh tiles its domain and has a valid dual mesh, or reports the locations of violations (VALID: G1-G4 and G20 of
// docs/method/quality.md, "Gates"). Measures the quality gates (QUALITY: G5-G16, OpenFOAM's measures and the targets of G3 and G4).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

enum class Violation {
  unmatched_face,              ///< G1: a cell face that no other cell and no boundary face shares
  overmatched_face,            ///< G1: more than two cells at a face, or a boundary face between two cells
  same_sense_face,             ///< G1: two cells (or cell and boundary face) see the face from the same side
  stray_boundary_face,         ///< G1: a boundary face that belongs to no cell
  duplicate_marker,            ///< G1: a boundary face that belongs to two patches
  bad_index,                   ///< G1: a node, line or patch index out of range, or a node repeated in one cell or boundary face
  bad_point,                   ///< G1: a coordinate that is not finite
  unused_node,                 ///< G1
  boundary_intersection,       ///< G2: boundaries cross each other or themselves
  envelope_intersection,       ///< G2: the interface between layers and tets crosses itself or a boundary
  invalid_cell,                ///< G3: exact wedge, pyramid, tet or hexahedron test
  volume_mismatch,             ///< the cell volumes do not equal the flux (divergence theorem): wall-to-envelope flux for layer cells, envelope-to-farfield
                               ///< flux for tets
  broken_line,                 ///< G1: two growth lines that share nodes, so that at least one has no nodes of its own (column meshes only)
  overlapping_parts,           ///< tiling: the fluid side of a boundary is covered more than once or lies outside the mesh (closed boundaries only)
  no_cells,                    ///< tiling: the mesh has no cell at all
  cell_within_rounding,        ///< G3: a valid cell whose volume or Jacobian is not above k_solver_margin in double precision (computed_volumes.h)
  negative_sub_volume,         ///< G4: a cell with a dual sub-volume that is not positive (exact)
  sub_volume_within_rounding,  ///< G4: a dual sub-volume, as computed by SU2, that is not above k_solver_margin
  open_dual_cell,              ///< G4: a control volume whose faces do not close (floating point, limit Measure::dual_closure)
  off_symmetry_plane,          ///< G20: a node of a symmetry patch off the patch's plane
  periodic_mismatch,           ///< G20: periodic sides that do not match node by node and face by face
};
std::string_view to_string(Violation v);
/// Returns "G1", "G2", "G3", "G4", "G20" or "tiling".
std::string_view gate_of(Violation v);
/// Returns the title of a gate of the verdict VALID, such as "conformity".
std::string_view title_of_gate(std::string_view gate);

struct CheckFinding {
  Violation violation;
  Point position;
  std::string what;  ///< name of the entity: "prism 12 (column 3, layer 0), patch wing"
};

struct Quality {
  double min_wedge_quality = 1.0;  ///< scaled Jacobian of the worst prism
  double min_dihedral = 0.0;       ///< radians, over the explicit tets
  double max_dihedral = 0.0;       ///< radians, over the explicit tets
  Point worst_prism;               ///< location of min_wedge_quality
  Point worst_tet;                 ///< location of min_dihedral
  Point most_obtuse_tet;           ///< location of max_dihedral
  /// Fractions of the prisms with a skew angle, eq. (13), below 6, below 18 and above 60 degrees. Pyramids and tets of columns over collapsed lines count as
  /// prisms above 60.
  double skew_below_6 = 0.0, skew_below_18 = 0.0, skew_above_60 = 0.0;
};

/// Layer coverage of one patch, by area (G12). Full: the layer has at least 0.9 of the target height along the wall normal. Compressed: its height is below the
/// number of layers times the first height.
struct PatchCoverage {
  std::string patch;
  double area = 0.0;                                                    ///< m^2 of wall
  double full = 0.0, reduced = 0.0, compressed = 0.0, collapsed = 0.0;  ///< fractions of the area; they sum to 1
  double attainable = 0.0;                                              ///< fraction on which the geometry permits the full height (layer_room.h)
  double attained = 0.0;                                                ///< fraction with at least 0.9 of the height that the geometry permits
  std::vector<std::pair<std::string, double>> lost;                     ///< fraction of the area below full height, by reason, largest first
};

/// Two matching periodic sides.
struct PeriodicMatchReport {
  std::string first, second;              ///< patches
  Vec3 translation;                       ///< m, from the first to the second
  std::int64_t n_nodes = 0, n_faces = 0;  ///< per side
  double worst = 0.0;                     ///< m, largest distance of an image from its partner
};

/// Locations of the gates that decide the verdict for one solver class: gates that FAIL, or if none fails, gates that warn.
struct ConsumerLocations {
  Consumer consumer = Consumer::cell_centred;
  std::optional<std::int64_t> n_locations;  ///< number of separate locations; empty if these gates have no locations, or some have too many items to be kept
  std::int64_t n_beyond = 0;                ///< cells, or nodes for node-centred solvers; gates with too many items to be kept are left out
};

struct CheckReport {
  CellCounts cells;
  std::int64_t n_nodes = 0;
  std::int64_t n_boundary_triangles = 0, n_boundary_quads = 0;
  std::vector<std::pair<Violation, std::int64_t>> counts;  ///< violations found, by kind; empty = VALID
  std::vector<CheckFinding> findings;                      ///< the first few of each kind, in mesh order
  double layer_volume = 0.0, layer_volume_error = 0.0;     ///< m^3, and error relative to layer_volume, limit 1e-11
  double tet_volume = 0.0, tet_volume_error = 0.0;         ///< the same two values for the tets
  double total_volume = 0.0;
  double dual_volume = 0.0;  ///< m^3, sum of all control volumes; equals total_volume to rounding
  Quality quality;
  std::vector<GateResult> gates;                     ///< QUALITY, in the order of Measure; empty if quality was not requested
  std::vector<ConsumerLocations> verdict_locations;  ///< in the order of k_consumers; empty if `gates` is empty
  Consumers consumers;                               ///< consumers that the states of `gates` refer to
  std::vector<PatchCoverage> coverage;               ///< per wall patch under layers, if the mesh has a layer request
  std::vector<PeriodicMatchReport> periodic;         ///< matching pairs of HybridMesh::periodic
  bool is_complete = true;                           ///< false: indices are out of range or points are not finite, so that no other check was possible
  bool intersections_checked = false;                ///< G2 was requested and run
  bool dual_checked = false;                         ///< G4 was run; it needs faces that conform
  bool quality_measured = false;                     ///< `quality` and `gates` are filled
  bool is_valid() const { return counts.empty(); }
  /// Returns the worst state of the QUALITY gates; not_checked if no gate was checked.
  GateState quality_state() const;
  /// Returns the worst state for one solver class.
  GateState quality_state(Consumer consumer) const;
  /// Keeps the states of gates that at least one of these consumers uses and sets the others to "not checked". Values are kept.
  void restrict_to(Consumers requested);
  /// Returns true if the measure belongs to a selected consumer.
  bool is_shown(const GateResult& gate) const { return info_of(gate.measure).consumers.has_any_of(consumers); }
  /// Returns the number of hard-limit violations over all measures that are proven to be forced by the given boundary. They do not FAIL.
  std::int64_t n_forced() const;
  /// \pre quality_measured
  const GateResult& gate(Measure measure) const { return gates[static_cast<std::size_t>(measure)]; }
  /// Replaces the entry of a measure that was computed elsewhere (G17, G18). Does nothing if quality was not requested.
  void put(GateResult gate);
  std::int64_t count(Violation v) const;
};

struct CheckOptions {
  bool intersections = true;  ///< G2, the exact triangle-triangle tests
  bool quality = true;        ///< fill CheckReport::quality and gates
  bool cell_centred = true;   ///< with quality: also OpenFOAM's measures, if consumers use them
  Consumers consumers;        ///< gates of other consumers are "not checked"
  GateTable limits;           ///< limits of the QUALITY gates
  bool measures_cell_centres() const { return quality && cell_centred && consumers.cell_centred; }
  int findings_per_kind = 10;
  std::int64_t faces_at_a_time = std::int64_t{1} << 27;  ///< bounds the memory for matching faces, 16 bytes each; the report does not depend on this value
};

/// Result of check_ahead().
class LayerCheck {
 public:
  struct Parts;
  explicit LayerCheck(std::unique_ptr<const Parts> parts);
  LayerCheck(LayerCheck&&) noexcept;
  LayerCheck& operator=(LayerCheck&&) noexcept;
  ~LayerCheck();
  /// nullptr: the mesh has faults, so no result is available.
  const Parts* parts() const { return parts_.get(); }

 private:
  std::unique_ptr<const Parts> parts_;
};

/// Checks a mesh.
/// "Layer" means every cell except the explicit tets; "envelope" means the faces between layer and tets. Quads take part in the intersection test with both
/// of their triangulations (planar quads with one).
/// The check proves or refutes: every face is matched by vertex ids with opposite sense, or is a boundary face of exactly one patch; every cell is valid by its
/// exact test; boundaries and envelope are free of crossings; no node is unused; volumes are consistent to 1e-11.
/// Column meshes are checked without making their cells explicit (matching over base edges), explicit meshes by sorting faces. Both checks are parallel and
/// give the same report for any thread count.
/// The dual mesh and the QUALITY gates need a conforming mesh: with a G1 violation they are "not checked". Gates of layers need columns. Gates that compare
/// with a request need HybridMesh::request. Never throws for a bad mesh: findings are the result.
/// `ahead`: result of check_ahead() for the same columns, boundary faces and their points, with the same options. It saves time and does not change the
/// report.
CheckReport check(const HybridMesh& mesh, const CheckOptions& options, const RunContext& context, const LayerCheck* ahead = nullptr);

/// Runs the part of check() that needs only columns and boundary faces, for a mesh that does not have its other cells and their points yet.
LayerCheck check_ahead(const HybridMesh& mesh, const CheckOptions& options, const RunContext& context);

/// Returns the verdict in one line: "VALID; cell-centred: FAIL at 3 places (12 of 3.2 M cells); node-centred: pass".
std::string verdict_line(const CheckReport& report);
/// Returns the part of verdict_line() for one solver class, without its name: "FAIL at 3 places (12 of 3.2 M cells)", "warn, 2 forced".
std::string verdict_of(const CheckReport& report, Consumer consumer);
/// Returns a human-readable report of several lines: both verdicts, gates with counts and worst locations, findings with coordinates.
std::string to_text(const CheckReport& report);
/// Returns the lines of one measure in this report.
std::string to_text(const GateResult& gate);
/// Returns JSON with schema "sterna-check-2", described in docs/check_json.md.
std::string to_json(const CheckReport& report);

}  // namespace sterna
