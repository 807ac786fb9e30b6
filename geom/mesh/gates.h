// Numeric quality gates (docs/quality_gates.md): the quantity each gate measures, its limits, and the running statistics that decide the gate.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

/// A measured quantity of a gate; a gate may have several.
enum class Measure : std::uint8_t {
  scaled_jacobian,           ///< G3: wedge_quality of each prism
  dual_closure,              ///< G4: sum of a dual cell's face normals over the sum of their areas
  orthogonality,             ///< G5: SU2's definition, per node
  sub_volume_ratio,          ///< G6: SU2's definition, per node
  face_area_ratio,           ///< G7: SU2's CV face area aspect ratio, per node
  relative_face_area_ratio,  ///< G7: face_area_ratio over l_t / H, longest edge along the layer over height of the dual cell
  stack_growth,              ///< G8: ratio of the heights of consecutive cells of a growth line (larger over smaller)
  interface_height,          ///< G9: ratio of the last layer height to 0.816 times the mean envelope edge, or its inverse
  interface_volume,          ///< G9: ratio of three times the tet's volume to the prism's volume, or its inverse
  stack_angle,               ///< G10: angle of the steepest of the first cells against the wall facets, minus the best possible angle
  first_height,              ///< G11: relative deviation of the first height along the vertex normal
  boundary_layer,            ///< G12: area share that covers the requested boundary-layer thickness, or the part of it that the geometry permits
  coverage,                  ///< G12: share of the wall area with the height along the normal that the geometry permits
  collapsed,                 ///< G12: share of the wall area without layer cells
  layer_step,                ///< G13: difference of the number of layers across an edge
  min_dihedral,              ///< G14
  max_dihedral,              ///< G14
  tet_growth,                ///< G15: ratio of the volumes of two tets with a common face (larger over smaller)
  edge_ratio,                ///< G16: longest over shortest edge of a node, without edges along its stack
  non_orthogonality,         ///< OpenFOAM's, per inner face: angle between its normal and the line through the centres of its cells
  skewness,                  ///< OpenFOAM's, per face: distance from that line to the face centre, over the face's extent (or 0.2 of the line)
  face_weight,               ///< OpenFOAM's, per inner face: distance of the nearer cell centre from the face plane, over the sum for both centres
  volume_ratio,              ///< OpenFOAM's, per inner face: smaller over larger volume of its cells
  face_flatness,             ///< OpenFOAM's, per quadrilateral: area over the sum of the areas of its triangles around its centre
  cell_aspect_ratio,         ///< OpenFOAM's, per cell; reported only
  cell_openness,             ///< OpenFOAM's, per cell: sum of its face normals over the sum of their sizes
  face_tets,                 ///< OpenFOAM's, per face: quality of the worst tet into which it and its cells are cut
  stacked_orthogonality,     ///< non_orthogonality between two prisms of one column, caused by different height proportions at their corners
  stacked_skewness,          ///< skewness of the same faces
  cell_determinant,          ///< OpenFOAM's measure of a cell: determinant of the tensor of its inner faces, which is 1 for a cube; only reported
  cad_distance,              ///< G17: distance of a wall node from the model, over the body length (surfmesh/model/deviation.h)
  cad_normal,                ///< G18: facet normal against the model normal at the facet's centroid (same source)
};
inline constexpr std::size_t k_n_measures = static_cast<std::size_t>(Measure::cad_normal) + 1;

/// Solver classes by type of control volume.
enum class Consumer : std::uint8_t {
  cell_centred,  ///< control volumes are cells: OpenFOAM, Fluent
  node_centred,  ///< control volumes are dual cells of nodes: SU2, TAU, Edge
};
inline constexpr std::array k_consumers = {Consumer::cell_centred, Consumer::node_centred};
/// Returns "cell-centred" or "node-centred".
std::string_view to_string(Consumer consumer);

/// A set of solver classes.
struct Consumers {
  bool cell_centred = true, node_centred = true;
  bool has(Consumer consumer) const { return consumer == Consumer::cell_centred ? cell_centred : node_centred; }
  bool has_any_of(const Consumers& other) const { return (cell_centred && other.cell_centred) || (node_centred && other.node_centred); }
  friend bool operator==(const Consumers&, const Consumers&) = default;
};

