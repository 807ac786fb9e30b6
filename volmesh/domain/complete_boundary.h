// Completes the user's surface to a closed surface with patch kinds. The inside of that surface is the fluid.
#pragma once

#include <memory>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/periodic_names.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/farfield_options.h"

namespace sterna::volmesh {

struct OuterOptions {
  FarfieldOptions farfield;
  std::shared_ptr<const TriMesh> surface = nullptr;  ///< outer boundary for the shape "surface"; it is closed, or ends in the planes in which the bodies end
  std::vector<PeriodicNames> periodic = {};          ///< pairs of patches, including patches of added planes
};

/// A plane that was added as a boundary of the fluid.
struct AddedPlane {
  std::size_t axis = 1;
  double at = 0.0;            ///< m
  double inward = 1.0;        ///< +1: the fluid is where the coordinate is larger
  double edge = k_automatic;  ///< m, longest edge on the plane
};

/// Adds the outer boundary of the fluid: the outer shape around bodies, and the planes x, y or z = constant in which bodies end (half models;
/// constraints_of_borders). The shape is cut at these planes. A surface that encloses its fluid gets no shape; the normals of its outermost part point inwards
/// (a tunnel, a complete domain).
///
/// Order of the result: the surface's vertices, triangles and patches come first. They are unchanged, except that vertices of open boundaries are moved
/// bit-exactly into their planes. Then come those of the shape. Those of the planes come last; between the open boundaries they are long thin triangles that
/// have to be re-meshed.
///
/// Patches of the planes have kind symmetry and the name "symmetry", or "symmetry_y" or "symmetry_y_min" if there are several planes. farfield_sides can rename
/// them. If the shape has a patch in a plane whose kind is not farfield, the plane takes over its name and kind (such as the side wall of a tunnel on which a
/// wing stands). Normals of the user's outer surface are turned into the fluid. If all its patches are walls and farfield_sides has no rule for them, they get
/// kind farfield.
///
/// If two of the planes are periodic sides and no shape is given, the shape is a box. The sides of a box are images of each other, and the choice is logged.
/// With `farfield_floor` the surface is an open sheet, with or without bodies above it. It gets a lid, and sides from its open boundary up to the lid, with the
/// patches of a box's sides (floor.h). `planes`, if not null, receives the planes that were added.
/// \pre the surface is manifold, with normals into the fluid
/// \post the result is closed (no boundary edges) and manifold; the volumes of bodies are positive, that of the outermost part is negative
/// \throws Error(open_surface) for open boundaries that are in no plane; (bad_argument) if the shape does not enclose the bodies, if there is no shape around
/// them (shape none), if a shape is requested around a surface that encloses its fluid, or if farfield_sides has an edge length for a side that is not
/// triangulated with it; (empty_surface)
TriMesh complete_boundary(const TriMesh& surface, const OuterOptions& options, const RunContext& context, std::vector<AddedPlane>* planes = nullptr);

/// A plane x, y or z = constant in which an open surface ends.
struct OpenBorderPlane {
  std::size_t axis = 0;
  double at = 0.0;       ///< m
  bool is_above = true;  ///< the surface is on the side of larger coordinates
  Box border;            ///< m, bounding box of the surface's open-boundary vertices in the plane
  double covered = 0.0;  ///< m^2, area of the surface in the plane
};
/// Returns the planes that contain all open boundaries of the surface; empty for a closed surface.
/// \throws Error(open_surface) if an open boundary lies in no such plane, or if the surface is on both sides of a plane
std::vector<OpenBorderPlane> open_border_planes_of(const TriMesh& surface, const RunContext& context);

/// Returns true if the options name or change an outer shape.
bool is_farfield_given(const FarfieldOptions& options);

/// Turns outermost parts of an open surface whose normals point inwards, as in a domain, if the surface is meant to be a body in a farfield. Does nothing if
/// other parts lie within them, or if the normals point outwards. \return number of parts that were turned
std::int64_t turn_to_bodies(TriMesh& surface, const RunContext& context);

}  // namespace sterna::volmesh
