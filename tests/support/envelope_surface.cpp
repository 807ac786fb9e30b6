#include "tests/support/envelope_surface.h"

#include "geom/base/parallel.h"

namespace sterna::test {

EnvelopeSurface envelope_surface(const volmesh::LayerBase& base, const volmesh::EnvelopeShape& envelope, const RunContext& context) {
  EnvelopeSurface surface;
  const std::size_t n = base.wall.n_vertices();
  surface.points.resize(2 * n);
  surface.triangles.resize(base.wall.n_triangles());
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    surface.points[i] = base.wall.points[v];
    surface.points[n + i] = envelope.point(base.wall, v);
  });
  parallel_for(context, surface.triangles.size(), [&](std::size_t i) {
    const TriangleVertices& v = base.wall.triangles[TriangleId(i)];
    for (std::size_t k = 0; k < 3; ++k) surface.triangles[i][k] = v[k].value() + (envelope.is_collapsed(v[k]) ? 0u : static_cast<std::uint32_t>(n));
  });
  return surface;
}

}  // namespace sterna::test
