// Uses Green's theorem on the grid of the surface's knots. With any base line u = b, the integral of g over the face is that of (integral of g from b to u) dv
// along its border. Every piece of the border uses the knot line to its left as its base, so that its inner integral stays within one cell and is smooth. Where
// the base changes from one piece to the next, at v, the integral over the columns between both bases up to v is added. It is taken from a table of whole cells
// and one partial cell for each column. Steps: divide the border into pieces between crossings with the grid; make the table; sum over the pieces; sum over the
// changes of base; find the box of samples.
#include "geom/model/face_quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>

namespace sterna {
namespace {

/// Gauss-Legendre on [0, 1], exact to degree 11: x . (S_u x S_v) of a bicubic surface has degree 8 in each direction.
constexpr std::array<double, 6> k_nodes = {0.033765242898423975, 0.16939530676686776, 0.38069040695840156,
                                           0.61930959304159849,  0.83060469323313224, 0.96623475710157603};
constexpr std::array<double, 6> k_weights = {0.085662246189585178, 0.18038078652406929, 0.23395696728634552,
                                             0.23395696728634552,  0.18038078652406929, 0.085662246189585178};
/// Gauss-Legendre exact to degree 3, for a first estimate.
constexpr std::array<double, 2> k_few_nodes = {0.21132486540518713, 0.78867513459481287};
constexpr std::array<double, 2> k_few_weights = {0.5, 0.5};
/// Number of pieces of a direction without knots. With this number, sines and cosines over a full turn are integrated up to rounding.
constexpr int k_plain_pieces = 12;
/// Parts of an interval between knots if the pieces are not polynomials of degree 3 or less.
constexpr int k_parts = 3;
/// The number of parts is doubled until area and volume agree to this fraction, or the maximum number of refinements is reached. On smooth faces each
/// refinement reduces the error by a factor of 4000: agreement to 1e-8 means an error of 1e-11. Kinks that are not at knots converge slowly, and each
/// refinement costs four times the previous one.
constexpr double k_agreement = 1e-8;
constexpr int k_tries = 3;
/// Number of parts of a piece of border. Each part may cross a knot line once; further crossings only reduce accuracy.
constexpr int k_border_parts = 4;
/// Bisections in search of a crossing: enough for an accuracy of rounding.
constexpr int k_halvings = 50;

bool is_simple(int degree, const std::vector<double>& weights) { return degree <= 3 && weights.empty(); }

std::vector<double> distinct(std::vector<double> knots) {
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return knots;
}

std::vector<double> refined(const std::vector<double>& knots, int parts) {
  std::vector<double> fine;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (int k = 0; k < parts; ++k) fine.push_back(knots[i] + (knots[i + 1] - knots[i]) * k / parts);
  fine.push_back(knots.back());
  return fine;
}

/// Returns the grid lines in one direction, over the part that the face uses.
std::vector<double> grid_lines(std::vector<double> knots, bool has_knots, int parts, const Interval& domain, bool is_periodic, const Interval& used) {
  if (!has_knots) return refined({used.from, used.to}, parts / k_parts * k_plain_pieces);
  if (is_periodic && domain.length() > 0.0) {
    const double first = std::floor((used.from - domain.from) / domain.length()), last = std::ceil((used.to - domain.to) / domain.length());
    std::vector<double> all;
    for (double turn = first; turn <= last; ++turn)
      for (const double k : knots) all.push_back(k + turn * domain.length());
    knots = std::move(all);
  }
  std::erase_if(knots, [&](double k) { return !(k > used.from && k < used.to); });
  knots.push_back(used.from);
  knots.push_back(used.to);
  return refined(distinct(std::move(knots)), parts);
}

/// Returns the column or row of a parameter; beyond the grid the outermost one.
std::size_t cell_of(const std::vector<double>& lines, double at) {
  const auto above = static_cast<std::size_t>(std::upper_bound(lines.begin(), lines.end(), at) - lines.begin());
  return std::clamp<std::size_t>(above, 1, lines.size() - 1) - 1;
}

struct BorderPiece {
  const ParameterCurve* curve;
  double from, to;  ///< in the direction of the border
  Uv start, end;
  std::size_t column;
};

class FaceIntegral {
 public:
  FaceIntegral(const Model& model, FaceId face, const Point& about, int refinement, std::span<const double> nodes, std::span<const double> weights)
      : model_(model), face_(model.faces[face]), surface_(*face_.surface), about_(about), refinement_(refinement), nodes_(nodes), weights_(weights) {}

  FaceQuadrature run() {
    find_used_box();
    make_grid();
    for (const Border& border : face_.borders) add_border(border);
    add_inner_samples();
    return {total_, low_, high_};
  }

