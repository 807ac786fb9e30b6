// tear_surface IN OUT.stl [SEED]: tears a surface (tests/support/tear.h) and writes the remaining triangles.
#include <cstdlib>
#include <iostream>

#include "geom/base/error.h"
#include "io/file/surface_file.h"
#include "tests/support/tear.h"

int main(int argc, char** argv) {
  using namespace sterna;
  if (argc < 3) {
    std::cerr << "usage: tear_surface IN OUT.stl [SEED]\n";
    return 2;
  }
  const RunContext context;
  try {
    const TriMesh whole = io::to_tri_mesh(io::read_surface_file(argv[1], context));
    test::TearOptions options;
    if (argc > 3) options.seed = std::strtoull(argv[3], nullptr, 10);
    io::write_surface_file(io::to_tri_mesh(test::tear(whole, options)), argv[2], context);
  } catch (const Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
