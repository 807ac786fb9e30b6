#include "surfmesh/model/model_structure.h"

#include <algorithm>
#include <cmath>

namespace sterna::surfmesh {
namespace {

constexpr int k_use_samples = 5;

std::string number_of(std::size_t now, std::string_view what, std::size_t before) {
  return "the model has " + std::to_string(now) + " " + std::string(what) + ", the reference has " + std::to_string(before);
}

double share_of(double t, const Interval& range) { return range.length() > 0.0 ? (t - range.from) / range.length() : 0.0; }

bool runs_alike(const UseStructure& a, const ParameterBox& of_a, const UseStructure& b, const ParameterBox& of_b) {
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    const Uv p = a.samples[k], q = b.samples[k];
    if (!(std::abs(share_of(p.u, of_a.u) - share_of(q.u, of_b.u)) <= k_same_border && std::abs(share_of(p.v, of_a.v) - share_of(q.v, of_b.v)) <= k_same_border))
      return false;
  }
  return true;
}

std::string difference_of_faces(const FaceStructure& a, const FaceStructure& b, FaceId f) {
  const std::string face = "face " + std::to_string(f.value()) + " (\"" + b.name + "\")";
  if (a.name != b.name) return face + " has the name \"" + a.name + "\" in the reference";
  if (a.component != b.component || a.role != b.role || a.kind != b.kind || a.is_reversed != b.is_reversed)
    return face + " has another component, role, kind or orientation in the reference";
  if (a.borders.size() != b.borders.size())
    return face + " has " + std::to_string(b.borders.size()) + " borders, but in the reference " + std::to_string(a.borders.size());
  for (std::size_t i = 0; i < a.borders.size(); ++i) {
    if (a.borders[i].size() != b.borders[i].size())
      return face + " has a border of " + std::to_string(b.borders[i].size()) + " edges, but in the reference of " + std::to_string(a.borders[i].size());
    for (std::size_t k = 0; k < a.borders[i].size(); ++k) {
      const UseStructure &x = a.borders[i][k], &y = b.borders[i][k];
      if (x.edge != y.edge || x.is_reversed != y.is_reversed) return face + " is bounded by different edges in the reference";
      if (!runs_alike(x, a.box, y, b.box)) return face + " is trimmed differently in the reference";
    }
  }
  return {};
}

}  // namespace

ModelStructure structure_of(const Model& model) {
  ModelStructure structure;
  structure.components = model.components.raw();
  structure.n_corners = model.corners.size();
  for (const ModelEdge& edge : model.edges) structure.edges.push_back({edge.start, edge.end, edge.is_degenerate(), edge.range, edge.name});
  for (const ModelFace& face : model.faces) {
    FaceStructure entry{face.component, face.name, face.role, patch_kind(face), face.is_reversed, {{1e300, -1e300}, {1e300, -1e300}}, {}};
    for (const Border& border : face.borders) {
      std::vector<UseStructure> uses;
      for (const EdgeUse& use : border) {
        UseStructure of_use{use.edge, use.is_reversed, {}};
        const Interval range = model.edges[use.edge].range;
        for (int k = 0; k < k_use_samples; ++k) {
          const Uv p = use.parameter->point(k + 1 == k_use_samples ? range.to : range.from + range.length() * k / (k_use_samples - 1));
          entry.box = {{std::min(entry.box.u.from, p.u), std::max(entry.box.u.to, p.u)}, {std::min(entry.box.v.from, p.v), std::max(entry.box.v.to, p.v)}};
          of_use.samples.push_back(p);
        }
        uses.push_back(std::move(of_use));
      }
      entry.borders.push_back(std::move(uses));
    }
    structure.faces.push_back(std::move(entry));
  }
  for (const ModelSolid& solid : model.solids) structure.solids.push_back({solid.name, solid.faces, solid.is_closed});
  return structure;
}

std::string difference_of(const ModelStructure& reference, const ModelStructure& now) {
  const ModelStructure &a = reference, &b = now;
  if (a.components.size() != b.components.size()) return number_of(b.components.size(), "components", a.components.size());
  if (a.faces.size() != b.faces.size()) return number_of(b.faces.size(), "faces", a.faces.size());
  if (a.edges.size() != b.edges.size()) return number_of(b.edges.size(), "edges", a.edges.size());
  if (a.n_corners != b.n_corners) return number_of(b.n_corners, "corners", a.n_corners);
  if (a.solids.size() != b.solids.size()) return number_of(b.solids.size(), "solids", a.solids.size());
  for (std::size_t i = 0; i < a.components.size(); ++i)
    if (a.components[i].name != b.components[i].name || a.components[i].kind != b.components[i].kind)
      return "component \"" + b.components[i].name + "\" is \"" + a.components[i].name + "\", or of another kind, in the reference";
  for (std::size_t i = 0; i < a.solids.size(); ++i)
    if (a.solids[i].name != b.solids[i].name || a.solids[i].faces != b.solids[i].faces || a.solids[i].is_closed != b.solids[i].is_closed)
      return "solid \"" + b.solids[i].name + "\" is different in the reference";
  for (const EdgeId e : a.edges.ids()) {
    const EdgeStructure &x = a.edges[e], &y = b.edges[e];
    if (x.start != y.start || x.end != y.end || x.is_degenerate != y.is_degenerate || x.name != y.name)
      return "edge " + std::to_string(e.value()) + " joins other corners, or has another name, in the reference";
  }
  for (const FaceId f : a.faces.ids())
    if (std::string difference = difference_of_faces(a.faces[f], b.faces[f], f); !difference.empty()) return difference;
  return {};
}

double carried(double t, const Interval& from, const Interval& to) {
  if (from == to || !(from.length() > 0.0)) return t;
  return to.from + (t - from.from) * (to.length() / from.length());
}

Uv carried(Uv at, const ParameterBox& from, const ParameterBox& to) { return {carried(at.u, from.u, to.u), carried(at.v, from.v, to.v)}; }

}  // namespace sterna::surfmesh
