#include "geom/cad/face_origins.h"

#include <BRepBuilderAPI_MakeShape.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_ListOfShape.hxx>

#include <algorithm>

#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {}  // namespace

bool is_closed_model(const Model& model) {
  return !model.solids.empty() && std::all_of(model.solids.begin(), model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
}

std::vector<ErrorLocation> open_locations(const Model& model) {
  std::vector<ErrorLocation> locations;
  for (const EdgeId e : free_edges(model)) {
    const ModelEdge& edge = model.edges[e];
    locations.push_back({edge.curve->point(0.5 * (edge.range.from + edge.range.to)), "open edge"});
  }
  return locations;
}

BooleanPart boolean_part(const Model& model, const std::string& attempted, const RunContext& context) {
  BooleanPart part{.model = &model, .shape = shape_of(model, context)};
  if (!is_closed_model(model)) {
    ErrorInfo info{.code = ErrorCode::open_surface,
                   .attempted = attempted,
                   .problem = "\"" + part.name() + "\" is not closed",
                   .hint = "close the part first: booleans need closed parts"};
    info.locations = open_locations(model);
    info.n_locations = static_cast<std::int64_t>(info.locations.size());
    info.locations.resize(std::min(k_max_locations, info.locations.size()));
    throw Error(std::move(info));
  }
  for (const SolidId solid : model.solids.ids()) {
    const SolidMeasures measures = solid_measures(model, solid);
    part.volume += measures.volume;
    part.area += measures.area;
  }
  return part;
}

FaceOrigins origins_of(BRepBuilderAPI_MakeShape& operation, std::span<const BooleanPart> parts) {
  FaceOrigins origins;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<TopoDS_Face>& faces = parts[p].shape->content().faces;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto add = [&](const TopoDS_Shape& piece) {
        if (!origins.IsBound(piece)) origins.Bind(piece, {p, FaceId(static_cast<std::uint64_t>(f))});
      };
      const TopTools_ListOfShape& pieces = operation.Modified(faces[f]);
      for (const TopoDS_Shape& piece : pieces) add(piece);
      if (pieces.IsEmpty() && !operation.IsDeleted(faces[f])) add(faces[f]);
    }
  }
  return origins;
}

LabelledShape labelled(const TopoDS_Shape& shape, const FaceOrigins& origins, std::span<const BooleanPart> parts) {
  LabelledShape result;
  result.parts.push_back({.shape = shape, .component = parts.front().name(), .name = {}, .label = {}});
  for (FaceOrigins::Iterator it(origins); it.More(); it.Next()) {
    const Model& model = *parts[it.Value().part].model;
    const ModelFace& face = model.faces[it.Value().face];
    result.labels.Bind(it.Key(), {.name = face.name, .colour = face.colour, .layer = face.layer, .component = model.components[face.component].name});
  }
  return result;
}

std::string restore_origins(Model& model, const FaceOrigins& origins, std::span<const BooleanPart> parts, std::vector<FaceOrigin>& of_face) {
  const CadShape::Content& content = model.shape->content();
  for (const FaceId f : model.faces.ids()) {
    const FaceOrigin* origin = origins.Seek(content.faces[f.index()]);
    if (!origin) return "a face of the result belongs to none of the parts";
    const Model& part = *parts[origin->part].model;
    const ModelFace& from = part.faces[origin->face];
    ModelFace& face = model.faces[f];
    face.role = from.role;
    face.kind = from.kind;
    model.components[face.component].kind = part.components[from.component].kind;
    TopLoc_Location location, from_location;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(content.faces[f.index()], location);
    const Handle(Geom_Surface) from_surface = BRep_Tool::Surface(parts[origin->part].shape->content().faces[origin->face.index()], from_location);
    if (surface == from_surface && location.IsEqual(from_location)) face.surface = from.surface;
    of_face.push_back(*origin);
  }
  for (ModelSolid& solid : model.solids) {  // a separate body is named after its own component
    const auto is_named = [&](FaceId f) { return model.components[model.faces[f].component].name == solid.name; };
    if (std::none_of(solid.faces.begin(), solid.faces.end(), is_named)) solid.name = model.components[model.faces[solid.faces.front()].component].name;
  }
  return {};
}

}  // namespace sterna::cad
