// A series that has run, as the workbench shows it: its cases with what is known of each, and a script whose argument `case` goes through their meshes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sterna::scripting {

/// Whether the folder holds the table of a series that has run.
bool is_series_folder(const std::filesystem::path& folder);

struct SeriesCases {
  std::string script;  ///< its cases are numbered from 1, those without a mesh or a surface left out
  /// JSON list: name, parameters, status, verdict, quality, cells, gates (state by name), result, message; `case`: number in the script or null; `picture`:
  /// index into `pictures` or null.
  std::string json;
  std::vector<std::filesystem::path> pictures;  ///< PNG files that the cases have written
};

/// \pre is_series_folder(folder)
/// \throws Error(file_malformed) for a table that cannot be read; (file_not_found) where no case has a mesh or a surface
SeriesCases read_series_cases(const std::filesystem::path& folder);

}  // namespace sterna::scripting
