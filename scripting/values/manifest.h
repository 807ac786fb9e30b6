// The record beside every mesh: what it was made of, with which options, by which version. No wall-clock, no thread count: same input, same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// JSON text of the manifest, schema "sterna-manifest-1".
std::string manifest_json(const MeshValue& mesh, const std::filesystem::path& output, std::uint64_t seed);

/// Writes "<output>.json", whole or not at all.
/// \throws Error(write_failed).
void write_manifest(const MeshValue& mesh, const std::filesystem::path& output, const RunContext& context);

}  // namespace sterna::scripting
