// The font of all pictures: DejaVu Sans, as a TrueType file's bytes, put into the program when it is built.
#pragma once

#include <span>

namespace sterna::draw {

std::span<const unsigned char> embedded_font();

}  // namespace sterna::draw
