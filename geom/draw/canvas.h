// Text and flat shapes on top of a picture, and the picture as PNG. The only code that uses cairo. The font (DejaVu Sans) is part of the program, so that text
// is the same everywhere.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "geom/draw/image.h"

namespace sterna::draw {

enum class Anchor { left, center, right };

/// Drawing surface in pixels, x to the right, y down, from the upper left corner. Failures of cairo throw Error(internal).
class Canvas {
 public:
  explicit Canvas(const Image& image);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// Draws UTF-8 text with its baseline at y.
  void text(double x, double y, std::string_view text, double size, Rgb color, Anchor anchor = Anchor::left);
  double width_of(std::string_view text, double size);
  void rectangle(double x, double y, double width, double height, Rgb fill, double opacity = 1.0);
  void frame(double x, double y, double width, double height, Rgb color, double line_width);
  void line(double x0, double y0, double x1, double y1, Rgb color, double line_width);
  void circle(double x, double y, double radius, Rgb color, double line_width);
  void disc(double x, double y, double radius, Rgb fill);
  void triangle(const std::array<double, 6>& corners, Rgb fill);

  /// Returns the picture as the bytes of a PNG file, without timestamps.
  std::string png();

 private:
  struct Cairo;
  std::unique_ptr<Cairo> cairo_;
};

}  // namespace sterna::draw
