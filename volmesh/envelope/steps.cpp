#include "volmesh/envelope/steps.h"

#include <algorithm>
#include <array>
#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "volmesh/envelope/global_optimisation.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/keep_distance.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/smooth.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr int k_denoising_sweeps = 3;
constexpr std::array<std::string_view, 7> k_names = {"classified", "initial", "smoothed", "untangled", "unwarped", "retracted", "finished"};

/// Cosine of the angle from a facet's normal beyond which cells along a line are hardly higher than nothing above the facet; and what of the best possible
/// cosine counts where there is no better.
constexpr double k_seen_cosine = 0.2, k_seen_share = 0.85;
/// Of its height, what a line that is set more upright may keep.
constexpr std::array<double, 3> k_upright_heights = {1.0, 0.7, 0.4};
/// Cosine of 75 degrees: columns whose flat cells lean by more get lines that are more upright.
constexpr double k_lean_cosine = 0.26;
constexpr double k_least_upright = 0.1;  ///< of a line's height along the vertex's normal, as in layer_line.h
constexpr std::size_t k_facet_chunk = 256;

/// m, the step along the line at v from the wall to its first node, if it is straight.
Vec3 straight_step(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope, VertexId v) {
  if (envelope.is_collapsed(v)) return {};
  const double upright = std::max(dot(envelope.direction[v], base.vertex_normal[v]), k_least_upright);
  const double room = height_for_first_cell(scale.growth(v), scale.n(v));
  return scale.first_step(v) / upright * std::min(1.0, envelope.height[v] * upright / room) * envelope.direction[v];
}

/// Cosine between a facet's normal and the way from the centre of one flat cell above it to that of the next: corners count by (1 + a_i / (a_1 + a_2 + a_3)) /
/// 4, where a_i are their heights above the facet (growth_law.h).
double column_cosine(const std::array<Vec3, 3>& steps, const Vec3& normal) {
  std::array<double, 3> a{};
  for (std::size_t k = 0; k < 3; ++k) a[k] = std::max(0.0, dot(steps[k], normal));
  const double sum = a[0] + a[1] + a[2];
  if (!(sum > 0.0)) return 1.0;
  Vec3 way;
  for (std::size_t k = 0; k < 3; ++k) way += 0.25 * (1.0 + a[k] / sum) * steps[k];
  return dot(way, normal) / norm(way);
}

/// Of facets above which flat cells lean by more than the angle with the first cosine: the lines that lean by more than the angle with the second one.
std::vector<VertexId> leaning_lines(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope, double of_cells, double of_lines,
                                    const RunContext& context) {
  std::vector<VertexId> lines = parallel_collect<VertexId>(
      context, base.wall.n_triangles(),
      [&](std::size_t begin, std::size_t end, std::vector<VertexId>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleVertices& v = base.wall.triangles[TriangleId(i)];
          const Vec3& normal = base.unit_normal[TriangleId(i)];
          const auto leans = [&](VertexId w) { return !envelope.is_collapsed(w) && dot(envelope.direction[w], normal) < of_cells; };
          if (std::ranges::none_of(v, leans)) continue;  // nor does the mean of lines within a cone
          const auto step = [&](VertexId w) { return straight_step(base, scale, envelope, w); };
          if (column_cosine({step(v[0]), step(v[1]), step(v[2])}, normal) >= of_cells) continue;
          for (const VertexId w : v)
            if (!envelope.is_collapsed(w) && base.fan_of(w) == nullptr && dot(envelope.direction[w], normal) < of_lines) found.push_back(w);
        }
      },
      k_facet_chunk);
  sort_unique(lines);
  return lines;
}

/// Sets lines upright that optimisation has made lean, where the envelope stays valid and clear.
void set_upright(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  for (const double share : k_upright_heights) {
    ShapeChange change;
    for (const VertexId v : leaning_lines(base, scale_of(base, options), envelope, k_lean_cosine, k_seen_cosine, context)) {
      const Vec3 upright = pull_to_facets(base, v, envelope.direction[v], std::min(k_seen_cosine, k_seen_share * base.visibility[v]));
      if (upright == envelope.direction[v]) continue;
      change.vertices.push_back(v);
      change.direction.push_back(upright);
      change.height.push_back(share * envelope.height[v]);
    }
    if (change.vertices.empty()) return;
    apply_where_clear(base, collider, envelope, std::move(change), context);
  }
}

}  // namespace

std::string_view to_string(EnvelopeStep step) { return k_names[static_cast<std::size_t>(step)]; }

EnvelopeStep envelope_step_of(std::string_view text) {
  const auto found = std::find(k_names.begin(), k_names.end(), text);
  if (found == k_names.end())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading an envelope", .problem = "\"" + std::string(text) + "\" is no step of it"});
  return static_cast<EnvelopeStep>(found - k_names.begin());
}

void smooth_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  smooth_heights(base, classes, options, envelope, context);
  // A few sweeps everywhere take out noise; the many sweeps only where lines converge, so that smooth surfaces keep their normals.
  smooth_directions(base, classes, std::min(options.direction_sweeps, k_denoising_sweeps), envelope, context);
  const Column<VertexId, std::uint8_t> concave = concave_region(base, classes, context);
  smooth_directions(base, classes, options.direction_sweeps, envelope, context, &concave);
  smooth_tangled_regions(base, classes, options, envelope, context);
  keep_inside(base, options, envelope, context);
}

void untangle_step(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  untangle_edges(base, options, envelope, context);
}

void unwarp_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  unwarp(base, options, HeightLimit::warp, envelope, context);
  smooth_envelope(base, classes, options.envelope_sweeps, envelope, context);
  regrow(base, envelope, context);
}

void retract_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  share_gaps(base, options, collider, envelope, context);
  retract_collisions(base, options, collider, envelope, context);
  regrow_clear(base, collider, envelope, context);
  keep_distance(base, options, collider, envelope, context);
}

void optimise_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  optimise_globally(base, options, collider, envelope, context);
  if (options.optimiser != "none") {
    regrow_clear(base, collider, envelope, context);
    keep_distance(base, options, collider, envelope, context);
  }
  if (has_common_growth(options)) set_upright(base, options, collider, envelope, context);
  seat_on_surfaces(base, options, &collider, envelope, context);
}

}  // namespace sterna::volmesh
