// What a report page shows of one mesh or surface (schema "sterna-report-1", docs/report.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scripting/report/report_options.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// A page that would be larger is thinned further.
inline constexpr std::size_t k_most_page_bytes = 25'000'000;

/// The page of a volume mesh. The mesh's last check counts; one that was never checked is checked here. \p cuts places by name or planes ("x=1.2", "point=0,0,0
/// normal=0,1,0"), shown before the automatic ones. \p name stands for an automatic title
/// \throws Error(unsupported_format) of a build without the page; (bad_argument) for a cut that is not there; (mesh_invalid) where indices or points are
/// unusable; (cancelled)
std::string report_html(const MeshValue& mesh, const ReportOptions& options, const std::vector<std::string>& cuts, std::string_view name,
                        const RunContext& context);
/// The page of a surface: its shape only.
std::string report_html(const SurfaceValue& surface, const ReportOptions& options, std::string_view name, const RunContext& context);

/// \throws Error(bad_argument) for a text that is neither a plane nor could be a name, (unsupported_format) of a build without the page; before the work
void require_report_cuts(const std::vector<std::string>& cuts);

}  // namespace sterna::scripting
