// Readers of models' files, which the table of formats does not have: sumo's, CPACS, airfoils, displacements.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"

namespace sterna::fuzz {

struct ModelReader {
  std::string_view name, extension;
  /// Reads the file; what is wrong with the result, empty = nothing.
  std::string (*read)(const std::filesystem::path&, const RunContext&);
  std::string_view seed;  ///< a small file
};

std::span<const ModelReader> model_readers();

}  // namespace sterna::fuzz
