// The font of all pictures: DejaVu Sans, as the bytes of a TrueType file, embedded at build time.
#pragma once

#include <span>

namespace sterna::draw {

std::span<const unsigned char> embedded_font();

}  // namespace sterna::draw
