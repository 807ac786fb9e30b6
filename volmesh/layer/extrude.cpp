// Steps of Extruder::extrude: place_stale_lines, limit_growth, limit_warp, invalid_among. While a column is invalid: reduce_curving; if that is not sufficient,
// lower_heights; and both steps again for all columns that changed. Curving and heights only fall, so the rounds end.
#include "volmesh/layer/extrude.h"

#include <algorithm>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "geom/math/measures.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/layer/layer_cells.h"
#include "volmesh/layer/layer_line.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_repair_rounds = 200;
constexpr int k_curving_rounds = 8;  ///< number of rounds that reduce c_t by bisection; later rounds straighten growth lines and lower heights immediately
constexpr int k_warp_rounds = 3;     ///< number of rounds, because less curving at one column changes the adjacent columns
constexpr int k_bisections = 6;      ///< number of bisections; the result is within 1/64 of the previous c_t
constexpr double k_equalise_factor = 1.05;  ///< corners of an invalid cell get heights within this ratio of the lowest corner
constexpr double k_shrink_factor = 0.7;     ///< factor on the heights of a cell that is invalid even with equal heights and straight growth lines
/// Largest ratio of consecutive node distances of a curved growth line, relative to the ratio of its heights; the ratio itself is at most k_max_growth (gate G8
/// allows 1.5).
constexpr double k_growth_reserve = 1.15, k_max_growth = 1.45;
/// The same factor for a growth line whose heights already grow by nearly k_max_growth.
constexpr double k_least_reserve = 1.02;
/// Smallest cosine between a face normal and the direction through the face (65 degrees, OpenFOAM's non-orthogonality), and the smallest improvement of
/// straight growth lines over curved ones that counts.
constexpr double k_least_top_cosine = 0.42, k_tilt_room = 0.02;
constexpr double k_hopeless = -1.0;  ///< fraction for a column that is invalid even with straight growth lines
constexpr std::size_t k_line_chunk = 512;
constexpr std::size_t k_column_chunk = 256;

/// Returns the largest fraction of c_t, to 1/64, for which `is_good(share)` holds. It must hold for 0 and fail for 1.
template <class IsGood>
double largest_share(const IsGood& is_good) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < k_bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (is_good(middle) ? low : high) = middle;
  }
  return low;
}

/// Returns true if all cells of a column are valid. On a virtual triangle the first cell does not exist, and most other cells are parts of hexahedra.
/// close_multi_normals.h checks the actual cells, so no height is reduced for such a column.
bool is_certain(const LayerBase& base, std::size_t column, const ColumnLines& lines) {
  if (!base.is_virtual(TriangleId(column)) || lines.n_prisms() != lines.n_cells()) return is_column_certain(lines);
  const auto& [a, b, c] = lines.nodes;
  for (int j = 1, n = lines.n_prisms(); j < n; ++j)
    if (!is_wedge_valid({a[j], b[j], c[j], a[j + 1], b[j + 1], c[j + 1]})) return false;
  return true;
}

}  // namespace

Extruder::Extruder(Borrowed<const LayerBase> base, const EnvelopeOptions& envelope_options, const PrismOptions& options, const RunContext& context)
    : base_(base),
      envelope_options_(envelope_options),
      scale_(scale_of(base, envelope_options)),
      context_(context),
      curving_(base, options.wall_perpendicularity),
      truncation_(truncation_of(options.truncate)),
      placed_(base->wall.n_vertices()) {
  const std::size_t n = base->wall.n_vertices();
  layers_.n_layers = 0;
  for (std::size_t i = 0; i < n; ++i) layers_.n_layers = std::max(layers_.n_layers, scale_.n(VertexId(i)));
  if (is_truncating()) layers_.line_layers.resize(n);
  for (std::size_t i = 0; i < n && layers_.is_uniform(); ++i)
    if (scale_.n(VertexId(i)) != layers_.n_layers) layers_.line_layers.resize(n);
  for (std::size_t i = 0; i < layers_.line_layers.size(); ++i) layers_.line_layers[i] = static_cast<std::uint16_t>(scale_.n(VertexId(i)));
  layers_.first_node.resize(n);
  std::uint64_t n_nodes = 0;
  for (std::size_t i = 0; i < n; ++i) {
    layers_.first_node[i] = NodeId(n_nodes).value();
    n_nodes += static_cast<std::uint64_t>(scale_.n(VertexId(i))) + 1;
  }
  layers_.is_collapsed.resize(n);
  layers_.base.resize(base->wall.n_triangles());
  for (const TriangleId t : IdRange<TriangleId>(base->wall.n_triangles())) {
    const TriangleVertices& v = base->wall.triangles[t];
    layers_.base[t.index()] = {v[0].value(), v[1].value(), v[2].value()};
  }
  points_.resize(n_nodes);
}

