#include "scripting/report/report_page.h"

#include "scripting/report/embedded_text.h"

#ifdef STERNA_REPORT_PAGE
STERNA_EMBED_TEXT(k_sterna_report_page_begin, k_sterna_report_page_end, STERNA_REPORT_PAGE)
#endif

namespace sterna::scripting {

std::string_view report_page() {
#ifdef STERNA_REPORT_PAGE
  return {k_sterna_report_page_begin, k_sterna_report_page_end};
#else
  return {};
#endif
}

}  // namespace sterna::scripting
