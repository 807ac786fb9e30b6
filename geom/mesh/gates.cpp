#include "geom/mesh/gates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "geom/math/constants.h"

namespace sterna {
namespace {

constexpr double k_right = std::numbers::pi / 2.0;

using M = Measure;

// Numbers: quality.md §6. Coverage asks 99 % of the whole; the wing's 99.5 % need a script that knows which patch is a wing.
constexpr std::array<MeasureInfo, k_n_measures> k_measures = {{
    {M::scaled_jacobian, "G3", "scaled_jacobian", "scaled Jacobian of prisms", "prisms", false, true, {k_nan, 0.05, 0.2, 0.999}, {0, 1, 50}},
    {M::dual_closure, "G4", "dual_closure", "closure of dual cells", "nodes", false, false, {1e-12, 1e-12, k_nan, 1.0}, {0x1p-60, 0x1p-36, 48, 2}},
    {M::orthogonality, "G5", "orthogonality", "SU2 orthogonality", "nodes", true, true, {5 * k_degree, 20 * k_degree, 35 * k_degree, 0.999}, {0, k_right, 45}},
    {M::sub_volume_ratio, "G6", "sub_volume_ratio", "SU2 CV sub-volume ratio", "nodes", false, false, {1e5, 1e3, 200, 0.999}, {1, 0x1p24, 48, 2}},
    {M::face_area_ratio, "G7", "face_area_ratio", "SU2 CV face area aspect ratio", "nodes", false, false, {k_nan, k_nan, k_nan, 1.0}, {1, 0x1p24, 48, 2}},
    {M::relative_face_area_ratio,
     "G7",
     "relative_face_area_ratio",
     "the same over edge / height",
     "nodes",
     false,
     false,
     {k_nan, 1.5, k_nan, 1.0},
     {1, 0x1p12, 48, 4}},
    {M::stack_growth, "G8", "stack_growth", "growth along a line", "area", false, false, {1.5, k_nan, 1.2, 0.999}, {1, 2, 50}},
    {M::interface_height, "G9", "interface_height", "last height / (0.816 edge)", "prisms", false, false, {8, k_nan, 3, 0.99}, {1, 0x1p8, 48, 6}},
    {M::interface_volume, "G9", "interface_volume", "3 tet / prism volume", "prisms", false, false, {8, k_nan, 3, 0.99}, {1, 0x1p8, 48, 6}},
    {M::stack_angle, "G10", "stack_angle", "stack angle beyond the best", "area", true, false, {k_nan, k_nan, 10 * k_degree, 0.995}, {0, k_right, 45}},
    {M::first_height, "G11", "first_height", "first height against request", "lines", false, false, {0.2, k_nan, 0.02, 0.99}, {0, 0.5, 50}},
    {M::coverage, "G12", "coverage", "area at its attainable height", "area", false, true, {0.95, 0.99, k_nan, 1.0}, {}},
    {M::collapsed, "G12", "collapsed", "area without layers", "area", false, false, {k_nan, 0.0, k_nan, 1.0}, {}},
    {M::layer_step, "G13", "layer_step", "layers lost over an edge", "edges", false, false, {1, 0, k_nan, 1.0}, {}},
    {M::min_dihedral, "G14", "min_dihedral", "smallest dihedral of a tet", "tets", true, true, {5 * k_degree, 12 * k_degree, k_nan, 1.0}, {0, k_right, 45}},
    {M::max_dihedral,
     "G14",
     "max_dihedral",
     "largest dihedral of a tet",
     "tets",
     true,
     false,
     {170 * k_degree, 155 * k_degree, k_nan, 1.0},
     {60 * k_degree, 180 * k_degree, 60}},
    {M::tet_growth, "G15", "tet_growth", "volume ratio of tets at a face", "faces", false, false, {20, k_nan, 4, 0.999}, {1, 0x1p8, 48, 6}},
    {M::edge_ratio, "G16", "edge_ratio", "edge ratio at a node", "nodes", false, false, {100, k_nan, 10, 0.999}, {1, 0x1p10, 50, 5}},
    // quality.md §3; limits are those at which checkMesh and meshQualityDict object. Aspect ratios of y+ = 1 prisms are beyond any limit of theirs: shown only.
    {M::non_orthogonality,
     "OF",
     "non_orthogonality",
     "OpenFOAM non-orthogonality",
     "inner faces",
     true,
     false,
     {90 * k_degree, 70 * k_degree, 65 * k_degree, 0.999},
     {0, k_right, 45}},
    {M::skewness, "OF", "skewness", "OpenFOAM skewness", "faces", false, false, {20, 4, k_nan, 1.0}, {0x1p-6, 0x1p4, 40, 4}},
    {M::face_weight, "OF", "face_weight", "OpenFOAM face weight", "inner faces", false, true, {0.05, 0.05, k_nan, 1.0}, {0, 0.5, 50}},
    {M::volume_ratio, "OF", "volume_ratio", "OpenFOAM volume ratio", "inner faces", false, true, {0.01, 0.01, k_nan, 1.0}, {0, 1, 50}},
    {M::face_flatness, "OF", "face_flatness", "OpenFOAM flatness of quads", "quads", false, true, {k_nan, 0.8, k_nan, 1.0}, {0.5, 1, 50}},
    {M::cell_aspect_ratio, "OF", "cell_aspect_ratio", "OpenFOAM aspect ratio", "cells", false, false, {k_nan, k_nan, k_nan, 1.0}, {1, 0x1p16, 48, 3}},
    {M::cell_openness, "OF", "cell_openness", "OpenFOAM openness", "cells", false, false, {1e-6, 1e-9, k_nan, 1.0}, {0x1p-60, 0x1p-20, 40, 1}},
    // The limit is checkMesh's (SMALL squared): tets that are upside down or flat; their shape does not matter to it.
    {M::face_tets, "OF", "face_tets", "OpenFOAM decomposition tets", "faces", false, true, {1e-30, k_nan, k_nan, 1.0}, {0, 1, 50}},
    // Runs diverge from such faces near the wall (docs/heights.md); what FAILs is the measure over all faces.
    {M::stacked_orthogonality,
     "OF",
     "stacked_orthogonality",
     "non-orthogonality in columns",
     "faces",
     true,
     false,
     {k_nan, 85 * k_degree, 70 * k_degree, 0.999},
     {0, k_right, 45}},
    {M::stacked_skewness, "OF", "stacked_skewness", "skewness in columns", "faces", false, false, {k_nan, 20, 4, 0.999}, {0x1p-6, 0x1p4, 40, 4}},
    // First cells of y+ = 1 are beyond any limit of checkMesh's here, too: shown only.
    {M::cell_determinant, "OF", "cell_determinant", "OpenFOAM cell determinant", "cells", false, true, {k_nan, k_nan, k_nan, 1.0}, {0, 2, 50}},
    {M::cad_distance, "G17", "cad_distance", "wall nodes off the CAD, / length", "nodes", false, false, {1e-6, 1e-9, k_nan, 1.0}, {0x1p-60, 0x1p-12, 48, 1}},
    {M::cad_normal, "G18", "cad_normal", "wall facets against the CAD", "facets", true, false, {30 * k_degree, 10 * k_degree, k_nan, 1.0}, {0, k_right, 45}},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < k_n_measures; ++i)
    if (k_measures[i].classes.n > HistogramClasses::k_most || k_measures[i].measure != static_cast<Measure>(i)) return false;
  return true;
}
static_assert(is_in_order());

bool is_none(double limit) { return limit != limit; }

}  // namespace

const std::array<MeasureInfo, k_n_measures>& measures() { return k_measures; }
double in_report_unit(const MeasureInfo& info, double value) { return info.is_angle ? value / k_degree : value; }
const MeasureInfo* find_measure(std::string_view name) {
  const auto found = std::find_if(k_measures.begin(), k_measures.end(), [&](const MeasureInfo& info) { return info.name == name; });
  return found == k_measures.end() ? nullptr : &*found;
}

int HistogramClasses::of(double value) const {
  if (value != value || value >= to) return n - 1;
  if (value <= from) return 0;
  if (per_octave == 0) return std::min(n - 1, static_cast<int>((value - from) / (to - from) * n));
  // Exponent and mantissa off the bits: cheap, and the same everywhere.
  const auto bits = std::bit_cast<std::uint64_t>(value), low = std::bit_cast<std::uint64_t>(from);
  const int octave = static_cast<int>(bits >> 52) - static_cast<int>(low >> 52);
  const double mantissa = static_cast<double>(bits & 0xfffffffffffffULL) * 0x1p-52;
  return std::clamp(octave * per_octave + static_cast<int>(mantissa * per_octave), 0, n - 1);
}

std::vector<double> HistogramClasses::edges() const {
  std::vector<double> edges;
  for (int i = 0; n > 0 && i <= n; ++i)
    edges.push_back(per_octave == 0 ? from + (to - from) * i / n : std::ldexp(from * (1.0 + static_cast<double>(i % per_octave) / per_octave), i / per_octave));
  return edges;
}

const MeasureInfo& info_of(Measure measure) { return k_measures[static_cast<std::size_t>(measure)]; }

std::string_view trouble_of(Measure measure) {
  switch (measure) {
    case M::scaled_jacobian: return "prisms are nearly folded";
    case M::dual_closure: return "control volumes do not close";
    case M::orthogonality: return "faces of control volumes lie nearly along their edges";
    case M::sub_volume_ratio: return "parts of one control volume differ too much in size";
    case M::face_area_ratio: return "faces of one control volume differ too much in area";
    case M::relative_face_area_ratio: return "faces of one control volume differ more in area than cells of a layer must";
    case M::stack_growth: return "heights of layers jump";
    case M::interface_height: return "the last cells of the layer do not fit the tetrahedra on them in height";
    case M::interface_volume: return "the last cells of the layer do not fit the tetrahedra on them in volume";
    case M::stack_angle: return "lines of the layer lean away from the wall's normal";
    case M::first_height: return "first cells are not as high as asked for";
    case M::coverage: return "the layer is lower than the geometry permits";
    case M::collapsed: return "parts of the wall have no layer";
    case M::layer_step: return "numbers of layers differ too much across an edge";
    case M::min_dihedral: return "tetrahedra are flat: sharp angles";
    case M::max_dihedral: return "tetrahedra are flat: obtuse angles";
    case M::tet_growth: return "tetrahedra beside each other differ too much in size";
    case M::edge_ratio: return "edges at one node differ too much in length";
    case M::non_orthogonality: return "faces are oblique to the line between the centres of their cells";
    case M::skewness: return "lines between centres of cells miss the face between them";
    case M::face_weight: return "faces are far nearer to one of their cells than to the other";
    case M::volume_ratio: return "cells beside each other differ too much in volume";
    case M::face_flatness: return "quadrilaterals are warped";
    case M::cell_aspect_ratio: return "cells are long and thin";
    case M::cell_openness: return "faces of cells do not close";
    case M::face_tets: return "faces cannot be cut into triangles that OpenFOAM's particles and mappings accept";
    case M::stacked_orthogonality: return "the corners of flat prisms grow by different ratios";
    case M::stacked_skewness: return "the corners of flat prisms have different heights above the wall";
    case M::cell_determinant: return "cells are nearly flat";
    case M::cad_distance: return "nodes of the wall are off the model";
    case M::cad_normal: return "triangles of the wall are turned against the model";
  }
  return "";
}

std::string_view remedy_of(Measure measure) {
  switch (measure) {
    case M::scaled_jacobian:
    case M::dual_closure:
    case M::sub_volume_ratio:
    case M::face_area_ratio:
    case M::relative_face_area_ratio:
    case M::min_dihedral:
    case M::max_dihedral:
    case M::tet_growth:
    case M::edge_ratio:
    case M::face_weight:
    case M::volume_ratio:
    case M::face_flatness:
    case M::cell_aspect_ratio:
    case M::cell_openness:
    case M::face_tets:
    case M::cell_determinant: return "remesh the wall there: triangles without needles that change slowly in size";
    case M::orthogonality:
    case M::stack_angle:
    case M::non_orthogonality:
    case M::skewness: return "several normals at the sharp edge (open_ridges = \"always\"), finer triangles along it, or round it";
    case M::stacked_orthogonality:
    case M::stacked_skewness: return "growth = \"uniform\", a smaller max_growth, and shorter edges of the wall where heights differ";
    case M::stack_growth:
    case M::interface_height:
    case M::interface_volume:
      return "more layers or a larger max_growth; in corners and narrow places shorter edges there alone (narrow, intersection_factor = 1, a smaller min_edge)";
    case M::first_height:
    case M::coverage:
    case M::collapsed:
    case M::layer_step: return "fewer layers, or a smaller first_height or max_thickness, where walls are near";
    case M::cad_distance:
    case M::cad_normal: return "smaller chord_error of surface_mesh";
  }
  return "";
}

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

GateScan::GateScan(const MeasureInfo& info, const GateLimits& limits)
    : measure_(info.measure), limits_(limits), sign_(info.is_low_bad ? -1.0 : 1.0), classes_(&info.classes) {
  const auto badness_of = [&](double limit) { return is_none(limit) ? k_infinity : sign_ * limit; };
  hard_ = badness_of(limits.hard);
  target_ = badness_of(limits.target);
  usual_ = is_none(limits.usual) ? target_ : badness_of(limits.usual);
  soft_ = is_none(limits.target) ? usual_ : target_;
}

void GateScan::add_soft(double badness, std::uint64_t id, double weight) {
  ++n_soft_;
  if (badness > hard_) return;
  ++n_soft_within_;
  soft_weight_ += weight;
  if ((id & k_too_small) != 0) ++n_soft_small_;
  if (has_dropped_soft_) return;
  soft_ids_.push_back(id);
  if (soft_ids_.size() <= k_most_soft) return;
  has_dropped_soft_ = true;
  soft_ids_ = {};
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
  worst_within_ = std::max(worst_within_, other.worst_within_);
  beyond_.insert(beyond_.end(), other.beyond_.begin(), other.beyond_.end());
  n_soft_ += other.n_soft_;
  n_soft_within_ += other.n_soft_within_;
  n_soft_small_ += other.n_soft_small_;
  soft_weight_ += other.soft_weight_;
  has_dropped_soft_ = has_dropped_soft_ || other.has_dropped_soft_ || soft_ids_.size() + other.soft_ids_.size() > k_most_soft;
  if (has_dropped_soft_) soft_ids_ = {};
  else soft_ids_.insert(soft_ids_.end(), other.soft_ids_.begin(), other.soft_ids_.end());
  for (std::size_t i = 0; i < histogram_.size(); ++i) histogram_[i] += other.histogram_[i];
  for (const Item& item : other.worst_) remember(item);
}

bool GateScan::is_notable(const Item& item) const {
  if (hard_ == k_infinity && target_ == k_infinity && usual_ == k_infinity) return true;
  return item.badness > std::min({hard_, target_, usual_});
}

std::vector<GateScan::Beyond> GateScan::beyond_hard() const {
  std::vector<Beyond> sorted = beyond_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Beyond& a, const Beyond& b) { return a.item.badness != b.item.badness ? a.item.badness > b.item.badness : a.item.id < b.item.id; });
  return sorted;
}

