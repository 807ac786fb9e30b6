// Array names of .sterna files, shared by writer and reader (docs/sterna_format.md).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "geom/mesh/tri_mesh.h"

namespace sterna::io::part {

/// Array names of a triangulated surface.
struct SurfaceNames {
  std::string_view points, triangles, triangle_patch, patches;
};
inline constexpr SurfaceNames k_surface = {"surface/points", "surface/triangles", "surface/triangle_patch", "surface/patches"};
inline constexpr SurfaceNames k_farfield = {"farfield/points", "farfield/triangles", "farfield/triangle_patch", "farfield/patches"};
inline constexpr std::string_view k_direction = "envelope/direction", k_height = "envelope/height", k_target = "envelope/target", k_eq1 = "envelope/eq1",
                                  k_cap = "envelope/cap", k_limit = "envelope/limit", k_first_height = "envelope/first_height";
inline constexpr std::string_view k_boundary_points = "tetrahedra/n_boundary_points", k_new_points = "tetrahedra/new_points",
                                  k_engine_tetrahedra = "tetrahedra/tetrahedra", k_moved_nodes = "tetrahedra/moved_nodes",
                                  k_moved_points = "tetrahedra/moved_points";
inline constexpr std::string_view k_points = "mesh/points", k_prisms = "mesh/prisms", k_pyramids = "mesh/pyramids", k_hexahedra = "mesh/hexahedra",
                                  k_tetrahedra = "mesh/tetrahedra", k_triangles = "mesh/boundary_triangles", k_triangle_patch = "mesh/boundary_triangle_patch",
                                  k_quads = "mesh/boundary_quads", k_quad_patch = "mesh/boundary_quad_patch", k_patches = "mesh/patches",
                                  k_periodic_patches = "mesh/periodic/patches", k_periodic_translations = "mesh/periodic/translations";
inline constexpr std::string_view k_n_layers = "mesh/layers/n_layers", k_base = "mesh/layers/base", k_first_node = "mesh/layers/first_node",
                                  k_is_collapsed = "mesh/layers/is_collapsed", k_line_layers = "mesh/layers/line_layers";
/// Version of files with k_line_layers: older readers would assign n_layers to every growth line.
inline constexpr std::uint32_t k_line_layers_version = 2;
/// Version of files in which growth lines of one column have different numbers of layers.
inline constexpr std::uint32_t k_truncated_version = 3;
inline constexpr std::string_view k_request = "mesh/request/first_height_max_growth", k_request_target = "mesh/request/target_height",
                                  k_request_reason = "mesh/request/reason", k_request_reasons = "mesh/request/reasons",
                                  k_request_first_height = "mesh/request/first_height", k_request_first_room = "mesh/request/first_room",
                                  k_request_boundary_layer = "mesh/request/boundary_layer", k_request_max_growth = "mesh/request/max_growth",
                                  k_request_layers = "mesh/request/layers";
/// Prefix for the array names of the layer around which the tetrahedra were generated, used if ridges are opened or there are wake sheets.
inline constexpr std::string_view k_opened = "opened/";
/// Version of files with k_opened: older readers would mistake the layers of the mesh for this layer.
inline constexpr std::uint32_t k_opened_version = 4;
inline constexpr std::string_view k_manifest = "manifest", k_certificate = "certificate", k_quality = "quality";

inline constexpr std::array k_patch_kinds = {PatchKind::wall,    PatchKind::slip,     PatchKind::symmetry, PatchKind::inflow,
                                             PatchKind::outflow, PatchKind::farfield, PatchKind::interface};

}  // namespace sterna::io::part
