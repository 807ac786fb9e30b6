#include "geom/cad/aircraft_union.h"

#include <algorithm>
#include <numeric>

#include "geom/model/components.h"

namespace sterna::cad {
namespace {

constexpr const char* k_aircraft_attempt = "uniting the components";

/// Maps numbers of a model to those of a part; parts are numbered in order of first use.
template <class Id, class T>
class Renumbering {
 public:
  Renumbering(const Column<Id, T>& from, Column<Id, T>& to) : from_(from), to_(to), of_(from.size()) {}
  Id operator()(Id old) {
    Id& id = of_[old.index()];
    if (!id.is_valid()) id = to_.push_back(from_[old]);
    return id;
  }

 private:
  const Column<Id, T>& from_;
  Column<Id, T>& to_;
  std::vector<Id> of_;
};

Model part_of(const Model& whole, const ModelSolid& solid) {
  Model part;
  part.source_unit = whole.source_unit;
  Renumbering components(whole.components, part.components);
  Renumbering corners(whole.corners, part.corners);
  Renumbering edges(whole.edges, part.edges);
  ModelSolid own{.name = solid.name, .faces = {}, .is_closed = solid.is_closed};
  for (const FaceId f : solid.faces) {
    ModelFace face = whole.faces[f];
    face.component = components(face.component);
    for (Border& border : face.borders)
      for (EdgeUse& use : border) use.edge = edges(use.edge);
    own.faces.push_back(part.faces.push_back(std::move(face)));
  }
  for (ModelEdge& edge : part.edges) {
    edge.start = corners(edge.start);
    edge.end = corners(edge.end);
  }
  part.solids.push_back(std::move(own));
  return part;
}

}  // namespace

std::vector<Model> split_solids(const Model& components) {
  std::vector<bool> is_loose(components.faces.size(), true);
  std::vector<Model> parts;
  for (const ModelSolid& solid : components.solids) {
    for (const FaceId f : solid.faces) is_loose[f.index()] = false;
    parts.push_back(part_of(components, solid));
  }
  ErrorInfo info{.code = ErrorCode::open_surface, .attempted = k_aircraft_attempt, .hint = "close the solids first: only closed solids can be united"};
  for (const FaceId f : components.faces.ids()) {
    if (!is_loose[f.index()]) continue;
    ++info.n_locations;
    const ModelFace& face = components.faces[f];
    const EdgeUse& use = face.borders.front().front();
    const Interval range = components.edges[use.edge].range;
    if (info.locations.size() < k_max_locations)
      info.locations.push_back({face.surface->point(use.parameter->point(0.5 * (range.from + range.to))), "\"" + face.name + "\""});
  }
  if (info.n_locations == 0) return parts;
  info.problem = std::to_string(info.n_locations) + " faces belong to no solid";
  throw Error(std::move(info));
}

std::vector<Model> unite_touching(std::span<const Model> solids, const UniteOptions& options, const RunContext& context) {
  if (solids.size() < 2) return {solids.begin(), solids.end()};
  std::vector<std::size_t> group(solids.size());  // the first solid of each connected group
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const PartContact& contact : find_contacts(solids, context).contacts) {
    if (contact.kind == ContactKind::apart) continue;
    const std::size_t a = group[contact.first], b = group[contact.second];
    for (std::size_t& g : group)
      if (g == std::max(a, b)) g = std::min(a, b);
  }
  std::vector<Model> result;
  for (std::size_t g = 0; g < solids.size(); ++g) {
    std::vector<Model> members;
    for (std::size_t i = 0; i < solids.size(); ++i)
      if (group[i] == g) members.push_back(solids[i]);
    if (members.size() == 1) result.push_back(std::move(members.front()));
    if (members.size() < 2) continue;
    for (Model& solid : split_solids(unite(members, options, context).model)) result.push_back(std::move(solid));
  }
  return result;
}

UniteResult unite_aircraft(const Model& components, const UniteOptions& options, const RunContext& context) {
  const std::vector<Model> parts = split_solids(components);
  return unite(parts, options, context);
}

UniteResult unite_aircraft(const Aircraft& aircraft, const UniteOptions& options, const RunContext& context) {
  return unite_aircraft(make_components(aircraft, context), options, context);
}

}  // namespace sterna::cad
