#include "volmesh/layer/truncate.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "volmesh/case/growth_law.h"

namespace sterna::volmesh {
namespace {

/// Fractions of the height of a regular tetrahedron on the top. k_target_last is the target for the last cell. k_least_step is the smallest height whose step
/// is a good cell (a tetrahedron on a step of this height has an angle of about 6 degrees). k_most_last limits the last cell that fewer layers may produce,
/// unless the last cell is already taller.
constexpr double k_target_last = 0.5, k_least_step = 0.12, k_most_last = 1.5;
constexpr double k_rounding = 1.0 + 1e-9;  ///< tolerance for heights that are compared with n h0, and for growth
/// Fraction of max_growth that is used; the remainder is for curved growth lines, whose cells grow by more than their heights.
constexpr double k_used_growth = 0.98;

/// Possible numbers of layers of a growth line.
struct LineChoice {
  int target_layers = 0;  ///< number of layers without regard to neighbours
  int least = 0;          ///< smallest number of layers beside neighbours with fewer layers
  int thin_from = 0;      ///< from this number on, the last cell is lower than k_least_step
};

class LineTruncation {
 public:
  LineTruncation(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope) : base_(base), scale_(scale), envelope_(envelope) {}

  /// \pre truncation is not `never`
  LineChoice choose(VertexId v, Truncation truncation) const {
    const int all = scale_.n(v);
    const double height = normal_height(base_, envelope_, v), h0 = scale_.first_step(v), regular = k_regular_height * envelope_edge(base_, envelope_, v);
    const LineGrowth law = scale_.growth(v);
    const auto last = [&](int n) { return last_height(law, height, n); };
    // The growth and the height of the last cell decrease with the number of layers.
    const auto least_with_growth = [&](double most) {
      return first_of(1, all, [&](int n) { return n == 1 ? height <= h0 * k_rounding : growth_for_height(h0, height, n) <= most * k_rounding; });
    };
    const double most_growth = std::max(1.0, k_used_growth * scale_.max_growth(v));
    const int least = least_with_growth(most_growth);
    LineChoice choice;
    choice.least = first_of(least, all, [&](int n) { return last(n) <= k_most_last * regular; });
    if (truncation == Truncation::always) {
      choice.target_layers = least_with_growth(std::min(most_growth, growth_for_height(h0, envelope_.target[v], all)));
      choice.thin_from = all + 1;
    } else {
      const auto first_below = [&](double share) { return first_of(least, all + 1, [&](int n) { return n > all || last(n) < share * regular; }); };
      choice.thin_from = first_below(k_least_step);
      choice.target_layers = choice.thin_from <= least ? all : std::max(least, first_below(k_target_last) - 1);
    }
    choice.least = std::min(choice.least, choice.target_layers);
    return choice;
  }

 private:
  /// Returns the smallest n in [low, high] for which a condition holds. The condition must hold from some n on, and is assumed to hold at `high`.
  template <class IsTrue>
  static int first_of(int low, int high, const IsTrue& is_true) {
    while (low < high) {
      const int middle = low + (high - low) / 2;
      if (is_true(middle)) high = middle;
      else low = middle + 1;
    }
    return low;
  }

