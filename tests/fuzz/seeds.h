// Small meshes with every kind of cell and part, written by our own writers: initial fuzzer inputs in addition to the samples.
#pragma once

#include <filesystem>

#include "tests/fuzz/fuzz_input.h"

namespace sterna::fuzz {

/// Fills `folder` with inputs for the target: files from the writers of its format, and samples with its extensions from the other folders. Leaves out inputs
/// above `largest` bytes.
/// \returns number of inputs
int write_seeds(const Target& target, const std::filesystem::path& folder, std::span<const std::filesystem::path> sample_folders, std::size_t largest);

}  // namespace sterna::fuzz
