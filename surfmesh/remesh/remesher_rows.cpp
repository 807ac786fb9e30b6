// Remesher: rows of stretched triangles along lines. The mesh is opened along the line. The opened border moves away from the line row by row, and the
// triangles in front of it make room by collapses into it, flips and moves. The gap between line and border is filled with the rows of the columns.
#include <algorithm>
#include <cmath>

#include "geom/math/measures.h"
#include "surfmesh/face/band_rows.h"
#include "surfmesh/model/wing_edges.h"
#include "surfmesh/remesh/remesher.h"

namespace sterna::surfmesh {
namespace {

/// Triangles in front of the border keep at least this mean ratio, or at least their previous one if that is less.
constexpr double k_border_floor = 0.25;
/// Largest number of steps for one row. Each step covers the remaining distance, or a half or a quarter of it. Then the triangles in front of the border make
/// room.
constexpr int k_border_steps = 16;
constexpr std::array<double, 3> k_border_shares = {1.0, 0.5, 0.25};
/// Fraction of a row's height. If the border cannot move by the whole height, the row is kept if the border moved by at least this fraction.
constexpr double k_least_part = 0.5;
/// Edges in front of the border that are shorter than this are collapsed, relative to the target length.
constexpr double k_short_before_border = 0.6;
constexpr double k_longest_at_border = 2.0;
/// Limits for triangles of rows: smallest cosine between their normal and the surface normal, and range of the edge length of a row relative to that on the
/// line.
constexpr double k_row_cosine = 0.5;
constexpr double k_row_narrowest = 0.45, k_row_widest = 2.2;
/// Target accuracy of the length of a step, and the largest accepted deviation, both relative to the step.
constexpr double k_row_tolerance = 1e-7, k_row_inexact = 0.05;
constexpr int k_row_iterations = 20;
/// Weight of the last step's direction in the direction of the next step. Through it the outer border becomes smoother than the line.
constexpr double k_straight_on = 0.5;

}  // namespace

/// The lines with rows while the mesh is opened along them.
struct Remesher::Opening {
  struct Cut {
    HalfedgeId halfedge;
    const SideRows* side;  ///< null if there are no rows on this side
  };
  /// Half-edges of the border that end and begin at a column's vertex.
  struct Border {
    HalfedgeId in, out;
  };
  std::vector<const LineRows*> rows_of;  ///< rows of each line; null if there are none
  std::vector<Cut> cuts;
  Column<HalfedgeId, const SideRows*> side_of;  ///< rows in front of each half-edge; null if there are none
  std::vector<VertexId> touched;                ///< vertices of the cuts, ascending
  std::vector<Border> borders;                  ///< border at each column

