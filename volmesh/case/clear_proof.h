// Proof that the triangles of a boundary meet only in shared vertices and edges.
#pragma once

namespace sterna {
class RunContext;
}

namespace sterna::volmesh {

class Collider;
struct EnvelopeShape;
struct LayerBase;
struct PreflightLimits;
struct PreflightReport;
struct TestedEnvelope;
struct TetraBoundary;

/// States whether the triangles of a boundary are proved to meet only in shared vertices and edges. Only the functions that test this make a proof; all others
/// pass it on with the boundary, or drop it where they change the boundary.
class ClearProof {
 public:
  ClearProof() = default;  ///< nothing is proved
  bool is_given() const { return is_given_; }

 private:
  explicit ClearProof(bool is_clear) : is_given_(is_clear) {}
  friend TestedEnvelope certify_envelope(const LayerBase& base, Collider& collider, const EnvelopeShape& envelope, const RunContext& context);
  friend PreflightReport preflight(const TetraBoundary& boundary, const PreflightLimits& limits, const RunContext& context);

  bool is_given_ = false;
};

}  // namespace sterna::volmesh
