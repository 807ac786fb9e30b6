#include "scripting/values/geometry_changes.h"

#include <nlohmann/json.hpp>

#include "surfmesh/stitch/as_read.h"

namespace sterna::scripting {

void note_change(SurfaceValue& surface, const GeometryChange& change, const RunContext& context, GeometryChangeUse use) {
  surface.changed.push_back(to_json(change));
  for (const std::string& text : warnings_of(change, use)) context.warn(text);
  context.info(change.by + ": " + to_text(change));
}

void note_reading(SurfaceValue& surface, const std::vector<SurfaceSoup>& soups, const RunContext& context) {
  if (surface.report.n_degenerate_removed + surface.report.n_duplicate_removed == 0) return;
  const GeometryChange change = compare_geometry(surfmesh::mesh_as_read(soups, surface.options), surface.mesh, "reading", context);
  if (!change.is_small()) note_change(surface, change, context);
}

void note_half(SurfaceValue& half, const TriMesh& whole, const HalfOptions& options, const RunContext& context) {
  const GeometryChange change = compare_geometry(beyond_plane(whole, options), half.mesh, "half", context);
  note_change(half, change, context);
}

std::string changed_json(const std::vector<std::string>& changed) {
  std::string text = "[";
  for (const std::string& entry : changed) text += (text.size() > 1 ? "," : "") + entry;
  return text + "]";
}

std::vector<std::string> changed_of_json(const std::string& text) {
  std::vector<std::string> changed;
  for (const auto& entry : nlohmann::ordered_json::parse(text))
    if (entry.is_object()) changed.push_back(entry.dump());
  return changed;
}

}  // namespace sterna::scripting
