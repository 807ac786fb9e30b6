// The record beside every mesh: its inputs, options and program version. It has no wall-clock time and no thread count, so the same input gives the same bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scripting/values/option_json.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Adds the entries of a request: "options", and those of the history of the wall, rules, sources, discs, wake sheets and periodic sides.
void add_request(Json& json, const MeshOrigin& origin);

/// Returns the list of files with their hashes.
Json inputs_json(const std::vector<InputFile>& inputs);

/// Returns the manifest, schema "sterna-manifest-1"; the second function returns it as text. \param hash io::hash_input of the finished file, by which a later
/// run verifies that the manifest belongs to this file \param rounding io::rounding_of_volume_file; if it is not empty, the manifest has this reason instead of
/// the states of the QUALITY gates
Json manifest_of(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed, const std::string& hash = {},
                 const std::string& rounding = {});
std::string manifest_json(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed, const std::string& hash = {},
                          const std::string& rounding = {});

/// Returns the entry "quality" of the manifest of a file whose coordinates are rounded. \param rounding io::rounding_of_volume_file, not empty
Json unmeasured_quality_json(const std::string& rounding);

/// Returns the disconnected regions of fluid as a JSON array of their volumes (m^3) and patches, the largest first.
Json regions_json(const HybridMesh& mesh);
/// Returns the report of a check as JSON or text, with these regions; the text names the regions if there are several.
std::string check_json(const CheckReport& report, const HybridMesh& mesh);
std::string check_text(const CheckReport& report, const HybridMesh& mesh);

/// Returns the path of the manifest of a mesh: NAME.json beside it, also for a folder with a slash at its end.
std::filesystem::path manifest_path(const std::filesystem::path& output);

/// Writes the manifest beside the mesh, atomically. \pre `output` is the finished file
/// \param format name of the format in the table; empty: given by the extension
/// \throws Error(write_failed).
void write_manifest(const MeshValue& mesh, const std::filesystem::path& output, const RunContext& context, std::string_view format = {});

}  // namespace sterna::scripting
