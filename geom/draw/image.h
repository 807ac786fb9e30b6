// Colours and images with 8 bits per channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sterna::draw {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Rows from the top, without padding.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Rgb at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
};

}  // namespace sterna::draw
