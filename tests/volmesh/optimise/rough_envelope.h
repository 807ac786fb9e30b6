// Envelopes with tilted growth lines and uneven heights, for the tests of the optimisers.
#pragma once

#include "tests/support/test_shapes.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {

/// Deterministic numbers in [-0.5, 0.5).
class Noise {
 public:
  double next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<double>(state_ >> 8) / 16777216.0 - 0.5;
  }
  Vec3 vector() {
    const double x = next(), y = next();
    return {x, y, next()};
  }

 private:
  std::uint32_t state_ = 7;
};

inline EnvelopeOptions thick_layers() {
  EnvelopeOptions options;
  options.first_height = 1e-4;
  options.layers = 20;
  options.max_growth = 1.5;
  options.max_thickness = 0.6;
  return options;
}

/// The inside of a sphere: growth lines converge, and a layer of half the radius leaves a quarter of the wall area.
inline TriMesh hollow_sphere(int f) {
  TriMesh mesh = test::sphere(f);
  for (TriangleVertices& v : mesh.triangles) std::swap(v[1], v[2]);
  return mesh;
}

/// Returns a valid envelope with tilted growth lines and uneven heights.
inline Envelope rough_envelope(const LayerBase& base, const EnvelopeOptions& options, double tilt, double unevenness, const RunContext& context) {
  Envelope envelope = initial_envelope(base, options, context);
  Noise noise;
  for (const VertexId v : envelope.height.ids()) {
    envelope.direction[v] = normalized(envelope.direction[v] + tilt * noise.vector());
    envelope.height[v] *= 1.0 - unevenness * (0.5 + noise.next());
  }
  unwarp(base, options, HeightLimit::warp, envelope, context);
  return envelope;
}

}  // namespace sterna::volmesh
