#pragma once

#include <string_view>

namespace sterna::scripting {

/// The page of the workbench (HTML, scripting/report/page/src/workbench); the text lives as long as the program. Empty where report_page() is.
std::string_view view_page();

}  // namespace sterna::scripting
