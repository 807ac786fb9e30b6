#include "geom/model/select_faces.h"

#include <map>
#include <utility>

namespace sterna {

Model select_faces(const Model& model, const std::function<bool(FaceId)>& is_chosen) {
  Model result;
  result.source_unit = model.source_unit;
  std::map<std::uint64_t, ComponentId> components;
  std::map<std::uint64_t, CornerId> corners;
  std::map<std::uint64_t, EdgeId> edges;
  std::map<std::uint64_t, FaceId> faces;
  const auto corner = [&](CornerId id) {
    const auto [location, is_new] = corners.try_emplace(id.value());
    if (is_new) location->second = result.corners.push_back(model.corners[id]);
    return location->second;
  };
  for (const FaceId f : model.faces.ids()) {
    if (!is_chosen(f)) continue;
    ModelFace face = model.faces[f];
    const auto [component, is_new] = components.try_emplace(face.component.value());
    if (is_new) component->second = result.components.push_back(model.components[face.component]);
    face.component = component->second;
    for (Border& border : face.borders)
      for (EdgeUse& use : border) {
        const auto [edge, is_new_edge] = edges.try_emplace(use.edge.value());
        if (is_new_edge) {
          ModelEdge copy = model.edges[use.edge];
          copy.start = corner(copy.start);
          copy.end = corner(copy.end);
          edge->second = result.edges.push_back(copy);
        }
        use.edge = edge->second;
      }
    faces[f.value()] = result.faces.push_back(std::move(face));
  }
  for (const ModelSolid& solid : model.solids) {
    ModelSolid kept{solid.name, {}, solid.is_closed};
    for (const FaceId f : solid.faces)
      if (const auto found = faces.find(f.value()); found != faces.end()) kept.faces.push_back(found->second);
    kept.is_closed = solid.is_closed && kept.faces.size() == solid.faces.size();
    if (!kept.faces.empty()) result.solids.push_back(std::move(kept));
  }
  return result;
}

}  // namespace sterna