/// Places the growth lines whose height, direction or curving has changed since they were placed. Returns these growth lines, ascending.
std::vector<VertexId> Extruder::place_stale_lines(const Envelope& envelope) {
  return parallel_collect<VertexId>(
      context_, base_.wall.n_vertices(),
      [&](std::size_t begin, std::size_t end, std::vector<VertexId>& stale) {
        LinePlacer placer(base_, scale_);
        for (std::size_t i = begin; i < end; ++i) {
          const VertexId v(i);
          const Placed target{envelope.direction[v], envelope.height[v], curving_[v], layers(v)};
          if (target == placed_[v]) continue;
          placed_[v] = target;
          layers_.is_collapsed[i] = envelope.is_collapsed(v) ? 1 : 0;
          placer.place(envelope, v, layers(v), curving_[v], points_.data() + layers_.first_node[i]);
          stale.push_back(v);
        }
      },
      k_line_chunk);
}

Extruder::Columns Extruder::columns_at(const std::vector<VertexId>& lines) const {
  Columns columns;
  for (const VertexId v : lines)
    for (const HalfedgeId h : base_.topology.outgoing(v)) columns.push_back(triangle_of(h).index());
  sort_unique(columns);
  return columns;
}

/// Returns the invalid columns among some columns, or among all columns.
Extruder::Columns Extruder::invalid_among(const Columns* some) const {
  return parallel_collect<std::size_t>(
      context_, some ? some->size() : layers_.n_columns(),
      [&](std::size_t begin, std::size_t end, Columns& bad) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t column = some ? (*some)[i] : i;
          if (!is_certain(base_, column, column_lines(layers_, points_, column))) bad.push_back(column);
        }
      },
      k_column_chunk);
}

namespace {

double worst_ratio(std::span<const Point> nodes) {
  double worst = 1.0, before = distance(nodes[0], nodes[1]);
  for (std::size_t j = 1; j + 1 < nodes.size(); ++j) {
    const double step = distance(nodes[j], nodes[j + 1]);
    worst = std::max({worst, step / before, before / step});
    before = step;
  }
  return worst;
}

}  // namespace

/// Limits c_t of growth lines whose cells would grow by more than their heights. Returns true if there are such growth lines.
bool Extruder::limit_growth(const Envelope& envelope, const std::vector<VertexId>& lines) {
  std::vector<double> share(lines.size(), 1.0);
  parallel_chunks(context_, lines.size(), k_line_chunk, [&](std::size_t begin, std::size_t end) {
    LinePlacer placer(base_, scale_);
    std::vector<Point> nodes;
    for (std::size_t i = begin; i < end; ++i) {
      const VertexId v = lines[i];
      const int n = layers(v);
      if (envelope.is_collapsed(v) || curving_[v] == 0.0) continue;
      const double ratio = largest_growth(scale_.growth(v), normal_height(base_, envelope, v), n);
      const double most = n < scale_.n(v) ? std::min(scale_.max_growth(v), k_max_growth) : k_max_growth;
      const double allowed = std::max(k_least_reserve * ratio, std::min(k_growth_reserve * ratio, most));
      nodes.resize(static_cast<std::size_t>(n) + 1);
      const auto is_even = [&](double part) {
        placer.place(envelope, v, n, part * curving_[v], nodes.data());
        return worst_ratio(nodes) <= allowed;
      };
      if (!is_even(1.0)) share[i] = largest_share(is_even);
    }
  });
  bool has_any = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (share[i] == 1.0) continue;
    curving_.limit(lines[i], share[i] * curving_[lines[i]]);
    has_any = true;
  }
  return has_any;
}

