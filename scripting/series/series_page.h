// The page of a series (docs/report.md), which compares its cases.
#pragma once

#include <span>
#include <string>

#include "scripting/series/series_report.h"

namespace sterna::scripting {

/// Returns the page as a single HTML file. Each case has parameters, verdict, figures and gates from its quality.json and measure.json; its first picture
/// (.png) is shown, its first page (.html) linked. Pictures are left out, largest first, if the page would exceed k_most_page_bytes. Empty in a build without
/// the page.
std::string series_page_html(const SeriesPlan& plan, std::span<const CaseResult> results);

}  // namespace sterna::scripting