inline constexpr Consumers k_cell_centred_alone{.cell_centred = true, .node_centred = false}, k_node_centred_alone{.cell_centred = false, .node_centred = true};

/// Justification of a hard limit.
enum class Evidence : std::uint8_t {
  none,        ///< there is no hard limit, or the consumer does not use the measure
  definition,  ///< the mesh cannot be used beyond the limit, or it is not the requested mesh
  measured,    ///< the limit is from runs of a solver; the source names the page
  cited,       ///< the limit is from a program or guideline, without evidence from own runs: beyond it the gate warns
};
/// Returns "definition", ...; "" for none.
std::string_view to_string(Evidence evidence);
struct LimitEvidence {
  Evidence cell_centred, node_centred;
  std::string_view source;  ///< source of the limit, human-readable
  Evidence of(Consumer consumer) const { return consumer == Consumer::cell_centred ? cell_centred : node_centred; }
};

/// Histogram classes of a measure: values below the first edge are in the first class; values above the last edge, and NaN, are in the last.
struct HistogramClasses {
  double from = 0.0, to = 0.0;  ///< powers of two for logarithmic classes
  int n = 0;                    ///< 0: the measure has no histogram
  int per_octave = 0;           ///< 0: equal widths; else number of equal parts per doubling
  static constexpr int k_most = 64;
  int of(double value) const;
  /// Returns n + 1 class edges, ascending.
  std::vector<double> edges() const;
};

/// Limits of a measure in SI units and radians; NaN for no limit.
struct GateLimits {
  double hard;         ///< beyond this value the gate FAILs
  double target;       ///< beyond this value the gate warns
  double usual;        ///< the gate warns unless at least the fraction `usual_share` of the measure is within this limit
  double usual_share;  ///< fraction in [0, 1]
};

/// Fixed properties of a measure.
struct MeasureInfo {
  Measure measure;
  std::string_view gate;     ///< "G5"
  std::string_view name;     ///< JSON key: "orthogonality"
  std::string_view title;    ///< human-readable
  std::string_view counted;  ///< unit of the share: "nodes", "area", ...
  bool is_angle;             ///< radians inside, degrees in reports
  bool is_low_bad;           ///< limits are lower bounds
  GateLimits limits;         ///< defaults
  HistogramClasses classes;  ///< in SI and radians
  Consumers consumers;       ///< solver classes whose solutions depend on the measure
  LimitEvidence evidence;    ///< evidence for the hard limit
  double fail_share = 0.0;   ///< the gate FAILs if more than this share of the items (or of the area) is beyond the hard limit; 0: one item is enough
};

/// The table of docs/quality_gates.md, in the order of Measure.
const std::array<MeasureInfo, k_n_measures>& measures();
const MeasureInfo& info_of(Measure measure);
/// Returns a short description of the defect where the measure misses a limit: "heights of layers jump".
std::string_view trouble_of(Measure measure);
/// Returns a remedy for the user.
std::string_view remedy_of(Measure measure);
/// Converts a value of the measure to the unit of reports: degrees for angles.
double in_report_unit(const MeasureInfo& info, double value);

/// Limits of all measures; initialised with the defaults.
class GateTable {
 public:
  GateTable();
  const GateLimits& operator[](Measure measure) const { return limits_[static_cast<std::size_t>(measure)]; }
  GateLimits& operator[](Measure measure) { return limits_[static_cast<std::size_t>(measure)]; }

 private:
  std::array<GateLimits, k_n_measures> limits_;
};

enum class GateState : std::uint8_t { pass, warn, fail, not_checked };
/// Returns "pass", "warn", "FAIL" or "not checked".
std::string_view to_string(GateState state);
/// Returns the measure with this name, or nullptr.
const MeasureInfo* find_measure(std::string_view name);

/// Proof that no mesh on the given boundary can meet a limit at a location, with a remedy that removes the cause.
struct Forcing {
  std::string why;
  std::string remedy;
};

/// One of the worst locations of a measure.
struct GateLocation {
  double value = 0.0;
  Point position;
  std::string what;  ///< name of the entity
  Forcing forcing;   ///< empty: a mesher defect
};