/// Returns the largest common fraction of the present c_t of its growth lines with which a column is valid, to 1/64. Returns k_hopeless if the column is also
/// invalid with straight growth lines.
double Extruder::valid_share(const Envelope& envelope, std::size_t column) const {
  const std::size_t per_line = static_cast<std::size_t>(scale_.most_layers()) + 1;
  std::vector<Point> nodes(3 * per_line);
  LinePlacer placer(base_, scale_);
  const auto is_valid = [&](double share) {
    ColumnLines lines;
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v(layers_.base[column][k]);
      placer.place(envelope, v, layers(v), share * curving_[v], nodes.data() + k * per_line);
      lines.nodes[k] = nodes.data() + k * per_line;
      lines.n_steps[k] = envelope.is_collapsed(v) ? 0 : layers(v);
    }
    return is_certain(base_, column, lines);
  };
  return is_valid(0.0) ? largest_share(is_valid) : k_hopeless;
}

/// Returns the ends of a wall edge, the third corner of its triangle and the third corner of the triangle beyond (invalid at the wall's boundary).
std::array<VertexId, 4> Extruder::vertices_at(HalfedgeId side) const {
  const HalfedgeId twin = base_.topology.twin(side);
  return {base_.topology.from(side), base_.topology.to(side), base_.topology.from(previous(side)),
          twin.is_valid() ? base_.topology.from(previous(twin)) : VertexId()};
}

/// Returns the number of layers that have prisms on both sides of a side.
int Extruder::prisms_beside(const std::array<VertexId, 4>& around) const {
  int n = scale_.most_layers();
  for (const VertexId v : around)
    if (v.is_valid()) n = std::min(n, layers(v));
  return n;
}

/// Returns the first layer that has to be evaluated on the side over an edge, for both columns.
int Extruder::first_layer_at(HalfedgeId side) const {
  const auto first = [&](std::size_t column) { return first_layer_to_look_at(column_lines(layers_, points_, column)); };
  const HalfedgeId twin = base_.topology.twin(side);
  const int own = first(triangle_of(side).index());
  return twin.is_valid() ? std::min(own, first(triangle_of(twin).index())) : own;
}

/// Returns the edges of some triangles, or of all, over which the sides of prisms are not good. Each edge is given by its lower half-edge.
std::vector<HalfedgeId> Extruder::warped_sides(const Envelope& envelope, const Columns* some) const {
  return parallel_collect<HalfedgeId>(
      context_, some ? some->size() : layers_.n_columns(),
      [&](std::size_t begin, std::size_t end, std::vector<HalfedgeId>& warped) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t column = some ? (*some)[i] : i;
          for (int corner = 0; corner < 3; ++corner) {
            const HalfedgeId side = halfedge(TriangleId(column), corner), twin = base_.topology.twin(side);
            if (twin.is_valid() && twin < side && !(some && !std::ranges::binary_search(*some, triangle_of(twin).index()))) continue;
            const std::array<VertexId, 4> v = vertices_at(side);
            if (std::ranges::any_of(v, [&](VertexId w) { return w.is_valid() && envelope.is_collapsed(w); })) continue;
            const auto line = [&](VertexId w) { return w.is_valid() ? points_.data() + layers_.first_node[w.index()] : nullptr; };
            if (!is_good(side_shape({line(v[0]), line(v[1]), line(v[2]), line(v[3])}, first_layer_at(side), prisms_beside(v)))) warped.push_back(side);
          }
        }
      },
      k_column_chunk);
}

