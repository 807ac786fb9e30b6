#include "geom/cad/reference_data.h"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>

#include <algorithm>
#include <cmath>

#include "geom/cad/occt_call.h"
#include "geom/cad/occt_shape.h"

namespace sterna::cad {
namespace {

/// What a face adds to a body.
struct FaceShare {
  double area = 0.0;
  Vec3 area_moment;
  Bnd_Box box;
};
struct Volume {
  double volume = 0.0;
  Vec3 moment;
};

Vec3 to_vec(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

FaceShare measure(const TopoDS_Face& face) {
  FaceShare share;
  GProp_GProps area;
  BRepGProp::SurfaceProperties(face.Oriented(TopAbs_FORWARD), area, k_measure_tolerance);
  share.area = std::abs(area.Mass());
  share.area_moment = share.area * to_vec(area.CentreOfMass());
  BRepBndLib::Add(face, share.box, false);
  return share;
}

Volume volume_of(const TopoDS_Shape& solid) {
  GProp_GProps volume;
  BRepGProp::VolumeProperties(solid, volume, k_measure_tolerance);
  return {volume.Mass(), volume.Mass() * to_vec(volume.CentreOfMass())};
}

class BodySum {
 public:
  void add(const FaceShare& share) {
    ++n_faces_;
    area_ += share.area;
    area_moment_ += share.area_moment;
    box_.Add(share.box);
  }
  void add(const Volume& share) {
    volume_ += share.volume;
    volume_moment_ += share.moment;
  }
  BodyMeasures measures(const std::string& name, bool has_volume) const {
    BodyMeasures result{.name = name, .n_faces = n_faces_, .area = area_, .volume = has_volume ? volume_ : 0.0, .has_volume = has_volume};
    if (has_volume && volume_ != 0.0)
      result.centre = volume_moment_ / volume_;
    else if (area_ > 0.0)
      result.centre = area_moment_ / area_;
    if (!box_.IsVoid()) {
      Bnd_Box box = box_;
      box.SetGap(0.0);
      result.box = {to_vec(box.CornerMin()), to_vec(box.CornerMax())};
    }
    return result;
  }

 private:
  std::size_t n_faces_ = 0;
  double area_ = 0.0, volume_ = 0.0;
  Vec3 area_moment_, volume_moment_;
  Bnd_Box box_;
};

}  // namespace

ReferenceData reference_data(const Model& model, const RunContext& context) {
  const std::shared_ptr<const CadShape> shape = shape_of(model, context);
  ReferenceData data;
  run_occt({.attempted = "measuring the model"}, context, [&](const Message_ProgressRange&) {
    std::vector<FaceShare> shares;
    for (const TopoDS_Face& face : shape->content().faces) {
      context.check_stop();
      shares.push_back(measure(face));
      data.faces.push_back({shares.back().area, shares.back().area > 0.0 ? shares.back().area_moment / shares.back().area : Vec3{}});
    }
    std::vector<BodySum> components(model.components.size());
    BodySum total;
    for (const FaceId f : model.faces.ids()) {
      components[model.faces[f].component.index()].add(shares[f.index()]);
      total.add(shares[f.index()]);
    }
    bool all_closed = !model.solids.empty();
    std::vector<bool> has_volume(model.components.size(), true), is_closed(model.faces.size(), false);
    for (const SolidId s : model.solids.ids()) {
      const ModelSolid& solid = model.solids[s];
      BodySum sum;
      for (const FaceId f : solid.faces) sum.add(shares[f.index()]);
      if (solid.is_closed) {
        const Volume volume = volume_of(shape->content().solids[s.index()]);
        sum.add(volume);
        total.add(volume);
        const ComponentId owner = model.faces[solid.faces.front()].component;
        components[owner.index()].add(volume);
        // The parts of a solid of several components have no volume of their own.
        const bool is_of_one = std::all_of(solid.faces.begin(), solid.faces.end(), [&](FaceId f) { return model.faces[f].component == owner; });
        for (const FaceId f : solid.faces) is_closed[f.index()] = true;
        if (!is_of_one)
          for (const FaceId f : solid.faces) has_volume[model.faces[f].component.index()] = false;
      }
      data.solids.push_back(sum.measures(solid.name, solid.is_closed));
    }
    for (const FaceId f : model.faces.ids()) {
      if (is_closed[f.index()]) continue;
      has_volume[model.faces[f].component.index()] = false;
      all_closed = false;
    }
    for (const ComponentId c : model.components.ids()) data.components.push_back(components[c.index()].measures(model.components[c].name, has_volume[c.index()]));
    data.total = total.measures("total", all_closed);
  });
  return data;
}

}  // namespace sterna::cad