/// Nodes and cells of the items of a measure that are beyond a limit; check_locations.cpp derives locations and shares from them.
struct GateExtent {
  std::vector<std::uint32_t> nodes;        ///< item after item
  std::vector<std::uint32_t> first = {0};  ///< start of each item in `nodes`, and the end
  std::vector<std::uint64_t> cells;        ///< numbers (check_parts::CellNumbers) of the cells that the items are or belong to; empty for node items
  void end_item() { first.push_back(static_cast<std::uint32_t>(nodes.size())); }
  bool empty() const { return nodes.empty(); }
};

struct GateResult {
  Measure measure = Measure::scaled_jacobian;
  GateLimits limits{};
  GateState state = GateState::not_checked;  ///< the worst state_for() over the selected consumers
  bool is_hard_missed = false;               ///< an item not forced by the input surface misses the hard limit
  bool is_soft_missed = false;               ///< the target or the usual limit is missed
  std::string reason;                        ///< why the gate was not checked
  double worst = 0.0;
  double total = 0.0;                ///< number of items; m^2 if areas are counted
  double share_beyond_hard = 0.0;    ///< share of `total` beyond the hard limit, without forced items
  double share_within = 0.0;         ///< share of `total` within limits.usual, or within limits.target if there is no usual limit
  std::int64_t n_beyond_hard = 0;    ///< number of items beyond the hard limit
  std::int64_t n_forced = 0;         ///< number of these items that are proven to be forced by the given boundary: they do not FAIL
  std::int64_t n_beyond_target = 0;  ///< number of items beyond limits.target (limits.usual if there is no target), including those beyond the hard limit
  // The following members describe the items that decide: those beyond the hard limit that are not forced, or if there are none, those beyond the target.
  std::int64_t n_too_small = 0, n_too_large = 0;  ///< deciding items with a value below or above the ideal
  std::optional<std::int64_t> n_locations;        ///< clusters of deciding items whose cells touch; none if items have no location, or are too many to be kept
  double share_beyond = 0.0;                      ///< share of the deciding items: of the wall's area if areas are counted, else of the fluid's volume
  GateExtent extent;                              ///< nodes and cells of the deciding items; empty after check()
  std::vector<GateLocation> locations;            ///< the worst ten items that miss a limit and are not forced (any items for a measure without limits), worst
                                                  ///< first
  std::vector<GateLocation> forced;               ///< the worst ten forced items, worst first
  std::vector<double> histogram;                  ///< number of items, or m^2, in each class of MeasureInfo::classes; empty if the measure has no histogram
};

/// Returns the state of a result for one solver class. A gate beyond its hard limit FAILs if the limit is by definition or measured and more than
/// MeasureInfo::fail_share is beyond it, or if the limit is the user's own; otherwise it warns. Returns not_checked if the consumer does not use the measure.
GateState state_for(const GateResult& gate, Consumer consumer);

/// Running statistics of one measure, which collect the weight within the usual limit and the worst items. The result of merging does not depend on how items
/// were distributed to the parts, except for the rounding of non-integer weights.
class GateScan {
 public:
  static constexpr std::size_t k_most_locations = 10;
  struct Item {
    double badness;  ///< larger is worse
    std::uint64_t id;
    friend auto operator<=>(const Item&, const Item&) = default;
  };

