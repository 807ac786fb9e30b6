#include "geom/mesh/gates.h"

#include <algorithm>
#include <numbers>

namespace sterna {
namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
constexpr double k_degree = std::numbers::pi / 180.0;
constexpr double k_infinity = std::numeric_limits<double>::infinity();

using M = Measure;

// Numbers: quality.md §6. Coverage asks 99 % of the whole; the wing's 99.5 % need a script that knows which patch is a wing.
constexpr std::array<MeasureInfo, k_n_measures> k_measures = {{
    {M::scaled_jacobian, "G3", "scaled_jacobian", "scaled Jacobian of prisms", "prisms", false, true, {k_none, 0.05, 0.2, 0.999}},
    {M::dual_closure, "G4", "dual_closure", "closure of dual cells", "nodes", false, false, {1e-12, 1e-12, k_none, 1.0}},
    {M::orthogonality, "G5", "orthogonality", "SU2 orthogonality", "nodes", true, true, {5 * k_degree, 20 * k_degree, 35 * k_degree, 0.999}},
    {M::sub_volume_ratio, "G6", "sub_volume_ratio", "SU2 CV sub-volume ratio", "nodes", false, false, {1e5, 1e3, 200, 0.999}},
    {M::face_area_ratio, "G7", "face_area_ratio", "SU2 CV face area aspect ratio", "nodes", false, false, {k_none, k_none, k_none, 1.0}},
    {M::relative_face_area_ratio, "G7", "relative_face_area_ratio", "the same over edge / height", "nodes", false, false, {k_none, 1.5, k_none, 1.0}},
    {M::stack_growth, "G8", "stack_growth", "growth along a line", "area", false, false, {1.5, k_none, 1.2, 0.999}},
    {M::interface_height, "G9", "interface_height", "last height / (0.816 edge)", "prisms", false, false, {8, k_none, 3, 0.99}},
    {M::interface_volume, "G9", "interface_volume", "3 tet / prism volume", "prisms", false, false, {8, k_none, 3, 0.99}},
    {M::stack_angle, "G10", "stack_angle", "stack angle beyond the best", "area", true, false, {k_none, k_none, 10 * k_degree, 0.995}},
    {M::first_height, "G11", "first_height", "first height against request", "lines", false, false, {0.2, k_none, 0.02, 0.99}},
    {M::coverage, "G12", "coverage", "area at its full height", "area", false, true, {0.95, 0.99, k_none, 1.0}},
    {M::collapsed, "G12", "collapsed", "area without layers", "area", false, false, {k_none, 0.0, k_none, 1.0}},
    {M::layer_step, "G13", "layer_step", "layers lost over an edge", "edges", false, false, {1, 0, k_none, 1.0}},
    {M::min_dihedral, "G14", "min_dihedral", "smallest dihedral of a tet", "tets", true, true, {5 * k_degree, 12 * k_degree, k_none, 1.0}},
    {M::max_dihedral, "G14", "max_dihedral", "largest dihedral of a tet", "tets", true, false, {170 * k_degree, 155 * k_degree, k_none, 1.0}},
    {M::tet_growth, "G15", "tet_growth", "volume ratio of tets at a face", "faces", false, false, {20, k_none, 4, 0.999}},
    {M::edge_ratio, "G16", "edge_ratio", "edge ratio at a node", "nodes", false, false, {100, k_none, 10, 0.999}},
    {M::cad_distance, "G17", "cad_distance", "wall nodes off the CAD, / length", "nodes", false, false, {1e-6, 1e-9, k_none, 1.0}},
    {M::cad_normal, "G18", "cad_normal", "wall facets against the CAD", "facets", true, false, {30 * k_degree, 10 * k_degree, k_none, 1.0}},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < k_n_measures; ++i)
    if (k_measures[i].measure != static_cast<Measure>(i)) return false;
  return true;
}
static_assert(is_in_order());

bool is_none(double limit) { return limit != limit; }

}  // namespace

const std::array<MeasureInfo, k_n_measures>& measures() { return k_measures; }
double in_report_unit(const MeasureInfo& info, double value) { return info.is_angle ? value / k_degree : value; }
const MeasureInfo& info_of(Measure measure) { return k_measures[static_cast<std::size_t>(measure)]; }

GateTable::GateTable() {
  for (std::size_t i = 0; i < k_n_measures; ++i) limits_[i] = k_measures[i].limits;
}

std::string_view to_string(GateState state) {
  switch (state) {
    case GateState::pass: return "pass";
    case GateState::warn: return "warn";
    case GateState::fail: return "FAIL";
    case GateState::not_checked: return "not checked";
  }
  return "";
}

GateScan::GateScan(const MeasureInfo& info, const GateLimits& limits) : measure_(info.measure), limits_(limits), sign_(info.is_low_bad ? -1.0 : 1.0) {
  const auto badness_of = [&](double limit) { return is_none(limit) ? k_infinity : sign_ * limit; };
  hard_ = badness_of(limits.hard);
  target_ = badness_of(limits.target);
  usual_ = is_none(limits.usual) ? target_ : badness_of(limits.usual);
}

void GateScan::remember(const Item& item) {
  const auto is_worse = [](const Item& a, const Item& b) { return a.badness != b.badness ? a.badness > b.badness : a.id < b.id; };
  if (worst_.size() == k_most_places && !is_worse(item, worst_.back())) return;
  worst_.insert(std::upper_bound(worst_.begin(), worst_.end(), item, is_worse), item);
  if (worst_.size() > k_most_places) worst_.pop_back();
  if (worst_.size() == k_most_places) entry_ = worst_.back().badness;
}

void GateScan::merge(const GateScan& other) {
  total_ += other.total_;
  within_ += other.within_;
  n_beyond_hard_ += other.n_beyond_hard_;
  for (const Item& item : other.worst_) remember(item);
}

bool GateScan::is_notable(const Item& item) const {
  if (hard_ == k_infinity && target_ == k_infinity && usual_ == k_infinity) return true;
  return item.badness > std::min({hard_, target_, usual_});
}

GateResult GateScan::judge() const {
  GateResult result;
  result.measure = measure_;
  result.limits = limits_;
  result.total = total_;
  result.n_beyond_hard = n_beyond_hard_;
  if (worst_.empty()) {
    result.reason = "the mesh has none";
    return result;
  }
  result.worst = value_of(worst_.front());
  result.share_within = total_ > 0.0 ? within_ / total_ : 0.0;
  const double badness = worst_.front().badness;
  const bool is_usual_missed = !is_none(limits_.usual) && within_ < limits_.usual_share * total_;
  result.state = badness > hard_ ? GateState::fail : badness > target_ || is_usual_missed ? GateState::warn : GateState::pass;
  return result;
}

GateResult not_checked(Measure measure, const GateTable& limits, std::string reason) {
  GateResult result;
  result.measure = measure;
  result.limits = limits[measure];
  result.reason = std::move(reason);
  return result;
}

}  // namespace sterna
