#include "geom/model/components.h"

#include <algorithm>
#include <map>

#include "geom/base/error.h"
#include "geom/model/deflection.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"

namespace sterna {
namespace {

/// Patch names of engine ends by body.
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

/// What is said of a wing's control surfaces: its deflections, and patches of those that have none.
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
  Model model;
  const std::map<std::string, BodyEnds> ends = engine_ends(aircraft.engines);
  for (const Body& body : aircraft.bodies) {
    context.check_stop();
    const auto found = ends.find(body.name);
    const ComponentKind kind = body.lip ? ComponentKind::nacelle : body.kind;
    append(model, make_body(body, kind, found == ends.end() ? BodyEnds{} : found->second));
    if (body.has_mirror_image) append(model, make_body(image_of(body), kind, {}, mirror()));
  }
  for (const Wing& wing : aircraft.wings) {
    context.check_stop();
    const std::vector<Deflection> deflections = deflections_of(aircraft, wing);
    append(model, make_wing(deflected(wing, deflections)));
    if (wing.has_mirror_image) {
      const Wing image = image_of(wing);
      append(model, make_wing(deflected(image, images_of(deflections, image.name)), mirror()));
    }
  }
  for (const CowlNacelle& nacelle : aircraft.nacelles) {
    context.check_stop();
    append(model, make_nacelle(nacelle));
    if (nacelle.has_mirror_image) append(model, make_nacelle(image_of(nacelle), mirror()));
  }
  return model;
}

}  // namespace sterna
