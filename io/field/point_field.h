// A scalar at points, as another program or an earlier run left it: the wanted edge lengths of an adapted mesh.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::io {

struct PointField {
  std::vector<Vec3> points;    ///< metres
  std::vector<double> values;  ///< one for each point
};

/// The point data array `name` of a VTU file, of all its pieces, in any encoding that read_volume_vtu() takes.
/// \throws Error file_malformed (no such array: those that there are; other than one value for each point; not finite), unsupported_format, file_not_found.
PointField read_point_field(const std::filesystem::path& path, const std::string& name, const RunContext& context);

}  // namespace sterna::io
