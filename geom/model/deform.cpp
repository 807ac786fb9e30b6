#include "geom/model/deform.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/model/transformed.h"

namespace sterna {
namespace {

/// Replaces every surface and curve once, so that geometry shared by faces and edges stays shared.
template <class SurfaceMap, class CurveMap>
void replace_geometry(Model& model, const SurfaceMap& map_surface, const CurveMap& map_curve) {
  std::map<const Surface*, SurfacePtr> surfaces;
  for (ModelFace& face : model.faces) {
    auto [location, is_new] = surfaces.try_emplace(face.surface.get());
    if (is_new) location->second = map_surface(face.surface);
    face.surface = location->second;
  }
  std::map<const Curve*, CurvePtr> curves;
  for (ModelEdge& edge : model.edges) {
    if (edge.is_degenerate()) continue;
    auto [location, is_new] = curves.try_emplace(edge.curve.get());
    if (is_new) location->second = map_curve(edge.curve);
    edge.curve = location->second;
  }
  model.shape.reset();  // it represents the old geometry
}

double largest_stretch(const Vec3& x, const Vec3& y, const Vec3& z) {
  Eigen::Matrix3d j;
  j << x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z;
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(j.transpose() * j, Eigen::EigenvaluesOnly).eigenvalues()[2]));
}

void scale_tolerances(Model& model, double factor) {
  for (ModelCorner& corner : model.corners) corner.tolerance *= factor;
  for (ModelEdge& edge : model.edges) edge.tolerance *= factor;
  for (ModelFace& face : model.faces) face.tolerance *= factor;
}

/// Returns parameters at and evenly between the breaks.
std::vector<double> samples_of(Interval range, std::vector<double> stops) {
  stops.insert(stops.begin(), range.from);
  stops.push_back(range.to);
  const int each = std::max(1, k_fold_over_samples / static_cast<int>(stops.size() - 1));
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i)
    for (int k = 0; k < each; ++k) result.push_back(stops[i] + (stops[i + 1] - stops[i]) * k / each);
  result.push_back(range.to);
  return result;
}

/// Returns the parameters that a face uses. They are the box of its outer border, estimated from samples.
ParameterBox used_box(const Model& model, const ModelFace& face) {
  if (face.borders.empty() || face.borders.front().empty()) return face.surface->domain();
  constexpr int k_border_samples = 16;
  Uv low{1e300, 1e300}, high{-1e300, -1e300};
  for (const EdgeUse& use : face.borders.front()) {
    const Interval range = model.edges[use.edge].range;  // the parameter curve may extend beyond it
    for (int i = 0; i <= k_border_samples; ++i) {
      const Uv p = use.parameter->point(range.from + range.length() * i / k_border_samples);
      low = {std::min(low.u, p.u), std::min(low.v, p.v)};
      high = {std::max(high.u, p.u), std::max(high.v, p.v)};
    }
  }
  return {{low.u, high.u}, {low.v, high.v}};
}

struct FaceStretch {
  double largest = 0.0;
  std::vector<std::pair<double, Point>> folded;  ///< determinant, location
};

std::vector<double> inside(const std::vector<double>& breaks, Interval range) {
  std::vector<double> result;
  for (const double b : breaks)
    if (b > range.from && b < range.to) result.push_back(b);
  return result;
}

FaceStretch measure(const Model& model, const ModelFace& face, const SpaceMap& map) {
  const ParameterBox box = used_box(model, face);
  FaceStretch result;
  for (const double u : samples_of(box.u, inside(face.surface->breaks_u(), box.u))) {
    for (const double v : samples_of(box.v, inside(face.surface->breaks_v(), box.v))) {
      const Point p = face.surface->point({u, v});
      const SpaceMapDerivatives d = map.derivatives(p);
      result.largest = std::max(result.largest, largest_stretch(d.dx, d.dy, d.dz));
      if (!(d.determinant() > 0.0)) result.folded.emplace_back(d.determinant(), p);
    }
  }
  return result;
}

