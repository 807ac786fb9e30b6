#include "scripting/values/model_parts.h"

#include <algorithm>
#include <optional>

#include "geom/base/error.h"
#include "geom/cad/aircraft_union.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"
#include "scripting/values/models.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

/// Start indices of a part's columns in those of its model.
struct Begin {
  std::size_t components = 0, corners = 0, edges = 0, faces = 0, solids = 0;
  void add(const Model& model) {
    components += model.components.size();
    corners += model.corners.size();
    edges += model.edges.size();
    faces += model.faces.size();
    solids += model.solids.size();
  }
  bool is_end_of(const Model& model) const {
    return components == model.components.size() && corners == model.corners.size() && edges == model.edges.size() && faces == model.faces.size() &&
           solids == model.solids.size();
  }
};

template <class IdType>
IdType shifted(IdType id, std::size_t by) {
  return IdType(static_cast<std::uint64_t>(id.index() + by));
}

/// Returns true if two faces are the same piece of the same surface.
bool is_same_face(const Model& a, const ModelFace& of_a, const Model& b, const ModelFace& of_b) {
  if (of_a.surface != of_b.surface || of_a.is_reversed != of_b.is_reversed || of_a.borders.size() != of_b.borders.size()) return false;
  for (std::size_t i = 0; i < of_a.borders.size(); ++i) {
    const bool is_same =
        std::equal(of_a.borders[i].begin(), of_a.borders[i].end(), of_b.borders[i].begin(), of_b.borders[i].end(), [&](const EdgeUse& x, const EdgeUse& y) {
          const ModelEdge &of_x = a.edges[x.edge], &of_y = b.edges[y.edge];
          return x.parameter == y.parameter && x.is_reversed == y.is_reversed && of_x.curve == of_y.curve && of_x.range.from == of_y.range.from &&
                 of_x.range.to == of_y.range.to;
        });
    if (!is_same) return false;
  }
  return true;
}

bool is_same_solid(const Model& a, const Model& b) {
  return std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(),
                    [&](const ModelFace& x, const ModelFace& y) { return is_same_face(a, x, b, y); });
}

/// Returns part `i` at its location.
Model slice(const Model& model, const std::vector<ModelPart>& parts, std::size_t i) {
  Begin begin;
  for (std::size_t k = 0; k < i; ++k) begin.add(*parts[k].own);
  Model part = *parts[i].own;  // keeps the numbers of the part; the following data are replaced by their current values
  for (const ComponentId c : part.components.ids()) part.components[c] = model.components[shifted(c, begin.components)];
  for (const CornerId c : part.corners.ids()) part.corners[c] = model.corners[shifted(c, begin.corners)];
  for (const EdgeId e : part.edges.ids()) {
    const ModelEdge own = part.edges[e];
    part.edges[e] = model.edges[shifted(e, begin.edges)];
    part.edges[e].start = own.start;
    part.edges[e].end = own.end;
  }
  for (const FaceId f : part.faces.ids()) {
    const ModelFace own = std::move(part.faces[f]);
    part.faces[f] = model.faces[shifted(f, begin.faces)];
    part.faces[f].component = own.component;
    for (std::size_t b = 0; b < own.borders.size(); ++b)
      for (std::size_t k = 0; k < own.borders[b].size(); ++k) part.faces[f].borders[b][k].edge = own.borders[b][k].edge;
  }
  for (const SolidId s : part.solids.ids()) part.solids[s].name = model.solids[shifted(s, begin.solids)].name;
  part.source_unit = model.source_unit;
  part.shape.reset();
  return part;
}

}  // namespace

std::vector<ModelPart> parts_of(const ModelValue& value) {
  if (value.parts.empty()) return {{std::make_shared<const Model>(value.model), {}, value.provenance.key()}};
  Begin end;
  for (const ModelPart& part : value.parts) end.add(*part.own);
  if (!end.is_end_of(value.model))
    throw Error({.code = ErrorCode::internal,
                 .attempted = "finding the parts of a model",
                 .problem = "the parts have other numbers of faces, edges and corners than the model"});
  return value.parts;
}

Model own_model(const ModelValue& value, const std::vector<ModelPart>& parts, std::size_t i) {
  Begin begin;
  for (std::size_t k = 0; k < i; ++k) begin.add(*parts[k].own);
  Model own = *parts[i].own;
  for (const ComponentId c : own.components.ids()) own.components[c] = value.model.components[shifted(c, begin.components)];
  for (const EdgeId e : own.edges.ids()) own.edges[e].name = value.model.edges[shifted(e, begin.edges)].name;
  for (const FaceId f : own.faces.ids()) {
    const ModelFace& now = value.model.faces[shifted(f, begin.faces)];
    own.faces[f].name = now.name;
    own.faces[f].role = now.role;
    own.faces[f].kind = now.kind;
  }
  for (const SolidId s : own.solids.ids()) own.solids[s].name = value.model.solids[shifted(s, begin.solids)].name;
  return own;
}

void move_parts(const Transform& motion, ModelValue& value) {
  value.parts = parts_of(value);
  for (ModelPart& part : value.parts) part.placement = motion * part.placement;
  value.model = transformed(value.model, motion);
}

void mirror_parts(const Point& at, const Vec3& normal, ModelValue& value) {
  const Transform image = mirroring(at, normal);  // the mirroring is its own inverse
  value.parts = parts_of(value);
  for (ModelPart& part : value.parts) {
    part.own = std::make_shared<const Model>(mirrored(*part.own, at, normal));
    if (part.key) part.key = KeyMaker("mirrored").add(*part.key).add(at).add(normal).key();
    if (!part.is_in_place()) part.placement = image * part.placement * image;
  }
  value.model = mirrored(value.model, at, normal);
}

void take_solids(const Model& looked_at, const Model& changed, ModelValue& value) {
  const std::vector<ModelPart> parts = parts_of(value);
  std::vector<std::vector<Model>> solids_of_part(parts.size());
  {
    std::vector<Model> seen = cad::split_solids(looked_at);
    auto next = seen.begin();
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (std::size_t k = 0; k < parts[p].own->solids.size(); ++k) solids_of_part[p].push_back(std::move(*next++));
  }
  std::vector<Model> solids = cad::split_solids(changed);
  Model model;
  model.source_unit = value.model.source_unit;
  std::vector<ModelPart> kept;
  bool is_any_kept = false;
  std::optional<Model> others;
  const auto end_others = [&] {
    if (!others) return;
    append(model, *others);
    kept.push_back({std::make_shared<const Model>(std::move(*others)), {}, {}});
    others.reset();
  };
  for (std::size_t i = 0; i < solids.size();) {
    const auto is_here = [&](const std::vector<Model>& of_part) {
      return !of_part.empty() && of_part.size() <= solids.size() - i &&
             std::equal(of_part.begin(), of_part.end(), solids.begin() + static_cast<std::ptrdiff_t>(i), is_same_solid);
    };
    const auto found = std::find_if(solids_of_part.begin(), solids_of_part.end(), is_here);
    if (found == solids_of_part.end()) {
      if (!others) others.emplace();
      append(*others, solids[i++]);
      continue;
    }
    end_others();
    const auto part = static_cast<std::size_t>(found - solids_of_part.begin());
    append(model, slice(value.model, parts, part));
    kept.push_back(parts[part]);
    is_any_kept = true;
    i += found->size();
  }
  if (!is_any_kept) {  // the model is as made by the boolean, including the order of its faces
    value.model = changed;
    value.parts.clear();
    return;
  }
  end_others();
  value.model = std::move(model);
  value.parts = std::move(kept);
}

}  // namespace sterna::scripting
