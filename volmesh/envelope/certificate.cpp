#include "volmesh/envelope/certificate.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

Point centre(const std::array<Point, 3>& p) { return (p[0] + p[1] + p[2]) / 3.0; }

/// Returns the smallest Jacobian over the corners of a tetrahedron, scaled by the three edges at the corner.
double tet_quality(const std::array<Point, 4>& p) {
  const double volume6 = 6.0 * tet_volume(p[0], p[1], p[2], p[3]);
  double worst = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double lengths = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) lengths *= distance(p[i], p[j]);
    worst = std::min(worst, lengths > 0.0 ? volume6 / lengths : 0.0);
  }
  return worst;
}

struct MacroVerdict {
  bool is_cell = true;
  bool is_valid = true;
  double quality = 1.0;
  const char* kind = "wedge";
};

/// Tests a macro-element. Uses the exact test of the cell type that results from its collapsed corners, without any margin.
MacroVerdict judge(const LayerBase& base, const EnvelopeShape& shape, TriangleId t) {
  const TriangleVertices& v = base.wall.triangles[t];
  std::array<Point, 3> low, top;
  std::array<bool, 3> is_down{};
  int n_down = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = base.wall.points[v[k]];
    top[k] = shape.point(base.wall, v[k]);
    is_down[k] = shape.is_collapsed(v[k]);
    n_down += is_down[k] ? 1 : 0;
  }
  if (n_down == 3) return {.is_cell = false};
  if (n_down == 0) {
    const WedgePoints p = {low[0], low[1], low[2], top[0], top[1], top[2]};
    return {.is_valid = is_wedge_valid(p), .quality = wedge_quality(p)};
  }
  std::size_t a = 0;
  while (is_down[a] != (n_down == 1)) ++a;
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  if (n_down == 2) {
    const std::array<Point, 4> p = {low[a], low[b], low[c], top[a]};
    return {.is_valid = is_tet_valid(p), .quality = tet_quality(p), .kind = "tet"};
  }
  // The base has the corners b, top b, top c and c; the apex is a.
  const std::array<Point, 5> p = {low[b], top[b], top[c], low[c], low[a]};
  double quality = 1.0;
  for (std::size_t k = 0; k < 4; ++k) quality = std::min(quality, tet_quality({p[k], p[(k + 1) % 4], p[(k + 3) % 4], p[4]}));
  return {.is_valid = is_pyramid_valid(p), .quality = quality, .kind = "pyramid"};
}

struct MacroCount {
  std::int64_t n = 0, n_invalid = 0;
  TriangleId worst;
  MacroVerdict verdict;

  void add(const MacroVerdict& other, TriangleId t) {
    if (!other.is_cell) return;
    ++n;
    n_invalid += other.is_valid ? 0 : 1;
    if (worst.is_valid() && other.quality >= verdict.quality) return;
    worst = t;
    verdict = other;
  }
};

std::string describe(const BoundaryCrossing& pair) {
  return std::string(to_string(pair[0].part)) + " triangle " + std::to_string(pair[0].index) + " crosses " + std::string(to_string(pair[1].part)) +
         " triangle " + std::to_string(pair[1].index);
}

std::string in_short(const WorstElement& worst) {
  char number[32];
  std::snprintf(number, sizeof number, "%.3g", worst.quality);
  return "worst " + std::string(number) + " at " + format_point(worst.location);
}

}  // namespace

