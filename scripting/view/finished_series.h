// A finished series as shown in the workbench: the data of its cases, and a script whose argument `case` selects a mesh.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sterna::scripting {

/// Returns true if the folder contains the table of a finished series.
bool is_series_folder(const std::filesystem::path& folder);

struct SeriesCases {
  std::string script;  ///< cases are numbered from 1; cases without a mesh or a surface are left out
  /// JSON list of cases with name, parameters, status, verdict, quality, cells, gates (state by name), result and message. `case` is the number in the script,
  /// or null; `picture` is an index into `pictures`, or null.
  std::string json;
  std::vector<std::filesystem::path> pictures;  ///< PNG files that the cases have written
};

/// Reads the cases of a series folder.
/// \pre is_series_folder(folder)
/// \throws Error(file_malformed) for a table that cannot be read; (file_not_found) if no case has a mesh or a surface
SeriesCases read_series_cases(const std::filesystem::path& folder);

}  // namespace sterna::scripting