  const LineRows& rows(std::int32_t line) const { return *rows_of[static_cast<std::size_t>(line)]; }
};

/// Finds the half-edges and vertices of all lines with rows.
Remesher::Opening Remesher::find_cuts(std::span<const LineRows> rows) {
  Opening opening;
  opening.rows_of.resize(r_.lines.size(), nullptr);
  for (const LineRows& l : rows) opening.rows_of[static_cast<std::size_t>(l.line)] = &l;
  opening.side_of.resize(mesh_.twins.size(), nullptr);
  for (const HalfedgeId h : mesh_.twins.ids()) {
    const std::int32_t l = mesh_.line(h);
    if (mesh_.is_removed(triangle_of(h)) || l == k_no_line || opening.rows_of[static_cast<std::size_t>(l)] == nullptr) continue;
    const bool is_along = s_on_line(mesh_.from(h), l) < s_on_line(mesh_.to(h), l);
    const SideRows& side = opening.rows(l).sides[is_along ? 0 : 1];
    opening.cuts.push_back({h, side.is_any ? &side : nullptr});
    opening.side_of[h] = opening.cuts.back().side;
    opening.touched.push_back(mesh_.from(h));
  }
  std::sort(opening.touched.begin(), opening.touched.end());
  opening.touched.erase(std::unique(opening.touched.begin(), opening.touched.end()), opening.touched.end());
  return opening;
}

/// Separates the triangles on both sides of the cuts. Each vertex is replaced by one copy for each fan of triangles around it, and copies with rows on both
/// edges of their fan start a column.
void Remesher::cut_apart(Opening& opening) {
  std::vector<std::vector<HalfedgeId>> around;
  for (const VertexId v : opening.touched) {
    around.emplace_back();
    mesh_.for_out(v, [&](HalfedgeId h) { around.back().push_back(h); });
  }
  for (const Opening::Cut& cut : opening.cuts) {
    mesh_.twins[cut.halfedge] = {};
    locked_[static_cast<std::size_t>(mesh_.line(cut.halfedge))] = 1;
  }
  for (std::size_t i = 0; i < opening.touched.size(); ++i) {
    for (const HalfedgeId first : around[i])
      if (!mesh_.twins[first].is_valid()) copy_fan(opening.touched[i], first, opening);
    mesh_.outgoing[opening.touched[i]] = {};
  }
}

/// Gives a copy of a vertex to the fan of triangles that begins at the half-edge `first`.
void Remesher::copy_fan(VertexId v, HalfedgeId first, Opening& opening) {
  WorkVertex vertex = mesh_.vertices[v];
  vertex.is_fixed = true;
  const VertexId copy = mesh_.vertices.push_back(vertex);
  mesh_.outgoing.push_back(first);
  bool has_line = false;
  HalfedgeId in;
  for (HalfedgeId h = first; h.is_valid(); h = mesh_.twins[in]) {
    mesh_.triangles[triangle_of(h)][corner_of(h)] = copy;
    has_line = has_line || (h != first && mesh_.is_line(h));
    in = previous(h);
  }
  copies_.emplace_back(copy, v);
  if (opening.side_of[first] == nullptr || opening.side_of[in] == nullptr || has_line) return;
  opening.borders.push_back({in, first});
  LineColumn column;
  column.vertex = copy;
  column.side_rows = opening.side_of[first];
  columns_.push_back(column);
}

/// Sets the neighbours, the first row and the room of a column.
void Remesher::start_column(std::size_t number, const Column<VertexId, std::size_t>& column_of, const Opening& opening) {
  LineColumn& column = columns_[number];
  const Opening::Border& border = opening.borders[number];
  column.before = mesh_.from(border.in);
  column.after = mesh_.to(border.out);
  column.before_column = column_of[column.before];
  column.after_column = column_of[column.after];
  const Point& p = mesh_.at(column.vertex);
  column.spacing = 0.5 * (distance(p, mesh_.at(column.before)) + distance(p, mesh_.at(column.after)));
  // The vertex on the line needs the normal of this side. If both sides are in one smooth piece, the hints of triangles may be from the other side.
  const std::int32_t l = mesh_.line(border.out);
  const FeatureLine& line = r_.lines[static_cast<std::size_t>(l)];
  column.is_nose = opening.rows(l).is_nose;
  const double s_here = s_on_line(column.vertex, l);
  const std::size_t segment = r_.line_location(l, s_here).segment;
  HalfedgeId h = line.halfedges[segment];
  if ((r_.topology.from(h) == line.vertices[segment]) != (s_here < s_on_line(column.after, l))) h = r_.topology.twin(h);
  WorkVertex location = mesh_.vertices[column.vertex];
  location.location = r_.nearest(p, triangle_of(h));
  location.normal = r_.normal(location.location);
  column.rows.push_back(location);
  column.room = k_share_of_chord * width_across(r_, h, 1e3 * column.spacing);
}

/// Opens the mesh along the lines with rows. \pre there are no columns yet
void Remesher::open_lines(std::span<const LineRows> rows) {
  front_ = static_cast<std::int32_t>(r_.lines.size());
  locked_.resize(r_.lines.size() + 1, 0);
  locked_.back() = 1;
  Opening opening = find_cuts(rows);
  cut_apart(opening);
  Column<VertexId, std::size_t> column_of(mesh_.vertices.size(), k_no_column);
  for (std::size_t c = 0; c < columns_.size(); ++c) column_of[columns_[c].vertex] = c;
  for (std::size_t c = 0; c < columns_.size(); ++c) start_column(c, column_of, opening);
  for (const Opening::Cut& cut : opening.cuts) {
    if (cut.side == nullptr) continue;
    const VertexId a = mesh_.from(cut.halfedge), b = mesh_.to(cut.halfedge);
    row_edges_.push_back({a, b, column_of[a], column_of[b], mesh_.hint[triangle_of(cut.halfedge)]});
    mesh_.labels[cut.halfedge] = front_;
  }
}

const WorkVertex& Remesher::row_at(VertexId vertex, std::size_t column, std::size_t row) const {
  if (column == k_no_column) return mesh_.vertices[vertex];
  const LineColumn& c = columns_[column];
  return c.rows[std::min(row, c.n_rows())];
}

/// Returns the direction across the row below, blended with the last direction.
Vec3 Remesher::row_direction(const LineColumn& c, std::size_t row) const {
  const WorkVertex& top = c.rows[row - 1];
  const Vec3 along = row_at(c.after, c.after_column, row - 1).point - row_at(c.before, c.before_column, row - 1).point;
  Vec3 way = normalized(cross(top.normal, along));
  if (row > 1) {
    Vec3 on = c.way - dot(c.way, top.normal) * top.normal;
    way = normalized((1.0 - k_straight_on) * way + k_straight_on * normalized(on));
  }
  return way;
}

/// Tests the cells that a column's next row would form with its neighbours.
bool Remesher::is_step_good(const LineColumn& c, const WorkVertex& top, std::size_t row) const {
  const Point& below = c.rows[row - 1].point;
  const auto is_up = [&](const Point& p, const Point& q, const Point& r) {
    const Vec3 n = cross(q - p, r - p);
    return dot(n, top.normal) > k_row_cosine * norm(n);
  };
  for (const bool is_after : {false, true}) {
    const VertexId vertex = is_after ? c.after : c.before;
    const std::size_t column = is_after ? c.after_column : c.before_column;
    const std::size_t n = n_rows_of(column);
    if (n + 1 < row) return false;
    const Point& q = row_at(vertex, column, row - 1).point;
    if (!(is_after ? is_up(below, q, top.point) : is_up(q, below, top.point))) return false;
    if (n < row) continue;
    const Point& r = row_at(vertex, column, row).point;
    if (!(is_after ? is_up(below, q, r) && is_up(below, r, top.point) && is_up(q, r, top.point)
                   : is_up(q, below, r) && is_up(below, top.point, r) && is_up(q, top.point, r)))
      return false;
    const double wide = distance(top.point, r), on_line = distance(c.rows[0].point, row_at(vertex, column, 0).point);
    if (wide < k_row_narrowest * on_line || wide > k_row_widest * on_line) return false;
  }
  return true;
}

/// Moves a vertex if all adjacent triangles are then better than `floor`. \return true if it was moved
bool Remesher::place(VertexId v, const WorkVertex& where, double floor) {
  const WorkVertex kept = mesh_.vertices[v];
  WorkVertex moved = where;
  moved.is_fixed = true;
  mesh_.vertices[v] = moved;
  if (fan_quality_now(v, floor) > floor) {
    update_fan(v);
    return true;
  }
  mesh_.vertices[v] = kept;
  return false;
}

/// Merges the start vertex of h, which blocks the border, into the border vertex at its end.
bool Remesher::take_into(HalfedgeId h, double floor) {
  if (!is_collapse_legal(h) || !(collapse_quality(h, k_longest_at_border) > floor)) return false;
  const VertexId u = mesh_.to(h);
  mesh_.collapse(h);
  update_fan(u);
  return true;
}

/// Makes room in front of a border vertex in the direction of a point. \return true if the mesh was changed
bool Remesher::make_room(VertexId v, const Point& towards) {
  const Vec3 way = towards - mesh_.at(v);
  bool has_changed = false;
  // Vertices that block the border are merged into it, the nearest first.
  std::vector<std::pair<double, VertexId>> near;
  mesh_.for_out(v, [&](HalfedgeId h) {
    if (!mesh_.twins[h].is_valid() || !(dot(mesh_.at(mesh_.to(h)) - mesh_.at(v), way) > 0.0)) return;
    const double length = std::min(distance(mesh_.at(v), mesh_.at(mesh_.to(h))), distance(towards, mesh_.at(mesh_.to(h))));
    if (length < k_short_before_border * target_length(h)) near.emplace_back(length, mesh_.to(h));
  });
  std::sort(near.begin(), near.end());
  for (const auto& [length, w] : near) {
    HalfedgeId found;
    mesh_.for_out(v, [&](HalfedgeId h) {
      if (mesh_.to(h) == w && mesh_.twins[h].is_valid()) found = mesh_.twins[h];
    });
    if (found.is_valid() && take_into(found, std::min(k_border_floor, 0.5 * std::max(fan_quality(v), 0.0)))) has_changed = true;
  }
  std::vector<HalfedgeId> opposite;
  mesh_.for_out(v, [&](HalfedgeId h) { opposite.push_back(next(h)); });
  for (const HalfedgeId h : opposite)
    if (!mesh_.is_removed(triangle_of(h)) && try_flip(h, 1e-3)) has_changed = true;
  std::vector<VertexId> ring;
  mesh_.for_ring(v, [&](VertexId w) { ring.push_back(w); });
  for (const VertexId w : ring)
    if (mesh_.vertices[w].kind != VertexKind::corner && move(w, k_border_floor)) has_changed = true;
  return has_changed;
}

/// Moves the border's vertex to its next row, or by a part of the distance. \return true if the row was made
bool Remesher::advance(LineColumn& c, const WorkVertex& target, double height) {
  const VertexId v = c.vertex;
  const WorkVertex start = mesh_.vertices[v];
  const double before = fan_quality(v);
  const std::size_t row = c.rows.size();
  bool is_there = false;
  for (int i = 0; i < k_border_steps && !is_there; ++i) {
    bool has_moved = false;
    for (const double share : k_border_shares) {
      WorkVertex next = target;
      if (share < 1.0) {
        const WorkVertex& here = mesh_.vertices[v];
        put_on_face(next, here.point + share * (target.point - here.point),
                    here.kind == VertexKind::face ? here.location.triangle : c.rows[0].location.triangle);
      }
      if (!place(v, next, std::min(k_border_floor, 0.9 * fan_quality(v)))) continue;
      has_moved = true;
      is_there = share == 1.0;
      break;
    }
    if (is_there) break;
    if (!make_room(v, target.point) && !has_moved) break;
  }
  const double done = distance(mesh_.at(v), start.point);
  const bool is_row = is_there || (done > k_least_part * height && is_step_good(c, mesh_.vertices[v], row));
  if (!is_row) {
    for (int i = 0; i < k_border_steps && !place(v, start, std::min(0.0, before - 1e-9)); ++i) make_room(v, start.point);
    // If the vertex cannot be moved back, the row stays lower.
    if (mesh_.vertices[v].point == start.point) return false;
  }
  c.way = normalized(mesh_.at(v) - start.point);
  c.heights.push_back(distance(mesh_.at(v), start.point));
  c.climbed += c.heights.back();
  c.rows.push_back(mesh_.vertices[v]);
  return is_there;
}

bool Remesher::grow_column(LineColumn& c, std::size_t row) {
  if (n_rows_of(c.before_column) + 1 < row || n_rows_of(c.after_column) + 1 < row) return false;
  const WorkVertex top = c.rows.back();
  const Vec3 way = row_direction(c, row);
  double height = row == 1 ? c.side_rows->first : c.side_rows->growth * c.heights.back();
  const auto step = [&](double length, WorkVertex& to) {
    double reach = length, done = 0.0;
    for (int i = 0; i < k_row_iterations; ++i) {
      put_on_face(to, top.point + reach * way, top.location.triangle);
      done = distance(to.point, top.point);
      if (!(done > 0.1 * length)) return false;
      if (std::abs(done - length) <= k_row_tolerance * length) break;
      reach *= std::clamp(length / done, 0.5, 2.0);
    }
    return std::abs(done - length) <= k_row_inexact * length && dot(to.point - top.point, way) > 0.5 * done;
  };
  WorkVertex target;
  if (!step(height, target)) return false;
  // The curvature angle limits the turn of the surface across a row. It does not reduce the height of the row below min_edge.
  if (const double turn = angle_between(top.normal, target.normal); turn > c.side_rows->curvature_angle) {
    const double lower = std::max(height * c.side_rows->curvature_angle / turn, std::min(height, c.side_rows->min_edge));
    if (lower < height) {
      height = lower;
      if (!step(height, target)) return false;
    }
  }
  const double wide =
      0.5 * (distance(row_at(c.before, c.before_column, row - 1).point, top.point) + distance(row_at(c.after, c.after_column, row - 1).point, top.point));
  if (height > k_isotropic_height * std::min(c.spacing, wide) || c.climbed + height > c.room || row > k_max_rows) return false;
  if (!is_step_good(c, target, row)) return false;
  target.size = std::min(target.size, c.spacing);
  return advance(c, target, height);
}

void Remesher::grow_rows(std::span<const LineRows> rows) {
  if (rows.empty()) return;
  open_lines(rows);
  for (std::size_t row = 1; row <= k_max_rows; ++row) {
    bool is_any = false;
    for (LineColumn& c : columns_) {
      if (!c.is_growing || c.n_rows() + 1 != row) continue;
      c.is_growing = grow_column(c, row);
      is_any = is_any || c.is_growing;
    }
    context_.check_stop();
    if (!is_any) break;
  }
}

std::vector<Remesher::RowCell> Remesher::row_cells() const {
  std::vector<RowCell> cells;
  for (std::uint32_t e = 0; e < row_edges_.size(); ++e) {
    const RowEdge& edge = row_edges_[e];
    const auto na = static_cast<std::uint32_t>(n_rows_of(edge.a_column)), nb = static_cast<std::uint32_t>(n_rows_of(edge.b_column));
    const auto point = [&](std::size_t side, std::size_t row) -> const Point& {
      return side == 0 ? row_at(edge.a, edge.a_column, row).point : row_at(edge.b, edge.b_column, row).point;
    };
    for (std::uint32_t k = 1; k <= std::min(na, nb); ++k) {
      if (is_first_diagonal(point(0, k - 1), point(1, k - 1), point(1, k), point(0, k), (e + k) % 2 == 0)) {
        cells.push_back({e, {{{0, k - 1}, {1, k - 1}, {1, k}}}});
        cells.push_back({e, {{{0, k - 1}, {1, k}, {0, k}}}});
      } else {
        cells.push_back({e, {{{0, k - 1}, {1, k - 1}, {0, k}}}});
        cells.push_back({e, {{{1, k - 1}, {1, k}, {0, k}}}});
      }
    }
    if (na > nb) cells.push_back({e, {{{0, nb}, {1, nb}, {0, na}}}});
    if (nb > na) cells.push_back({e, {{{0, na}, {1, na}, {1, nb}}}});
  }
  return cells;
}

std::vector<SizePoint> Remesher::row_ends() const {
  std::vector<SizePoint> ends;
  for (const LineColumn& c : columns_) ends.push_back({c.rows.back().point, c.spacing});
  return ends;
}

std::vector<RowReach> Remesher::nose_reaches() const {
  std::vector<RowReach> reaches;
  for (const LineColumn& c : columns_)
    if (c.is_nose) reaches.push_back({c.rows.front().point, c.climbed});
  return reaches;
}

RowReport Remesher::row_report() const {
  RowReport report;
  for (const LineColumn& c : columns_) {
    ++(c.n_rows() > 0 ? report.n_columns : report.n_without);
    for (std::size_t k = 0; k < c.heights.size(); ++k) {
      report.max_stretch = std::max(report.max_stretch, c.spacing / c.heights[k]);
      if (k > 0) report.max_growth = std::max({report.max_growth, c.heights[k] / c.heights[k - 1], c.heights[k - 1] / c.heights[k]});
    }
  }
  report.n_triangles = static_cast<std::int64_t>(row_cells().size());
  return report;
}

}  // namespace sterna::surfmesh
