// Objective of sterna's own optimiser: f_1 + f_2 of the paper, optionally the orthogonality at the envelope (f_3), and a barrier against every way in which a
// macro-element can become invalid (docs/method/optimisation.md, "Own objective"; [ET15 §3.2.6]; barrier on the Jacobian: Garanzha et al. 2021).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/layer_element.h"
#include "volmesh/envelope/layer_folds.h"

namespace sterna::volmesh {

using Vec3Field = std::vector<Vec3>;

struct ObjectiveWeights {
  double height = 1.0;    ///< weight of f_2 relative to f_1
  double top = 0.0;       ///< weight of f_3 relative to f_1
  double membrane = 0.0;  ///< weight of f_4 relative to f_1
  double barrier = 0.02;  ///< weight of the barrier relative to f_1; the barrier is summed over its terms and elements
};

/// Parts of the objective for one set of unknowns.
struct ObjectiveValue {
  double f1 = 0.0;  ///< eq. (8), mean over the moving vertices
  double f2 = 0.0;  ///< eq. (9)
  double f3 = 0.0;  ///< eq. (8) with the envelope's normals
  double f4 = 0.0;  ///< membrane term, weighted: mean over the vertices of half the squared slope of the normal height along their edges
  double barrier = 0.0;
  double total = 0.0;  ///< weighted sum of all terms
};

/// Objective and descent steps of the optimiser. The unknowns are the growth vectors of all vertices divided by their upper heights, y = (envelope point - wall
/// point) / h_u. Each vertex has one Vec3 with 3, 2 or 1 free components, depending on its constraint.
class LayerObjective {
 public:
  /// \p h_u and \p h_l are the upper and lower bounds of the normal component of the growth vector, m. Vertices that are collapsed or whose bounds nearly
  /// coincide do not move. No element may get a scaled Jacobian below `least_quality`. \p floor (may be empty) contains lower limits, m, for the lengths of
  /// growth vectors that are longer at the start.
  /// \pre every macro-element of `start` is valid, unless the weights of f_3 and of the barrier are zero.
  LayerObjective(Borrowed<const LayerBase> base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double least_quality,
                 const ObjectiveWeights& weights, const RunContext& context, const Column<VertexId, double>& floor = {});

  std::size_t size() const { return h_u_.size(); }
  bool is_moving(std::size_t v) const { return is_moving_[v] != 0; }
  double upper(std::size_t v) const { return h_u_[v]; }  ///< h_u, m
  std::size_t n_moving() const { return n_moving_; }
  Vec3Field unknowns(const Envelope& envelope) const;
  /// Writes directions and heights of the moving vertices to the envelope.
  void store(const Vec3Field& y, Envelope& envelope) const;
  /// Returns the objective.
  /// \pre every element is feasible, unless the weights of f_3 and of the barrier are zero; then elements are not evaluated
  ObjectiveValue evaluate(const Vec3Field& y, const RunContext& context) const;
  /// Makes one pass over the vertices of `active`, colour by colour. Each vertex moves towards the minimum of its local quadratic model, as far as the
  /// objective falls and all its elements stay feasible. Afterwards `active` marks the vertices of the next pass. The total objective falls monotonically.
  /// Returns the number of visited vertices.
  std::size_t descend(Vec3Field& y, std::vector<std::uint8_t>& active, double tolerance, const RunContext& context);

 private:
  const ElementMargins* margins_of(std::size_t t) const { return has_wide_margins_[t] ? &k_wide_margins : &k_least_margins; }
  bool load(std::size_t t, const Vec3Field& y, LayerElement& e) const;
  FoldPoints fold_points(std::size_t fold, const Vec3Field& y) const;
  /// Returns the barrier of the fold; infinite if the fold is too sharp.
  double fold_energy(const Fold& shape, std::size_t fold) const;
  /// Returns the sum of the barriers of all folds.
  double sum_of_folds(const Vec3Field& y, const RunContext& context) const;
  /// Clamps y to the bounds.
  void clamp(std::size_t v, Vec3& y) const;
  struct VisitScratch;
  void colour_vertices();
  /// Makes the step of one vertex. Returns the length of the step in units of h_u.
  double visit(std::size_t i, Vec3Field& y, VisitScratch& scratch) const;
  /// Weight of one corner of one element in f_1 and f_3.
  double corner_weight() const { return 1.0 / (3.0 * static_cast<double>(std::max<std::size_t>(n_elements_, 1))); }
  ElementWeights element_weights() const { return {corner_weight() * weights_.top, corner_weight() * weights_.barrier}; }
  double vertex_weight() const { return n_counted_ > 0.0 ? 1.0 / n_counted_ : 1.0; }  ///< weight of a whole vertex in f_2
  /// Weight of half the squared slope along one edge. With six edges at each vertex, the sum is a mean over the vertices.
  double membrane_weight(std::size_t v, std::size_t other) const {
    return weights_.membrane * std::max(mirror_share_[v], mirror_share_[other]) * vertex_weight() / 6.0;
  }
  double normal_height(std::size_t v, const Vec3& y) const { return h_u_[v] * dot(y, normal_[v]); }  ///< m
  /// Weighted terms of f_4 for the edges at one vertex, as a function of the normal height of this vertex.
  struct Membrane {
    double energy = 0.0;
    double share = 0.0;  ///< fraction of the energy that is counted at this vertex, so that the sum over all moving vertices counts each edge once
    double slope = 0.0, curvature = 0.0;
  };
  Membrane membrane(std::size_t v, double height, const Vec3Field& y) const;
  double height_weight(std::size_t v) const { return weights_.height * mirror_share_[v] * vertex_weight(); }

  const LayerBase& base_;
  ObjectiveWeights weights_;
  double least_quality_;
  std::vector<double> h_u_, h_l_share_, least_length_;
  std::vector<std::uint8_t> is_moving_;
  std::size_t n_moving_ = 0, n_elements_ = 0;
  double n_counted_ = 0.0;        ///< number of moving vertices weighted by their mirror share: n_v of eq. (9)
  std::vector<Vec3> normal_;      ///< direction in which heights are measured at each vertex: the vertex normal within the constraint
  std::vector<Vec3> normal_sum_;  ///< sum of the unit normals of the incident triangles that are not collapsed
  std::vector<double> n_incident_;
  std::vector<double> mirror_share_;            ///< fraction of the full model's vertex that is in this model: 1, on a plane 1/2, on a line 1/4; used in f_2
  std::vector<std::uint8_t> is_element_;        ///< true for triangles without a collapsed corner, of which some corner moves
  std::vector<std::uint8_t> has_wide_margins_;  ///< true for triangles to which k_wide_margins apply
  LayerFolds folds_;
  std::vector<std::vector<std::uint32_t>> colours_;  ///< moving vertices by colour; vertices of a colour share no element
};

}  // namespace sterna::volmesh
