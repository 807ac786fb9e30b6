// A scalar field at points, written by another program or an earlier run: the target edge lengths of an adapted mesh.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::io {

struct PointField {
  std::vector<Vec3> points;    ///< metres
  std::vector<double> values;  ///< one per point
};

/// Reads the point data array `name` from all pieces of a VTU file, in any encoding that read_volume_vtu() accepts.
/// \throws Error file_malformed (no such array, with the available names; not one value per point; not finite), unsupported_format, file_not_found.
PointField read_point_field(const std::filesystem::path& path, const std::string& name, const RunContext& context);

}  // namespace sterna::io