 private:
  FaceSums integrand(Uv at) const {
    const SurfaceDerivatives d = surface_.derivatives(at);
    const Vec3 n = cross(d.du, d.dv), x = d.point - about_;
    const double area = norm(n);
    return {area, dot(x, n) / 3.0, 0.5 * std::abs(n.z), n, area * x, 0.5 * Vec3{x.x * x.x * n.x, x.y * x.y * n.y, x.z * x.z * n.z}};
  }

  /// Returns the parameters at which an edge use is divided, within the range of the edge, because the parameter curve may extend beyond that range.
  std::vector<double> steps_of(const EdgeUse& use) const {
    const Interval range = model_.edges[use.edge].range;
    const std::optional<NurbsCurveForm<Uv>> form = use.parameter->exact_nurbs();
    if (!form) return refined({range.from, range.to}, refinement_ * k_plain_pieces);
    std::vector<double> knots = distinct(form->knots);
    std::erase_if(knots, [&](double k) { return !(k > range.from && k < range.to); });
    knots.insert(knots.begin(), range.from);
    knots.push_back(range.to);
    return refined(knots, refinement_ * (is_simple(form->degree, form->weights) ? 1 : k_parts));
  }

  void find_used_box() {
    used_ = {{k_far, -k_far}, {k_far, -k_far}};
    for (const Border& border : face_.borders)
      for (const EdgeUse& use : border)
        for (const double t : refined(steps_of(use), k_border_parts)) {
          const Uv p = use.parameter->point(t);
          used_ = {{std::min(used_.u.from, p.u), std::max(used_.u.to, p.u)}, {std::min(used_.v.from, p.v), std::max(used_.v.to, p.v)}};
        }
  }

  void make_grid() {
    const ParameterBox domain = surface_.domain();
    std::vector<double> knots_u = surface_.breaks_u(), knots_v = surface_.breaks_v();
    int parts_u = k_parts, parts_v = k_parts;
    const std::optional<NurbsSurfaceForm> form = surface_.exact_nurbs();
    if (form) {
      knots_u = form->knots_u;
      knots_v = form->knots_v;
      if (is_simple(form->degree_u, form->weights)) parts_u = 1;
      if (is_simple(form->degree_v, form->weights)) parts_v = 1;
    }
    u_ = grid_lines(knots_u, form || !knots_u.empty(), refinement_ * parts_u, domain.u, surface_.is_periodic_u(), used_.u);
    v_ = grid_lines(knots_v, form || !knots_v.empty(), refinement_ * parts_v, domain.v, surface_.is_periodic_v(), used_.v);
  }

  FaceSums over_box(double u0, double u1, double v0, double v1) const {
    FaceSums sum;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (std::size_t j = 0; j < nodes_.size(); ++j)
        sum.add(weights_[i] * weights_[j] * (u1 - u0) * (v1 - v0), integrand({u0 + nodes_[i] * (u1 - u0), v0 + nodes_[j] * (v1 - v0)}));
    return sum;
  }

  /// Returns the integral over a column from the first row to `v`.
  FaceSums column_up_to(std::size_t column, double v) {
    std::vector<FaceSums>& whole = columns_[column];
    if (whole.empty()) {
      whole.resize(v_.size());
      for (std::size_t j = 0; j + 1 < v_.size(); ++j) {
        whole[j + 1] = whole[j];
        whole[j + 1].add(1.0, over_box(u_[column], u_[column + 1], v_[j], v_[j + 1]));
      }
    }
    const std::size_t row = cell_of(v_, v);
    if (v == v_[row + 1]) return whole[row + 1];
    FaceSums sum = whole[row];
    if (v != v_[row]) sum.add(1.0, over_box(u_[column], u_[column + 1], v_[row], v));
    return sum;
  }

  /// Finds parameters between `from` and `to` where the curve crosses a line, by bisection; the curve is assumed monotone.
  template <class Coordinate>
  static void add_crossings(const std::vector<double>& lines, double from, double to, const Coordinate& coordinate, std::vector<double>& crossings) {
    const double a = coordinate(from), b = coordinate(to);
    for (auto line = std::upper_bound(lines.begin(), lines.end(), std::min(a, b)); line != lines.end() && *line < std::max(a, b); ++line) {
      double low = from, high = to;
      for (int k = 0; k < k_halvings; ++k) {
        const double middle = 0.5 * (low + high);
        ((coordinate(middle) < *line) == (a < b) ? low : high) = middle;
      }
      crossings.push_back(0.5 * (low + high));
    }
  }

