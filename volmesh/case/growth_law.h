// Geometric growth of layer heights: total height from ratio, and ratio from total height.
#pragma once

#include <vector>

namespace sterna::volmesh {

/// Sum of n heights h0, h0 r, h0 r^2, ...: h0 (r^n - 1)/(r - 1), and n h0 at r = 1. [ET15 eq. (1)]
/// \pre h0 > 0, r >= 1, n >= 1.
double layer_height(double h0, double r, int n);

/// Ratio r_j of eq. (1): min((l/h0)^(1/(n-1)), r_max), clamped to [1, r_max]; l is the mean edge length at the vertex, m.
double growth_for_edge(double h0, double l, double r_max, int n);

/// The ratio r >= 1 with h0 (r^n - 1)/(r - 1) = height (Newton); 1 if height <= n h0 (the layer is then compressed).
double growth_for_height(double h0, double height, int n);

/// Computes the parameters t_0 = 0 .. t_n = 1 of the nodes on a growth line of total height `height`: eq. (11) with r from growth_for_height; equal spacing if
/// compressed. Writes n + 1 values to `t`; the last value is exactly 1.
void layer_parameters(double h0, double height, int n, double* t);

/// Growth law of the cells of one growth line, from the wall upwards. [docs/method/prisms.md, "Growth of one line"; docs/heights.md]
///
/// Local growth: one ratio per growth line, eq. (11). The corner heights of a prism are in proportions that change by a share s from one layer to the next. The
/// centroid then moves sideways by s/4 of an edge e, so the face between two flat cells of height h leans by atan(s e / 4 h): 0.1 % gives 68 degrees at e/h =
/// 1e4.
///
/// Common growth: ratio_j = g / (1 + b min(1, (100 h_j / e)^2)), at least 1, with one g for all growth lines and a bend b that follows from the total height of
/// the line (b < 0: g (1 - b min(...))). Flat cells grow by g on all lines. If the bends of neighbours differ by a small d, faces lean by at most atan(25 d).
///
/// Growth lines far below their target height would end with cells too low for the tetrahedra on top. The bend is therefore limited so that the ratio at the
/// top is at least 1 + 0.6 (r - 1), where r is the top ratio of a line of target height. Still lower lines have lower cells, all by one share, down to a share
/// of 0.4. Below that, the first cells get lower, and the bend acts where cells have 0.4 of the height at which it acts on full-height lines: otherwise lines
/// of a thousandth of their height would bend while they are flat. At and below a third of the least height for the first cell, lines have the bend of a line
/// of target height.
struct LineGrowth {
  double h0 = 0.0;      ///< m, first height
  double common = 0.0;  ///< g; 0: local growth
  double edge = 0.0;    ///< m, e, longest wall edge there
  double target = 0.0;  ///< m, target total height; with a common ratio
};

/// Computes the parameters as layer_parameters() above. \pre h0 > 0, height > 0, n >= 1; with a common ratio g >= 1, edge > 0 and target > 0
void layer_parameters(const LineGrowth& line, double height, int n, double* t);
/// Returns the ratio of the top cells, where it differs most from the common ratio, or the common ratio if that is larger; 1 if compressed.
double largest_growth(const LineGrowth& line, double height, int n);
/// Edge-to-height ratio above which cells count as flat.
inline constexpr double k_flat_edges = 100.0;
/// Returns how much of a change of ratios may act on a cell of this height, 0 to 1: the square of 100 h / e leaves flat cells nearly unchanged.
double bend_share(double height, double edge);
/// Returns the total height of n layers, m, whose last cell is as tall as the wall's edge, eq. (1); with a common ratio, as tall as a regular tetrahedron on
/// that edge.
double height_by_edge(double h0, double edge, double r_max, int n, bool has_common_growth);

/// Returns the height of the last of n cells, m.
double last_height(const LineGrowth& line, double height, int n);
/// Returns the least total height with which the first of n cells has height h0, m.
double height_for_first_cell(const LineGrowth& line, int n);

}  // namespace sterna::volmesh
