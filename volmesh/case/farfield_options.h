// Options of the outer boundary: a sphere, a box, a cylinder, a user-supplied surface, or none.
#pragma once

#include <string>
#include <vector>

#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

/// User settings for one side of the outer shape. The sides are x_min to z_max for a box; start, end and side for a cylinder; patch names for other shapes.
/// Planes in which bodies end are also sides. They are called symmetry, or if there are several, symmetry_y, symmetry_z, symmetry_y_min and so on.
struct SideRule {
  std::string side;
  std::string name;  ///< name of the side's patch; empty: the name of the kind
  PatchKind kind = PatchKind::farfield;
  bool has_kind = false;      ///< false: `kind` was not given
  double edge = k_automatic;  ///< m
};

struct FarfieldOptions {
  std::string farfield_shape = "automatic";
  double farfield_radius = k_automatic;
  double farfield_edge = k_automatic;  ///< a negative value, which users cannot enter, is a multiple of the automatic edge
  double farfield_center_x = k_automatic;
  double farfield_center_y = k_automatic;
  double farfield_center_z = k_automatic;
  double farfield_from_x = k_automatic;
  double farfield_from_y = k_automatic;
  double farfield_from_z = k_automatic;
  double farfield_to_x = k_automatic;
  double farfield_to_y = k_automatic;
  double farfield_to_z = k_automatic;
  std::string farfield_floor;
  std::vector<SideRule> farfield_sides;  ///< sides with other settings than the farfield; each side occurs once
  std::string farfield_surface;
};

/// Parses rules such as "x_min=inflow x_max=outflow,name:exit,edge:0.5 z_min=slip".
/// \throws Error(bad_argument) with the invalid entry
std::vector<SideRule> parse_sides(const std::string& text);
/// Returns the string form of the rules; parse_sides() restores them.
std::string sides_text(const std::vector<SideRule>& rules);

/// Returns the patch kind with this name.
/// \throws Error(bad_argument) with the list of kinds
PatchKind patch_kind_of(const std::string& name, const std::string& attempted);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::FarfieldOptions> {
  using O = volmesh::FarfieldOptions;
  static constexpr std::string_view stage = "farfield";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step | volmesh::k_tetrahedra_step;
  static constexpr std::array fields = {
      Field<O>{.name = "farfield_shape",
               .member = &O::farfield_shape,
               .help = "shape of the farfield around the bodies; automatic: a sphere, or none if the surface encloses its fluid",
               .choices = "automatic sphere box cylinder surface none"},
      Field<O>{.name = "farfield_radius",
               .member = &O::farfield_radius,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "radius of the sphere, or of the cylinder",
               .automatic = "50 body lengths"},
      Field<O>{.name = "farfield_edge",
               .member = &O::farfield_edge,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "edge length of the farfield triangles",
               .automatic = "about 1/5 of the radius, or 1/10 of the longest side of the box"},
      Field<O>{.name = "farfield_center_x",
               .member = &O::farfield_center_x,
               .unit = Unit::metre,
               .help = "centre of the sphere",
               .automatic = "centre of the wall's bounding box, or in the symmetry plane of a half model"},
      Field<O>{.name = "farfield_center_y",
               .member = &O::farfield_center_y,
               .unit = Unit::metre,
               .help = "centre of the sphere",
               .automatic = "centre of the wall's bounding box, or in the symmetry plane of a half model"},
      Field<O>{.name = "farfield_center_z",
               .member = &O::farfield_center_z,
               .unit = Unit::metre,
               .help = "centre of the sphere",
               .automatic = "centre of the wall's bounding box, or in the symmetry plane of a half model"},
      Field<O>{.name = "farfield_from_x",
               .member = &O::farfield_from_x,
               .unit = Unit::metre,
               .help = "lower corner of the box, or centre of the cylinder's first end",
               .automatic = "50 body lengths from the centre of the wall; in the symmetry plane of a half model; y and z of a cylinder: on its axis"},
      Field<O>{.name = "farfield_from_y",
               .member = &O::farfield_from_y,
               .unit = Unit::metre,
               .help = "lower corner of the box, or centre of the cylinder's first end",
               .automatic = "50 body lengths from the centre of the wall; in the symmetry plane of a half model; y and z of a cylinder: on its axis"},
      Field<O>{.name = "farfield_from_z",
               .member = &O::farfield_from_z,
               .unit = Unit::metre,
               .help = "lower corner of the box, or centre of the cylinder's first end",
               .automatic = "50 body lengths from the centre of the wall; in the symmetry plane of a half model; y and z of a cylinder: on its axis"},
      Field<O>{.name = "farfield_to_x",
               .member = &O::farfield_to_x,
               .unit = Unit::metre,
               .help = "upper corner of the box, or centre of the cylinder's second end",
               .automatic = "50 body lengths from the centre of the wall; in the symmetry plane of a half model; y and z of a cylinder: on its axis"},
      Field<O>{.name = "farfield_to_y",
               .member = &O::farfield_to_y,
               .unit = Unit::metre,
               .help = "upper corner of the box, or centre of the cylinder's second end",
               .automatic = "50 body lengths from the centre of the wall; in the symmetry plane of a half model; y and z of a cylinder: on its axis"},
      Field<O>{.name = "farfield_to_z",
               .member = &O::farfield_to_z,
               .unit = Unit::metre,
               .help = "upper corner of the box, or centre of the cylinder's second end",
               .automatic = "50 body lengths from the centre of the wall; in the symmetry plane of a half model; y and z of a cylinder: on its axis"},
      Field<O>{.name = "farfield_floor",
               .member = &O::farfield_floor,
               .help = "name or pattern of the patches of an open floor surface (terrain): the box gets sides upwards from the border of the floor, and a lid; "
                       "empty: no floor"},
      Field<O>{.name = "farfield_sides",
               .member = text_option<&O::farfield_sides, volmesh::parse_sides, volmesh::sides_text>(),
               .help = "kinds, names and edge lengths of the farfield sides, as SIDE=KIND[,name:NAME][,edge:LENGTH] separated by blanks, e.g. \"x_min=inflow "
                       "x_max=outflow,name:exit,edge:0.5\". Sides of a box: x_min to z_max; of a cylinder: start, end, side; of a farfield surface: its "
                       "patches; symmetry plane of a half model: symmetry; empty: all sides have kind farfield"},
      Field<O>{.name = "farfield_surface", .member = &O::farfield_surface, .help = "file of the closed farfield surface, for the shape \"surface\""},
  };
};

}  // namespace sterna
