#include "geom/draw/font.h"

#include <cstddef>

// STERNA_FONT is the path found by CMake.
__asm__(
    ".pushsection .rodata\n"
    ".balign 16\n"
    "k_sterna_font_begin:\n"
    ".incbin \"" STERNA_FONT
    "\"\n"
    "k_sterna_font_end:\n"
    ".byte 0\n"
    ".popsection\n");

extern "C" const unsigned char k_sterna_font_begin[] __attribute__((visibility("hidden")));
extern "C" const unsigned char k_sterna_font_end[] __attribute__((visibility("hidden")));

namespace sterna::draw {

std::span<const unsigned char> embedded_font() { return {k_sterna_font_begin, static_cast<std::size_t>(k_sterna_font_end - k_sterna_font_begin)}; }

}  // namespace sterna::draw