  const LayerBase& base_;
  const EnvelopeScale& scale_;
  const Envelope& envelope_;
};

/// Requires all layers in all columns around multi-normal fans, because close_multi_normals.h makes explicit cells there.
void keep_multi_normals(const LayerBase& base, const EnvelopeScale& scale, std::vector<std::uint16_t>& least) {
  if (base.ridges == nullptr) return;
  std::vector<std::uint8_t> is_of_multi_normal(least.size(), 0);
  for (const VertexId v : base.ridges->end_vertices) is_of_multi_normal[v.index()] = 1;
  for (const VertexId v : base.wall.points.ids())
    if (base.multi_normal_of(v) != nullptr) is_of_multi_normal[v.index()] = 1;
  for (const TriangleVertices& t : base.wall.triangles)
    if (std::ranges::any_of(t, [&](VertexId v) { return is_of_multi_normal[v.index()] != 0; }))
      for (const VertexId v : t) least[v.index()] = static_cast<std::uint16_t>(scale.n(v));
}

}  // namespace

LayerNumbers::LayerNumbers(Borrowed<const LayerBase> base, const EnvelopeScale& scale, const Envelope& envelope, Truncation truncation,
                           const RunContext& context)
    : base_(base),
      layers_(base->wall.n_vertices()),
      least_(layers_.size()),
      thin_from_(layers_.size()),
      requested_(layers_.size()),
      is_fixed_(layers_.size(), 0) {
  const LineTruncation lines(base, scale, envelope);
  parallel_for(context, layers_.size(), [&](std::size_t i) {
    const VertexId v(i);
    const int all = scale.n(v);
    requested_[i] = static_cast<std::uint16_t>(all);
    LineChoice choice{all, all, all + 1};
    is_fixed_[i] = envelope.is_collapsed(v) || base->topology.outgoing(v).empty();
    const Truncation own = base->truncation.empty() ? truncation : base->truncation[v];
    if (!is_fixed_[i] && own != Truncation::never) choice = lines.choose(v, own);
    layers_[i] = static_cast<std::uint16_t>(choice.target_layers);
    least_[i] = static_cast<std::uint16_t>(choice.least);
    thin_from_[i] = static_cast<std::uint16_t>(choice.thin_from);
  });
  if (truncation == Truncation::never && base->truncation.empty()) return;
  keep_multi_normals(base, scale, least_);
  for (std::size_t i = 0; i < layers_.size(); ++i) layers_[i] = std::max(layers_[i], least_[i]);
  close_downwards();
  close_upwards();
}

namespace {

/// Calls visit(v, queue) for all vertices, then for the vertices that were put into the queue, until the queue is empty.
template <class Visit>
void visit_until_settled(const LayerBase& base, const Visit& visit) {
  std::vector<VertexId> changed;
  for (const VertexId v : base.wall.points.ids()) changed.push_back(v);
  while (!changed.empty()) {
    std::vector<VertexId> next;
    for (const VertexId v : changed) visit(v, next);
    changed = std::move(next);
  }
}

}  // namespace

/// Lowers numbers towards those of neighbours, as far as their growth lines permit: to one more than the neighbour, or to the same number if one more would be
/// thin. The result is the largest solution below the given numbers, for any order of visits.
void LayerNumbers::close_downwards() {
  visit_until_settled(base_, [&](VertexId v, std::vector<VertexId>& next) {
    if (is_fixed_[v.index()]) return;
    const int own = layers_[v.index()];
    for_each_edge(base_.topology, v, [&](HalfedgeId, VertexId neighbour) {
      int most = own;
      for_each_alike(base_, neighbour, [&](VertexId w) { most = std::max<int>(most, least_[w.index()]); });
      if (most == own) {
        bool is_thin = false;
        for_each_alike(base_, neighbour, [&](VertexId w) { is_thin = is_thin || own + 1 >= thin_from_[w.index()]; });
        most += is_thin ? 0 : 1;
      }
      for_each_alike(base_, neighbour, [&](VertexId w) {
        if (is_fixed_[w.index()] || layers_[w.index()] <= most) return;
        layers_[w.index()] = static_cast<std::uint16_t>(most);
        next.push_back(w);
      });
    });
  });
}

/// Raises numbers towards those of neighbours: to one less than the neighbour, or to the same number if the neighbour would be thin.
void LayerNumbers::close_upwards() {
  visit_until_settled(base_, [&](VertexId v, std::vector<VertexId>& next) {
    if (is_fixed_[v.index()]) return;
    const int own = layers_[v.index()], beside = own - (own >= thin_from_[v.index()] ? 0 : 1);
    const auto raise = [&](VertexId w, int target_layers) {
      const int least = std::min<int>(target_layers, requested_[w.index()]);
      if (is_fixed_[w.index()] || layers_[w.index()] >= least) return;
      layers_[w.index()] = static_cast<std::uint16_t>(least);
      next.push_back(w);
    };
    for_each_alike(base_, v, [&](VertexId w) { raise(w, own); });
    for_each_edge(base_.topology, v, [&](HalfedgeId, VertexId w) { raise(w, beside); });
  });
}

void LayerNumbers::raise(const std::vector<std::uint16_t>& least) {
  for (std::size_t i = 0; i < layers_.size(); ++i)
    if (!is_fixed_[i]) layers_[i] = std::max(layers_[i], least[i]);
  close_upwards();
}

}  // namespace sterna::volmesh
