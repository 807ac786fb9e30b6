// Computes the metrics of the inner nodes of columns. Contributions are gathered per line, not scattered: each prism is evaluated from each of its three lines.
// This costs three times the arithmetic, but needs no memory for edges or nodes, and four layers are computed at once.
// A prism (a0 b0 c0 | a1 b1 c1) is seen from a0, with vectors u relative to a0. Let g be its centroid, m the midpoint of an edge, and f the centroid of a face.
// The edge's two faces f1, f2 give the dual face (f1 - f2) x (g - m) / 2. Each of them gives a sub-volume |f . (g x m)| / 6.
#include <algorithm>
#include <cmath>

#include "geom/math/constants.h"
#include "geom/mesh/dual_parts.h"

namespace sterna::dual_parts {

using namespace lanes;

LineDual::LineDual(Borrowed<const HybridMesh> mesh, Borrowed<const LineRings> rings) : mesh_(mesh), rings_(rings) {
  n_padded_ = padded_size(mesh->layers.n_layers);
  upward_.assign(n_padded_, 0.0);
  for (std::vector<double>* values : {&least_above_, &most_above_, &sum_above_, &least_below_, &most_below_, &sum_below_}) values->assign(n_padded_, 0.0);
  metrics_.resize(n_padded_);
}

LineDual::Slot& LineDual::slot_of(std::uint32_t line) {
  for (std::size_t s = 0; s < n_slots_; ++s)
    if (slots_[s].line == line) return slots_[s];
  if (n_slots_ == slots_.size()) {
    slots_.emplace_back();
    neighbours_.emplace_back();
  }
  Slot& slot = slots_[n_slots_];
  slot.line = line;
  neighbours_[n_slots_].read(mesh_, line);
  slot.above.assign(n_padded_, 0.0);
  slot.below.assign(n_padded_, 0.0);
  ++n_slots_;
  return slot;
}

void LineDual::reset() {
  n_slots_ = 0;
  upward_.assign(n_padded_, 0.0);
  for (std::vector<double>* values : {&sum_above_, &sum_below_}) std::fill(values->begin(), values->end(), 0.0);
  for (std::vector<double>* values : {&least_above_, &least_below_}) std::fill(values->begin(), values->end(), k_infinity);
  for (std::vector<double>* values : {&most_above_, &most_below_}) std::fill(values->begin(), values->end(), -k_infinity);
}

// The triangle (own, b, c) is counter-clockwise as seen from above. The outward faces are: own c b (bottom), own b b1 own1, c own own1 c1, own1 b1 c1 (top).
void LineDual::add_column(std::uint32_t column, const LineVectors& b, const LineVectors& c, Slot& to_b, Slot& to_c) {
  const auto n = static_cast<std::size_t>(mesh_.layers.layers_of_column(column));
  const auto per_column = static_cast<std::uint64_t>(mesh_.layers.n_layers);  // cell numbers per column, of which some have no cell
  for (std::size_t j = 0; j < n; j += k_width) {
    const Vec3x4 a0 = own_.at(j), a1 = own_.at(j + 1);
    const Vec3x4 b0 = b.at(j) - a0, b1 = b.at(j + 1) - a1;
    const Vec3x4 c0 = c.at(j) - a0, c1 = c.at(j + 1) - a1;
    const Vec3x4 up = a1 - a0;
    const Vec3x4 half_up = 0.5 * up;
    const Vec3x4 middle = (1.0 / 6.0) * (b0 + c0 + b1 + c1);
    const Vec3x4 side_b = 0.25 * (b0 + b1), side_c = 0.25 * (c0 + c1);
    const Vec3x4 bottom = (1.0 / 3.0) * (b0 + c0), top = (1.0 / 3.0) * (b1 + c1);

    Packed lowest = all(std::numeric_limits<double>::infinity()), highest = -lowest, sum = all(0.0);
    const auto note = [&](Packed six_times) {
      lowest = least(lowest, six_times);
      highest = most(highest, six_times);
      sum += six_times;
    };
    /// Returns the dual face of the edge with midpoint m, from its faces before (running towards the corner) and after (running away from it).
    const auto piece = [&](const Vec3x4& before, const Vec3x4& after, const Vec3x4& g, const Vec3x4& m) {
      const Vec3x4 moment = cross(g, m);
      note(dot(before, moment));
      note(-dot(after, moment));
      return 0.5 * cross(before - after, g - m);
    };

    // The upward edge belongs to the corners at both of its ends.
    const Vec3x4 at_top_b = side_b - half_up, at_top_c = side_c - half_up;
    const Vec3x4 at_bottom_b = side_b + half_up, at_bottom_c = side_c + half_up;
    const Vec3x4 from_bottom = middle + half_up, from_top = middle - half_up;
    upward_.add(j, piece(at_bottom_b, at_bottom_c, from_bottom, half_up));
    const Packed shared_lowest = lowest, shared_highest = highest, shared_sum = sum;
    const Packed size2 = dot(b0, b0) + dot(c0, c0) + dot(b1, b1) + dot(c1, c1) + dot(up, up);
    const Packed bound = certain_sub_volume(root(dot(a0, a0)), root(size2), size2);

    to_b.above.add(j, piece(bottom, at_bottom_b, from_bottom, 0.5 * b0));
    to_c.above.add(j, piece(at_bottom_c, bottom, from_bottom, 0.5 * c0));
    store(least_above_, j, least(load(least_above_, j), lowest));
    store(most_above_, j, most(load(most_above_, j), highest));
    store(sum_above_, j, load(sum_above_, j) + sum);
    auto is_suspect = !(lowest > bound);

    lowest = shared_lowest, highest = shared_highest, sum = shared_sum;
    to_b.below.add(j + 1, piece(at_top_b, top, from_top, 0.5 * b1));
    to_c.below.add(j + 1, piece(top, at_top_c, from_top, 0.5 * c1));
    store(least_below_, j + 1, least(load(least_below_, j + 1), lowest));
    store(most_below_, j + 1, most(load(most_below_, j + 1), highest));
    store(sum_below_, j + 1, load(sum_below_, j + 1) + sum);
    is_suspect |= !(lowest > bound);

    for (std::size_t k = 0; k < k_width && j + k < n; ++k)
      if (is_suspect[k]) suspects_.push_back(std::uint64_t{column} * per_column + j + k);
  }
}

// Processes the edges along the layer, then the two upright edges, four layers at a time.
void LineDual::finish(std::size_t n_layers) {
  for (std::size_t j = 0; j < n_layers; j += k_width) {
    Packed area_sum = all(0.0), weighted = all(0.0), largest = all(0.0), smallest = all(k_infinity), longest = all(0.0), shortest = all(k_infinity);
    Vec3x4 closure{};
    const auto add_face = [&](const Vec3x4& normal, const Vec3x4& edge, Packed length) {
      const Packed area = root(dot(normal, normal));
      area_sum += area;
      weighted += area * arc_sine(dot(normal, edge) / (area * length));
      largest = most(largest, area);
      smallest = least(smallest, area);
      closure = closure + normal;
    };
    const Vec3x4 a = own_.at(j);
    for (std::size_t s = 0; s < n_slots_; ++s) {
      const Vec3x4 edge = neighbours_[s].at(j) - a;
      const Packed length = root(dot(edge, edge));
      longest = most(longest, length);
      shortest = least(shortest, length);
      add_face(slots_[s].above.at(j) + slots_[s].below.at(j), edge, length);
    }
    const Vec3x4 up = own_.at(j + 1) - a;
    const Packed height_above = root(dot(up, up));
    add_face(upward_.at(j), up, height_above);
    // Layer 0 has no downward edge and its result is not used; its lanes repeat the upward edge.
    const std::size_t k_shift = j == 0 ? 0 : 1;
    Vec3x4 below = own_.at(j - k_shift), normal_below = upward_.at(j - k_shift);
    if (j == 0) {
      const auto shift = [](Packed v) { return __builtin_shufflevector(v, v, 0, 0, 1, 2); };
      below = {shift(below.x), shift(below.y), shift(below.z)};
      normal_below = {shift(normal_below.x), shift(normal_below.y), shift(normal_below.z)};
    }
    const Vec3x4 down = below - a;
    const Packed height_below = root(dot(down, down));
    add_face(Vec3x4{} - normal_below, down, height_below);

    const Packed lowest = least(load(least_above_, j), load(least_below_, j));
    const Packed highest = most(load(most_above_, j), load(most_below_, j));
    const Packed volume = (1.0 / 6.0) * (load(sum_above_, j) + load(sum_below_, j));
    const Packed ratio = largest / smallest;
    const Packed relative = ratio * (0.5 * (height_above + height_below)) / longest;
    const Packed orthogonality = weighted / area_sum;
    const Packed sub_volume_ratio = lowest > all(0.0) ? highest / lowest : all(k_infinity);
    const Packed edge_ratio = longest / shortest;
    const Packed open = root(dot(closure, closure)), longest_of_all = most(longest, most(height_above, height_below));
    const Packed rounding = k_face_rounding * static_cast<double>(n_slots_ + 2) * longest_of_all * longest_of_all;
    const Packed closed = open <= rounding ? least(open / area_sum, all(k_rounding_closure)) : open / area_sum;
    for (std::size_t k = 0; k < k_width; ++k)
      metrics_[j + k] = {orthogonality[k], ratio[k], relative[k], sub_volume_ratio[k], edge_ratio[k], closed[k], volume[k]};
  }
}

std::span<const NodeMetrics> LineDual::measure(std::uint32_t line) {
  const auto n = static_cast<std::size_t>(mesh_.layers.layers_of_line(line));
  if (n < 2) return {};
  reset();
  own_.read(mesh_, line);
  for (const std::uint32_t column : rings_.columns(line)) {
    const auto& base = mesh_.layers.base[column];
    const std::size_t corner = base[0] == line ? 0 : base[1] == line ? 1 : 2;
    const std::uint32_t b = base[(corner + 1) % 3], c = base[(corner + 2) % 3];
    slot_of(b);
    slot_of(c);  // may reallocate the slots
    Slot &to_b = slot_of(b), &to_c = slot_of(c);
    add_column(column, neighbours_[static_cast<std::size_t>(&to_b - slots_.data())], neighbours_[static_cast<std::size_t>(&to_c - slots_.data())], to_b, to_c);
  }
  finish(n);
  return {metrics_.data() + 1, n - 1};
}

}  // namespace sterna::dual_parts
