// Geometric growth of layer heights: total height from ratio and ratio from total height.
#pragma once

#include <vector>

namespace sterna::volmesh {

/// Sum of n heights h0, h0 r, h0 r^2, ...: h0 (r^n - 1)/(r - 1), and n h0 at r = 1. [ET15 eq. (1)]
/// \pre h0 > 0, r >= 1, n >= 1.
double layer_height(double h0, double r, int n);

/// Ratio r_j of eq. (1): min((l/h0)^(1/(n-1)), r_max), clamped to [1, r_max]; l is the mean edge length at the vertex, m.
double growth_for_edge(double h0, double l, double r_max, int n);

/// The ratio r >= 1 with h0 (r^n - 1)/(r - 1) = height (Newton); 1 when height <= n h0 (the layer is compressed then).
double growth_for_height(double h0, double height, int n);

/// Parameters t_0 = 0 .. t_n = 1 of the nodes on a line of total height `height`: eq. (11) with r from growth_for_height; equal spacing when compressed.
/// Writes n + 1 values to `t`; the last one is exactly 1.
void layer_parameters(double h0, double height, int n, double* t);

/// How the cells of one line grow from the wall up. [docs/method/prisms.md, "Growth of one line"; docs/heights.md]
///
/// Local: by one ratio, which each line has for itself, eq. (11). The centroid of a prism whose corner heights are in proportions that change from one layer to
/// the next by a share s moves sideways by s/4 of an edge e, so the face between two flat cells of height h leans by atan(s e / 4 h): 0.1 % are 68 degrees at
/// e/h = 1e4. Common: ratio_j = g / (1 + b min(1, (100 h_j / e)^2)), at least 1, with one g for all lines and a bend b that follows from the total height of
/// the line (b < 0: g (1 - b min(...))). Flat cells grow by g on all lines; where the bends of neighbours differ by a small d, faces lean by atan(25 d) at most
/// for it. Lines that are far lower than asked would end with cells too low for the tetrahedra on them: the bend is limited so that the ratio at the top is at
/// least 1 + 0.6 (r - 1), where r is the ratio there of a line as tall as asked. Still lower lines have lower cells, all by one share, to a share of 0.4;
/// below that the first cells get lower, and the bend acts where cells have 0.4 of the height at which it acts on full lines: else lines a thousandth of their
/// height would bend while they are flat. A third lower than the least height for the first cell, they have the bend of a line as tall as asked.
struct LineGrowth {
  double h0 = 0.0;      ///< m, first height
  double common = 0.0;  ///< g; 0: local
  double edge = 0.0;    ///< m, e, the longest of the wall there
  double target = 0.0;  ///< m, the total height that is asked for; with a common ratio
};

/// As layer_parameters() above. \pre h0 > 0, height > 0, n >= 1; with a common ratio g >= 1, edge > 0 and target > 0
void layer_parameters(const LineGrowth& line, double height, int n, double* t);
/// Ratio of the cells at the top, which are where it differs most from the common one, or the common one where it is larger; 1 when compressed.
double largest_growth(const LineGrowth& line, double height, int n);
/// Edges over heights above which cells are flat.
inline constexpr double k_flat_edges = 100.0;
/// How much of a change of ratios may act on a cell of this height, 0 to 1: the square of 100 h / e leaves flat cells nearly alone.
double bend_share(double height, double edge);
/// Total height of n layers, m, whose last cell is as tall as the wall's edge, eq. (1); with a common ratio as tall as a regular tetrahedron on it.
double height_by_edge(double h0, double edge, double r_max, int n, bool has_common_growth);

/// m, height of the last of n cells.
double last_height(const LineGrowth& line, double height, int n);
/// m, the least total height with which the first cell of n is h0.
double height_for_first_cell(const LineGrowth& line, int n);

}  // namespace sterna::volmesh