  GateScan(const MeasureInfo& info, const GateLimits& limits);
  /// Flag in the id of an item whose measure is a two-sided deviation: the value is below the ideal.
  static constexpr std::uint64_t k_too_small = std::uint64_t{1} << 62;
  /// Maximum number of items beyond the target whose ids are kept for counting locations: 800 KB per measure.
  static constexpr std::size_t k_most_soft = 100'000;
  /// Adds an item. NaN counts as infinitely bad.
  void add(double value, std::uint64_t id, double weight = 1.0) {
    const double badness = value == value ? sign_ * value : std::numeric_limits<double>::infinity();
    total_ += weight;
    if (badness <= usual_) within_ += weight;
    if (badness > soft_) add_soft(badness, id, weight);
    if (badness > hard_) beyond_.push_back({{badness, id}, weight});
    else worst_within_ = std::max(worst_within_, badness);
    if (classes_->n > 0) histogram_[static_cast<std::size_t>(classes_->of(value))] += weight;
    if (badness >= entry_) remember({badness, id});
  }
  void merge(const GateScan& other);
  bool empty() const { return worst_.empty(); }
  /// Returns the worst items, worst first; ties by ascending id.
  const std::vector<Item>& worst() const { return worst_; }
  double value_of(const Item& item) const { return sign_ * item.badness; }
  /// Returns the result. `describe(id) -> pair(Point, string)` names the locations. If it has `gather(id, GateExtent&)`, which adds the nodes and cells of an
  /// item, the result has an extent.
  template <class Describe>
  GateResult result(const Describe& describe) const {
    return result(describe, [](std::uint64_t, double) { return std::optional<Forcing>(); });
  }
  /// Returns the result. `prove(id, value) -> optional<Forcing>` is called for every item beyond the hard limit.
  template <class Describe, class Prove>
  GateResult result(const Describe& describe, const Prove& prove) const {
    std::vector<GateLocation> locations, forced;
    const auto list = [&](std::vector<GateLocation>& to, const Item& item, Forcing forcing) {
      if (to.size() == k_most_locations) return;
      auto [position, what] = describe(item.id & ~k_too_small);
      to.push_back({value_of(item), position, std::move(what), std::move(forcing)});
    };
    std::int64_t n_forced = 0;
    double forced_weight = 0.0, own_weight = 0.0;
    std::vector<std::uint64_t> own;
    for (const Beyond& beyond : beyond_hard()) {
      std::optional<Forcing> forcing = prove(beyond.item.id & ~k_too_small, value_of(beyond.item));
      if (forcing) {
        ++n_forced;
        forced_weight += beyond.weight;
      } else {
        own.push_back(beyond.item.id);
        own_weight += beyond.weight;
      }
      const bool is_forced = forcing.has_value();
      list(is_forced ? forced : locations, beyond.item, std::move(forcing).value_or(Forcing{}));
    }
    for (const Item& item : worst_)
      if (item.badness <= hard_ && is_notable(item)) list(locations, item, {});
    GateResult result = judge(n_forced, forced_weight, own_weight);
    result.locations = std::move(locations);
    result.forced = std::move(forced);
    const std::vector<std::uint64_t> deciding = decide(std::move(own), own_weight, result);
    if constexpr (requires { describe.gather(std::uint64_t{}, result.extent); }) {
      for (const std::uint64_t id : deciding) {
        describe.gather(id & ~k_too_small, result.extent);
        result.extent.end_item();
      }
    }
    return result;
  }
  bool has_beyond_hard() const { return !beyond_.empty(); }

 private:
  struct Beyond {
    Item item;
    double weight;
  };
  void remember(const Item& item);
  void add_soft(double badness, std::uint64_t id, double weight);
  /// Fills the members of GateResult that describe the deciding items, and returns the ids of the deciding items that were kept. \p own: items beyond the
  /// hard limit that are not forced.
  std::vector<std::uint64_t> decide(std::vector<std::uint64_t> own, double own_weight, GateResult& result) const;
  bool is_notable(const Item& item) const;
  /// Returns the items beyond the hard limit, worst first; ties by ascending id.
  std::vector<Beyond> beyond_hard() const;
  GateResult judge(std::int64_t n_forced, double forced_weight, double own_weight) const;

  Measure measure_;
  GateLimits limits_;
  double sign_;
  double hard_, target_, usual_;  ///< as badness; infinity if there is no limit
  double soft_;                   ///< the target, or the usual limit if there is no target
  double entry_ = -std::numeric_limits<double>::infinity();
  double total_ = 0.0, within_ = 0.0;
  double worst_within_ = -std::numeric_limits<double>::infinity();  ///< badness of items within the hard limit
  std::vector<Beyond> beyond_;                                      ///< items beyond the hard limit; all of them are kept
  // Numbers of items beyond the soft limit: all of them, those within the hard limit, and those too small.
  std::int64_t n_soft_ = 0, n_soft_within_ = 0, n_soft_small_ = 0;
  double soft_weight_ = 0.0;
  bool has_dropped_soft_ = false;
  std::vector<std::uint64_t> soft_ids_;  ///< ids of items within the hard limit; empty if there are more than k_most_soft
  const HistogramClasses* classes_;
  std::array<double, HistogramClasses::k_most> histogram_{};
  std::vector<Item> worst_;
};

/// Returns the result for a measure that could not be computed.
GateResult not_checked(Measure measure, const GateTable& limits, std::string reason);

}  // namespace sterna
