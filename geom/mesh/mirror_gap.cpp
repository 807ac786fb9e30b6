#include "geom/mesh/mirror_gap.h"

#include <algorithm>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/mesh/bvh.h"

namespace sterna {

MirrorGap mirror_gap(const TriMesh& surface, std::size_t axis, double at, double share, const RunContext& context) {
  Column<VertexId, double> longest(surface.n_vertices(), 0.0);
  for (const TriangleVertices& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = distance(surface.points[t[k]], surface.points[t[(k + 1) % 3]]);
      for (const VertexId v : {t[k], t[(k + 1) % 3]}) longest[v] = std::max(longest[v], length);
    }
  const TriangleTree tree(surface, context);
  Column<VertexId, double> gap(surface.n_vertices(), 0.0);
  parallel_for(context, surface.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    if (longest[v] == 0.0) return;  // no triangle has this vertex
    Point image = surface.points[v];
    image[axis] = 2.0 * at - image[axis];
    const double d = tree.nearest(image).distance;
    if (d > share * longest[v]) gap[v] = d;
  });
  MirrorGap worst;
  for (const VertexId v : surface.points.ids())
    if (gap[v] > worst.distance) worst = {gap[v], surface.points[v]};
  return worst;
}

std::string describe_asymmetry(const MirrorGap& gap, const std::string& plane) {
  return "half at " + plane + ": the omitted side is not the mirror image of the kept side; the image of " + format_point(gap.at) + " is " +
         in_metres(gap.distance, 3) + " from the surface. A half model represents both sides: if they are meant to differ, mesh the whole model";
}

}  // namespace sterna
