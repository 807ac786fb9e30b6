#include "surfmesh/wrap/wrap_input.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/orient.h"
#include "surfmesh/stitch/patches.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {
namespace {

/// Relative to the body length: largest distance of an open boundary from its plane.
constexpr double k_border_off_plane = 1e-3;
/// Fraction of the borders' length that must lie in the plane. A torn half model has many borders elsewhere.
constexpr double k_border_share = 0.2;
/// Largest fraction of the boundary's box that facets in the plane may cover. If they cover more, the plane is a side of the body, and the boundary is a hole
/// in it.
constexpr double k_closed_share = 0.05;
/// Rad, 30 degrees: two lines that meet at a vertex with a larger bend form a corner there.
constexpr double k_corner_bend = 0.52;

double border_length(const TriMesh& mesh, TriangleId t, std::size_t k) {
  const auto c = corners(mesh, t);
  return distance(c[k], c[(k + 1) % 3]);
}

std::vector<Facet> facets_of(const TriMesh& mesh) {
  std::vector<Facet> facets;
  facets.reserve(mesh.n_triangles());
  for (const TriangleVertices& t : mesh.triangles) facets.push_back({t[0].value(), t[1].value(), t[2].value()});
  return facets;
}

/// Orients the facets of each part consistently. Parts are connected across edges with two facets.
void make_one_sense(WorkingSurface& surface, WrapInput& input) {
  const EdgeTable edges(surface.facets, surface.points.size());
  const Orientation orientation = flood_orientation(surface, edges);
  for (std::size_t f = 0; f < surface.n_facets(); ++f)
    if (orientation.is_flipped[f]) std::swap(surface.facets[f][1], surface.facets[f][2]);
  input.part = orientation.component;
  input.n_parts = orientation.n_components;
}

/// The longest open boundary within one plane at the end of the box.
struct PlanarBorder {
  int axis = -1;
  double at = 0.0;
  double length = 0.0;
  bool is_low = true;
};

PlanarBorder find_border(const WrapInput& input, double gap) {
  const Box box = bounding_box(input.mesh);
  const double near = k_border_off_plane * input.length;
  double all = 0.0;
  for (const TriangleId t : input.mesh.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k)
      if (input.is_border[t.index()][k]) all += border_length(input.mesh, t, k);
  PlanarBorder best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool is_low : {true, false}) {
      const double end = is_low ? box.min[axis] : box.max[axis];
      double length = 0.0, weighted = 0.0, facing = 0.0;
      Box extent;
      for (const TriangleId t : input.mesh.triangles.ids()) {
        const auto c = corners(input.mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 &a = c[k], &b = c[(k + 1) % 3];
          if (!input.is_border[t.index()][k] || std::abs(a[axis] - end) > near || std::abs(b[axis] - end) > near) continue;
          const double l = distance(a, b);
          length += l;
          weighted += 0.5 * l * (a[axis] + b[axis]);
          extent.add(a);
          extent.add(b);
        }
        // Facets that lie in the plane close the surface there.
        if (std::abs(c[0][axis] - end) <= near && std::abs(c[1][axis] - end) <= near && std::abs(c[2][axis] - end) <= near)
          facing += triangle_area(c[0], c[1], c[2]);
      }
      if (length < k_border_share * all || extent.empty() || extent.longest_side() <= gap || length <= best.length) continue;
      // An open boundary is a closed loop, so it covers its extent in both directions.
      const Vec3 size = extent.max - extent.min;
      const double enclosed = size[(axis + 1) % 3] * size[(axis + 2) % 3];
      if (length < 1.5 * extent.longest_side() || facing > k_closed_share * enclosed) continue;
      best = {static_cast<int>(axis), weighted / length, length, is_low};
    }
  }
  return best;
}

}  // namespace

std::string wrap_number(double value) { return short_number(value); }

