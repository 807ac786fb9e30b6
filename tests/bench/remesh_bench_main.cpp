// remesh_surface on real files: triangles, angles, radius ratios, distances over the length, speed.
// usage: remesh_bench [--threads N] [--out FOLDER] [--OPTION=VALUE]... surface...        Markdown table on standard output.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/check.h"
#include "io/file/surface_file.h"
#include "surfmesh/remesh/remesh_surface.h"
#include "surfmesh/stitch/stitch_surface.h"

using namespace sterna;

int main(int argc, char** argv) {
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  surfmesh::RemeshOptions options;
  const OptionTable table = sterna::options_of(options);
  std::filesystem::path out;
  RunSettings settings{.threads = 1};
  settings.log = [](LogLevel, std::string_view text) { std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data()); };
  std::printf("| file | before | after | least angle | 1 %% | radius ratio | needles | new to given / L | given to new / L | kept | CPU s | triangles/s |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--threads") settings.threads = std::stoi(argv[++i]);
    else if (arg == "--out") out = argv[++i];
    else if (arg.starts_with("--"))
      set_option_from_text(find_option(table, arg.substr(2, arg.find('=') - 2), "reading options"), arg.substr(arg.find('=') + 1));
    else {
      const RunContext context(settings);
      const std::filesystem::path path = arg;
      try {
        const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(path, context)}, {.allow_open = true}, context).mesh;
        const std::clock_t begin = std::clock();
        const surfmesh::RemeshResult result = surfmesh::remesh_surface(wall, options, {}, {}, context);
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        const surfmesh::RemeshReport& r = result.report;
        std::printf("| %s | %zu | %zu | %.2f | %.1f | %.4f | %lld | %.2e | %.2e | %lld | %.2f | %.0f |\n", path.filename().c_str(), wall.n_triangles(),
                    result.mesh.n_triangles(), r.min_angle * k_degrees, r.angle_quantile_1 * k_degrees, r.mean_radius_ratio,
                    static_cast<long long>(r.n_slivers), r.to_input.max / r.length, r.from_input.max / r.length, static_cast<long long>(r.n_kept), seconds,
                    static_cast<double>(result.mesh.n_triangles()) / seconds);
        std::fprintf(stderr, "%s\n%s\n", path.filename().c_str(), to_text(r).c_str());
        for (const StageTime& time : context.times()) std::fprintf(stderr, "  %s %.2f s\n", time.stage.c_str(), time.seconds);
        if (!out.empty()) io::write_surface_file(result.mesh, out / (path.stem().string() + ".stl"), context);
      } catch (const Error& error) {
        std::printf("| %s | %s |\n", path.filename().c_str(), error.what());
      }
      std::fflush(stdout);
    }
  }
}
