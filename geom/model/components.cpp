#include "geom/model/components.h"

#include <algorithm>
#include <functional>
#include <map>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/model/deflection.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"

namespace sterna {
namespace {

/// Returns the patch names of engine ends, by body.
std::map<std::string, BodyEnds> engine_ends(const std::vector<JetEngine>& engines) {
  std::map<std::string, BodyEnds> ends;
  for (const JetEngine& engine : engines) {
    const auto name = [&](const std::vector<EngineRegion>& regions, const char* what) {
      for (std::size_t i = 0; i < regions.size(); ++i) {
        BodyEnds& body = ends[regions[i].body];
        (regions[i].is_nose ? body.nose : body.tail) = engine.name + what + (regions.size() > 1 ? std::to_string(i) : "");
      }
    };
    name(engine.intakes, "Intake");
    name(engine.nozzles, "Exhaust");
  }
  return ends;
}

Transform mirror() { return mirroring({}, {0.0, 1.0, 0.0}); }

template <class Part>
Part image_of(const Part& part) {
  Part image = part;
  image.name = image_name(part.name);
  return image;
}

/// Returns the deflections of a wing's control surfaces, including patches for surfaces without deflection.
std::vector<Deflection> deflections_of(const Aircraft& aircraft, const Wing& wing) {
  std::vector<Deflection> result;
  for (const Deflection& d : aircraft.deflections)
    if (d.surface.wing == wing.name) result.push_back(d);
  const auto is_said = [&](const std::string& name) {
    return std::any_of(result.begin(), result.end(), [&](const Deflection& d) {
      return d.surface.name == name || ((d.other_side != OtherSide::none || d.surface.has_image) && image_name(d.surface.name) == name);
    });
  };
  for (const ControlSurface& surface : aircraft.control_surfaces)
    if (surface.wing == wing.name && !is_said(surface.name)) result.push_back({.surface = surface});
  return result;
}

std::vector<Deflection> images_of(const std::vector<Deflection>& deflections, const std::string& wing) {
  std::vector<Deflection> images;
  for (const Deflection& d : deflections) {
    if (d.other_side == OtherSide::none && !d.surface.has_image) continue;
    images.push_back(image_of(d));
    images.back().surface.wing = wing;
  }
  return images;
}

void check_wings(const Aircraft& aircraft) {
  const auto names = [&] {
    std::string text;
    for (const Wing& wing : aircraft.wings) text += (text.empty() ? "one of '" : ", '") + wing.name + "'";
    return text;
  };
  for (const Deflection& d : aircraft.deflections)
    if (std::none_of(aircraft.wings.begin(), aircraft.wings.end(), [&](const Wing& wing) { return wing.name == d.surface.wing; }))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "deflecting '" + d.surface.name + "'",
                   .problem = "there is no wing '" + d.surface.wing + "'",
                   .hint = names()});
}

}  // namespace

Model make_components(const Aircraft& aircraft, const RunContext& context) {
  check_wings(aircraft);
  const std::map<std::string, BodyEnds> ends = engine_ends(aircraft.engines);
  // In the order of the model; each component is built independently.
  std::vector<std::function<Model()>> makers;
  for (const Body& body : aircraft.bodies) {
    const auto found = ends.find(body.name);
    const ComponentKind kind = body.lip ? ComponentKind::nacelle : body.kind;
    makers.emplace_back([&body, kind, of = found == ends.end() ? BodyEnds{} : found->second] { return make_body(body, kind, of); });
    if (body.has_mirror_image) makers.emplace_back([&body, kind] { return make_body(image_of(body), kind, {}, mirror()); });
  }
  for (const Wing& wing : aircraft.wings) {
    makers.emplace_back([&] { return make_wing(deflected(wing, deflections_of(aircraft, wing))); });
    if (wing.has_mirror_image)
      makers.emplace_back([&] {
        const Wing image = image_of(wing);
        return make_wing(deflected(image, images_of(deflections_of(aircraft, wing), image.name)), mirror());
      });
  }
  for (const CowlNacelle& nacelle : aircraft.nacelles) {
    makers.emplace_back([&] { return make_nacelle(nacelle); });
    if (nacelle.has_mirror_image) makers.emplace_back([&] { return make_nacelle(image_of(nacelle), mirror()); });
  }
  std::vector<Model> parts(makers.size());
  parallel_for(
      context, makers.size(), [&](std::size_t i) { parts[i] = makers[i](); }, 1);
  Model model;
  for (const Model& part : parts) append(model, part);
  return model;
}

}  // namespace sterna
