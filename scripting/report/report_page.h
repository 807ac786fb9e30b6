#pragma once

#include <string_view>

namespace sterna::scripting {

/// The report page (HTML, scripting/report/page) with its two markers still in it; the text lives as long as the program.
/// Empty when this build had no npm, or npm could not get the page's libraries: then no report can be written.
std::string_view report_page();

}  // namespace sterna::scripting
