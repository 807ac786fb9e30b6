// The formulas of geom/math/wedge.cpp, in SIMD lanes. The filter bounds the error of a coefficient a x b . d by the product of the lengths instead of the sum
// of its terms' magnitudes. This bound is weaker but needs no extra work, since the lengths are computed anyway. Prisms of scaled Jacobian 1e-13 are still
// decided.
#include "geom/mesh/column_scan.h"

#include "geom/mesh/cell_lanes.h"
#include "geom/mesh/column_shapes.h"

namespace sterna {
namespace {

using namespace lanes;

/// Bound of a coefficient's error, divided by the product of its three lengths. There are six terms, each at most as large as the product and with at most 10
/// roundings (wedge.cpp); 2 b1 has twelve terms. Rounded up.
constexpr double k_coefficient_error = 64 * 0x1p-53;
/// Margin for comparing -2 b1 with 2 sqrt(b0) sqrt(b2), as k_root_margin of wedge.cpp.
constexpr double k_column_root_margin = 10 * 0x1p-53;

}  // namespace

const std::vector<PrismMeasures>& ColumnScan::measure(std::size_t column) {
  const auto n = static_cast<std::size_t>(mesh_.layers.layers_of_column(column));
  for (std::size_t k = 0; k < 3; ++k) lines_[k].read(mesh_, mesh_.layers.base[column][k]);
  measures_.resize(n);
  const Packed zero = all(0.0);
  for (std::size_t j = 0; j < n; j += k_width) {
    std::array<Vec3x4, 3> p, q, d;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = lines_[k].at(j);
      q[k] = lines_[k].at(j + 1);
      d[k] = q[k] - p[k];
    }
    const Vec3x4 a = p[1] - p[0], b = p[2] - p[0], a_top = q[1] - q[0], b_top = q[2] - q[0];
    const Vec3x4 n0 = cross(a, b), n1_twice = cross(a, b_top) + cross(a_top, b), n2 = cross(a_top, b_top);
    const Packed volume = (1.0 / 18.0) * dot(n0 + 0.5 * n1_twice + n2, d[0] + d[1] + d[2]);

    // Lengths of the edges opposite to the corners.
    const std::array<Packed, 3> base = {norm(p[2] - p[1]), norm(b), norm(a)};
    const std::array<Packed, 3> top = {norm(q[2] - q[1]), norm(b_top), norm(a_top)};
    const Packed bottom_area = norm(n0), top_area = norm(n2);
    const Packed longest_product = most(base[1], top[1]) * most(base[2], top[2]);  // products |a| |b|, maximum of the lower and upper edges
    Packed quality = all(std::numeric_limits<double>::infinity()), skew = zero;
    auto is_certain = zero == zero;
    for (std::size_t k = 0; k < 3; ++k) {
      const Packed height = norm(d[k]);
      const Packed b0 = dot(n0, d[k]), b1_twice = dot(n1_twice, d[k]), b2 = dot(n2, d[k]);
      const Packed error = k_coefficient_error * longest_product * height;
      const Packed low0 = b0 - error, low2 = b2 - error, low1 = b1_twice - 2.0 * error;
      const Packed lowest = 2.0 * (1.0 - k_column_root_margin) * root(most(low0, zero)) * root(most(low2, zero));
      is_certain &= (low0 > zero) & (low2 > zero) & ((low1 >= zero) | (-low1 < lowest));

      const Packed base_scale = base[(k + 1) % 3] * base[(k + 2) % 3] * height, top_scale = top[(k + 1) % 3] * top[(k + 2) % 3] * height;
      quality = least(quality, least(b0 / base_scale, b2 / top_scale));
      const Packed middle = (0.5 * b1_twice + root(most(b0, zero)) * root(most(b2, zero))) / (2.0 * root(base_scale) * root(top_scale));
      quality = (b0 > zero) & (b2 > zero) ? least(quality, middle) : quality;
      quality = (base_scale > zero) & (top_scale > zero) ? quality : least(quality, zero);
      const Packed lower = b0 / (bottom_area * height), upper = b2 / (top_area * height);
      // An edge or normal of zero length counts as a right angle.
      skew += arc_sine(bottom_area * height > zero ? lower : zero) + arc_sine(top_area * height > zero ? upper : zero);
    }
    skew = all(0.5 * std::numbers::pi) - (1.0 / 6.0) * skew;
    for (std::size_t k = 0; k < k_width && j + k < n; ++k) measures_[j + k] = {is_certain[k] != 0, volume[k], quality[k], skew[k]};
  }
  return measures_;
}

}  // namespace sterna

