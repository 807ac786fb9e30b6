#include "volmesh/envelope/lbfgs.h"

#include <algorithm>

#include "geom/base/parallel.h"

namespace sterna::volmesh {
namespace {

/// Least curvature (relative to the lengths of step and change) of a pair that is kept.
constexpr double k_min_curvature = 1e-10;

template <class F>
void for_all(const RunContext& context, std::size_t n, const F& f) {
  constexpr std::size_t k_chunk = 16384;
  parallel_for(context, n, f, k_chunk);
}

}  // namespace

double field_dot(const Vec3Field& a, const Vec3Field& b, const RunContext& context) {
  return parallel_reduce(
      context, a.size(), 0.0,
      [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i) sum += dot(a[i], b[i]);
        return sum;
      },
      [](double x, double y) { return x + y; });
}

void SymmetricBlock::add(double w, const Vec3& v) {
  xx += w * v.x * v.x;
  yy += w * v.y * v.y;
  zz += w * v.z * v.z;
  xy += w * v.x * v.y;
  yz += w * v.y * v.z;
  zx += w * v.z * v.x;
}

void SymmetricBlock::add_identity(double w) {
  xx += w;
  yy += w;
  zz += w;
}

Vec3 SymmetricBlock::operator*(const Vec3& v) const { return {xx * v.x + xy * v.y + zx * v.z, xy * v.x + yy * v.y + yz * v.z, zx * v.x + yz * v.y + zz * v.z}; }

SymmetricBlock SymmetricBlock::inverse() const {
  SymmetricBlock adjoint{yy * zz - yz * yz, zz * xx - zx * zx, xx * yy - xy * xy, yz * zx - xy * zz, zx * xy - yz * xx, xy * yz - zx * yy};
  const double d = 1.0 / (xx * adjoint.xx + xy * adjoint.xy + zx * adjoint.zx);
  return {d * adjoint.xx, d * adjoint.yy, d * adjoint.zz, d * adjoint.xy, d * adjoint.yz, d * adjoint.zx};
}

LbfgsMemory::LbfgsMemory(std::size_t n, std::size_t depth) : pairs_(depth) {
  for (Pair& p : pairs_) {
    p.step.resize(n);
    p.change.resize(n);
  }
}

void LbfgsMemory::push(const Vec3Field& from, const Vec3Field& to, const Vec3Field& gradient_from, const Vec3Field& gradient_to, const RunContext& context) {
  Pair& p = pairs_[next_];
  for_all(context, from.size(), [&](std::size_t i) {
    p.step[i] = to[i] - from[i];
    p.change[i] = gradient_to[i] - gradient_from[i];
  });
  p.product = field_dot(p.step, p.change, context);
  p.square = field_dot(p.change, p.change, context);
  const double length2 = field_dot(p.step, p.step, context);
  if (!(p.product > k_min_curvature * std::sqrt(p.square * length2))) {
    // The slot may have held the oldest pair, which is overwritten now.
    n_pairs_ = std::min(n_pairs_, pairs_.size() - 1);
    return;
  }
  next_ = (next_ + 1) % pairs_.size();
  n_pairs_ = std::min(n_pairs_ + 1, pairs_.size());
}

void LbfgsMemory::descend(const Vec3Field& gradient, double initial_scale, Vec3Field& direction, const RunContext& context) const {
  const std::size_t n = gradient.size();
  for_all(context, n, [&](std::size_t i) { direction[i] = -gradient[i]; });
  std::vector<double> alpha(n_pairs_);
  for (std::size_t k = 0; k < n_pairs_; ++k) {
    const Pair& p = pair(k);
    alpha[k] = field_dot(p.step, direction, context) / p.product;
    for_all(context, n, [&, a = alpha[k]](std::size_t i) { direction[i] -= a * p.change[i]; });
  }
  const double scale = n_pairs_ > 0 ? pair(0).product / pair(0).square : initial_scale;
  for_all(context, n, [&](std::size_t i) { direction[i] *= scale; });
  for (std::size_t k = n_pairs_; k-- > 0;) {
    const Pair& p = pair(k);
    const double beta = field_dot(p.change, direction, context) / p.product;
    for_all(context, n, [&, b = alpha[k] - beta](std::size_t i) { direction[i] += b * p.step[i]; });
  }
}

}  // namespace sterna::volmesh
