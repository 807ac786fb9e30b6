#include "io/surface_file.h"

#include "geom/base/error.h"
#include "io/format_table.h"

namespace sterna::io {

SurfaceSoup read_surface_file(const std::filesystem::path& path, const RunContext& context) {
  const Format& format = format_of(path);
  if (!format.read_surface)
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "reading " + path.string(),
                 .problem = std::string(format.name) + " is not read as a surface",
                 .hint = "write the surface as STL, OBJ, PLY, OFF, SU2, MSH or UGRID"});
  return format.read_surface(path, context);
}

}  // namespace sterna::io