namespace sterna::check_parts {
namespace {

using namespace lanes;

/// Returns the faces of a prism in the order of cell_faces(), for four layers.
std::array<FaceShapes, 5> prism_faces(const std::array<LineVectors, 3>& lines, std::size_t layer) {
  std::array<Vec3x4, 3> low, high;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = lines[k].at(layer);
    high[k] = lines[k].at(layer + 1);
  }
  const auto side = [&](std::size_t u, std::size_t v) { return face_shapes(std::array<Vec3x4, 4>{low[u], low[v], high[v], high[u]}); };
  return {side(0, 1), side(1, 2), side(2, 0), face_shapes(std::array<Vec3x4, 3>{low[0], low[2], low[1]}), face_shapes(high)};
}

void store_faces(const InnerFaces& faces, std::size_t n_used, InnerFace* to) {
  for (std::size_t k = 0; k < n_used; ++k)
    to[k] = {faces.non_orthogonality[k], faces.skewness[k], faces.weight[k], faces.volume_ratio[k], faces.flatness[k], faces.tets[k]};
}

}  // namespace

void ColumnShapes::read(std::size_t column) {
  n_ = static_cast<std::size_t>(mesh_.layers.layers_of_column(column));
  for (std::size_t k = 0; k < 3; ++k) lines_[k].read(mesh_, mesh_.layers.base[column][k]);
}

ColumnShapes::Side ColumnShapes::side_at(std::size_t corner, std::size_t layer) const {
  const LineVectors &u = lines_[corner], &v = lines_[(corner + 1) % 3];
  return {u.at(layer), v.at(layer), v.at(layer + 1), u.at(layer + 1)};
}

std::span<const CellShape> ColumnShapes::cells() {
  cells_.resize(n_);
  for (std::size_t j = 0; j < n_; j += k_width) {
    const CellShapes shapes = cell_shapes(prism_faces(lines_, j));
    for (std::size_t k = 0; k < k_width && j + k < n_; ++k)
      cells_[j + k] = {lane(shapes.location.centre, k), shapes.location.volume[k], shapes.aspect_ratio[k], shapes.openness[k], shapes.determinant[k]};
  }
  return cells_;
}

void ColumnShapes::locations(CellCentre* locations) const {
  for (std::size_t j = 0; j < n_; j += k_width) {
    const CellCentres four = cell_locations(prism_faces(lines_, j));
    for (std::size_t k = 0; k < k_width && j + k < n_; ++k) locations[j + k] = lane(four, k);
  }
}

std::span<const InnerFace> ColumnShapes::tops(const CellCentre* locations) {
  const std::size_t n = n_ - 1;
  tops_.resize(n);
  for (std::size_t j = 0; j < n; j += k_width) {
    const std::array<Vec3x4, 3> corners = {lines_[0].at(j + 1), lines_[1].at(j + 1), lines_[2].at(j + 1)};
    const std::size_t n_used = std::min(k_width, n - j);
    store_faces(inner_faces(corners, face_shapes(corners), load(locations + j), load(locations + j + 1), n_used), n_used, tops_.data() + j);
  }
  return tops_;
}

std::span<const InnerFace> ColumnShapes::side(std::size_t corner, const CellCentre* locations, const CellCentre* locations_beyond) {
  sides_.resize(n_);
  for (std::size_t j = 0; j < n_; j += k_width) {
    const Side corners = side_at(corner, j);
    const std::size_t n_used = std::min(k_width, n_ - j);
    store_faces(inner_faces(corners, face_shapes(corners), load(locations + j), load(locations_beyond + j), n_used), n_used, sides_.data() + j);
  }
  return sides_;
}

}  // namespace sterna::check_parts
