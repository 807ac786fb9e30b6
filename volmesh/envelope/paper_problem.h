// Optimisation problem (3)-(9) of the paper for one envelope, with analytic gradients (docs/method/optimisation.md, "Optimisation problem"; [ET15 §3.2.6]).
// Independent of any solver.
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

/// The constraint (5): sums over violations.
struct PaperConstraint {
  double g1 = 0.0;              ///< sum of positive g_1 of eq. (6)
  double g2 = 0.0;              ///< sum of positive g_2 of eq. (7)
  std::int64_t n_violated = 0;  ///< violations of g_1 and of g_2 are counted separately
  double total() const { return g1 + g2; }
};

struct PaperBounds {
  std::vector<double> lower, upper;  ///< z_l and z_u of eq. (4)
};

/// Optimisation problem of the paper. Unknowns: for each vertex that participates, by ascending id, its tangential unknowns (2 free, 1 in a plane or surface,
/// 0 on a line), then its height: x_j = p_j + h_u (u t_1 + v t_2 + h n), n = vertex normal within the constraint. They are in units of the vertex's h_u, so
/// that every unknown is of order one for any edge length ((8) and (9) depend on such ratios only).
///
/// A vertex participates unless it is collapsed, fixed, beside a collapsed vertex (pyramids and tets stay unchanged), or its bounds nearly coincide (h_u <
/// 1.05 h_l). All other vertices are excluded from the sums: f_1 is over the corners of vertices that participate, n_c are the prisms with such a corner.
///
/// f_1 of a vertex is n - u . N, with n the number of its triangles, N the sum of their normals and u the direction of its growth edge: no pass over elements
/// is necessary.
class PaperProblem {
 public:
  /// h_u: upper bound of the heights along the vertex normals, m, raised to the start's height where that is larger; h_l: lower bound, m, max(h0, h_min).
  /// g1_min of eq. (6): share of the wall triangle's area that the envelope triangle keeps, projected on the wall. `base` must outlive this.
  PaperProblem(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double g1_min, const RunContext& context);

  std::size_t n_unknowns() const { return n_unknowns_; }
  std::size_t n_vertices() const { return vertices_.size(); }  ///< n_v of eq. (9)
  std::size_t n_elements() const { return elements_.size(); }  ///< n_c of eq. (8)
  bool takes_part(VertexId v) const { return vertex2place_[v] != k_none; }

  /// Returns the bounds: heights within [h_l, h_u] (the start's height where it is below h_l), tangential unknowns within a cone that contains the start.
  const PaperBounds& bounds() const { return bounds_; }

  /// Returns the unknowns of any envelope with the same wall; components outside the constraints are dropped. Not clamped to the bounds.
  std::vector<double> unknowns(const Envelope& envelope) const;
  /// Writes direction and height (length of the growth edge) of the vertices that participate; on a curved surface the point is projected back onto it.
  void store(std::span<const double> z, Envelope& envelope, const RunContext& context) const;
  /// Returns the unknowns of one vertex; empty if it does not participate.
  std::span<double> unknowns_of(VertexId v, std::span<double> z) const;

  /// Returns the objective. \pre z.size() == n_unknowns(); gradient empty (value alone) or of that size: overwritten with d(f_1 + f_2)/dz. \cost one pass
  /// over the vertices
  PaperObjective objective(std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  /// Returns the constraint, with arguments as in objective(). The gradient of g_2's minimum over the edges is that of the edge that attains the minimum (the
  /// first of equal edges). g_2 is in units of h_u. \cost one pass over the elements. Not to be called from two threads at once.
  PaperConstraint constraint(std::span<const double> z, std::span<double> gradient, const RunContext& context) const;

  /// Shortens to `factor` of their length the growth edges of the vertices that can repair a violated element, to heights not below z_l. Returns the number
  /// of growth edges shortened.
  std::size_t shrink_violated(std::span<double> z, double factor, const RunContext& context) const;

  /// Separate parts for tests and reports: selects one of the four sums.
  enum class Part { f1, f2, g1, g2 };
  double part(Part part, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;

 private:
  static constexpr std::uint32_t k_none = 0xffffffffu;
  /// A vertex that participates.
  struct Place {
    VertexId vertex;
    std::uint32_t first = 0;  ///< index of its first unknown
    std::uint8_t n_tangents = 0;
    double n_triangles = 0.0;
    double h_u = 0.0;          ///< m
    std::array<Vec3, 3> axis;  ///< t_1, t_2 (as many as n_tangents), then n: unit
    Vec3 normal_sum;           ///< sum of the unit normals of its triangles
  };
  struct Weights {
    double first, second;  ///< weights of f_1 and f_2, or of g_1 and g_2
  };
  struct Violated;

  /// Returns the growth edge over h_u.
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
  mutable Column<VertexId, Vec3> growth_;  ///< m; scratch of constraint(), constant at vertices that do not participate
};

}  // namespace sterna::volmesh
