#include "surfmesh/model/local_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/error.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {
namespace {

/// Strips beside tips: their widths as fractions of the span, and their factors (docs/method/surface.md, "Factors on wings").
struct Strip {
  double width, factor;
};
constexpr std::array<Strip, 2> k_strips{{{0.03, 0.4}, {0.06, 0.6}}};
/// Number of segments for the samples of an edge; few are needed, because leading edges bend little.
constexpr std::size_t k_lines_of_edge = 8;
/// Cosine between the normals of two faces above which their edge is smooth.
constexpr double k_smooth_cosine = 0.5;

double distance_to(const std::vector<WingFactors::Line>& lines, const Point& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& line : lines) nearest = std::min(nearest, distance_to_segment(p, line.a, line.b));
  return nearest;
}

/// Smooth step: 0 at 0, and 1 from 1 on; twice differentiable.
double quintic(double t) { return t >= 1.0 ? 1.0 : t * t * t * (10.0 - 15.0 * t + 6.0 * t * t); }

void add_lines(const EdgeSamples& edge, std::vector<WingFactors::Line>& lines) {
  const std::size_t n = edge.samples.size();
  if (n < 2) return;
  const std::size_t step = std::max<std::size_t>(1, (n - 1 + k_lines_of_edge - 1) / k_lines_of_edge);
  for (std::size_t i = 0; i + 1 < n; i += step) lines.push_back({edge.samples[i].point, edge.samples[std::min(n - 1, i + step)].point});
}

/// Returns the outward normal beside the middle of an edge; zero if there is none.
Vec3 normal_beside(const Model& model, const EdgeUseLocation& location, const EdgeSamples& edge) {
  const ModelFace& face = model.faces[location.face];
  const SurfaceDerivatives d =
      face.surface->derivatives(face.borders[location.border][location.location].parameter->point(edge.samples[edge.samples.size() / 2].t));
  const Vec3 normal = cross(d.du, d.dv);
  return norm2(normal) > 0.0 && is_finite(normal) ? (face.is_reversed ? -1.0 : 1.0) * normalized(normal) : Vec3{};
}

}  // namespace

double WingFactors::operator()(const Point& p, double leading_factor, double trailing_factor, bool has_strips) const {
  double factor = 1.0;
  if (!leading.empty() && !trailing.empty() && (leading_factor != 1.0 || trailing_factor != 1.0)) {
    const double to_leading = distance_to(leading, p), to_trailing = distance_to(trailing, p);
    // Fraction of the chord. A quarter of the perimeter of the section is half of the chord.
    const double share = to_leading + to_trailing > 0.0 ? to_leading / (to_leading + to_trailing) : 0.0;
    factor = std::min(leading_factor + (1.0 - leading_factor) * quintic(2.0 * share), trailing_factor + (1.0 - trailing_factor) * quintic(2.0 * (1.0 - share)));
  }
  if (!has_strips || tips.empty()) return factor;
  const double to_tip = distance_to(tips, p);
  for (const Strip& strip : k_strips)
    if (to_tip < strip.width * span) return std::min(factor, strip.factor);
  return factor;
}

