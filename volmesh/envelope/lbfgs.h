// Limited-memory BFGS approximation of an inverse Hessian over one Vec3 of unknowns per vertex (Nocedal 1980; two-loop recursion).
#pragma once

#include <cstddef>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

using Vec3Field = std::vector<Vec3>;

/// Returns the sum of a[i].b[i], added in fixed chunks: bitwise equal for any number of threads.
double field_dot(const Vec3Field& a, const Vec3Field& b, const RunContext& context);

/// Symmetric 3 x 3 matrix: xx, yy, zz, xy, yz, zx.
struct SymmetricBlock {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, yz = 0.0, zx = 0.0;
  /// Adds w v v^T.
  void add(double w, const Vec3& v);
  void add_identity(double w);
  Vec3 operator*(const Vec3& v) const;
  /// \pre positive definite.
  SymmetricBlock inverse() const;
};

/// L-BFGS memory of the last `depth` pairs of step and gradient change; all memory is allocated once.
class LbfgsMemory {
 public:
  LbfgsMemory(std::size_t n, std::size_t depth);

  /// Stores the pair (to - from, gradient_to - gradient_from); skips the pair if its curvature is not positive, which keeps the approximation positive
  /// definite.
  void push(const Vec3Field& from, const Vec3Field& to, const Vec3Field& gradient_from, const Vec3Field& gradient_to, const RunContext& context);
  void clear() { n_pairs_ = 0; }
  bool empty() const { return n_pairs_ == 0; }
  /// Computes direction = - H gradient, where H starts from `initial_scale` times the identity if there are no pairs.
  void descend(const Vec3Field& gradient, double initial_scale, Vec3Field& direction, const RunContext& context) const;

 private:
  struct Pair {
    Vec3Field step, change;
    double product = 0.0;  ///< step . change
    double square = 0.0;   ///< change . change
  };
  /// Returns the i-th youngest pair.
  const Pair& pair(std::size_t i) const { return pairs_[(next_ + pairs_.size() - 1 - i) % pairs_.size()]; }

  std::vector<Pair> pairs_;
  std::size_t next_ = 0, n_pairs_ = 0;
};

}  // namespace sterna::volmesh