/// Rejects a map that folds over on the model's faces; returns the largest stretching.
double check_fold_over(const Model& model, const SpaceMap& map, const RunContext& context) {
  std::vector<FaceStretch> faces(model.faces.size());
  parallel_for(
      context, faces.size(), [&](std::size_t f) { faces[f] = measure(model, model.faces.raw()[f], map); }, 1);
  double stretch = 0.0;
  struct Fold {
    double determinant;
    std::size_t face;
    Point location;
  };
  std::vector<Fold> folds;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    stretch = std::max(stretch, faces[f].largest);
    for (const auto& [determinant, location] : faces[f].folded) folds.push_back({determinant, f, location});
  }
  if (folds.empty()) return stretch;
  std::stable_sort(folds.begin(), folds.end(), [](const Fold& a, const Fold& b) { return a.determinant < b.determinant; });
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = "deforming a model",
                 .problem = "the deformation folds space: the determinant of its Jacobian is " + number_text(folds.front().determinant) + ", must be positive",
                 .n_locations = static_cast<std::int64_t>(folds.size()),
                 .hint = "make displacements smaller, or let them change over a longer distance"};
  constexpr std::size_t k_locations = 5;
  for (std::size_t i = 0; i < std::min(k_locations, folds.size()); ++i)
    info.locations.push_back({folds[i].location, "face " + model.faces.raw()[folds[i].face].name + ", determinant " + number_text(folds[i].determinant)});
  throw Error(std::move(info));
}

}  // namespace

Model transformed(const Model& model, const Transform& t) {
  Model result = model;
  replace_geometry(
      result, [&](const SurfacePtr& s) { return transformed(s, t); }, [&](const CurvePtr& c) { return transformed(c, t); });
  for (ModelCorner& corner : result.corners) corner.point = t.point(corner.point);
  if (t.determinant() < 0.0)
    for (ModelFace& face : result.faces) face.is_reversed = !face.is_reversed;
  if (const double stretch = largest_stretch(t.x, t.y, t.z); stretch != 1.0) scale_tolerances(result, stretch);
  return result;
}

namespace {

/// Returns true unless the match is part of a longer word ("support"); "WingLeft" and "wing_left" are matches.
bool is_word(const std::string& name, std::size_t at, std::size_t size) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  const bool begins = at == 0 || !(is_lower(name[at - 1]) || is_upper(name[at - 1])) || (is_upper(name[at]) && is_lower(name[at - 1]));
  const char last = name[at + size - 1];
  const bool ends = at + size == name.size() || !(is_lower(name[at + size]) || (is_upper(last) && is_upper(name[at + size])));
  return begins && ends;
}

}  // namespace

std::string mirrored_name(const std::string& name) {
  constexpr std::array<std::array<std::string_view, 2>, 6> k_sides = {
      {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}, {"port", "starboard"}, {"Port", "Starboard"}, {"PORT", "STARBOARD"}}};
  for (const auto& [a, b] : k_sides) {
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
      for (std::size_t at = name.find(from); at != std::string::npos; at = name.find(from, at + 1))
        if (is_word(name, at, from.size())) return name.substr(0, at) + std::string(to) + name.substr(at + from.size());
    }
  }
  return name + " mirrored";
}

std::string image_name(const std::string& name) {
  const std::string other = mirrored_name(name);
  return other.starts_with(name) ? name + "Left" : other;
}

Model mirrored(const Model& model, const Point& at, const Vec3& normal, const NameRule& rename) {
  Model result = transformed(model, mirroring(at, normal));
  const auto change = [&](std::string& name) {
    if (!name.empty()) name = rename(name);
  };
  for (Component& component : result.components) change(component.name);
  for (ModelFace& face : result.faces) change(face.name);
  for (ModelSolid& solid : result.solids) change(solid.name);
  for (ModelEdge& edge : result.edges) change(edge.name);
  return result;
}

Model deformed(const Model& model, const SpaceMapPtr& map, const RunContext& context) {
  const double stretch = check_fold_over(model, *map, context);
  Model result = model;
  replace_geometry(
      result, [&](const SurfacePtr& s) { return std::make_shared<DeformedSurface>(s, map); },
      [&](const CurvePtr& c) { return std::make_shared<DeformedCurve>(c, map); });
  for (ModelCorner& corner : result.corners) corner.point = map->point(corner.point);
  if (stretch > 1.0) scale_tolerances(result, stretch);
  return result;
}

}  // namespace sterna
