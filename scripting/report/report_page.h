#pragma once

#include <string_view>

namespace sterna::scripting {

/// Returns the report page (HTML, scripting/report/page) with its two markers not yet replaced; the string lives as long as the program.
/// Empty if npm was not available in this build, or could not download the page's libraries: then no report can be written.
std::string_view report_page();

}  // namespace sterna::scripting
