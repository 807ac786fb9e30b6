#include "scripting/values/surface_items.h"

#include <utility>

#include "scripting/lua/verb_tools.h"
#include "scripting/values/wall_files.h"

namespace sterna::scripting {
namespace {

SurfaceSoup soup_of_surface(const SurfaceValue& surface, double unit) {
  SurfaceSoup soup;
  soup.source = surface.inputs.empty() ? "surface" : surface.inputs.front().name;
  soup.has_names = true;
  for (const Point& p : surface.mesh.points) soup.points.push_back(p / unit);
  for (const Patch& patch : surface.mesh.patches) soup.patch_names.push_back(patch.name);
  for (const TriangleId t : surface.mesh.triangles.ids()) {
    const TriangleVertices& v = surface.mesh.triangles[t];
    soup.triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
    soup.patch.push_back(surface.mesh.triangle_patch[t].value());
  }
  return soup;
}

}  // namespace

std::vector<UnionItem> read_surfaces_and_files(TableReader& reader, const ScriptCall& call) {
  std::vector<UnionItem> items;
  std::size_t number = 0;
  for (const ScriptValue& item : reader.items()) {
    ++number;
    if (const auto* surface = std::get_if<SurfaceHandle>(&item)) items.emplace_back(*surface);
    else if (const auto* name = std::get_if<std::string>(&item)) items.emplace_back(find_input(call, *name));
    else reader.add_problem("entry " + std::to_string(number) + ": expected a surface or a file name, not " + std::string(type_text(item)));
  }
  if (number == 0) reader.add_problem("needs a surface or a file name");
  return items;
}

SurfaceItems read_items(std::span<const UnionItem> items, const surfmesh::StitchOptions& options, const RunContext& context) {
  SurfaceItems all;
  SurfaceValue& wall = all.wall;
  wall.options = options;
  const auto add = [&](const SurfaceValue& known) {
    wall.inputs.insert(wall.inputs.end(), known.inputs.begin(), known.inputs.end());
    wall.layers.insert(wall.layers.end(), known.layers.begin(), known.layers.end());
    inherit(wall.history, known.history, items.size() == 1);
  };
  for (const UnionItem& item : items) {
    if (const auto* file = std::get_if<InputPath>(&item)) {
      WallFiles read = read_wall_files(std::span(file, 1), wall.options, context);
      add(read.wall);
      if (items.size() == 1) wall.smooth_angle = read.wall.smooth_angle;
      all.kinds.insert(read.kinds.begin(), read.kinds.end());
      wall.options = read.wall.options;
      for (SurfaceSoup& soup : read.soups) all.soups.push_back(std::move(soup));
    } else {
      const SurfaceValue& surface = *std::get<SurfaceHandle>(item);
      add(surface);
      if (items.size() == 1) wall.smooth_angle = surface.smooth_angle;
      for (const Patch& patch : surface.mesh.patches) all.kinds.insert({patch.name, patch.kind});
      all.soups.push_back(soup_of_surface(surface, options.unit));
    }
  }
  return all;
}

SurfaceValue with_mesh(const SurfaceItems& items, TriMesh mesh, surfmesh::StitchReport report) {
  SurfaceValue wall = items.wall;
  wall.mesh = std::move(mesh);
  wall.report = std::move(report);
  for (Patch& patch : wall.mesh.patches)
    if (const auto kind = items.kinds.find(patch.name); kind != items.kinds.end()) patch.kind = kind->second;
  return wall;
}

}  // namespace sterna::scripting