/// Returns the largest common fraction of the present c_t of the growth lines around a side with which the side can be cut. Returns k_hopeless if straight
/// growth lines are not sufficient.
double Extruder::unwarped_share(const Envelope& envelope, HalfedgeId side) const {
  const std::size_t per_line = static_cast<std::size_t>(scale_.most_layers()) + 1;
  const std::array<VertexId, 4> v = vertices_at(side);
  const int n = prisms_beside(v);
  std::vector<Point> nodes(4 * per_line);
  LinePlacer placer(base_, scale_);
  const int first = first_layer_at(side);
  const auto is_fine = [&](double share) {
    std::array<const Point*, 4> lines{};
    for (std::size_t k = 0; k < 4; ++k) {
      if (!v[k].is_valid()) continue;
      placer.place(envelope, v[k], layers(v[k]), share * curving_[v[k]], nodes.data() + k * per_line);
      lines[k] = nodes.data() + k * per_line;
    }
    return is_good(side_shape({lines[0], lines[1], lines[2], lines[3]}, first, n));
  };
  return is_fine(0.0) ? largest_share(is_fine) : k_hopeless;
}

/// Limits c_t where the sides of prisms are not good and less curving improves them. Returns true if there is such a location.
bool Extruder::limit_warp(const Envelope& envelope, const Columns* some) {
  const std::vector<HalfedgeId> warped = warped_sides(envelope, some);
  std::vector<double> share(warped.size());
  parallel_for(
      context_, warped.size(), [&](std::size_t i) { share[i] = unwarped_share(envelope, warped[i]); }, 8);
  bool has_any = false;
  for (std::size_t i = 0; i < warped.size(); ++i) {
    if (share[i] == k_hopeless) continue;
    has_any = true;
    for (const VertexId v : vertices_at(warped[i]))
      if (v.is_valid()) curving_.limit(v, share[i] * curving_[v]);
  }
  return has_any;
}

namespace {

/// Returns the smallest cosine between the normal of a face between two cells of a column and the line that connects the centres of these cells.
double worst_top_cosine(const ColumnLines& lines) {
  const auto& [a, b, c] = lines.nodes;
  double worst = 1.0;
  for (int j = 1, n = lines.n_prisms(); j < n; ++j) {
    const Vec3 area = cross(b[j] - a[j], c[j] - a[j]), way = a[j + 1] - a[j - 1] + (b[j + 1] - b[j - 1]) + (c[j + 1] - c[j - 1]);
    worst = std::min(worst, dot(area, way) / std::sqrt(norm2(area) * norm2(way)));
  }
  return worst;
}

}  // namespace

/// Limits c_t where the faces between the cells of a column are tilted against the column and less curving improves them. Returns true if there is such a
/// location.
bool Extruder::limit_tilt(const Envelope& envelope, const Columns* some) {
  const auto has_lines = [&](std::size_t column) { return layers_.n_collapsed(column) == 0; };
  const Columns tilted = parallel_collect<std::size_t>(
      context_, some ? some->size() : layers_.n_columns(),
      [&](std::size_t begin, std::size_t end, Columns& found) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t column = some ? (*some)[i] : i;
          if (has_lines(column) && worst_top_cosine(column_lines(layers_, points_, column)) < k_least_top_cosine) found.push_back(column);
        }
      },
      k_column_chunk);
  std::vector<double> share(tilted.size());
  parallel_for(
      context_, tilted.size(), [&](std::size_t i) { share[i] = upright_share(envelope, tilted[i]); }, 8);
  bool has_any = false;
  for (std::size_t i = 0; i < tilted.size(); ++i) {
    if (share[i] == 1.0) continue;
    has_any = true;
    for (const VertexId v : base_.wall.triangles[TriangleId(tilted[i])]) curving_.limit(v, share[i] * curving_[v]);
  }
  return has_any;
}

