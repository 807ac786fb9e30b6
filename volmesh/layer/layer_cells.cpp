#include "volmesh/layer/layer_cells.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/math/sub_volumes.h"

namespace sterna::volmesh {
namespace {

constexpr int k_top_layers = 4;             ///< number of top layers that are evaluated; below these, growth lines are nearly normal and cells are flat
constexpr double k_narrow_share = 0.3;      ///< fraction of the wall triangle's area: sides are evaluated where the cross section of the column is smaller
constexpr std::size_t k_proof_chunk = 256;  ///< columns per task, which are some 10^4 cells

WedgePoints wedge_of(const ColumnLines& lines, int layer) {
  const auto& [a, b, c] = lines.nodes;
  return {a[layer], b[layer], c[layer], a[layer + 1], b[layer + 1], c[layer + 1]};
}

/// A cell of a column beside a growth line that has ended. It is rotated so that the growth line that differs from the other two comes first; the cyclic order
/// is kept (LayerBlock::cell).
struct PartialCell {
  std::array<const Point*, 3> nodes;  ///< nodes in this layer; for growth lines that have ended, their last nodes
  bool is_pyramid;
};
PartialCell partial_cell(const ColumnLines& lines, int layer) {
  const auto has_ended = [&](std::size_t k) { return lines.n_steps[k] <= layer; };
  const bool is_pyramid = has_ended(0) + has_ended(1) + has_ended(2) == 1;
  std::size_t first = 0;
  while (has_ended(first) != is_pyramid) ++first;
  const auto at = [&](std::size_t k) { return lines.nodes[k % 3] + std::min(layer, lines.n_steps[k % 3]); };
  return {{at(first), at(first + 1), at(first + 2)}, is_pyramid};
}
std::array<Vec3, 5> pyramid_of(const PartialCell& cell) {
  const auto& [a, b, c] = cell.nodes;
  return {b[0], b[1], c[1], c[0], a[0]};
}
std::array<Vec3, 4> tet_of(const PartialCell& cell) {
  const auto& [a, b, c] = cell.nodes;
  return {a[0], b[0], c[0], a[1]};
}

/// Returns six times the volume of the tetrahedron between a triangle and the cell's centre. It is positive if the triangle's normal points away from the
/// centre.
double outward_volume(const Point& a, const Point& b, const Point& c, const Point& centre) { return dot(cross(b - a, c - a), a - centre); }

using Quad = std::array<Point, 4>;

/// Returns a quality for each diagonal of a quadrilateral. The quadrilateral is cut into tetrahedra with a cell's centre, around its middle and along the
/// diagonal. The quality is the smallest of their volumes divided by the mean volume of the tetrahedra around its middle. It is negative if a tetrahedron is
/// inverted.
std::array<double, 2> cut_shares(const Quad& q, const Point& centre) {
  const Point middle = 0.25 * (q[0] + q[1] + q[2] + q[3]);
  std::array<double, 4> around{};
  for (std::size_t i = 0; i < 4; ++i) around[i] = outward_volume(q[i], q[(i + 1) % 4], middle, centre);
  const double mean = 0.25 * (around[0] + around[1] + around[2] + around[3]);
  if (mean == 0.0) return {-k_infinity, -k_infinity};
  std::array<double, 2> shares{};
  for (std::size_t base = 0; base < 2; ++base) {
    const auto at = [&](std::size_t i) { return q[(base + i) % 4]; };
    shares[base] = std::min({around[0] / mean, around[1] / mean, around[2] / mean, around[3] / mean, outward_volume(at(0), at(1), at(2), centre) / mean,
                             outward_volume(at(0), at(2), at(3), centre) / mean});
  }
  return shares;
}

Point centre_of(const Quad& side, const Point* third, int layer) { return (side[0] + side[1] + side[2] + side[3] + third[layer] + third[layer + 1]) / 6.0; }

void add_column(const ColumnLines& lines, std::size_t column, LayerCertificate& certificate) {
  certificate.n_cells += lines.n_cells();
  for (int j = lines.n_prisms(), n = lines.n_cells(); j < n; ++j) {
    const PartialCell partial = partial_cell(lines, j);
    certificate.n_proved += partial.is_pyramid ? is_pyramid_valid(pyramid_of(partial)) : is_tet_valid(tet_of(partial));
  }
  for (int j = 0, n = lines.n_prisms(); j < n; ++j) {
    const WedgePoints p = wedge_of(lines, j);
    certificate.n_proved += is_wedge_valid(p);
    const double quality = wedge_quality(p);
    if (!(quality < certificate.min_quality)) continue;
    certificate.min_quality = quality;
    certificate.worst_location = (p[0] + p[1] + p[2] + p[3] + p[4] + p[5]) / 6.0;
    certificate.worst_column = static_cast<std::int64_t>(column);
    certificate.worst_layer = j;
  }
}

}  // namespace

ColumnLines column_lines(const LayerBlock& layers, std::span<const Point> points, std::size_t column) {
  ColumnLines lines;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t line = layers.base[column][k];
    lines.nodes[k] = points.data() + layers.first_node[line];
    lines.n_steps[k] = layers.n_steps(line);
  }
  return lines;
}

