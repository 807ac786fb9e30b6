// Private to volmesh/domain: common parts of box and cylinder.
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
inline constexpr double k_default_edge = 0.2;     ///< share of the radius
inline constexpr double k_shape_margin = 0.02;    ///< body lengths between wall and shape: tunnels are narrow, but a layer must fit
inline constexpr double k_edge_growth = 0.3;      ///< growth of triangle edges per distance from a finer side
inline constexpr double k_coincident = 1e-6;      ///< share of the shape's longest side: nearer planes coincide

/// Number of edges on a line of this length.
inline int pieces(double length, double edge) { return std::max(1, static_cast<int>(std::ceil(length / edge - 1e-9))); }
/// Approximate number of triangles with this edge length in an area.
inline double triangles_of(double area, double edge) { return area / (0.433 * edge * edge); }
/// \throws Error(bad_argument) for more than 20 million
void require_affordable(double n_triangles, const std::string& attempted);
/// Returns the edge length of all sides: the given one, `usual` if automatic, and for negative values that share of `usual` (a member of a mesh family,
/// layer_choice.h).
inline double common_edge(double given, double usual) { return is_automatic(given) ? usual : given > 0.0 ? given : -given * usual; }
double edge_of_side(std::span<const SideRule> rules, const std::string& side, double common);
/// Adds triangles by their vertices as a patch of kind farfield. \param is_turned reverses their orientation
void add_patch(TriMesh& mesh, const std::string& name, std::span<const std::array<std::uint32_t, 3>> triangles, const std::vector<VertexId>& vertices,
               bool is_turned);

}  // namespace sterna::volmesh
