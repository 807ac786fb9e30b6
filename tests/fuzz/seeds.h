// Small meshes with every kind of cell and part, written by our own writers: where a fuzzer starts beside the samples.
#pragma once

#include <filesystem>

#include "tests/fuzz/fuzz_input.h"

namespace sterna::fuzz {

/// Fills `folder` with inputs for the target: what the writers of its format write, and the samples of its extensions in the other folders.
/// \returns how many. Inputs above `largest` bytes are left out.
int write_seeds(const Target& target, const std::filesystem::path& folder, std::span<const std::filesystem::path> sample_folders, std::size_t largest);

}  // namespace sterna::fuzz
