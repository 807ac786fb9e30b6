// `sterna convert`: converts a surface or a volume mesh from one format to another. Nothing is added or repaired.
#pragma once

#include <filesystem>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

struct ConvertSettings {
  std::string format;               ///< name of the output's format; empty: by the extension
  bool as_surface = false;          ///< take the boundary of a volume mesh
  WriteOptions writing;             ///< for volume meshes
  bool is_numbering_given = false;  ///< --numbering is given, which is an error if there are no cells
};

/// Converts the file. Volume meshes stay volume meshes if the output's format supports them; otherwise it is an error unless the boundary is requested.
/// Connectivity, coordinates and order are kept, unless `writing` requests another order. Data that the format cannot hold (names, digits) are reported in the
/// log.
/// \returns what was written: "surface, 12 triangles, 2 patches"
/// \throws Error of io; unsupported_format if the output's format cannot hold the type of the input, before anything is written.
std::string convert(const InputPath& input, const std::filesystem::path& output, const ConvertSettings& settings, const RunContext& context);

}  // namespace sterna::scripting
