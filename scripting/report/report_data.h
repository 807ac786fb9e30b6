// Contents of a report page of a mesh or surface (schema "sterna-report-1", docs/report.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scripting/report/report_options.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Size limit of a page; larger pages are decimated further.
inline constexpr std::size_t k_most_page_bytes = 25'000'000;

/// Returns the page of a volume mesh. Uses the mesh's last check, or checks the mesh if there is none. \p cuts locations by name, or planes ("x=1.2",
/// "point=0,0,0 normal=0,1,0"), which are shown before the automatic cuts. \p name replaces an automatic title
/// \throws Error(unsupported_format) in a build without the page; (bad_argument) for a cut that does not exist; (mesh_invalid) if indices or points are
/// unusable; (cancelled)
std::string report_html(const MeshValue& mesh, const ReportOptions& options, const std::vector<std::string>& cuts, std::string_view name,
                        const RunContext& context);
/// Returns the page of a surface, which shows only its shape.
std::string report_html(const SurfaceValue& surface, const ReportOptions& options, std::string_view name, const RunContext& context);

/// Tests the cuts before the computation.
/// \throws Error(bad_argument) for a string that is neither a plane nor a possible name, (unsupported_format) in a build without the page
void require_report_cuts(const std::vector<std::string>& cuts);

}  // namespace sterna::scripting
