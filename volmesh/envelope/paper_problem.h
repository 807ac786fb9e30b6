// The optimisation problem (3)-(9) as published (method.md §6, [ET15 §3.2.6]): objective f_1 + f_2, bounds, and the two constraint sums over violated elements.
#pragma once

#include <array>
#include <vector>

#include "volmesh/envelope/layer_objective.h"

namespace sterna::volmesh {

/// One constraint of (5): the sum over the elements that violate it, and how many do.
struct ConstraintSum {
  double sum = 0.0;
  std::int64_t n_violated = 0;
};

/// Design variables z: for every moving vertex its tangential ways (2, 1 or 0, as its constraint leaves) and its height along the vertex normal, all over
/// the upper height h_u. Gradients are with respect to z.
class PaperProblem {
 public:
  /// As LayerObjective, whose moving vertices and elements are these.
  PaperProblem(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const RunContext& context);

  std::size_t n_variables() const { return lower_.size(); }
  std::size_t n_moving() const { return objective_.n_moving(); }
  std::vector<double> variables(const Envelope& envelope) const;
  void store(const double* z, Envelope& envelope) const;
  /// Bounds (4): heights from h_l to h_u; tangential ways up to k_tangential_bound.
  const std::vector<double>& lower() const { return lower_; }
  const std::vector<double>& upper() const { return upper_; }

  /// f_1 and f_2 of (8) and (9); gradient (n_variables() numbers) of their sum, or null.
  ObjectiveValue objective(const double* z, double* gradient, const RunContext& context);
  /// (6): sum of max(0, g_1min - n_w.n_e / |n_w|^2).
  ConstraintSum inversion(const double* z, double* gradient, const RunContext& context) { return constraint(Kind::inversion, z, gradient, context); }
  /// (7): sum of max(0, -min_k y_k.n_w), with growth edges over h_u and unit n_w, so that thin and thick layers count alike.
  ConstraintSum below_wall(const double* z, double* gradient, const RunContext& context) { return constraint(Kind::below_wall, z, gradient, context); }

 private:
  enum class Kind { inversion, below_wall };
  struct Frame {
    std::array<Vec3, 3> axis;  ///< tangents, then the normal
    int count = 0;             ///< 0: the vertex does not move
    std::size_t first = 0;     ///< its first variable
  };
  void unpack(const double* z, const RunContext& context);
  void pack_gradient(const Vec3Field& by_vertex, double* gradient, const RunContext& context) const;
  ConstraintSum constraint(Kind kind, const double* z, double* gradient, const RunContext& context);

  const LayerBase& base_;
  LayerObjective objective_;
  std::vector<double> h_u_;
  std::vector<Frame> frames_;
  std::vector<double> lower_, upper_;
  Vec3Field y_, gradient_;                ///< scratch, allocated once
  std::vector<Vec3> corner_gradient_;     ///< 3 per triangle
  std::vector<std::uint8_t> is_violated_;  ///< per triangle
};

}  // namespace sterna::volmesh
