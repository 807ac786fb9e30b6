// The page of a series, which compares its cases (docs/report.md).
#pragma once

#include <span>
#include <string>

#include "scripting/series/series_report.h"

namespace sterna::scripting {

/// Returns the page as a single HTML file. Each case has parameters, verdict, figures and gates from its quality.json and measure.json. Its first picture
/// (.png) is shown, its first page (.html) is linked. If the page would exceed k_most_page_bytes, pictures are left out, largest first. Empty in a build
/// without the page.
std::string series_page_html(const SeriesPlan& plan, std::span<const CaseResult> results);

}  // namespace sterna::scripting