std::int64_t require_clear_input(Collider& collider, const RunContext& context) {
  const std::vector<BoundaryCrossing> crossings = collider.fixed_crossings(context);
  if (crossings.empty()) return collider.n_pairs();
  const bool is_outer = std::any_of(crossings.begin(), crossings.end(), [](const BoundaryCrossing& pair) { return pair[1].part == BoundaryPart::outer; });
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = "checking wall and outer boundary before the layer grows",
                 .problem = std::to_string(crossings.size()) + " pairs of triangles intersect",
                 .n_locations = static_cast<std::int64_t>(crossings.size()),
                 .hint = is_outer ? "the outer boundary must enclose the wall with a margin: make the outer boundary larger"
                                  : "the wall must be free of self-intersections: use `sterna info` and the stitching options to find and repair them"};
  for (std::size_t i = 0; i < std::min(crossings.size(), k_max_locations); ++i)
    info.locations.push_back({centre(collider.corners_of(crossings[i][0])), describe(crossings[i])});
  for (const BoundaryCrossing& pair : crossings) {
    for (const BoundaryTriangle& triangle : pair) {
      const std::uint32_t next = static_cast<std::uint32_t>(info.geometry.points.size());
      for (const Point& p : collider.corners_of(triangle)) info.geometry.points.push_back(p);
      info.geometry.triangles.push_back({next, next + 1, next + 2});
    }
  }
  throw Error(std::move(info));
}

TestedEnvelope certify_envelope(const LayerBase& base, Collider& collider, const EnvelopeShape& envelope, const RunContext& context) {
  TestedEnvelope certificate;
  collider.move_top(envelope, context);
  certificate.n_crossings = static_cast<std::int64_t>(collider.crossings(context).size());
  certificate.n_pairs = collider.n_pairs();
  certificate.n_triangles = collider.n_triangles();
  certificate.n_swallowings = static_cast<std::int64_t>(collider.swallowings(envelope).size());
  certificate.clear = ClearProof(certificate.n_crossings == 0 && certificate.n_swallowings == 0);

  const MacroCount macros = parallel_reduce(
      context, base.wall.n_triangles(), MacroCount{},
      [&](std::size_t begin, std::size_t end) {
        MacroCount count;
        for (std::size_t i = begin; i < end; ++i) count.add(judge(base, envelope, TriangleId(i)), TriangleId(i));
        return count;
      },
      [](MacroCount all, const MacroCount& more) {
        if (more.worst.is_valid()) {
          const std::int64_t n = all.n + more.n, n_invalid = all.n_invalid + more.n_invalid;
          all.add(more.verdict, more.worst);
          all.n = n;
          all.n_invalid = n_invalid;
        }
        return all;
      });
  certificate.n_macro_elements = macros.n;
  certificate.n_invalid_macro_elements = macros.n_invalid;
  if (macros.worst.is_valid())
    certificate.worst_macro_element = {macros.verdict.quality, centre(corners(base.wall, macros.worst)),
                                       macros.verdict.kind + (" on wall triangle " + std::to_string(macros.worst.value()))};
  return certificate;
}

void require_proved(const EnvelopeCertificate& certificate) {
  if (certificate.is_proved()) return;
  throw Error({.code = ErrorCode::envelope_failed,
               .attempted = "proving the layer",
               .problem = std::to_string(certificate.n_crossings) + " crossing pairs of boundary triangles, " + std::to_string(certificate.n_swallowings) +
                          " surfaces within a layer, " + std::to_string(certificate.n_invalid_macro_elements) + " invalid macro-elements, " +
                          std::to_string(certificate.n_invalid_layer_cells) + " invalid cells of the layer",
               .locations = {{certificate.worst_macro_element.location, "worst macro-element: " + certificate.worst_macro_element.what},
                             {certificate.worst_layer_cell.location, "worst cell: " + certificate.worst_layer_cell.what}},
               .hint = "report this surface"});
}

std::string to_text(const EnvelopeCertificate& certificate) {
  std::string text = (certificate.is_proved() ? "proved: " : "NOT PROVED: ") + std::to_string(certificate.n_triangles) + " boundary triangles, " +
                     std::to_string(certificate.n_crossings) + " crossings in " + std::to_string(certificate.n_pairs) + " pairs; " +
                     std::to_string(certificate.n_macro_elements) + " macro-elements, " + std::to_string(certificate.n_invalid_macro_elements) + " invalid, " +
                     in_short(certificate.worst_macro_element);
  if (certificate.n_layer_cells > 0)
    text += "; " + std::to_string(certificate.n_layer_cells) + " cells, " + std::to_string(certificate.n_invalid_layer_cells) + " invalid, " +
            in_short(certificate.worst_layer_cell);
  return text;
}

}  // namespace sterna::volmesh
