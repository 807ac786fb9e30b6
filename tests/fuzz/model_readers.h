// Readers of model files, which are not in the table of formats: sumo's, CPACS, airfoils, displacements.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"

namespace sterna::fuzz {

struct ModelReader {
  std::string_view name, extension;
  /// Reads the file and returns the defect of the result; empty if there is none.
  std::string (*read)(const std::filesystem::path&, const RunContext&);
  std::string_view seed;  ///< a small file
};

std::span<const ModelReader> model_readers();

}  // namespace sterna::fuzz