/// Returns the largest common fraction of the present c_t of its growth lines with which the faces between a column's cells are within the limit, or as upright
/// as with straight growth lines. Returns 1 if straight growth lines are no better.
double Extruder::upright_share(const Envelope& envelope, std::size_t column) const {
  const std::size_t per_line = static_cast<std::size_t>(scale_.most_layers()) + 1;
  std::vector<Point> nodes(3 * per_line);
  LinePlacer placer(base_, scale_);
  const auto cosine = [&](double share) {
    ColumnLines lines{};
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v(layers_.base[column][k]);
      placer.place(envelope, v, layers(v), share * curving_[v], nodes.data() + k * per_line);
      lines.nodes[k] = nodes.data() + k * per_line;
      lines.n_steps[k] = layers(v);
    }
    return worst_top_cosine(lines);
  };
  const double target = std::min(k_least_top_cosine, cosine(0.0) - k_tilt_room);
  if (cosine(1.0) >= target) return 1.0;
  return largest_share([&](double share) { return cosine(share) >= target; });
}

/// Limits c_t at the growth lines of invalid columns to the result of bisection. Returns the columns that no c_t makes valid.
Extruder::Columns Extruder::reduce_curving(const Envelope& envelope, const Columns& bad) {
  std::vector<double> share(bad.size());
  parallel_for(
      context_, bad.size(), [&](std::size_t i) { share[i] = valid_share(envelope, bad[i]); }, 8);
  Columns hopeless;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    if (share[i] == k_hopeless) {
      hopeless.push_back(bad[i]);
      continue;
    }
    for (const VertexId v : base_.wall.triangles[TriangleId(bad[i])]) curving_.limit(v, share[i] * curving_[v]);
  }
  return hopeless;
}

/// Makes heights equal over the corners of invalid columns. Lowers them if they were already equal.
void Extruder::lower_heights(const Columns& columns, Envelope& envelope) const {
  std::vector<VertexId> touched;
  for (const std::size_t c : columns) {
    const TriangleVertices& v = base_.wall.triangles[TriangleId(c)];
    double lowest = 0.0, tallest = 0.0;
    for (const VertexId vertex : v) {
      const double h = envelope.height[vertex];
      if (h > 0.0 && (lowest == 0.0 || h < lowest)) lowest = h;
      tallest = std::max(tallest, h);
    }
    const double bound = tallest > k_equalise_factor * lowest ? k_equalise_factor * lowest : k_shrink_factor * lowest;
    for (const VertexId vertex : v) {
      lower(envelope, vertex, bound, HeightLimit::prism, scale_);
      touched.push_back(vertex);
    }
  }
  sort_unique(touched);
  unwarp(base_, envelope_options_, HeightLimit::prism, envelope, context_, &touched);
  seat_on_surfaces(base_, envelope_options_, nullptr, envelope, context_);
}

/// Chooses the numbers of layers of all growth lines under the present envelope.
void Extruder::choose_layers(const Envelope& envelope) {
  if (!is_truncating()) return;
  numbers_.emplace(base_, scale_, envelope, truncation_, context_);
  if (!least_layers_.empty()) numbers_->raise(least_layers_);
  layers_.line_layers = numbers_->layers();
}

/// Gives truncated growth lines of invalid columns one layer more than the longest growth line of the column has, up to the requested number. Returns all other
/// columns.
Extruder::Columns Extruder::with_more_layers(const Columns& hopeless) {
  Columns others;
  least_layers_.resize(layers_.n_lines(), 0);
  for (const std::size_t column : hopeless) {
    const int longest = layers_.layers_of_column(column);
    bool is_truncated = false;
    for (const std::uint32_t line : layers_.base[column]) {
      const int most = std::min(longest + 1, scale_.n(VertexId(line)));
      if (layers_.is_collapsed[line] || layers_.line_layers[line] >= most) continue;
      least_layers_[line] = std::max(least_layers_[line], static_cast<std::uint16_t>(most));
      is_truncated = true;
    }
    if (!is_truncated) others.push_back(column);
  }
  if (others.size() == hopeless.size()) return others;
  numbers_->raise(least_layers_);
  layers_.line_layers = numbers_->layers();
  return others;
}

