#include "geom/mesh/gates.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geom/math/constants.h"

namespace sterna {
namespace {

bool is_none(double limit) { return limit != limit; }

/// Orders the worst first; ties by ascending id, ignoring the flag of the side.
bool is_before(const GateScan::Item& a, const GateScan::Item& b) {
  if (a.badness != b.badness) return a.badness > b.badness;
  return (a.id & ~GateScan::k_too_small) < (b.id & ~GateScan::k_too_small);
}

}  // namespace

int HistogramClasses::of(double value) const {
  if (value != value || value >= to) return n - 1;
  if (value <= from) return 0;
  if (per_octave == 0) return std::min(n - 1, static_cast<int>((value - from) / (to - from) * n));
  // Exponent and mantissa are taken from the bits: fast, and identical on every platform.
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

GateTable::GateTable() {
  for (std::size_t i = 0; i < k_n_measures; ++i) limits_[i] = measures()[i].limits;
}

std::string_view to_string(Consumer consumer) { return consumer == Consumer::cell_centred ? "cell-centred" : "node-centred"; }

std::string_view to_string(Evidence evidence) {
  switch (evidence) {
    case Evidence::none: return "";
    case Evidence::definition: return "definition";
    case Evidence::measured: return "measured";
    case Evidence::cited: return "cited";
  }
  return "";
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
  const auto is_worse = [](const Item& a, const Item& b) { return is_before(a, b); };
  if (worst_.size() == k_most_locations && !is_worse(item, worst_.back())) return;
  worst_.insert(std::upper_bound(worst_.begin(), worst_.end(), item, is_worse), item);
  if (worst_.size() > k_most_locations) worst_.pop_back();
  if (worst_.size() == k_most_locations) entry_ = worst_.back().badness;
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
  std::sort(sorted.begin(), sorted.end(), [](const Beyond& a, const Beyond& b) { return is_before(a.item, b.item); });
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

GateResult GateScan::judge(std::int64_t n_forced, double forced_weight, double own_weight) const {
  GateResult result;
  result.measure = measure_;
  result.limits = limits_;
  result.total = total_;
  result.n_beyond_hard = static_cast<std::int64_t>(beyond_.size());
  result.n_forced = n_forced;
  result.n_beyond_target = n_soft_;
  result.histogram.assign(histogram_.begin(), histogram_.begin() + classes_->n);
  if (worst_.empty()) {
    result.reason = "the mesh has no items of this type";
    return result;
  }
  result.worst = value_of(worst_.front());
  result.share_within = total_ > 0.0 ? within_ / total_ : 0.0;
  result.share_beyond_hard = total_ > 0.0 ? own_weight / total_ : 0.0;
  // Items that are forced count as if they kept their limits.
  const bool is_usual_missed = !is_none(limits_.usual) && within_ + forced_weight < limits_.usual_share * total_;
  result.is_hard_missed = n_forced < result.n_beyond_hard;
  result.is_soft_missed = worst_within_ > target_ || is_usual_missed;
  result.state = GateState::pass;  // the gate was measured
  for (const Consumer consumer : k_consumers)
    if (const GateState state = state_for(result, consumer); state != GateState::not_checked) result.state = std::max(result.state, state);
  return result;
}

GateState state_for(const GateResult& gate, Consumer consumer) {
  const MeasureInfo& info = info_of(gate.measure);
  if (gate.state == GateState::not_checked || !info.consumers.has(consumer)) return GateState::not_checked;
  if (!gate.is_hard_missed) return gate.is_soft_missed ? GateState::warn : GateState::pass;
  const bool is_own_limit = gate.limits.hard != info.limits.hard;
  const Evidence evidence = info.evidence.of(consumer);
  const bool has_evidence = evidence == Evidence::definition || evidence == Evidence::measured;
  const bool may_fail = is_own_limit || (has_evidence && gate.share_beyond_hard > info.fail_share);
  return may_fail ? GateState::fail : GateState::warn;
}

GateResult not_checked(Measure measure, const GateTable& limits, std::string reason) {
  GateResult result;
  result.measure = measure;
  result.limits = limits[measure];
  result.reason = std::move(reason);
  return result;
}

}  // namespace sterna
