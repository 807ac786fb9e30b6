#include "surfmesh/model/proximity.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geom/base/parallel.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {
namespace {

/// Two faces face each other if their normals are opposite within 30 degrees. The sides of a wider groove do not form a gap.
constexpr double k_facing_cosine = 0.866;
/// Relative to the length of a ray: nearer hits are ignored, because they are the curved surface itself.
constexpr double k_start = 1e-6;

struct NearFacet {
  std::array<Point, 3> p;
  Vec3 normal;  ///< normal, outwards
  FaceId face;
};

/// Returns the triangles of cells whose corners are inside the border. A cell that the border cuts contributes the half that is inside.
std::vector<NearFacet> facets_of(const Model& model, const SurfaceSizes& field) {
  std::vector<NearFacet> facets;
  for (const FaceId f : model.faces.ids()) {
    const FaceGrid& grid = field.grid(f);
    if (grid.empty()) continue;
    for (const FaceGridCell& cell : grid.cells()) {
      if (!cell.is_used) continue;
      for (const std::array<std::size_t, 3>& k : {std::array<std::size_t, 3>{0, 1, 3}, std::array<std::size_t, 3>{0, 3, 2}}) {
        NearFacet facet{{grid.nodes()[cell.nodes[k[0]]].point, grid.nodes()[cell.nodes[k[1]]].point, grid.nodes()[cell.nodes[k[2]]].point}, {}, f};
        const Vec3 normal = cross(facet.p[1] - facet.p[0], facet.p[2] - facet.p[0]);
        if (!(norm2(normal) > 0.0)) continue;
        facet.normal = (model.faces[f].is_reversed ? -1.0 : 1.0) * normalized(normal);
        if (std::all_of(k.begin(), k.end(), [&](std::size_t i) { return grid.nodes()[cell.nodes[i]].is_inside; })) facets.push_back(facet);
      }
    }
  }
  return facets;
}

/// Returns the length along the unit direction `way` from p to a facet, if it is at most `reach`.
std::optional<double> hit(const Point& p, const Vec3& way, double reach, const NearFacet& facet) {
  const double across = dot(way, facet.normal);
  if (across == 0.0) return std::nullopt;
  const double t = dot(facet.p[0] - p, facet.normal) / across;
  if (!(t > k_start * reach && t < reach)) return std::nullopt;
  const Point q = p + t * way;
  double low = 0.0, high = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = dot(cross(facet.p[(k + 1) % 3] - facet.p[k], q - facet.p[k]), facet.normal);
    low = std::min(low, side);
    high = std::max(high, side);
  }
  if (low < 0.0 && high > 0.0) return std::nullopt;
  return t;
}

/// Adds sources of the same size at points all over a facet, spaced by about that size.
void add_over(const NearFacet& facet, const SizePoint& source, std::vector<SizePoint>& sources) {
  constexpr double k_most = 32.0;
  const double longest = std::max({distance(facet.p[0], facet.p[1]), distance(facet.p[1], facet.p[2]), distance(facet.p[2], facet.p[0])});
  const double n = std::clamp(std::ceil(longest / source.size), 1.0, k_most);
  for (double i = 0.5; i < n; i += 1.0)
    for (double k = 0.5; i + k <= n; k += 1.0)
      sources.push_back({facet.p[0] + (i / n) * (facet.p[1] - facet.p[0]) + (k / n) * (facet.p[2] - facet.p[0]), source.size});
}

}  // namespace

bool looks_for_gaps(const SurfaceMeshOptions& options) { return options.sizes.gap_cells > 0.0 || !is_automatic(options.sizes.thickness_factor); }

void add_gap_sources(const Model& model, const SurfaceSizes& field, const SurfaceMeshOptions& options, ModelSizes& sizes, const RunContext& context) {
  if (!looks_for_gaps(options)) return;
  const std::vector<NearFacet> facets = facets_of(model, field);
  std::vector<Box> boxes(facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (const Point& p : facets[i].p) boxes[i].add(p);
  const BoxTree tree(boxes, context);
  struct Found {
    FaceId other;
    SizePoint own, opposite;
  };
  std::vector<std::vector<Found>> found(facets.size());
  // The size required by a gap is share * width. Gaps are ignored if that size exceeds the largest edge.
  const double share_of_gap = options.sizes.gap_cells > 0.0 ? 1.0 / (options.sizes.gap_cells * options.sizes.refinement) : 0.0;
  const double share_of_part = is_automatic(options.sizes.thickness_factor) ? 0.0 : options.sizes.thickness_factor / options.sizes.refinement;
  parallel_for(
      context, facets.size(),
      [&](std::size_t i) {
        const NearFacet& from = facets[i];
        const Point middle = (from.p[0] + from.p[1] + from.p[2]) / 3.0;
        const FaceSizes& own = sizes.faces[from.face];
        for (const auto& [share, way] : {std::pair(share_of_gap, from.normal), std::pair(share_of_part, -1.0 * from.normal)}) {
          if (share == 0.0) continue;
          const double reach = own.max_edge / share;
          Box box;
          box.add(middle);
          box.add(middle + reach * way);
          double nearest = reach;
          std::uint32_t at = 0;
          tree.for_each_overlap(box, [&](std::uint32_t k) {
            if (dot(facets[k].normal, from.normal) > -k_facing_cosine) return true;
            const std::optional<double> t = hit(middle, way, reach, facets[k]);
            if (t && (*t < nearest || (*t == nearest && k < at))) {
              nearest = *t;
              at = k;
            }
            return true;
          });
          if (nearest >= reach) continue;
          const FaceSizes& other = sizes.faces[facets[at].face];
          found[i].push_back({facets[at].face,
                              {middle, std::max(own.limits.min_edge, share * nearest)},
                              {middle + nearest * way, std::max(other.limits.min_edge, share * nearest)}});
        }
      },
      256);
  Column<FaceId, std::vector<SizePoint>> sources(model.faces.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (const Found& f : found[i]) {
      add_over(facets[i], f.own, sources[facets[i].face]);
      sources[f.other].push_back(f.opposite);
    }
  for (const auto& list : sources) sizes.sources.insert(sizes.sources.end(), list.begin(), list.end());
  for (const FaceId f : model.faces.ids()) sizes.local.set_sources(f, sources[f], context);
}

}  // namespace sterna::surfmesh
