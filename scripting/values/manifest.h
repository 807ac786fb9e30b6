// The record beside every mesh: what it was made of, with which options, by which version. No wall-clock, no thread count: same input, same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// JSON text of the manifest, schema "sterna-manifest-1". \param hash io::hash_input of the finished file, by which a later run knows that the manifest is of
/// it
std::string manifest_json(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed, const std::string& hash = {});

/// Regions of fluid that are not connected with each other, as a JSON array of their volumes (m^3) and patches, the largest first.
std::string regions_json(const HybridMesh& mesh);
/// A report of its check as JSON or text, with these regions; the text names them where there are several.
std::string check_json(const CheckReport& report, const HybridMesh& mesh);
std::string check_text(const CheckReport& report, const HybridMesh& mesh);

/// Where the manifest of a mesh goes: NAME.json beside it, also of a folder with a slash at its end.
std::filesystem::path manifest_path(const std::filesystem::path& output);

/// Writes it there, whole or not at all. \pre `output` is the finished file
/// \throws Error(write_failed).
void write_manifest(const MeshValue& mesh, const std::filesystem::path& output, const RunContext& context);

}  // namespace sterna::scripting
