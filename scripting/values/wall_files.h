// Reads a wall in two steps: reading its files, and joining them. Defects that prevent joining can thus be inspected without reading twice.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/surface_soup.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// The files of a wall before joining.
struct WallFiles {
  SurfaceValue wall;  ///< all data except its mesh; its options include those of the manifests beside the files
  std::vector<SurfaceSoup> soups;
  std::map<std::string, PatchKind> kinds;  ///< kinds of patches, from the manifests
};

/// Reads the files.
/// \throws Error of io
WallFiles read_wall_files(std::span<const InputPath> files, const surfmesh::StitchOptions& options, const RunContext& context);
/// Joins the files by the wall's options.
/// \throws Error of surfmesh::stitch_surface
SurfaceValue join_wall(const WallFiles& files, const RunContext& context);

/// Logs size and unit of a surface that was read, with a hint if the unit seems wrong.
void report_wall(const SurfaceValue& wall, const RunContext& context);

}  // namespace sterna::scripting
