// wrap_bench OUT.stl FILE...: wraps files with the defaults, prints times and statistics, writes the wrap. The environment variables EDGE and GAP set the edge
// length and the gap.
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "geom/base/error.h"
#include "io/file/surface_file.h"
#include "surfmesh/wrap/wrap_surface.h"

int main(int argc, char** argv) {
  using namespace sterna;
  const RunContext context({.threads = 2, .log = [](LogLevel, std::string_view text) { std::cout << "  " << text << "\n"; }});
  std::vector<SurfaceSoup> soups;
  for (int i = 2; i < argc; ++i) soups.push_back(io::read_surface_file(argv[i], context));
  surfmesh::WrapOptions options;
  if (const char* edge = std::getenv("EDGE")) options.edge = std::atof(edge);
  if (const char* gap = std::getenv("GAP")) options.gap = std::atof(gap);
  const auto start = std::chrono::steady_clock::now();
  try {
    const surfmesh::WrapResult wrap = surfmesh::wrap_surface(soups, options, context);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const surfmesh::WrapReport& r = wrap.report;
    std::cout << argv[2] << ": " << r.n_triangles << " of " << r.expected_triangles << " triangles, " << seconds << " s, L " << body_length(wrap.mesh)
              << ", edge " << r.edge << ", to input " << r.to_input << " (closed " << r.to_input_closed << "), from input " << r.from_input << ", beyond "
              << r.n_beyond_tolerance << ", off " << r.n_off_input << ", lines " << r.n_feature_edges << "/" << r.n_on_features << ", min angle "
              << r.quality.min_angle * 57.2958 << ", below 15: " << r.quality.n_below_15 << " (" << r.quality.n_at_features << " at features), closures "
              << r.n_closures << ", leaks " << r.leaks.size() << ", components " << r.n_components << "\n";
    for (const StageTime& time : context.times()) std::cout << "  " << time.stage << " " << time.seconds << "\n";
    io::write_surface_file(wrap.mesh, argv[1], context);
  } catch (const Error& error) {
    std::cout << argv[2] << ": " << error.what() << "\n";
    return 1;
  }
}
