#include "io/volume_file.h"

#include "geom/base/error.h"
#include "io/format_table.h"

namespace sterna::io {
namespace {

/// The names of the formats for which `can` holds, for hints.
template <class Predicate>
std::string format_names(const Predicate& can) {
  std::string text;
  for (const Format& format : formats())
    if (can(format)) text += (text.empty() ? "" : ", ") + std::string(format.name);
  return text;
}

}  // namespace

HybridMesh read_volume_file(const std::filesystem::path& path, const RunContext& context) {
  const Format& format = format_of(path);
  if (!format.read_volume)
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "reading " + path.string(),
                 .problem = "volume meshes are not read from " + std::string(format.name),
                 .hint = "formats read: " + format_names([](const Format& f) { return f.read_volume != nullptr; })});
  const StageTimer timer(context, "read");
  return format.read_volume(path, context.part("read", 0.0, 1.0));
}

void write_volume_file(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const Format& format = format_of(path);
  const bool is_packed = path.extension() == ".gz" || path.extension() == ".GZ";
  if (!format.write_volume || is_packed)
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "writing " + path.string(),
                 .problem = is_packed ? "files are not gzipped on writing" : "volume meshes are not written as " + std::string(format.name),
                 .hint = "formats written: " + format_names([](const Format& f) { return f.write_volume != nullptr; })});
  const StageTimer timer(context, "write");
  format.write_volume(mesh, path, context.part("write", 0.0, 1.0));
}

}  // namespace sterna::io
