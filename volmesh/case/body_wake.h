// What a body leaves behind: whether anything refines it, and the source that does.
#pragma once

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// What wake{ wall, ... } and --wake take.
struct BodyWake {
  double length = 2.0;
  double size = k_automatic;
  double size_end = k_automatic;
  double spread = 0.05;
};
/// Short edges in what the body leaves behind: as wide and as high as the body, from its middle on to `length` body lengths behind its end. In a surface that
/// encloses its fluid (a tunnel with a model) the body is what is no outer wall, and the wake ends where the fluid does.
/// \throws Error(bad_argument) for a surface without walls, and for one that encloses its fluid and has no other walls than outer ones
SizeSource wake_behind(const TriMesh& wall, const BodyWake& wake, const Vec3& direction);

/// A body in a farfield of our own without any source or wake sheet, its own or the family's: nothing but the growth of tetrahedra resolves its wake. Not of
/// tunnels and of bodies with engines, whose flow is not around them, and of what is no body.
bool has_bare_wake(const TriMesh& surface, const MeshCase& options);

/// Members of a family get wake{ wall }, along x, where nothing else refines the wake (family_wake): their sources with it, in edges of the medium member. Told
/// in the log. \pre not refined() yet
MeshCase with_family_wake(const TriMesh& surface, MeshCase options, const RunContext& context);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::BodyWake> {
  using O = volmesh::BodyWake;
  static constexpr std::string_view stage = "body_wake";
  static constexpr std::array fields = {
      Field<O>{.name = "length", .member = &O::length, .min = 0.01, .max = 1000.0, .help = "behind a surface, in body lengths"},
      Field<O>{.name = "size",
               .member = &O::size,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "edge length behind the body",
               .automatic = "an eighth of the body's height, at least a fiftieth of its length"},
      Field<O>{
          .name = "size_end", .member = &O::size_end, .unit = Unit::metre, .min = 1e-12, .help = "edge length at its far end", .automatic = "twice the size"},
      Field<O>{.name = "spread", .member = &O::spread, .min = 0.0, .max = 10.0, .help = "half its growth in height over the distance"},
  };
};

}  // namespace sterna
