// What a report page shows of one mesh or surface (schema "sterna-report-1", docs/report.md).
#pragma once

#include <string>
#include <vector>

#include "geom/mesh/cut_places.h"
#include "scripting/verbs.h"

namespace sterna::scripting {

struct ReportSettings {
  std::string title;                       ///< empty: the file's name
  std::vector<CutPlace> cuts;              ///< of the user, before the automatic ones
  bool automatic_cuts = true;
  bool with_times = true;                  ///< of this run; without them the same mesh gives the same bytes
  int max_triangles = 250000;              ///< of the surface, above which it is thinned
  int max_polygons = 100000;               ///< of all cuts; of each those next to its focus
};

/// The page of a volume mesh, below k_most_page_bytes: where it would be larger, surface and cuts are thinned further. The mesh's last check counts; one that was never checked is checked here.
/// \throws Error(unsupported_format) of a build without the page, Error(cancelled)
std::string report_html(const MeshValue& mesh, const ReportSettings& settings, const RunContext& context);
/// The page of a surface: its shape only.
std::string report_html(const SurfaceValue& surface, const ReportSettings& settings, const RunContext& context);

inline constexpr std::size_t k_most_page_bytes = 25'000'000;

}  // namespace sterna::scripting
