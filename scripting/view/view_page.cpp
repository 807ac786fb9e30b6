#include "scripting/view/view_page.h"

#ifdef STERNA_VIEW_PAGE

// As in report_page.cpp.
asm(".pushsection .rodata\n"
    "k_sterna_view_page_begin:\n"
    ".incbin \"" STERNA_VIEW_PAGE
    "\"\n"
    "k_sterna_view_page_end:\n"
    ".byte 0\n"
    ".popsection\n"
    ".globl k_sterna_view_page_begin\n"
    ".globl k_sterna_view_page_end\n");

extern "C" {
extern const char k_sterna_view_page_begin[];
extern const char k_sterna_view_page_end[];
}

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
