// The page that reports are filled into: scripting/report/page, bundled by npm when sterna is built.
#pragma once

#include <string_view>

namespace sterna::scripting {

/// HTML with the places <!--STERNA_JSON--> and <!--STERNA_BLOB-->; empty in a build without npm.
std::string_view report_page();

}  // namespace sterna::scripting
