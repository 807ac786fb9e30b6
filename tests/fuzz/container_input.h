// Container files (CGNS, TAU, VTKHDF) are read by libraries in a separate process, which need not be fuzzed. Our own code begins with the image of the file
// that this process returns. Inputs of these targets are therefore images: here read_container() takes the file itself for an image.
#pragma once

#include <filesystem>
#include <string>

#include "tests/fuzz/fuzz_input.h"

namespace sterna::fuzz {

bool is_container(const Target& target);

/// Returns the image that sterna-read-container makes of a file; empty if that program crashes.
std::string image_of(const Target& target, const std::filesystem::path& path);

}  // namespace sterna::fuzz
