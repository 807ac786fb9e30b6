// Patch names: from the files, made clean and unique, or regions between sharp edges.
#pragma once

#include <string>

#include "surfmesh/stitch/edges.h"

namespace sterna::surfmesh {

/// [A-Za-z0-9_.-] only: everything else becomes '_'; not empty, does not start with a digit.
std::string clean_patch_name(const std::string& name, const std::string& if_empty);

/// Numbers the regions of each patch that are separated by edges bending by more than `angle` (rad). `parent` receives the old patch of each region;
/// returns the number of regions.
std::uint32_t split_by_angle(IndexedSurface& surface, const EdgeTable& edges, double angle, std::vector<std::uint32_t>& parent);

}  // namespace sterna::surfmesh
