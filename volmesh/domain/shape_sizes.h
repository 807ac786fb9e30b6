// Private to volmesh/domain: what box and cylinder have in common.
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
inline constexpr double k_default_edge = 0.2;     ///< of the radius
inline constexpr double k_shape_margin = 0.02;    ///< body lengths between wall and shape: tunnels are narrow, but a layer has to fit
inline constexpr double k_edge_growth = 0.3;      ///< of triangles' edges over the distance from a finer side
inline constexpr double k_coincident = 1e-6;      ///< of the shape's longest side: nearer planes are one

/// Edges of a line of this length.
inline int pieces(double length, double edge) { return std::max(1, static_cast<int>(std::ceil(length / edge - 1e-9))); }
/// Triangles of an area with this edge, about.
inline double triangles_of(double area, double edge) { return area / (0.433 * edge * edge); }
/// \throws Error(bad_argument) for more than 20 million
void require_affordable(double n_triangles, const std::string& attempted);
/// The edge length of all sides: given, `usual` where it is automatic, and below zero that share of `usual` (a member of a mesh family, layer_choice.h).
inline double common_edge(double given, double usual) { return is_automatic(given) ? usual : given > 0.0 ? given : -given * usual; }
double edge_of_side(std::span<const SideRule> rules, const std::string& side, double common);
/// Adds triangles by their vertices as a patch of kind farfield. \param is_turned their sense is turned
void add_patch(TriMesh& mesh, const std::string& name, std::span<const std::array<std::uint32_t, 3>> triangles, const std::vector<VertexId>& vertices,
               bool is_turned);

}  // namespace sterna::volmesh