Column<ComponentId, std::shared_ptr<WingFactors>> find_wings(const Model& model, const Column<EdgeId, EdgeSamples>& edges) {
  Column<ComponentId, std::shared_ptr<WingFactors>> wings(model.components.size());
  Column<ComponentId, Box> boxes(model.components.size());
  for (const ComponentId c : model.components.ids())
    if (model.components[c].kind == ComponentKind::wing || model.components[c].kind == ComponentKind::pylon) wings[c] = std::make_shared<WingFactors>();
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  const auto role_of = [&](const EdgeUseLocation& location) { return model.faces[location.face].role; };
  const auto is_skin = [&](const EdgeUseLocation& location) {
    return role_of(location) == FaceRole::upper || role_of(location) == FaceRole::lower || role_of(location) == FaceRole::control;
  };
  struct Sharp {
    EdgeId edge;
    double x;
  };
  Column<ComponentId, std::vector<Sharp>> sharp(model.components.size());
  for (const EdgeId e : model.edges.ids()) {
    if (uses[e].empty() || edges[e].samples.empty()) continue;
    for (const EdgeUseLocation& location : uses[e]) {
      const ComponentId c = model.faces[location.face].component;
      if (!c.is_valid() || !wings[c]) continue;
      for (const EdgeSample& s : edges[e].samples) boxes[c].add(s.point);
      // An edge is the border of a tip or a base only if the face on its other side has another role.
      const bool is_border =
          std::any_of(uses[e].begin(), uses[e].end(), [&](const EdgeUseLocation& other) { return is_skin(other) && model.faces[other.face].component == c; });
      if (is_border && role_of(location) == FaceRole::tip) add_lines(edges[e], wings[c]->tips);
      if (is_border && role_of(location) == FaceRole::trailing_edge) add_lines(edges[e], wings[c]->trailing);
    }
    if (uses[e].size() != 2 || !is_skin(uses[e][0]) || !is_skin(uses[e][1])) continue;
    const ComponentId c = model.faces[uses[e][0].face].component;
    const FaceRole a = role_of(uses[e][0]), b = role_of(uses[e][1]);
    if (!c.is_valid() || !wings[c] || model.faces[uses[e][1].face].component != c || a == b) continue;
    if (dot(normal_beside(model, uses[e][0], edges[e]), normal_beside(model, uses[e][1], edges[e])) > k_smooth_cosine) add_lines(edges[e], wings[c]->leading);
    else sharp[c].push_back({e, edges[e].samples[edges[e].samples.size() / 2].point.x});
  }
  for (const ComponentId c : model.components.ids()) {
    if (!wings[c]) continue;
    const bool has_blunt = !wings[c]->trailing.empty(), has_round = !wings[c]->leading.empty();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Sharp& s : sharp[c]) {
      low = std::min(low, s.x);
      high = std::max(high, s.x);
    }
    for (const Sharp& s : sharp[c]) {
      const bool is_leading = has_blunt || (!has_round && s.x < 0.5 * (low + high));
      add_lines(edges[s.edge], is_leading ? wings[c]->leading : wings[c]->trailing);
    }
    if (!boxes[c].empty()) wings[c]->span = std::max(boxes[c].max.y - boxes[c].min.y, boxes[c].max.z - boxes[c].min.z);
  }
  return wings;
}

LocalSizes::LocalSizes(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, const SpaceSizes& requested, double refinement)
    : faces_(model.faces.size()), regions_(requested.regions), function_(requested.function), refinement_(refinement), growth_(sizes.growth * refinement) {
  const bool has_factors = std::any_of(sizes.faces.begin(), sizes.faces.end(),
                                       [](const FaceSizes& f) { return f.leading_factor != 1.0 || f.trailing_factor != 1.0 || f.has_tip_strips; });
  Column<ComponentId, std::shared_ptr<WingFactors>> wings(model.components.size());
  if (has_factors) wings = find_wings(model, edges);
  for (const FaceId f : model.faces.ids()) {
    const FaceSizes& face = sizes.faces[f];
    const ComponentId c = model.faces[f].component;
    faces_[f] = {face.max_edge, face.leading_factor, face.trailing_factor, face.has_tip_strips, c.is_valid() ? wings[c] : nullptr, nullptr};
  }
}

void LocalSizes::set_sources(FaceId f, const std::vector<SizePoint>& sources, const RunContext& context) {
  if (!sources.empty()) faces_[f].sources = std::make_shared<const BackgroundSizes>(sources, growth_ / refinement_, faces_[f].max_edge, context);
}

double LocalSizes::operator()(FaceId f, const Point& p) const {
  const OfFace& face = faces_[f];
  double size = face.max_edge;
  if (face.wing) size *= (*face.wing)(p, face.leading, face.trailing, face.has_strips);
  if (regions_) size = std::min(size, regions_(p, growth_) / refinement_);
  if (face.sources) size = (*face.sources)(p, size);
  if (!function_) return size;
  const double by_function = function_(p);
  if (!(by_function > 0.0)) {
    ErrorInfo info{.code = ErrorCode::bad_argument,
                   .attempted = "meshing the model's surface",
                   .problem = "the size function returns " + std::to_string(by_function) + " m; edge lengths must be positive"};
    info.locations.push_back({p, "here"});
    throw Error(std::move(info));
  }
  return std::min(size, by_function / refinement_);
}

bool LocalSizes::is_level_within(FaceId f, const Point& p, double reach) const {
  const OfFace& face = faces_[f];
  if (face.wing || function_) return false;
  if (regions_ && regions_(p, growth_) / refinement_ - growth_ / refinement_ * reach < face.max_edge) return false;
  return !face.sources || (*face.sources)(p, face.max_edge, reach) >= face.max_edge;
}

}  // namespace sterna::surfmesh
