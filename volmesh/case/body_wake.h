// Wake of a body: finds bodies without wake refinement, and makes the size source that refines the wake.
#pragma once

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Arguments of wake{ wall, ... } and --wake.
struct BodyWake {
  double length = 2.0;
  double size = k_automatic;
  double size_end = k_automatic;
  double spread = 0.05;
  Vec3 direction{1.0, 0.0, 0.0};
};
/// Returns a size source with short edges in the wake of the body. The source is as wide and as high as the body, and reaches from the body's middle to
/// `length` body lengths behind its end. In a surface that encloses its fluid (a tunnel with a model), the body is all walls except the outer walls, and the
/// wake ends where the fluid ends.
/// \throws Error(bad_argument) for a surface without walls, and for a surface that encloses its fluid and has only outer walls
SizeSource wake_behind(const TriMesh& wall, const BodyWake& wake);

/// Returns true for a body in a generated farfield without any size source or wake sheet, including those of a mesh family. Only the growth of tetrahedra then
/// resolves its wake. Returns false for tunnels, for bodies with engines (which have inner flow as well), and for surfaces that are no body.
bool has_bare_wake(const TriMesh& surface, const MeshCase& options);

/// Adds the source wake{ wall } along x to members of a mesh family if nothing else refines the wake (family_wake). Edge lengths are those of the medium
/// member. The log reports the addition. \pre refined() has not been applied yet
MeshCase with_family_wake(const TriMesh& surface, MeshCase options, const RunContext& context);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::BodyWake> {
  using O = volmesh::BodyWake;
  static constexpr std::string_view stage = "body_wake";
  static constexpr std::array fields = {
      Field<O>{.name = "length", .member = &O::length, .min = 0.01, .max = 1000.0, .help = "length of the wake behind a surface, in body lengths"},
      Field<O>{.name = "size",
               .member = &O::size,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "edge length behind the body",
               .automatic = "1/8 of the body height, at least 1/50 of the body length"},
      Field<O>{.name = "size_end",
               .member = &O::size_end,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "edge length at the far end of the wake",
               .automatic = "twice the size"},
      Field<O>{.name = "spread", .member = &O::spread, .min = 0.0, .max = 10.0, .help = "half of the wake's growth in height per distance along the wake"},
      Field<O>{.name = "direction", .member = &O::direction, .help = "direction of the wake, of any length"},
  };
};

}  // namespace sterna
