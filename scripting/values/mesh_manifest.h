// Reads the manifest beside a volume mesh. Formats such as SU2 hold only names of patches; the kinds of the patches are in the manifest.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/lua/input_path.h"
#include "scripting/values/option_json.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns the manifest "<file>.json" beside a mesh file. Returns nothing if there is none. Returns nothing, with a warning, if the file was not
/// written by sterna or belongs to another state of the mesh file (`hash` differs).
/// \throws Error(file_malformed) if the manifest is of sterna but its contents are invalid
std::optional<Json> fitting_manifest(const InputPath& file, const std::string& hash, const RunContext& context);

/// Adds what the format of the file does not hold but the manifest beside it does: kinds of patches, periodic sides, first height and growth of the layers.
/// Notes patches of unknown kind. Kinds in a second file (.mapbc, .bmap, .aboc, .names) win over the manifest, with a warning if they differ. \throws Error of
/// fitting_manifest
void complete_from_manifest(MeshValue& mesh, const InputPath& file, const std::string& hash, const RunContext& context);

/// Returns the names as: patch "a", "b"
std::string quoted_list(const std::set<std::string>& names);

/// Returns the reason why kinds are unknown: "duct.su2 holds names of patches only, and there is no manifest duct.su2.json"
std::string why_kinds_are_unknown(const InputPath& file);

/// Writes the manifest of `from` beside `to`, which holds the same mesh or surface in another format.
/// \param rounding io::rounding_of_volume_file; if it is not empty, it replaces the states of QUALITY gates in the manifest of a mesh
/// \throws Error(write_failed)
void write_manifest_of_copy(Json manifest, const std::filesystem::path& to, const std::string& rounding = {});

}  // namespace sterna::scripting
