// The page of a series (docs/report.md): its cases side by side.
#pragma once

#include <span>
#include <string>

#include "scripting/series/series_report.h"

namespace sterna::scripting {

/// HTML, one file. Of each case: parameters, verdict, figures and gates as its quality.json and measure.json say; the first picture (.png) that it has written
/// is shown, its first page (.html) linked. Pictures are left out, largest first, where the page would become larger than k_most_page_bytes. Empty in a build
/// without the page.
std::string series_page_html(const SeriesPlan& plan, std::span<const CaseResult> results);

}  // namespace sterna::scripting
