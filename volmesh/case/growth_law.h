// Geometric growth of layer heights. Computes the total height from the ratio, and the ratio from the total height.
#pragma once

#include <vector>

namespace sterna::volmesh {

/// Returns the sum of n heights h0, h0 r, h0 r^2, ...: h0 (r^n - 1)/(r - 1), or n h0 for r = 1. [ET15 eq. (1)]
/// \pre h0 > 0, r >= 1, n >= 1.
double layer_height(double h0, double r, int n);

/// Returns the ratio r_j of eq. (1): min((l/h0)^(1/(n-1)), r_max), clamped to [1, r_max]. l is the mean edge length at the vertex, m.
double growth_for_edge(double h0, double l, double r_max, int n);

/// Returns the ratio r >= 1 with h0 (r^n - 1)/(r - 1) = height (Newton's method). Returns 1 if height <= n h0; the layer is then compressed.
double growth_for_height(double h0, double height, int n);

/// Computes the parameters t_0 = 0 to t_n = 1 of the nodes on a growth line of total height `height`. They follow from eq. (11) with r from growth_for_height,
/// or are equally spaced if the line is compressed. Writes n + 1 values to `t`; the last value is exactly 1.
void layer_parameters(double h0, double height, int n, double* t);

/// Growth law of the cells of one growth line, from the wall upwards. [docs/method/prisms.md, "Growth of one line"; docs/heights.md]
///
/// Local growth: each growth line has its own ratio, eq. (11). The proportions of the corner heights of a prism then change from one layer to the next, by a
/// fraction s. The centroid moves sideways by s/4 of an edge e, so the face between two flat cells of height h leans by atan(s e / 4 h). For s = 0.1 % and e/h
/// = 1e4 it leans by 68 degrees.
///
/// Common growth: ratio_j = g / (1 + b min(1, (100 h_j / e)^2)), at least 1, with the same g for all growth lines and a bend b that follows from the total
/// height of the line (b < 0: g (1 - b min(...))). Flat cells grow by g on all lines. If the bends of neighbours differ by a small d, faces lean by at most
/// atan(25 d).
///
/// Growth lines far below their target height would end with cells too low for the tetrahedra on top. The bend is therefore limited so that the ratio at the
/// top is at least 1 + 0.6 (r - 1), where r is the top ratio of a line of target height. On still lower lines all cells get lower by the same factor, down to
/// 0.4. Below that, the first cells get lower. The bend then acts where cells have 0.4 of the height at which it acts on full-height lines; otherwise lines of
/// a thousandth of their height would bend while they are flat. Lines up to a third of the least height for the first cell have the bend of a line of target
/// height.
struct LineGrowth {
  double h0 = 0.0;      ///< m, first height
  double common = 0.0;  ///< common ratio g; 0: local growth
  double edge = 0.0;    ///< m, edge length e: longest wall edge at the line
  double target = 0.0;  ///< m, target total height; needed with a common ratio
};

/// Computes the parameters like layer_parameters() above. \pre h0 > 0, height > 0, n >= 1; with a common ratio also g >= 1, edge > 0 and target > 0
void layer_parameters(const LineGrowth& line, double height, int n, double* t);
/// Returns the ratio of the top cells, where it differs most from the common ratio, or the common ratio if that is larger. Returns 1 for a compressed line.
double largest_growth(const LineGrowth& line, double height, int n);
/// Cells with a larger ratio of edge to height count as flat.
inline constexpr double k_flat_edges = 100.0;
/// Returns the fraction (0 to 1) of a change of ratios that may act on a cell of this height. The fraction is the square of 100 h / e, at most 1, so flat cells
/// remain nearly unchanged.
double bend_share(double height, double edge);
/// Returns the total height in metres of n layers whose last cell is as tall as the wall's edge, eq. (1). With a common ratio the last cell is as tall as a
/// regular tetrahedron on that edge.
double height_by_edge(double h0, double edge, double r_max, int n, bool has_common_growth);

/// Returns the height of the last of n cells in metres.
double last_height(const LineGrowth& line, double height, int n);
/// Returns the smallest total height in metres with which the first of n cells has height h0.
double height_for_first_cell(const LineGrowth& line, int n);

}  // namespace sterna::volmesh