void find_lines(WrapInput& input, double angle) {
  const TriMesh& mesh = input.mesh;
  const std::vector<Facet> facets = facets_of(mesh);
  const EdgeTable edges(facets, mesh.n_vertices());
  input.is_border.assign(facets.size(), {});
  input.lines.clear();
  input.is_border_of_patches.clear();
  input.corners.clear();
  std::map<std::uint32_t, std::vector<std::uint32_t>> ends;  // for each vertex: the other ends of the lines at it
  const double least = std::cos(angle);
  for (const Edge& edge : edges.edges()) {
    const auto sides = edges.at(edge);
    if (sides.size() == 1) {
      input.is_border[sides[0] / 3][sides[0] % 3] = 1;
      continue;
    }
    // Direction from the edge into each facet. With these directions the bend does not depend on the orientation of the facets. An edge with several facets is
    // classified by the sharpest pair.
    bool is_sharp = false, is_patch = false;
    const Vec3 a = mesh.points[VertexId(edge.low)], b = mesh.points[VertexId(edge.high)];
    const auto away = [&](std::uint32_t h) {
      for (const std::uint32_t v : facets[h / 3])
        if (v != edge.low && v != edge.high) {
          const Vec3 p = mesh.points[VertexId(v)] - a, e = normalized(b - a);
          return normalized(p - dot(p, e) * e);
        }
      return Vec3{};
    };
    const Vec3 first = away(sides[0]);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (-dot(first, away(sides[i])) < least) is_sharp = true;
      if (mesh.triangle_patch[TriangleId(sides[i] / 3)] != mesh.triangle_patch[TriangleId(sides[0] / 3)]) is_patch = true;
    }
    if (!is_sharp && !is_patch) continue;
    input.lines.push_back({a, b});
    input.is_border_of_patches.push_back(!is_sharp);
    ends[edge.low].push_back(edge.high);
    ends[edge.high].push_back(edge.low);
  }
  for (const auto& [v, others] : ends) {
    const Vec3 p = mesh.points[VertexId(v)];
    bool is_corner = others.size() != 2;
    if (!is_corner) is_corner = angle_between(p - mesh.points[VertexId(others[0])], mesh.points[VertexId(others[1])] - p) > k_corner_bend;
    if (is_corner) input.corners.push_back(p);
  }
}

