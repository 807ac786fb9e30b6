// From the surface that the user has to the closed surface, its patches with kinds, whose inside is the fluid.
#pragma once

#include <memory>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/farfield_options.h"
#include "volmesh/case/periodic_names.h"

namespace sterna::volmesh {

struct OuterOptions {
  FarfieldOptions farfield;
  std::shared_ptr<const TriMesh> surface = nullptr;  ///< for the shape "surface": closed, or ending in the planes of the bodies
  std::vector<PeriodicNames> periodic = {};          ///< pairs of patches, also of planes that are added
};

/// A plane that was added, beside which the fluid ends.
struct AddedPlane {
  std::size_t axis = 1;
  double at = 0.0;            ///< m
  double inward = 1.0;        ///< +1: the fluid is where the coordinate is larger
  double edge = k_automatic;  ///< m, longest edge on it
};

/// Adds what ends the fluid: the outer shape around bodies, and where bodies end in planes x, y or z = constant (half models; constraints_of_rims) these
/// planes, with the shape cut to its part beside them. A surface that encloses its fluid gets no shape: its outermost part has normals inwards (a tunnel, a
/// complete domain). The surface's vertices, triangles and patches come first and unchanged, but for vertices of rims, which are moved into their planes to the
/// bit; then the shape's; then the planes', with long thin triangles between the rims: to be triangulated anew. The planes' patches are of kind symmetry and
/// called "symmetry", where there are several "symmetry_y" or "symmetry_y_min"; farfield_sides names them otherwise. A plane in which the shape has a patch of
/// another kind than farfield takes over its name and kind (the side wall of a tunnel that a wing stands on). Of a user's surface, normals are turned into the
/// fluid; where it has walls alone and farfield_sides says nothing of them, they become farfield.
/// Where two of the planes are periodic sides and no shape is given, the shape is a box, whose sides are images of each other there; a log line says so.
/// With `farfield_floor` the surface is an open sheet, with bodies above it or none: it gets a lid, and sides from its rim upwards, patches as a box's sides
/// (floor.h).
/// `planes`, where it is not null, gets the planes that were added.
/// \pre surface manifold, normals into the fluid
/// \post closed (no boundary edges), manifold; body volumes positive, the outermost negative
/// \throws Error(open_surface) for rims in no plane; (bad_argument) when the shape does not enclose the bodies, when there is nothing around them (shape none),
/// when a shape is asked for around a surface that encloses its fluid, or for farfield_sides with an edge length where nothing is triangulated by it;
/// (empty_surface)
TriMesh complete_boundary(const TriMesh& surface, const OuterOptions& options, const RunContext& context, std::vector<AddedPlane>* planes = nullptr);

/// A plane x, y or z = constant that an open surface ends in.
struct RimPlane {
  std::size_t axis = 0;
  double at = 0.0;       ///< m
  bool is_above = true;  ///< the surface is on the side of larger coordinates
  Box rim;               ///< m, of the vertices of rims in it
  double covered = 0.0;  ///< m^2 of the surface that lie in it
};
/// The planes that all rims of the surface lie in; empty for a closed surface.
/// \throws Error(open_surface) when some rim lies in no such plane or the surface is on both sides of one
std::vector<RimPlane> rim_planes_of(const TriMesh& surface, const RunContext& context);

/// Whether the options name or change an outer shape.
bool is_farfield_given(const FarfieldOptions& options);

/// An open surface whose outermost parts have their normals inwards, as a domain has them, but which is to be a body in a farfield: turns these parts. Nothing
/// happens where other parts lie within them, or where the normals point outwards. \return number of parts that were turned
std::int64_t turn_to_bodies(TriMesh& surface, const RunContext& context);

}  // namespace sterna::volmesh