std::vector<std::uint64_t> GateScan::decide(std::vector<std::uint64_t> own, double own_weight, GateResult& result) const {
  const bool is_hard = !own.empty();
  const auto n = is_hard ? static_cast<std::int64_t>(own.size()) : n_soft_within_;
  const auto is_small = [](std::uint64_t id) { return (id & k_too_small) != 0; };
  const std::int64_t n_small = is_hard ? std::count_if(own.begin(), own.end(), is_small) : n_soft_small_;
  result.n_too_small = sign_ < 0.0 ? n : n_small;
  result.n_too_large = n - result.n_too_small;
  result.share_beyond = total_ > 0.0 ? (is_hard ? own_weight : soft_weight_) / total_ : 0.0;
  std::vector<std::uint64_t> ids = is_hard ? std::move(own) : soft_ids_;
  std::sort(ids.begin(), ids.end());
  return ids;
}

GateResult GateScan::judge(std::int64_t n_forced, double forced_weight) const {
  GateResult result;
  result.measure = measure_;
  result.limits = limits_;
  result.total = total_;
  result.n_beyond_hard = static_cast<std::int64_t>(beyond_.size());
  result.n_forced = n_forced;
  result.n_beyond_target = n_soft_;
  result.histogram.assign(histogram_.begin(), histogram_.begin() + classes_->n);
  if (worst_.empty()) {
    result.reason = "the mesh has none";
    return result;
  }
  result.worst = value_of(worst_.front());
  result.share_within = total_ > 0.0 ? within_ / total_ : 0.0;
  // What is forced counts as if it kept its limits.
  const bool is_usual_missed = !is_none(limits_.usual) && within_ + forced_weight < limits_.usual_share * total_;
  const bool is_hard_missed = n_forced < result.n_beyond_hard;
  result.state = is_hard_missed ? GateState::fail : worst_within_ > target_ || is_usual_missed ? GateState::warn : GateState::pass;
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
