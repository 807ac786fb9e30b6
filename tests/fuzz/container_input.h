// Container files (CGNS, TAU, VTKHDF) are read by libraries in a process of its own, which fuzzers need not try: what runs in ours begins with the image of the
// file that comes from there. So the inputs of these targets are images: here read_container() takes the file for one.
#pragma once

#include <filesystem>
#include <string>

#include "tests/fuzz/fuzz_input.h"

namespace sterna::fuzz {

bool is_container(const Target& target);

/// The image that sterna-read-container makes of a file; empty where it crashes.
std::string image_of(const Target& target, const std::filesystem::path& path);

}  // namespace sterna::fuzz
