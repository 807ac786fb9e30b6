// Local operations on the new surface. They bring edges to their target length, triangles to an equilateral shape, and vertices onto the reference.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "surfmesh/remesh/line_rows.h"
#include "surfmesh/remesh/remesh_sizes.h"
#include "surfmesh/remesh/row_sizes.h"
#include "surfmesh/remesh/work_mesh.h"

namespace sterna::surfmesh {

/// Remeshes by local operations. Passes are serial in a fixed order; only smoothing is parallel, one colour at a time. The result therefore does not depend on
/// the number of threads.
class Remesher {
 public:
  /// Starts with the reference's own triangles.
  Remesher(Borrowed<const Reference> reference, Borrowed<const RemeshSizes> sizes, const RunContext& context);

  /// Collapses edges shorter than `least` times the target length, shortest first. Returns the number of collapses. In the first call triangles may be inverted
  /// against the reference if some of those before were inverted, because sliver triangles of the input often are.
  std::int64_t collapse_short(double least, bool is_first);
  /// Halves edges longer than `most` times the target, longest first, until none is left or `max_triangles` is reached. Without that limit very thin baffles
  /// would be split without end.
  std::int64_t split_long(double most, std::int64_t max_triangles);
  std::int64_t n_triangles() const;
  /// Returns the middle and length (m) of the shortest edge that is still to be halved; the first vertex and 0 if there is none.
  std::pair<Point, double> shortest_to_halve(double most) const;
  /// Flips edges if the worse of the two triangles becomes better.
  std::int64_t flip_edges();
  /// Flips edges if the numbers of neighbours come closer to six (four beside a straight line) and the triangles remain good.
  std::int64_t regularise();
  /// Moves vertices towards the centre of their surroundings, weighted by sizes, provided that the worst adjacent triangle does not get worse or stays better
  /// than `floor`.
  void smooth(int rounds, double floor = 0.6);
  /// Improves triangles whose mean ratio is below `quality`. Collapses, flips or halves their edges, or moves their vertices, if the worst nearby triangle then
  /// improves.
  std::int64_t improve(double quality);
  /// Renumbers vertices and triangles so that neighbours in space are neighbours in memory.
  void renumber();
  /// Updates target lengths from the size field.
  void refresh_sizes();

  /// Grows rows of stretched triangles. The mesh is opened along the lines. On each side with rows, the opened border moves away from the line row by row,
  /// while the triangles in front of it make room. The row triangles themselves are made by result(). Lines with rows and the moved border do not change
  /// afterwards. \pre no rows have grown yet
  void grow_rows(std::span<const LineRows> rows);
  /// Returns the outer ends of rows with the edge lengths there. Sizes have to increase from these values.
  std::vector<SizePoint> row_ends() const;
  /// Returns the reach of rows at all locations of noses, for each side.
  std::vector<RowReach> nose_reaches() const;
  RowReport row_report() const;

  const WorkMesh& mesh() const { return mesh_; }
  /// An edge from one line to another, across a strip between lines, with its triangle, its middle and its length.
  struct Strip {
    TriangleId triangle;
    Point point;
    double width;
  };
  std::vector<Strip> strips() const;
  /// Returns the triangles with an angle below `angle`, smallest first, and the lines and corners there.
  std::vector<ErrorLocation> slivers(double angle) const;
  /// Returns the fraction of the area of triangles turned by more than `angle` from the reference at a corner. Rows are not included.
  double turned_share(double angle) const;
  /// Returns the remaining vertices and triangles, in their previous order.
  TriMesh result() const;
  /// Returns the reference triangles near the given pairs of triangles of result(): those within `rings` rings around the area that the pairs cover. Sorted,
  /// unique.
  std::vector<TriangleId> reference_triangles_of(const std::vector<std::array<std::uint32_t, 2>>& pairs, int rings) const;

