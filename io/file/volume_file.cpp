#include "io/file/volume_file.h"

#include "geom/base/error.h"
#include "io/file/format_table.h"

namespace sterna::io {

HybridMesh read_volume_file(const std::filesystem::path& path, const RunContext& context) {
  const Format& format = format_of(path, FormatUse::read_volume);
  if (!format.read_volume)
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "reading " + path.string(),
                 .problem = "volume meshes are not read from " + std::string(format.name),
                 .hint = "volume meshes are read from " + list_formats_with(FormatUse::read_volume)});
  const StageTimer timer(context, "read");
  return format.read_volume(path, context.part("read", 0.0, 1.0));
}

void write_volume_file(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name, Numbering cells) {
  const Format& format = format_to_write(path, FormatUse::write_volume, format_name);
  const StageTimer timer(context, "write");
  if (format.write_numbered) format.write_numbered(mesh, path, cells, context.part("write", 0.0, 1.0));
  else format.write_volume(mesh, path, context.part("write", 0.0, 1.0));
}

}  // namespace sterna::io