  std::vector<BorderPiece> pieces_of(const EdgeUse& use) const {
    const ParameterCurve& curve = *use.parameter;
    const std::vector<double> steps = steps_of(use);
    std::vector<double> stops = steps;
    const std::vector<double> fine = refined(steps, k_border_parts);
    for (std::size_t i = 0; i + 1 < fine.size(); ++i) {
      add_crossings(
          u_, fine[i], fine[i + 1], [&](double t) { return curve.point(t).u; }, stops);
      add_crossings(
          v_, fine[i], fine[i + 1], [&](double t) { return curve.point(t).v; }, stops);
    }
    stops = distinct(std::move(stops));
    if (use.is_reversed) std::reverse(stops.begin(), stops.end());
    std::vector<BorderPiece> pieces;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i)
      pieces.push_back(
          {&curve, stops[i], stops[i + 1], curve.point(stops[i]), curve.point(stops[i + 1]), cell_of(u_, curve.point(0.5 * (stops[i] + stops[i + 1])).u)});
    return pieces;
  }

  void add_border(const Border& border) {
    std::vector<BorderPiece> pieces;
    for (const EdgeUse& use : border) {
      const std::vector<BorderPiece> more = pieces_of(use);
      pieces.insert(pieces.end(), more.begin(), more.end());
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      add_piece(pieces[i]);
      const BorderPiece& next = pieces[(i + 1) % pieces.size()];
      change_base(pieces[i].column, next.column, 0.5 * (pieces[i].end.v + next.start.v));
    }
    outlines_.push_back(std::move(pieces));
  }

  void add_piece(const BorderPiece& piece) {
    add_sample(piece.start);
    const double base = u_[piece.column], length = piece.to - piece.from;
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const ParameterCurveDerivatives p = piece.curve->derivatives(piece.from + nodes_[k] * length);
      const double weight = weights_[k] * length * p.first.v, width = p.point.u - base;
      if (weight == 0.0 || width == 0.0) continue;
      for (std::size_t i = 0; i < nodes_.size(); ++i) total_.add(weight * weights_[i] * width, integrand({base + nodes_[i] * width, p.point.v}));
    }
    add_sample(piece.curve->point(piece.from + 0.5 * length));
  }

  /// Adds the integral between two bases up to v: the previous pieces have the line of column `before` as base, the following ones that of column `after`.
  void change_base(std::size_t before, std::size_t after, double v) {
    for (std::size_t c = std::min(before, after); c < std::max(before, after); ++c) total_.add(before > after ? 1.0 : -1.0, column_up_to(c, v));
  }

  void add_sample(Uv at) {
    const Point p = surface_.point(at);
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
  }

  /// Adds the middles and corners of cells inside the border. In each row, these lie between odd and even crossings.
  void add_inner_samples() {
    const std::vector<double> us = refined(u_, 2), vs = refined(v_, 2);
    for (std::size_t j = 1; j + 1 < vs.size(); ++j) {
      std::vector<double> crossings;
      for (const std::vector<BorderPiece>& outline : outlines_)
        for (std::size_t i = 0; i < outline.size(); ++i) {
          const Uv a = outline[i].start, b = outline[(i + 1) % outline.size()].start;
          if ((a.v <= vs[j]) != (b.v <= vs[j])) crossings.push_back(a.u + (vs[j] - a.v) / (b.v - a.v) * (b.u - a.u));
        }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
        for (auto u = std::upper_bound(us.begin(), us.end(), crossings[i]); u != us.end() && *u < crossings[i + 1]; ++u) add_sample({*u, vs[j]});
    }
  }

  const Model& model_;
  const ModelFace& face_;
  const Surface& surface_;
  Point about_;
  int refinement_;
  std::span<const double> nodes_, weights_;  ///< nodes and weights of the quadrature in each direction
  ParameterBox used_;
  std::vector<double> u_, v_;
  std::map<std::size_t, std::vector<FaceSums>> columns_;
  std::vector<std::vector<BorderPiece>> outlines_;
  FaceSums total_;
  static constexpr double k_far = std::numeric_limits<double>::infinity();
  Point low_{k_far, k_far, k_far}, high_{-k_far, -k_far, -k_far};
};

}  // namespace

FaceQuadrature integrate_face_roughly(const Model& model, FaceId face, const Point& about) {
  return FaceIntegral(model, face, about, 1, k_few_nodes, k_few_weights).run();
}

FaceQuadrature integrate_face(const Model& model, FaceId face, const Point& about) {
  FaceQuadrature last = FaceIntegral(model, face, about, 1, k_nodes, k_weights).run();
  for (int k = 1; k < k_tries; ++k) {
    const FaceQuadrature next = FaceIntegral(model, face, about, 1 << k, k_nodes, k_weights).run();
    const double reach = std::max(distance(next.low, about), distance(next.high, about));
    const double change = std::max(std::abs(next.sums.area - last.sums.area), std::abs(next.sums.volume - last.sums.volume) / reach);
    last = next;
    last.error = change;
    if (change <= k_agreement * next.sums.area) break;
  }
  return last;
}

}  // namespace sterna
