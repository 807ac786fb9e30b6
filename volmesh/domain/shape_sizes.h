// Private to volmesh/domain: common functions for box and cylinder.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/farfield_options.h"

namespace sterna::volmesh {

inline constexpr double k_default_radius = 50.0;  ///< body lengths
inline constexpr double k_default_edge = 0.2;     ///< fraction of the radius
/// Body lengths: smallest distance between wall and shape. It is small because tunnels are narrow, but a layer must fit in.
inline constexpr double k_shape_margin = 0.02;
inline constexpr double k_edge_growth = 0.3;  ///< growth of triangle edges per distance from a finer side
inline constexpr double k_coincident = 1e-6;  ///< fraction of the shape's longest side: planes nearer to each other than this coincide

/// Returns the number of edges on a line of this length.
inline int pieces(double length, double edge) { return std::max(1, static_cast<int>(std::ceil(length / edge - 1e-9))); }
/// Returns the approximate number of triangles with this edge length in an area.
inline double triangles_of(double area, double edge) { return area / (0.433 * edge * edge); }
/// \throws Error(bad_argument) for more than 20 million
void require_affordable(double n_triangles, const std::string& attempted);
/// Returns the edge length of all sides: the given one, or `usual` if it is automatic. A negative value is a multiple of `usual` (for a member of a mesh
/// family, layer_choice.h).
inline double common_edge(double given, double usual) { return is_automatic(given) ? usual : given > 0.0 ? given : -given * usual; }
double edge_of_side(std::span<const SideRule> rules, const std::string& side, double common);
/// Adds triangles, given by their vertices, as a patch of kind farfield. \param is_turned true: their orientation is reversed
void add_patch(TriMesh& mesh, const std::string& name, std::span<const std::array<std::uint32_t, 3>> triangles, const std::vector<VertexId>& vertices,
               bool is_turned);

}  // namespace sterna::volmesh
