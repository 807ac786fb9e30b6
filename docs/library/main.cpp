// A mesh from C++: the smallest program that uses sterna's library. usage: mesh_box WALL.stl OUT.su2
#include <cstdio>
#include <exception>

#include "geom/base/run_context.h"
#include "geom/mesh/check.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/volume_mesh.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: %s WALL.stl OUT.su2\n", argv[0]), 2;
  try {
    const sterna::RunContext context({.log = [](sterna::LogLevel level, std::string_view text) {
      if (level >= sterna::LogLevel::warning) std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data());
    }});
    const sterna::surfmesh::StitchResult wall = sterna::surfmesh::stitch_surface({sterna::io::read_surface_file(argv[1], context)}, {.unit = 1.0}, context);
    sterna::volmesh::MeshCase options;  // every option of `help(volume_mesh)` is a member of one of its stages
    options.envelope.layers = 12;
    options.envelope.first_height = 1e-3;
    options.farfield.farfield_radius = 20.0;
    options.tetrahedra.engine = "sterna";  // the others are programs of their own
    const sterna::volmesh::VolumeMeshResult made = sterna::volmesh::volume_mesh(wall.mesh, options, context);
    sterna::io::write_volume_file(made.mesh, argv[2], context);
    std::printf("%s: %zu nodes, %s\n", argv[2], made.mesh.points.size(), made.check.is_valid() ? "VALID" : "INVALID");
    return made.check.is_valid() ? 0 : 3;
  } catch (const std::exception& error) {  // sterna::Error has places and advice, too
    return std::fprintf(stderr, "error: %s\n", error.what()), 1;
  }
}
