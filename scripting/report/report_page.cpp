#include "scripting/report/report_page.h"

#ifdef STERNA_REPORT_PAGE

// The assembler takes the bytes in as they are: no generated source, no limit on the length of literals.
asm(".pushsection .rodata\n"
    "k_sterna_report_page_begin:\n"
    ".incbin \"" STERNA_REPORT_PAGE
    "\"\n"
    "k_sterna_report_page_end:\n"
    ".byte 0\n"
    ".popsection\n"
    ".globl k_sterna_report_page_begin\n"
    ".globl k_sterna_report_page_end\n");

extern "C" {
extern const char k_sterna_report_page_begin[];
extern const char k_sterna_report_page_end[];
}

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