 private:
  double target_length(HalfedgeId h) const;
  double length_ratio(HalfedgeId h) const;
  bool is_locked(HalfedgeId h) const { return mesh_.is_line(h) && locked_[static_cast<std::size_t>(mesh_.line(h))] != 0; }
  bool is_kept(TriangleId t) const { return r_.is_kept[mesh_.hint[t]] != 0; }
  Vec3 normal_at(VertexId v, TriangleId hint, const Point& towards, const Vec3& seen) const;
  /// Returns the quality computed by the last update().
  double quality(TriangleId t) const { return quality_[t]; }
  double quality_now(TriangleId t) const;
  void update(TriangleId t) { quality_[t] = quality_now(t); }
  void update_all();
  void update_fan(VertexId v) {
    mesh_.for_out(v, [&](HalfedgeId h) { update(triangle_of(h)); });
  }
  double quality_of(const TriangleVertices& v, TriangleId hint) const;
  bool is_at_border(VertexId v) const;
  bool lies_in_border(const TriangleVertices& v, const std::array<Point, 3>& p) const;
  double fan_quality(VertexId v) const;
  double fan_quality_now(VertexId v, double floor) const;
  int valence(VertexId v) const;
  double s_on_line(VertexId v, std::int32_t line) const;
  void put_on_face(WorkVertex& v, const Point& p, TriangleId start) const;
  void put_on_line(WorkVertex& v, std::int32_t line, double s) const;
  void resize(WorkVertex& v, TriangleId t) const;
  WorkVertex middle(HalfedgeId h) const;
  bool is_split_good(HalfedgeId h, VertexId m) const;
  bool is_collapse_legal(HalfedgeId h) const;
  double collapse_quality(HalfedgeId h, double most) const;
  bool try_collapse(HalfedgeId h, double floor, double most);
  bool try_flip(HalfedgeId h, double gain);
  bool is_flip_good(HalfedgeId h, double floor) const;
  void flip(HalfedgeId h);
  WorkVertex smoothed(VertexId v, double share) const;
  bool move(VertexId v, double good);
  bool search(VertexId v);
  std::vector<std::vector<VertexId>> colours() const;

  /// The rows at one location of a line, on one side. rows[0] lies on the line, and the last one is the border vertex.
  struct LineColumn {
    VertexId vertex;                                  ///< vertex of the border
    VertexId before, after;                           ///< its neighbours along the border; the face is to the left of the path from one to the other
    std::size_t before_column = 0, after_column = 0;  ///< columns of these neighbours; k_no_column: a neighbour without rows
    std::vector<WorkVertex> rows;
    std::vector<double> heights;  ///< m, heights of the rows
    Vec3 way;                     ///< unit vector of the last step
    double spacing = 0.0;         ///< m, mean length of the two edges along the line
    double room = 0.0;            ///< m: available height for the rows
    double climbed = 0.0;         ///< m, height of all rows made so far
    const SideRows* side_rows = nullptr;
    bool is_growing = true;
    bool is_nose = false;
    std::size_t n_rows() const { return rows.size() - 1; }
  };
  /// An edge of a line with rows on this side, from a to b with the face to the left; a and b are vertices of the border.
  struct RowEdge {
    VertexId a, b;
    std::size_t a_column, b_column;
    TriangleId hint;
  };
  /// A triangle of rows.
  struct RowCell {
    std::uint32_t edge;                                   ///< index in row_edges_
    std::array<std::array<std::uint32_t, 2>, 3> corners;  ///< for each corner the side (0: a, 1: b) and the number of the row
  };
  static constexpr std::size_t k_no_column = ~std::size_t{0};

  void open_lines(std::span<const LineRows> rows);
  struct Opening;
  Opening find_cuts(std::span<const LineRows> rows);
  void cut_apart(Opening& opening);
  void copy_fan(VertexId v, HalfedgeId first, Opening& opening);
  void start_column(std::size_t number, const Column<VertexId, std::size_t>& column_of, const Opening& opening);
  bool is_front(HalfedgeId h) const { return mesh_.line(h) == front_; }
  bool grow_column(LineColumn& column, std::size_t row);
  bool advance(LineColumn& column, const WorkVertex& target, double height);
  bool is_step_good(const LineColumn& column, const WorkVertex& top, std::size_t row) const;
  bool place(VertexId v, const WorkVertex& where, double floor);
  bool make_room(VertexId v, const Point& towards);
  bool take_into(HalfedgeId h, double floor);
  const WorkVertex& row_at(VertexId vertex, std::size_t column, std::size_t row) const;
  std::size_t n_rows_of(std::size_t column) const { return column == k_no_column ? 0 : columns_[column].n_rows(); }
  Vec3 row_direction(const LineColumn& column, std::size_t row) const;
  std::vector<RowCell> row_cells() const;

  const Reference& r_;
  const RemeshSizes& sizes_;
  RunContext context_;
  WorkMesh mesh_;
  Column<TriangleId, double> quality_;   ///< quality of each triangle; k_folded if it is inverted against the reference
  std::vector<std::uint8_t> locked_;     ///< flags of the lines that border kept triangles
  std::vector<std::uint8_t> is_border_;  ///< flags of the lines that are open boundaries; empty if there is none
  double flat_ = 0.0;                    ///< m
  std::int32_t front_ = k_no_line - 1;   ///< placeholder for the line of the border's edges; locked
  std::vector<LineColumn> columns_;
  std::vector<RowEdge> row_edges_;
  /// Vertices of the opened mesh, each with the line vertex from which it was copied; sorted by the former.
  std::vector<std::pair<VertexId, VertexId>> copies_;
};

}  // namespace sterna::surfmesh
