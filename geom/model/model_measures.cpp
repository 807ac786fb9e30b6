#include "geom/model/model_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "geom/model/face_quadrature.h"

namespace sterna {
namespace {

constexpr double k_far = std::numeric_limits<double>::infinity();

class BodySum {
 public:
  void add(const FaceMeasures& face) {
    ++n_faces_;
    area_ += face.area;
    area_moment_ += face.area_moment;
    const auto wider = [](const Point& a, const Point& b, const auto& pick) { return Point{pick(a.x, b.x), pick(a.y, b.y), pick(a.z, b.z)}; };
    low_ = wider(low_, face.box.min, [](double a, double b) { return std::min(a, b); });
    high_ = wider(high_, face.box.max, [](double a, double b) { return std::max(a, b); });
  }
  void add_volume(const FaceMeasures& face) {
    volume_ += face.volume;
    volume_moment_ += face.volume_moment;
  }
  BodyMeasures measures(const std::string& name, bool has_volume, const Point& about) const {
    BodyMeasures result{.name = name, .n_faces = n_faces_, .area = area_, .volume = has_volume ? volume_ : 0.0, .has_volume = has_volume};
    if (has_volume && volume_ != 0.0) result.centre = about + volume_moment_ / volume_;
    else if (area_ > 0.0) result.centre = about + area_moment_ / area_;
    if (n_faces_ > 0) result.box = {low_, high_};
    return result;
  }

 private:
  std::size_t n_faces_ = 0;
  double area_ = 0.0, volume_ = 0.0;
  Vec3 area_moment_, volume_moment_;
  Point low_{k_far, k_far, k_far}, high_{-k_far, -k_far, -k_far};
};

Point middle_of(const Model& model) {
  if (model.corners.size() == 0) return {};
  Vec3 low{k_far, k_far, k_far}, high{-k_far, -k_far, -k_far};
  for (const ModelCorner& corner : model.corners) {
    const Point& p = corner.point;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return 0.5 * (low + high);
}

}  // namespace

FaceMeasures face_measures(const Model& model, FaceId id, const Point& about) {
  const ModelFace& face = model.faces[id];
  const FaceQuadrature q = integrate_face(model, id, about);
  const double sign = face.is_reversed ? -1.0 : 1.0;
  return {q.sums.area, sign * q.sums.volume, sign * q.sums.normal, q.sums.projected, q.sums.area_moment, sign * q.sums.volume_moment, q.error, {q.low, q.high}};
}

SolidMeasures solid_measures(const Model& model, SolidId solid) {
  SolidMeasures sum;
  Vec3 vector;
  const Point about = middle_of(model);
  for (const FaceId f : model.solids[solid].faces) {
    const FaceMeasures m = face_measures(model, f, about);
    sum.area += m.area;
    sum.volume += m.volume;
    vector += m.vector_area;
  }
  sum.open = sum.area > 0.0 ? norm(vector) / sum.area : 0.0;
  return sum;
}

ModelMeasures model_measures(const Model& model, const RunContext& context) {
  ModelMeasures result;
  result.about = middle_of(model);
  result.faces.resize(model.faces.size());
  parallel_for(
      context, model.faces.size(), [&](std::size_t f) { result.faces.raw()[f] = face_measures(model, FaceId(f), result.about); }, 1);

  std::vector<BodySum> components(model.components.size());
  BodySum total;
  for (const FaceId f : model.faces.ids()) {
    components[model.faces[f].component.index()].add(result.faces[f]);
    total.add(result.faces[f]);
  }
  std::vector<bool> has_volume(model.components.size(), true), is_closed(model.faces.size(), false);
  for (const ModelSolid& solid : model.solids) {
    BodySum sum;
    for (const FaceId f : solid.faces) {
      sum.add(result.faces[f]);
      sum.add_volume(result.faces[f]);
    }
    if (solid.is_closed) {
      const ComponentId owner = model.faces[solid.faces.front()].component;
      const bool is_of_one = std::all_of(solid.faces.begin(), solid.faces.end(), [&](FaceId f) { return model.faces[f].component == owner; });
      for (const FaceId f : solid.faces) {
        total.add_volume(result.faces[f]);
        components[owner.index()].add_volume(result.faces[f]);
        is_closed[f.index()] = true;
        if (!is_of_one) has_volume[model.faces[f].component.index()] = false;
      }
    }
    result.solids.push_back(sum.measures(solid.name, solid.is_closed, result.about));
  }
  bool all_closed = model.solids.size() > 0;
  for (const FaceId f : model.faces.ids()) {
    if (is_closed[f.index()]) continue;
    has_volume[model.faces[f].component.index()] = false;
    all_closed = false;
  }
  for (const ComponentId c : model.components.ids())
    result.components.push_back(components[c.index()].measures(model.components[c].name, has_volume[c.index()], result.about));
  result.total = total.measures("total", all_closed, result.about);
  return result;
}

}  // namespace sterna
