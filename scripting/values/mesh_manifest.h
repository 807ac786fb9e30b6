// The manifest beside a volume mesh, read back: formats such as SU2 hold names of patches only, and what the patches are stands in the manifest.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/lua/input_path.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// The text of the manifest "<file>.json" beside a mesh file; nothing where there is none, or where it is somebody else's or of another state of the file
/// (`hash` differs), which is a warning.
/// \throws Error(file_malformed) where it is ours but its contents are not as they must be
std::optional<std::string> fitting_manifest(const InputPath& file, const std::string& hash, const RunContext& context);

/// Adds what the format of the file does not hold and the manifest beside it knows: kinds of patches, periodic sides, first height and growth of the layers.
/// Notes patches whose kind nothing says. Kinds that stand in a second file (.mapbc, .bmap, .aboc, .names) win over the manifest, with a warning where they
/// differ. \throws Error of fitting_manifest
void complete_from_manifest(MeshValue& mesh, const InputPath& file, const std::string& hash, const RunContext& context);

/// patch "a", "b"
std::string quoted_list(const std::set<std::string>& names);

/// Why kinds are unknown: "duct.su2 holds names of patches only, and there is no manifest duct.su2.json"
std::string why_kinds_are_unknown(const InputPath& file);

/// Writes the manifest of `from` beside `to`, which holds the same mesh or surface in another format.
/// \throws Error(write_failed)
void write_manifest_of_copy(const std::string& manifest, const std::filesystem::path& to);

}  // namespace sterna::scripting
