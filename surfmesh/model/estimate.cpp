#include "surfmesh/model/estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "geom/base/error.h"
#include "geom/math/constants.h"

namespace sterna::surfmesh {
namespace {

constexpr const char* k_estimate_attempt = "meshing the model's surface";
constexpr std::size_t k_shown_faces = 5;
/// The mesh may have fewer triangles than estimated by up to this factor if it does not reach its target sizes.
constexpr double k_surely = 1.5;

std::string rounded(double n) {
  char text[32];
  std::snprintf(text, sizeof text, n < 1e6 ? "%.0f" : "%.2g", n);
  return text;
}

Point location_on(const Model& model, const Column<EdgeId, EdgeSamples>& edges, FaceId f) {
  for (const Border& border : model.faces[f].borders)
    for (const EdgeUse& use : border)
      if (const auto& samples = edges[use.edge].samples; !samples.empty()) return samples[samples.size() / 2].point;
  return model.corners[model.edges[model.faces[f].borders.front().front().edge].start].point;
}

}  // namespace

double estimated_triangles(const ModelSizes& sizes, FaceId face) {
  const FaceSizes& target = sizes.faces[face];
  double n = 0.0;
  target.curvature->for_each_cell([&](double by_curvature, double area) {
    const double size = std::min(by_curvature, target.max_edge);
    n += area / (k_equilateral_area * size * size);
  });
  return n;
}

void check_estimate(const Model& model, const ModelSizes& sizes, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options) {
  struct Entry {
    double n;
    FaceId face;
  };
  std::vector<Entry> entries;
  double total = 0.0;
  for (const FaceId f : model.faces.ids()) {
    double n = estimated_triangles(sizes, f), cuts = 0.0;
    // A face has at least as many triangles as it has border edges, minus two.
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border) cuts += edges[use.edge].length / sizes.faces[f].max_edge;
    n = std::max(n, cuts);
    entries.push_back({n, f});
    total += n;
  }
  if (total <= k_surely * options.sizes.max_triangles) return;
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.n > b.n; });
  ErrorInfo info{.code = ErrorCode::overflow, .attempted = k_estimate_attempt};
  info.problem = "the target sizes require about " + rounded(total) + " triangles; max_triangles is " + std::to_string(options.sizes.max_triangles);
  info.n_locations = static_cast<std::int64_t>(entries.size());
  for (std::size_t i = 0; i < std::min(k_shown_faces, entries.size()); ++i) {
    const FaceId f = entries[i].face;
    char size[32];
    std::snprintf(size, sizeof size, "%.3g", sizes.faces[f].max_edge);
    info.locations.push_back({location_on(model, edges, f), "\"" + model.faces[f].name + "\" (face " + std::to_string(f.value()) + "): about " +
                                                                rounded(entries[i].n) + " with edges of " + size + " m at most"});
  }
  info.hint = "a larger max_edge, min_edge or curvature_angle; check the units of the model";
  throw Error(std::move(info));
}

void check_band_estimate(const Model& model, const WingBands& bands, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options) {
  for (const EdgeId e : model.edges.ids()) {
    if (!bands.edges[e]) continue;
    // A column has two triangles in each row on each side.
    const double n = 2.0 * edges[e].length / bands.edges[e]->longest;
    if (n <= options.sizes.max_triangles) continue;
    char first[32];
    std::snprintf(first, sizeof first, "%.3g", bands.edges[e]->first);
    const Point location = edges[e].samples[edges[e].samples.size() / 2].point;
    throw Error({.code = ErrorCode::overflow,
                 .attempted = k_estimate_attempt,
                 .problem = "a band with a first cell of " + std::string(first) + " m requires more than " + rounded(n) + " triangles; max_triangles is " +
                            std::to_string(options.sizes.max_triangles),
                 .locations = {{location, bands.edges[e]->kind == BandKind::leading ? "leading edge" : "trailing edge"}},
                 .hint = "a larger chordwise or stretch; check the units of the model"});
  }
}

void check_count(const SurfaceMesh& mesh, const SurfaceMeshOptions& options) {
  const std::size_t n = mesh.mesh.n_triangles();
  if (n == 0)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_estimate_attempt,
                 .problem = "no triangle is left: edges and faces of the model are shorter than a twentieth of min_edge and were removed",
                 .hint = "a smaller min_edge or max_edge; check the units of the model"});
  if (n <= static_cast<std::size_t>(options.sizes.max_triangles)) return;
  throw Error({.code = ErrorCode::overflow,
               .attempted = k_estimate_attempt,
               .problem = std::to_string(n) + " triangles are more than max_triangles, " + std::to_string(options.sizes.max_triangles),
               .hint = "a larger max_edge, min_edge or curvature_angle, or a larger max_triangles"});
}

}  // namespace sterna::surfmesh
