// The verbs that make sources of the size field: box{...}, line{...}, wake{...} and so on, and reading them back from a verb's table.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "volmesh/case/size_sources.h"

namespace sterna::scripting {

/// point, line, box, cylinder, wake, size_samples. The values are tables with the field "shape", whose name is the verb's.
std::span<const ScriptVerb> source_verbs();
/// ball of a given size: sphere{ {x, y, z}, radius = 1, size = 0.1 }, which shares its verb with the farfield.
ScriptValue make_sphere_source(const ScriptCall& call);

/// The entry "sources" of a table: a list of what the verbs above made, or one. Notes problems with the reader.
std::vector<volmesh::SizeSource> read_sources(TableReader& reader, const ScriptCall& call);
/// A source of the command line, "line 0 0 0 8 0 0 size=0.02 radius=0.5" or "cylinder from=0,0,0 to=8,0,0 radius=1 size=0.1": the verb's name, its points (also
/// from, to, center), its named numbers. Numbers take units.
/// \throws Error(bad_argument, unknown_option)
volmesh::SizeSource source_of_text(const std::string& text);

/// What wake{ wall, ... } and --wake take.
struct BodyWake {
  double length = 2.0;
  double size = k_automatic;
  double size_end = k_automatic;
  double spread = 0.05;
};
/// Short edges in what the body leaves behind: as wide and as high as the body, from its middle on to `length` body lengths behind its end.
/// \throws Error(bad_argument) for a surface without walls, and for one that the fluid is inside of
volmesh::SizeSource wake_behind(const TriMesh& wall, const BodyWake& wake, const Vec3& direction);
/// "length=2 size=0.05 direction=1,0,0.05"; may be empty.
/// \throws Error(bad_argument, unknown_option), also as wake_behind
volmesh::SizeSource wake_of_text(const std::string& text, const TriMesh& wall);

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::BodyWake> {
  using O = scripting::BodyWake;
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
