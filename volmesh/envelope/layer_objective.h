// What our optimiser minimises: the paper's f_1 + f_2, optionally the same orthogonality at the envelope (f_3), and a barrier on every way in which a
// macro-element can become invalid (docs/method/optimisation.md, "Own objective"; [ET15 §3.2.6]; barrier on the Jacobian: Garanzha et al. 2021).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/layer_element.h"
#include "volmesh/envelope/layer_folds.h"
#include "volmesh/envelope/lbfgs.h"

namespace sterna::volmesh {

struct ObjectiveWeights {
  double height = 1.0;    ///< of f_2 against f_1
  double top = 0.0;       ///< of f_3 against f_1
  double membrane = 0.0;  ///< of f_4 against f_1
  double barrier = 0.02;  ///< of the barrier, sum over its terms and elements, against f_1
};

/// Parts of the objective at one point.
struct ObjectiveValue {
  double f1 = 0.0;  ///< eq. (8), over the moving vertices
  double f2 = 0.0;  ///< eq. (9)
  double f3 = 0.0;  ///< eq. (8) with the envelope's normals
  double f4 = 0.0;  ///< membrane: mean over the vertices of half the squared slope of the normal height along their edges, weighted
  double barrier = 0.0;
  double total = 0.0;  ///< weighted sum
};

/// The unknowns are the growth vectors of all vertices over their upper heights, y = (envelope point - wall point) / h_u: one Vec3 each, of which the
/// vertex's constraint leaves 3, 2 or 1 components.
class LayerObjective {
 public:
  /// h_u: upper bound of the normal component of the growth vector, m; h_l: lower bound. Vertices that are collapsed or whose bounds nearly meet do not move.
  /// \pre every macro-element of `start` is valid, unless the weights of f_3 and barrier are zero. `base` must outlive this.
  /// No element may get a scaled Jacobian below `least_quality`. `floor` (may be empty): lengths in metres below which
  /// growth vectors that start longer do not go.
  LayerObjective(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double least_quality,
                 const ObjectiveWeights& weights, const RunContext& context, const Column<VertexId, double>& floor = {});

  std::size_t size() const { return h_u_.size(); }
  bool is_moving(std::size_t v) const { return is_moving_[v] != 0; }
  double upper(std::size_t v) const { return h_u_[v]; }  ///< h_u, m
  std::size_t n_moving() const { return n_moving_; }
  Vec3Field unknowns(const Envelope& envelope) const;
  /// Writes directions and heights of the moving vertices.
  void store(const Vec3Field& y, Envelope& envelope) const;
  /// What minimises f_1 + f_2 when macro-elements are left aside: every vertex for itself.
  Vec3Field separable_optimum(const Vec3Field& y, const RunContext& context) const;

  /// \pre every element feasible, unless the weights of f_3 and barrier are zero: then elements are not looked at. gradient: with respect to y, within the
  /// constraints; null: value only.
  ObjectiveValue evaluate(const Vec3Field& y, Vec3Field* gradient, const RunContext& context);
  /// One pass over the vertices of `active`, colour by colour: each goes to the minimum of its local quadratic model, as far as the objective falls and all its
  /// elements stay feasible. Afterwards `active` marks what should be visited again. The total falls monotonically. Returns the number of visits.
  std::size_t descend(Vec3Field& y, std::vector<std::uint8_t>& active, double tolerance, const RunContext& context);
  /// Gradient without what points out of the bounds that y lies on.
  void free_part(const Vec3Field& y, Vec3Field& gradient, const RunContext& context) const;
  /// y into the bounds.
  void clamp(std::size_t v, Vec3& y) const;

  /// Distance of every element, then of every fold from infeasibility (0), in the units of the barrier's terms.
  void slacks(const Vec3Field& y, std::vector<float>& slack, const RunContext& context) const;
  /// Draws vertices of `to` back towards `from`, until every element keeps at least `keep` of its slack in `from` (or is far from the barrier). Returns how
  /// many vertices were drawn back.
  std::size_t hold_back(const Vec3Field& from, const std::vector<float>& slack_from, double keep, Vec3Field& to, const RunContext& context) const;

 private:
  const ElementMargins* margins_of(std::size_t t) const { return has_wide_margins_[t] ? &k_wide_margins : &k_least_margins; }
  bool load(std::size_t t, const Vec3Field& y, LayerElement& e) const;
  FoldPoints fold_points(std::size_t fold, const Vec3Field& y) const;
  /// Barrier of the fold; infinite where it is too sharp.
  double fold_energy(const Fold& shape, std::size_t fold) const;
  double add_folds(const Vec3Field& y, bool with_gradient, const RunContext& context);
  struct VisitScratch;
  void colour_vertices();
  /// The step of one vertex; returns how far it went, in units of h_u.
  double visit(std::size_t i, Vec3Field& y, VisitScratch& scratch) const;
  /// Of one corner of one element in f_1 and f_3.
  double corner_weight() const { return 1.0 / (3.0 * static_cast<double>(std::max<std::size_t>(n_elements_, 1))); }
  ElementWeights element_weights() const { return {corner_weight() * weights_.top, corner_weight() * weights_.barrier}; }
  double vertex_weight() const { return n_counted_ > 0.0 ? 1.0 / n_counted_ : 1.0; }  ///< of a whole vertex in f_2
  /// Of half the squared slope along one edge, so that six edges at each vertex make a mean over the vertices.
  double membrane_weight(std::size_t v, std::size_t other) const {
    return weights_.membrane * std::max(mirror_share_[v], mirror_share_[other]) * vertex_weight() / 6.0;
  }
  double normal_height(std::size_t v, const Vec3& y) const { return h_u_[v] * dot(y, normal_[v]); }  ///< m
  /// f_4's terms of the edges at one vertex, weighted, as a function of its normal height.
  struct Membrane {
    double energy = 0.0;
    double share = 0.0;  ///< of the energy, so that the sum over all moving vertices has each edge once
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
  double n_counted_ = 0.0;        ///< moving vertices by their mirror share: n_v of (9)
  std::vector<Vec3> normal_;      ///< direction in which heights are measured: the vertex normal within the constraint
  std::vector<Vec3> normal_sum_;  ///< sum of the unit normals of the standing incident triangles
  std::vector<double> n_incident_;
  std::vector<double> mirror_share_;            ///< of the whole body's vertex that is here: 1, 1/2 on a plane, 1/4 on a line; counts in f_2
  std::vector<std::uint8_t> is_element_;        ///< no collapsed corner, some corner moves
  std::vector<std::uint8_t> has_wide_margins_;  ///< likewise per triangle
  LayerFolds folds_;
  std::vector<Vec3> fold_gradient_;    ///< 4 per fold, scratch of evaluate()
  std::vector<Vec3> corner_gradient_;  ///< 3 per element, scratch of evaluate()
  std::vector<std::uint8_t> has_gradient_;
  std::vector<std::vector<std::uint32_t>> colours_;  ///< moving vertices that share no element with others of their colour
};

}  // namespace sterna::volmesh