bool is_column_certain(const ColumnLines& lines) {
  for (int j = 0, n = lines.n_prisms(); j < n; ++j) {
    const WedgePoints p = wedge_of(lines, j);
    if (!is_wedge_valid(p) || !are_sub_volumes_positive(p)) return false;
  }
  for (int j = lines.n_prisms(), n = lines.n_cells(); j < n; ++j) {
    const PartialCell partial = partial_cell(lines, j);
    if (!partial.is_pyramid) {
      if (!is_tet_valid(tet_of(partial))) return false;  // if the tetrahedron is valid, its dual is positive, too
      continue;
    }
    const std::array<Vec3, 5> p = pyramid_of(partial);
    if (!is_pyramid_valid(p) || !are_sub_volumes_positive(p)) return false;
  }
  return true;
}

namespace {

/// Returns the cut quality of a side in one layer for the better diagonal. The worse of both cells determines it.
double cut_share(const Quad& side, const Point& own_centre, const Point* centre_beyond) {
  const std::array<double, 2> own = cut_shares(side, own_centre);
  const std::array<double, 2> beyond = centre_beyond ? cut_shares(side, *centre_beyond) : own;
  return std::max(std::min(own[0], beyond[0]), std::min(own[1], beyond[1]));
}

Quad side_in(const SideLines& lines, int layer) { return {lines.from[layer], lines.to[layer], lines.to[layer + 1], lines.from[layer + 1]}; }

}  // namespace

SideShape side_shape(const SideLines& lines, int first, int n_layers, const PrismCentre& own_centre, const PrismCentre& centre_beyond) {
  SideShape shape;
  for (int j = first; j < n_layers; ++j) {
    const Quad side = side_in(lines, j);
    const Point own = own_centre ? own_centre(j) : centre_of(side, lines.own, j);
    const Point beyond = !lines.beyond ? Point{} : centre_beyond ? centre_beyond(j) : centre_of(side, lines.beyond, j);
    shape.cut_share = std::min(shape.cut_share, cut_share(side, own, lines.beyond ? &beyond : nullptr));
    if (!lines.beyond) continue;
    const Point middle = 0.25 * (side[0] + side[1] + side[2] + side[3]);
    const Vec3 normal = cross(side[2] - side[0], side[3] - side[1]);
    const double near = std::abs(dot(own - middle, normal)), far = std::abs(dot(beyond - middle, normal));
    if (near + far > 0.0) shape.weight = std::min(shape.weight, std::min(near, far) / (near + far));
  }
  return shape;
}

int first_layer_to_look_at(const ColumnLines& lines) {
  const auto& [a, b, c] = lines.nodes;
  const auto area = [&](int j) { return cross(b[j] - a[j], c[j] - a[j]); };
  const Vec3 normal = normalized(area(0));
  const double narrow = k_narrow_share * norm(area(0));
  const int top = std::max(0, lines.n_prisms() - k_top_layers);
  for (int j = 1; j <= top; ++j)
    if (dot(area(j), normal) < narrow) return j - 1;
  return top;
}

LayerCertificate certify_layer(const LayerBlock& layers, std::span<const Point> points, const RunContext& context) {
  return parallel_reduce(
      context, layers.n_columns(), LayerCertificate{},
      [&](std::size_t begin, std::size_t end) {
        LayerCertificate part;
        for (std::size_t c = begin; c < end; ++c) add_column(column_lines(layers, points, c), c, part);
        return part;
      },
      [](LayerCertificate a, const LayerCertificate& b) {
        const std::int64_t n_cells = a.n_cells + b.n_cells, n_proved = a.n_proved + b.n_proved;
        if (b.min_quality < a.min_quality) a = b;
        a.n_cells = n_cells;
        a.n_proved = n_proved;
        return a;
      },
      k_proof_chunk);
}

}  // namespace sterna::volmesh
