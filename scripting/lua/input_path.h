// A file that a script or a command names.
#pragma once

#include <filesystem>
#include <string>

namespace sterna::scripting {

/// A file as the user wrote it and where it was found.
struct InputPath {
  std::string name;
  std::filesystem::path path;
};

}  // namespace sterna::scripting
