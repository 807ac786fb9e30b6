#include "geom/model/components.h"

#include <map>

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

/// "RightNacelle" -> "LeftNacelle"; names without a side get "Left" behind: no blanks, names become patches of meshes.
std::string image_name(const std::string& name) {
  const std::string other = mirrored_name(name);
  return other.starts_with(name) ? name + "Left" : other;
}

template <class Part>
Part image_of(const Part& part) {
  Part image = part;
  image.name = image_name(part.name);
  return image;
}

}  // namespace

Model make_components(const Aircraft& aircraft, const RunContext& context) {
  Model model;
  const std::map<std::string, BodyEnds> ends = engine_ends(aircraft.engines);
  for (const Body& body : aircraft.bodies) {
    context.check_stop();
    const auto found = ends.find(body.name);
    const ComponentKind kind = body.lip ? ComponentKind::nacelle : ComponentKind::body;
    append(model, make_body(body, kind, found == ends.end() ? BodyEnds{} : found->second));
    if (body.has_mirror_image) append(model, make_body(image_of(body), kind, {}, mirror()));
  }
  for (const Wing& wing : aircraft.wings) {
    context.check_stop();
    if (wing.has_winglet) context.info("wing '" + wing.name + "': winglets are joined straight, without sumo's elliptic blend");
    append(model, make_wing(wing));
    if (wing.has_mirror_image) append(model, make_wing(image_of(wing), mirror()));
  }
  for (const CowlNacelle& nacelle : aircraft.nacelles) {
    context.check_stop();
    append(model, make_nacelle(nacelle));
    if (nacelle.has_mirror_image) append(model, make_nacelle(image_of(nacelle), mirror()));
  }
  return model;
}

}  // namespace sterna