WrapInput read_wrap_input(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, WrapReport& report, const RunContext& context) {
  StitchOptions stitch;
  stitch.unit = options.unit;
  StitchReport cleaned;
  WrapInput input;
  WorkingSurface surface = weld_exact(soups, stitch, cleaned);
  for (const SurfaceSoup& soup : soups) report.n_facets_read += static_cast<std::int64_t>(soup.triangles.size());
  drop_degenerate_facets(surface, cleaned);
  // Duplicate facets would count several times in winding numbers, so they are left out.
  {
    std::vector<std::pair<Facet, std::uint32_t>> sorted;
    for (std::uint32_t f = 0; f < surface.n_facets(); ++f) {
      Facet key = surface.facets[f];
      std::sort(key.begin(), key.end());
      sorted.push_back({key, f});
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> is_kept(surface.n_facets(), 1);
    for (std::size_t i = 1; i < sorted.size(); ++i)
      if (sorted[i].first == sorted[i - 1].first) is_kept[sorted[i].second] = 0;
    surface.keep(is_kept);
  }
  for (Vec3& p : surface.points) p = surface.metres(p);
  surface.to_metres = 1.0;
  const Box box = surface.box();
  input.length = surface.facets.empty() ? 0.0 : box.longest_side();
  for (std::size_t f = 0; f < surface.n_facets(); ++f) {
    const auto c = surface.corners(f);
    input.area += triangle_area(c[0], c[1], c[2]);
  }
  if (!(input.length > 0.0) || !(input.area > 0.0))
    throw Error({.code = ErrorCode::empty_surface, .attempted = "wrapping", .problem = "no facet of the input has an area"});
  make_one_sense(surface, input);
  input.mesh = make_mesh(surface, clean_patch_names(soups, &report.messages));
  find_lines(input, options.features);
  context.check_stop();
  return input;
}

void mirror_half(WrapInput& input, double gap, WrapReport& report, const RunContext& context) {
  const PlanarBorder border = find_border(input, gap);
  if (border.axis < 0) return;
  const auto axis = static_cast<std::size_t>(border.axis);
  TriMesh& mesh = input.mesh;
  const double near = k_border_off_plane * input.length;
  // Planes at a distance of less than half the tolerance from zero are set to zero.
  const double at = std::abs(border.at) < 0.5 * near ? 0.0 : border.at;
  std::vector<char> is_on_border(mesh.n_vertices(), 0);
  for (const TriangleId t : mesh.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k)
      if (input.is_border[t.index()][k])
        for (const VertexId v : {mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}) is_on_border[v.index()] = 1;
  for (const VertexId v : mesh.points.ids()) {
    double& x = mesh.points[v][axis];
    const bool is_beyond = border.is_low ? x < at : x > at;
    if (!(is_beyond || (is_on_border[v.index()] && std::abs(x - at) <= near))) continue;
    input.half_moved = std::max(input.half_moved, std::abs(x - at));
    x = at;
  }
  const std::size_t n_points = mesh.n_vertices(), n_facets = mesh.n_triangles();
  std::vector<VertexId> image(n_points);
  for (std::size_t v = 0; v < n_points; ++v) {
    Vec3 p = mesh.points[VertexId(std::uint64_t{v})];
    if (p[axis] == at) {
      image[v] = VertexId(std::uint64_t{v});
      continue;
    }
    p[axis] = 2.0 * at - p[axis];
    image[v] = mesh.points.push_back(p);
  }
  for (std::size_t f = 0; f < n_facets; ++f) {
    const TriangleVertices t = mesh.triangles[TriangleId(std::uint64_t{f})];
    mesh.triangles.push_back({image[t[0].index()], image[t[2].index()], image[t[1].index()]});
    mesh.triangle_patch.push_back(mesh.triangle_patch[TriangleId(std::uint64_t{f})]);
    input.part.push_back(input.part[f]);
  }
  input.area *= 2.0;
  input.half_axis = std::string(1, "xyz"[axis]);
  input.half_at = at;
  input.is_half_above = border.is_low;
  report.half_axis = input.half_axis;
  report.half_at = at;
  report.half_moved = input.half_moved;
  report.messages.push_back("half model: open in the plane " + input.half_axis + " = " + short_number(at) + " m (open boundary of " +
                            short_number(border.length) + " m, off the plane by at most " + short_number(input.half_moved) +
                            " m); mirrored, wrapped, and cut in that plane");
  context.check_stop();
}

void turn_parts(WrapInput& input, const TriMesh& around, double reach, const RunContext& context) {
  const TriangleTree tree(around, context);
  const std::size_t n = input.mesh.n_triangles();
  std::vector<double> vote(n, 0.0);
  parallel_for(
      context, n,
      [&](std::size_t f) {
        const auto c = corners(input.mesh, TriangleId(std::uint64_t{f}));
        const Vec3 area = area_vector(c[0], c[1], c[2]);
        const NearestHit hit = tree.nearest((c[0] + c[1] + c[2]) / 3.0, reach);
        if (!hit.triangle.is_valid()) return;
        const auto w = corners(around, hit.triangle);
        vote[f] = dot(area, normalized(area_vector(w[0], w[1], w[2])));
      },
      256);
  std::vector<double> sum(input.n_parts, 0.0), area(input.n_parts, 0.0), volume(input.n_parts, 0.0);
  std::vector<Vec3> centre(input.n_parts);
  for (std::size_t f = 0; f < n; ++f) {
    const auto c = corners(input.mesh, TriangleId(std::uint64_t{f}));
    const double a = triangle_area(c[0], c[1], c[2]);
    sum[input.part[f]] += vote[f];
    area[input.part[f]] += a;
    centre[input.part[f]] += (a / 3.0) * (c[0] + c[1] + c[2]);
  }
  for (std::uint32_t p = 0; p < input.n_parts; ++p)
    if (area[p] > 0.0) centre[p] = centre[p] / area[p];
  for (std::size_t f = 0; f < n; ++f) {
    const auto c = corners(input.mesh, TriangleId(std::uint64_t{f}));
    volume[input.part[f]] += tet_volume(centre[input.part[f]], c[0], c[1], c[2]);
  }
  /// If the result of a vote is below this fraction of the part's area, the votes of its two sides cancel each other.
  constexpr double k_clear_vote = 0.3;
  for (std::size_t f = 0; f < n; ++f) {
    const std::uint32_t p = input.part[f];
    const bool is_inwards = std::abs(sum[p]) > k_clear_vote * area[p] ? sum[p] < 0.0 : volume[p] < 0.0;
    if (!is_inwards) continue;
    TriangleVertices& t = input.mesh.triangles[TriangleId(std::uint64_t{f})];
    std::swap(t[1], t[2]);
    std::swap(input.is_border[f][0], input.is_border[f][2]);
  }
}

}  // namespace sterna::surfmesh