void Extruder::extrude(Envelope& envelope) {
  choose_layers(envelope);
  std::vector<VertexId> placed = place_stale_lines(envelope);
  const auto place_again = [&] {
    curving_.smooth(context_);
    const std::vector<VertexId> again = place_stale_lines(envelope);
    placed.insert(placed.end(), again.begin(), again.end());
    return again;
  };
  if (limit_growth(envelope, placed)) place_again();
  Columns some = is_first_ ? Columns{} : columns_at(placed);
  for (int round = 0; round < k_warp_rounds; ++round) {
    const bool is_tilted = limit_tilt(envelope, is_first_ ? nullptr : &some), is_warped = limit_warp(envelope, is_first_ ? nullptr : &some);
    if (!is_tilted && !is_warped) break;
    if (limit_growth(envelope, place_again())) place_again();  // a growth line that bends in lower layers grows more, unless it is straight
    if (!is_first_) some = columns_at(placed);
  }
  Columns bad = invalid_among(is_first_ ? nullptr : &some);
  is_first_ = false;
  for (int round = 0; !bad.empty(); ++round) {
    if (round == k_max_repair_rounds) {
      const auto place = base_.wall.points[base_.wall.triangles[TriangleId(bad.front())][0]];
      throw Error({.code = ErrorCode::envelope_failed,
                   .attempted = "extruding prisms",
                   .problem = std::to_string(bad.size()) + " prism columns are still invalid after " + std::to_string(round) + " repairs",
                   .locations = {{place, "column " + std::to_string(bad.front())}},
                   .n_locations = static_cast<std::int64_t>(bad.size()),
                   .hint = "report this surface"});
    }
    Columns hopeless;
    if (round < k_curving_rounds) {
      hopeless = reduce_curving(envelope, bad);
    } else {
      hopeless = bad;
      for (const std::size_t c : bad)
        for (const VertexId v : base_.wall.triangles[TriangleId(c)]) curving_.limit(v, 0.0);
    }
    context_.debug("extrusion: " + std::to_string(bad.size()) + " invalid columns in round " + std::to_string(round) + ", " + std::to_string(hopeless.size()) +
                   " of them also with straight growth lines");
    if (is_truncating()) hopeless = with_more_layers(hopeless);
    if (!hopeless.empty()) lower_heights(hopeless, envelope);
    curving_.smooth(context_);
    some = columns_at(place_stale_lines(envelope));
    some.insert(some.end(), bad.begin(), bad.end());  // this includes columns that could not be changed in this round
    sort_unique(some);
    bad = invalid_among(&some);
  }
}

Extrusion Extruder::take() && {
  if (is_truncating()) {
    layers_.n_layers = *std::ranges::max_element(layers_.line_layers);
    if (std::ranges::all_of(layers_.line_layers, [&](int n) { return n == layers_.n_layers; })) layers_.line_layers.clear();
  }
  std::uint64_t next = 0;
  for (std::size_t i = 0; i < layers_.n_lines(); ++i) {
    const std::size_t n_nodes = static_cast<std::size_t>(layers_.n_steps(i)) + 1;
    if (next != layers_.first_node[i]) std::copy_n(points_.begin() + layers_.first_node[i], n_nodes, points_.begin() + static_cast<std::ptrdiff_t>(next));
    layers_.first_node[i] = static_cast<std::uint32_t>(next);
    next += n_nodes;
  }
  points_.resize(next);
  Extrusion result{std::move(layers_), std::move(points_), 0, curving_.distribution()};
  for (const std::int64_t n : result.curving_shares) result.n_straightened += n;
  return result;
}

Extrusion extrude_prisms(const LayerBase& base, const EnvelopeOptions& envelope_options, const PrismOptions& options, Envelope& envelope,
                         const RunContext& context) {
  Extruder extruder(base, envelope_options, options, context);
  extruder.extrude(envelope);
  return std::move(extruder).take();
}

}  // namespace sterna::volmesh
