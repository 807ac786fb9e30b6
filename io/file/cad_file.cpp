#include "io/file/cad_file.h"

#include "geom/base/error.h"
#include "io/input/file_buffer.h"
#include "io/output/atomic_file.h"

namespace sterna::io {

bool is_cad_file(const std::filesystem::path& path) { return cad::format_of_name(path.filename().string()).has_value(); }

CadFile read_cad(const std::filesystem::path& path, const ReadCadOptions& options, const RunContext& context) {
  const FileBuffer file = load_file(path, context.part("load", 0.0, 0.05));
  std::optional<cad::CadFormat> format = cad::format_of_bytes(file.text());
  if (!format) format = cad::format_of_name(path.filename().string());
  if (!format) throw_unsupported(file.source, "neither the contents nor the name of the file are those of STEP, IGES or BREP");
  return cad::read_cad_bytes(file.text(), *format, file.source, options, context.part("read_cad", 0.05, 1.0));
}

void write_cad(const Model& model, const std::filesystem::path& path, const WriteCadOptions& options, const RunContext& context) {
  const std::optional<cad::CadFormat> format = cad::format_of_name(path.filename().string());
  if (!format || path.extension() == ".gz")
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "writing " + path.string(),
                 .problem = "the file extension is not that of a CAD format that can be written",
                 .hint = "use .step, .iges or .brep"});
  AtomicFile file(path);
  file.append(cad::cad_bytes(model, *format, path.filename().string(), options, context));
  file.commit();
}

}  // namespace sterna::io
