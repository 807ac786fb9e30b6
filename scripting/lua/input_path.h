// A file named by a script or a command.
#pragma once

#include <filesystem>
#include <string>

namespace sterna::scripting {

/// A file name as the user wrote it, and the location where the file was found.
struct InputPath {
  std::string name;
  std::filesystem::path path;
};

}  // namespace sterna::scripting
