// Optimisation problem (3)-(9) of the paper for one envelope, with analytic gradients (docs/method/optimisation.md, "Optimisation problem"; [ET15 §3.2.6]). It
// does not depend on the solver.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// The objective (3) in the units of the paper, which are means over elements and vertices.
struct PaperObjective {
  double f1 = 0.0;  ///< eq. (8), orthogonality
  double f2 = 0.0;  ///< eq. (9), heights
  double total() const { return f1 + f2; }
};

/// The constraint (5), as sums over violations.
struct PaperConstraint {
  double g1 = 0.0;              ///< sum of positive g_1 of eq. (6)
  double g2 = 0.0;              ///< sum of positive g_2 of eq. (7)
  std::int64_t n_violated = 0;  ///< number of violations; those of g_1 and of g_2 are counted separately
  double total() const { return g1 + g2; }
};

struct PaperBounds {
  std::vector<double> lower, upper;  ///< bounds z_l and z_u of eq. (4)
};

/// Optimisation problem of the paper. Each vertex that participates has tangential unknowns (2 if it is free, 1 in a plane or surface, 0 on a line) and its
/// height. Vertices are sorted by id, and the tangential unknowns of a vertex come first. x_j = p_j + h_u (u t_1 + v t_2 + h n), where n is the vertex normal
/// within the constraint. Unknowns are in units of the vertex's h_u, so that they are of order one for any edge length. ((8) and (9) depend only on such
/// ratios.)
///
/// Some vertices do not participate: those that are collapsed or fixed, those beside a collapsed vertex (pyramids and tetrahedra stay unchanged), and those
/// whose bounds nearly coincide (h_u < 1.05 h_l). They are excluded from the sums. f_1 is the sum over the corners of vertices that participate, and n_c is the
/// number of prisms with such a corner.
///
/// f_1 of a vertex is n - u . N, where n is the number of its triangles, N the sum of their normals and u the direction of its growth edge. Therefore no pass
/// over the elements is necessary.
class PaperProblem {
 public:
  /// \p h_u upper bound of the heights along the vertex normals, m, increased to the start's height if that is larger. \p h_l lower bound max(h0, h_min), m. \p
  /// g1_min g_1,min of eq. (6): fraction of the wall triangle's area that the envelope triangle keeps in projection on the wall.
  PaperProblem(Borrowed<const LayerBase> base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double g1_min,
               const RunContext& context);

  std::size_t n_unknowns() const { return n_unknowns_; }
  std::size_t n_vertices() const { return vertices_.size(); }  ///< n_v of eq. (9)
  std::size_t n_elements() const { return elements_.size(); }  ///< n_c of eq. (8)
  bool takes_part(VertexId v) const { return vertex2location_[v] != k_none; }

  /// Returns the bounds. Heights are within [h_l, h_u]; if the start's height is below h_l, it is the lower bound. Tangential unknowns are within a cone that
  /// contains the start.
  const PaperBounds& bounds() const { return bounds_; }

  /// Returns the unknowns of any envelope over the same wall. Components outside the constraints are dropped. The unknowns are not clamped to the bounds.
  std::vector<double> unknowns(const Envelope& envelope) const;
  /// Writes direction and height (length of the growth edge) of the vertices that participate. On a curved surface the point is projected back onto the
  /// surface.
  void store(std::span<const double> z, Envelope& envelope, const RunContext& context) const;
  /// Returns the unknowns of one vertex; empty if it does not participate.
  std::span<double> unknowns_of(VertexId v, std::span<double> z) const;

  /// Returns the objective. \pre z.size() == n_unknowns(). The gradient has the same size, or is empty if only the value is needed. It is overwritten with
  /// d(f_1 + f_2)/dz. \cost one pass over the vertices
  PaperObjective objective(std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  /// Returns the constraint. The arguments are those of objective(). g_2 contains a minimum over the edges; its gradient is that of the edge that attains the
  /// minimum (the first one if several do). g_2 is in units of h_u. \cost one pass over the elements. Two threads must not call this function at the same time.
  PaperConstraint constraint(std::span<const double> z, std::span<double> gradient, const RunContext& context) const;

  /// Shortens growth edges to `factor` of their length, but to heights not below z_l. Shortened are the growth edges of vertices that can repair a violated
  /// element. Returns the number of growth edges shortened.
  std::size_t shrink_violated(std::span<double> z, double factor, const RunContext& context) const;

  /// Selects one of the four sums, for tests and reports.
  enum class Part { f1, f2, g1, g2 };
  double part(Part part, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;

 private:
  /// A vertex that participates.
  struct Location {
    VertexId vertex;
    std::uint32_t first = 0;  ///< number of its first unknown
    std::uint8_t n_tangents = 0;
    double n_triangles = 0.0;
    double h_u = 0.0;          ///< m
    std::array<Vec3, 3> axis;  ///< unit vectors: t_1 and t_2 (n_tangents of them), then n
    Vec3 normal_sum;           ///< sum of the unit normals of its triangles
  };
  struct Weights {
    double first, second;  ///< weights of f_1 and f_2, or weights of g_1 and g_2
  };
  struct Violated;

  /// Returns the growth edge divided by h_u.
  static Vec3 growth(const Location& location, std::span<const double> z);
  static void add_gradient(const Location& location, const Vec3& d, std::span<double> gradient);
  PaperObjective objective(const Weights& weights, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  PaperConstraint constraint(const Weights& weights, std::span<const double> z, std::span<double> gradient, const RunContext& context) const;
  void add_location(VertexId v, double h_u, double h_l);

  const LayerBase& base_;
  double g1_min_;
  std::size_t n_unknowns_ = 0;
  std::vector<Location> vertices_;
  Column<VertexId, std::uint32_t> vertex2location_;
  std::vector<TriangleId> elements_;
  PaperBounds bounds_;
  Column<VertexId, double> upper_;         ///< m, h_u of every vertex that is not collapsed
  mutable Column<VertexId, Vec3> growth_;  ///< m; scratch memory of constraint(), constant at vertices that do not participate
};

}  // namespace sterna::volmesh
