#pragma once

#include <string_view>

namespace sterna::scripting {

/// Returns the page of the workbench (HTML, scripting/report/page/src/workbench); the string lives as long as the program. Empty if report_page() is empty.
std::string_view view_page();

}  // namespace sterna::scripting
