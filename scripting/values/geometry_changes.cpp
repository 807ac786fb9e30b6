#include "scripting/values/geometry_changes.h"

#include "surfmesh/stitch/as_read.h"

namespace sterna::scripting {

void note_change(SurfaceValue& surface, const GeometryChange& change, const RunContext& context, GeometryChangeUse use) {
  surface.history.back().figures = to_json(change);
  for (const std::string& text : warnings_of(change, use)) context.warn(text);
  context.info(change.by + ": " + to_text(change));
}

void note_reading(SurfaceValue& surface, const std::vector<SurfaceSoup>& soups, const RunContext& context) {
  if (surface.report.n_degenerate_removed + surface.report.n_duplicate_removed == 0) return;
  const GeometryChange change = compare_geometry(surfmesh::mesh_as_read(soups, surface.options), surface.mesh, "reading", context);
  if (change.is_small()) return;
  surface.history.emplace_back();
  note_change(surface, change, context);
}

void note_half(SurfaceValue& half, const TriMesh& whole, const HalfOptions& options, const RunContext& context) {
  const GeometryChange change = compare_geometry(beyond_plane(whole, options), half.mesh, "half", context);
  half.history.emplace_back();
  note_change(half, change, context);
}

}  // namespace sterna::scripting
