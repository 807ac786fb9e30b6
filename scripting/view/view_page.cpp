#include "scripting/view/view_page.h"

#include "scripting/report/embedded_text.h"

#ifdef STERNA_VIEW_PAGE
STERNA_EMBED_TEXT(k_sterna_view_page_begin, k_sterna_view_page_end, STERNA_VIEW_PAGE)
#endif

namespace sterna::scripting {

std::string_view view_page() {
#ifdef STERNA_VIEW_PAGE
  return {k_sterna_view_page_begin, k_sterna_view_page_end};
#else
  return {};
#endif
}

}  // namespace sterna::scripting
