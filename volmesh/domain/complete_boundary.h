// Completes the user's surface to a closed surface, with patch kinds, whose inside is the fluid.
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
  std::vector<PeriodicNames> periodic = {};          ///< pairs of patches, including patches of added planes
};

/// A plane that was added as a boundary of the fluid.
struct AddedPlane {
  std::size_t axis = 1;
  double at = 0.0;            ///< m
  double inward = 1.0;        ///< +1: the fluid is where the coordinate is larger
  double edge = k_automatic;  ///< m, longest edge on it
};

/// Adds the outer boundary of the fluid: the outer shape around bodies, and the planes x, y or z = constant in which bodies end (half models;
/// constraints_of_rims), with the shape cut to its part beside them. A surface that encloses its fluid gets no shape: its outermost part has normals inwards (a
/// tunnel, a complete domain).
///
/// Order of the result: the surface's vertices, triangles and patches come first and unchanged, except for vertices of open boundaries, which are moved
/// bit-exactly into their planes. Then come those of the shape. Those of the planes come last, with long thin triangles between the open boundaries that have
/// to be re-meshed.
///
/// Patches of the planes have kind symmetry and the name "symmetry"; with several planes "symmetry_y" or "symmetry_y_min". farfield_sides can rename them. If
/// the shape has a patch of another kind than farfield in a plane, the plane takes over its name and kind (the side wall of a tunnel that a wing stands on).
/// Normals of a user's surface are turned into the fluid; if it has walls alone and farfield_sides has no rule for them, they become farfield.
///
/// If two of the planes are periodic sides and no shape is given, the shape is a box, whose sides are images of each other there; this is logged. With
/// `farfield_floor` the surface is an open sheet, with or without bodies above it: it gets a lid, and sides from its open boundary upwards, with patches as a
/// box's sides (floor.h). `planes`, if not null, receives the planes that were added.
/// \pre surface manifold, normals into the fluid
/// \post closed (no boundary edges), manifold; body volumes positive, the outermost negative
/// \throws Error(open_surface) for open boundaries in no plane; (bad_argument) if the shape does not enclose the bodies, if nothing is around them (shape
/// none), if a shape is requested around a surface that encloses its fluid, or if farfield_sides has an edge length for a side that is not triangulated with
/// it; (empty_surface)
TriMesh complete_boundary(const TriMesh& surface, const OuterOptions& options, const RunContext& context, std::vector<AddedPlane>* planes = nullptr);

/// A plane x, y or z = constant in which an open surface ends.
struct RimPlane {
  std::size_t axis = 0;
  double at = 0.0;       ///< m
  bool is_above = true;  ///< the surface is on the side of larger coordinates
  Box rim;               ///< m, bounding box of the open-boundary vertices in the plane
  double covered = 0.0;  ///< m^2 of the surface that lie in the plane
};
/// Returns the planes that contain all open boundaries of the surface; empty for a closed surface.
/// \throws Error(open_surface) if some open boundary lies in no such plane or the surface is on both sides of a plane
std::vector<RimPlane> rim_planes_of(const TriMesh& surface, const RunContext& context);

/// Returns true if the options name or change an outer shape.
bool is_farfield_given(const FarfieldOptions& options);

/// Turns the outermost parts of an open surface whose normals point inwards, as in a domain, if the surface is meant as a body in a farfield. Nothing happens
/// if other parts lie within them, or if the normals point outwards. \return number of parts that were turned
std::int64_t turn_to_bodies(TriMesh& surface, const RunContext& context);

}  // namespace sterna::volmesh
