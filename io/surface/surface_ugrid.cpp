// Reads UGRID (AFLR3) as a surface: counts, coordinates, triangles, quads and their patch numbers. For volume cells only completeness is checked.
#include "io/surface/surface_ugrid.h"

#include <array>
#include <map>
#include <string>
#include <vector>

#include "io/grammar/ugrid_source.h"
#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/mesh/surface_boundary.h"
#include "io/mesh/surface_builder.h"
#include "io/volume/volume_ugrid.h"

namespace sterna::io {
namespace {

std::vector<std::uint32_t> read_corners(UgridSource& source, std::uint64_t n, std::size_t size, std::uint64_t n_points, const RunContext& context) {
  source.require_integers(n, size, "corners of the faces");
  std::vector<std::uint32_t> corners(n * size);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    corners[i] = source.node(n_points);
  }
  return corners;
}

}  // namespace

SurfaceSoup read_ugrid(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  UgridSource source(buffer, ugrid_variant(path));
  source.require_integers(7, 1, "the seven counts of a UGRID file");
  std::array<std::uint64_t, 7> counts;
  for (std::uint64_t& count : counts) count = source.count("the number of points, faces or cells");
  const auto [n_points, n_triangles, n_quads] = std::array{counts[0], counts[1], counts[2]};
  SurfaceBuilder builder(buffer.source);
  source.require_reals(n_points, 3, "coordinates of the points");
  builder.reserve_points(n_points);
  for (std::uint64_t i = 0; i < n_points; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    builder.add_point(source.any_point());
  }
  const std::vector<std::uint32_t> triangles = read_corners(source, n_triangles, 3, n_points, context);
  const std::vector<std::uint32_t> quads = read_corners(source, n_quads, 4, n_points, context);
  source.require_integers(n_triangles + n_quads, 1, "patch numbers of the faces");
  const std::map<std::int64_t, UgridPatch> patches = read_mapbc(path, context);
  const auto set_patch = [&] {
    const std::int64_t id = source.integer("the patch number of a face");
    const auto found = patches.find(id);
    builder.set_patch(found == patches.end() || found->second.name.empty() ? numbered_patch(id) : found->second.name);
  };
  builder.reserve_polygons(n_triangles + n_quads);
  for (std::size_t i = 0; i < n_triangles; ++i) {
    set_patch();
    builder.add_triangle(triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]);
  }
  for (std::size_t i = 0; i < n_quads; ++i) {
    set_patch();
    builder.add_polygon(std::span(quads).subspan(4 * i, 4));
  }
  // A file truncated within its volume cells is rejected.
  constexpr std::array<std::size_t, 4> k_cell_corners = {4, 5, 6, 8};
  for (std::size_t kind = 0; kind < k_cell_corners.size(); ++kind) {
    const std::string what = "volume cells of " + std::to_string(k_cell_corners[kind]) + " corners";
    source.require_integers(counts[3 + kind], k_cell_corners[kind], what);
    source.skip_integers(counts[3 + kind] * k_cell_corners[kind], what);
  }
  SurfaceSoup soup = builder.finish(context, true);
  soup.has_names = true;
  soup.n_cells = counts[3] + counts[4] + counts[5] + counts[6];
  return soup;
}

void write_ugrid(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_ugrid(as_boundary(mesh, Winding::turned), path, context);  // the writer turns boundary faces
}

}  // namespace sterna::io
