// `sterna convert`: a surface or a volume mesh from one format into another, nothing added, nothing repaired.
#pragma once

#include <filesystem>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

struct ConvertSettings {
  std::string format;               ///< name of the output's format; empty: by the extension
  bool as_surface = false;          ///< of a volume mesh take the boundary
  WriteOptions writing;             ///< of a volume mesh
  bool is_numbering_given = false;  ///< which is refused where there are no cells
};

/// Volume meshes stay volume meshes where the output's format has them, else it is an error unless the boundary is asked for. Connectivity, coordinates and,
/// unless `writing` asks for another, order are kept; what the format cannot hold (names, digits) is told in the log. \returns what was written: "surface, 12
/// triangles, 2 patches" \throws Error of io; unsupported_format when the output's format cannot hold what the input is, before anything is written.
std::string convert(const InputPath& input, const std::filesystem::path& output, const ConvertSettings& settings, const RunContext& context);

}  // namespace sterna::scripting
