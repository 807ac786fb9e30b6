#include "geom/model/model.h"

#include <array>

namespace sterna {
namespace {

constexpr std::array<std::string_view, 10> k_component_kinds = {"unknown", "body", "wing", "nacelle", "pylon", "fairing", "boom", "sting", "box", "tunnel"};
constexpr std::array<std::string_view, 22> k_face_roles = {
    "unknown", "skin", "upper",   "lower",        "leading_edge", "trailing_edge", "tip",    "nose",    "tail",     "inlet_lip", "fan_face",
    "nozzle",  "jet",  "control", "control_side", "hinge",        "wall",          "inflow", "outflow", "symmetry", "farfield",  "fillet"};

}  // namespace

std::string_view to_string(ComponentKind kind) { return k_component_kinds.at(static_cast<std::size_t>(kind)); }
std::string_view to_string(FaceRole role) { return k_face_roles.at(static_cast<std::size_t>(role)); }

PatchKind patch_kind(const ModelFace& face) {
  if (face.kind) return *face.kind;
  switch (face.role) {
    case FaceRole::inflow: return PatchKind::inflow;
    case FaceRole::outflow: return PatchKind::outflow;
    case FaceRole::symmetry: return PatchKind::symmetry;
    case FaceRole::farfield: return PatchKind::farfield;
    default: return PatchKind::wall;
  }
}

Column<EdgeId, std::vector<EdgeUseLocation>> uses_of_edges(const Model& model) {
  Column<EdgeId, std::vector<EdgeUseLocation>> uses(model.edges.size());
  for (const FaceId f : model.faces.ids()) {
    const std::vector<Border>& borders = model.faces[f].borders;
    for (std::uint32_t b = 0; b < borders.size(); ++b)
      for (std::uint32_t i = 0; i < borders[b].size(); ++i) uses[borders[b][i].edge].push_back({f, b, i});
  }
  return uses;
}

std::vector<EdgeId> free_edges(const Model& model) {
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  std::vector<EdgeId> result;
  for (const EdgeId e : model.edges.ids())
    if (uses[e].size() == 1 && !model.edges[e].is_degenerate()) result.push_back(e);
  return result;
}

}  // namespace sterna
