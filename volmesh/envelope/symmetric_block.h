// Symmetric 3 x 3 matrix: the Hessian of one vertex in the optimiser of the envelope.
#pragma once

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Symmetric 3 x 3 matrix with the entries xx, yy, zz, xy, yz, zx.
struct SymmetricBlock {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, yz = 0.0, zx = 0.0;
  /// Adds w v v^T.
  void add(double w, const Vec3& v) {
    xx += w * v.x * v.x;
    yy += w * v.y * v.y;
    zz += w * v.z * v.z;
    xy += w * v.x * v.y;
    yz += w * v.y * v.z;
    zx += w * v.z * v.x;
  }
  void add_identity(double w) {
    xx += w;
    yy += w;
    zz += w;
  }
  Vec3 operator*(const Vec3& v) const { return {xx * v.x + xy * v.y + zx * v.z, xy * v.x + yy * v.y + yz * v.z, zx * v.x + yz * v.y + zz * v.z}; }
};

}  // namespace sterna::volmesh
