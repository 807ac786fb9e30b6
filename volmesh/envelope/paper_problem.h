// The paper's optimisation problem (3)-(9) over one envelope, with analytic gradients (docs/method/optimisation.md, "Optimisation problem"; [ET15 §3.2.6]).
// Knows nothing of solvers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// The objective (3), in the units of the paper: means over elements and vertices.
struct PaperObjective {
  double f1 = 0.0;  ///< eq. (8), orthogonality
  double f2 = 0.0;  ///< eq. (9), heights
  double total() const { return f1 + f2; }
};

/// The constraint (5): sums over what is violated.
struct PaperConstraint {
  double g1 = 0.0;              ///< sum of positive g_1 of eq. (6)
  double g2 = 0.0;              ///< sum of positive g_2 of eq. (7)
  std::int64_t n_violated = 0;  ///< g_1 and g_2 counted apart
  double total() const { return g1 + g2; }
};

struct PaperBounds {
  std::vector<double> lower, upper;  ///< z_l and z_u of eq. (4)
};

/// Unknowns: for each vertex that takes part, by ascending id, its tangential unknowns (2 free, 1 in a plane or surface, 0 on a line), then its height:
/// x_j = p_j + h_u (u t_1 + v t_2 + h n), n = vertex normal within the constraint. They are in units of the vertex's h_u, so that every one is of order one
/// whatever the size of its edges ((8) and (9) depend on such ratios only).
///
/// A vertex takes part unless it is collapsed, fixed, beside a collapsed one (pyramids and tets stay as they are), or its bounds nearly meet
/// (h_u < 1.05 h_l). The others leave the sums: f_1 is over the corners of vertices that take part, n_c are the prisms with such a corner.
///
/// f_1 of a vertex is n - u . N, with n its number of triangles, N the sum of their normals and u its growth edge's direction: no pass over elements.
class PaperProblem {
 public:
  /// h_u: upper bound of the heights along the vertex normals, m, raised to the start's height where that is larger; h_l: lower bound, m, max(h0, h_min).
  /// g1_min of eq. (6): share of the wall triangle's area that the envelope triangle keeps, projected on the wall. `base` must outlive this.
  PaperProblem(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double g1_min, const RunContext& context);

  std::size_t n_unknowns() const { return n_unknowns_; }
  std::size_t n_vertices() const { return vertices_.size(); }  ///< n_v of eq. (9)
  std::size_t n_elements() const { return elements_.size(); }  ///< n_c of eq. (8)
  bool takes_part(VertexId v) const { return vertex2place_[v] != k_none; }

  /// Heights within [h_l, h_u] (the start's height where it is below h_l), tangential unknowns within a cone that holds the start.
  const PaperBounds& bounds() const { return bounds_; }

  /// Unknowns of an envelope: any with the same wall; what of it lies outside the constraints is dropped. Not clamped to the bounds.
  std::vector<double> unknowns(const Envelope& envelope) const;
  /// Writes direction and height (length of the growth edge) of the vertices that take part; on a curved surface the point is put back on it.
  void store(std::span<const double> z, Envelope& envelope, const RunContext& context) const;
  /// The unknowns of one vertex; empty when it does not take part.
  std::span<double> unknowns_of(VertexId v, std::span<double> z) const;

  /// \pre z.size() == n_unknowns(); gradient empty (value alone) or of that size: overwritten with d(f_1 + f_2)/dz. \cost one pass over the vertices
  PaperObjective objective(std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  /// As objective(); the gradient of g_2's minimum over the edges is that of the edge that attains it (the first of equal ones). g_2 is in units of h_u.
  /// \cost one pass over the elements. Not to be called from two threads at once.
  PaperConstraint constraint(std::span<const double> z, std::span<double> gradient, const RunContext& context) const;

  /// Shortens the growth edges of the vertices that could mend a violated element to `factor` of their length, heights not below z_l.
  /// Returns how many were shortened.
  std::size_t shrink_violated(std::span<double> z, double factor, const RunContext& context) const;

  /// Parts alone, for tests and reports: which of the four sums a gradient is of.
  enum class Part { f1, f2, g1, g2 };
  double part(Part part, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;

 private:
  static constexpr std::uint32_t k_none = 0xffffffffu;
  /// A vertex that takes part.
  struct Place {
    VertexId vertex;
    std::uint32_t first = 0;  ///< unknown
    std::uint8_t n_tangents = 0;
    double n_triangles = 0.0;
    double h_u = 0.0;          ///< m
    std::array<Vec3, 3> axis;  ///< t_1, t_2 (as many as n_tangents), then n: unit
    Vec3 normal_sum;           ///< of its triangles' unit normals
  };
  struct Weights {
    double first, second;  ///< of f_1 against f_2, g_1 against g_2
  };
  struct Violated;

  /// Growth edge over h_u.
  static Vec3 growth(const Place& place, std::span<const double> z);
  static void add_gradient(const Place& place, const Vec3& d, std::span<double> gradient);
  PaperObjective objective(const Weights& weights, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  PaperConstraint constraint(const Weights& weights, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  void add_place(VertexId v, double h_u, double h_l);

  const LayerBase& base_;
  double g1_min_;
  std::size_t n_unknowns_ = 0;
  std::vector<Place> vertices_;
  Column<VertexId, std::uint32_t> vertex2place_;
  std::vector<TriangleId> elements_;
  PaperBounds bounds_;
  Column<VertexId, double> upper_;         ///< m, h_u of every vertex that is not collapsed
  mutable Column<VertexId, Vec3> growth_;  ///< m; scratch of constraint(), constant where a vertex does not take part
};

}  // namespace sterna::volmesh
