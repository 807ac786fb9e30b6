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

}  // namespace sterna::volmesh
