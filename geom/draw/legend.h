// Elements beside the picture: title, colour bar, swatches, axes, scale, marks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/draw/camera.h"
#include "geom/draw/canvas.h"
#include "geom/draw/draw.h"
#include "geom/draw/scene.h"

namespace sterna::draw {

/// Layout of a picture, pixels.
struct Layout {
  double width, height;
  double text;                          ///< size of letters
  double panel = 0.0;                   ///< width of the legend at the right
  double inset = 0.0;                   ///< width of a legend of a few colours, drawn in an empty part of the picture
  double inset_x = 0.0, inset_y = 0.0;  ///< its upper left corner
  double head = 0.0;                    ///< height of the title at the top
  double middle_x() const { return 0.5 * (width - panel); }
  double middle_y() const { return head + 0.5 * (height - head); }
};
/// Places the inset in the first corner of the picture where all pixels have the paper colour: upper right, upper left, lower right. \returns false if there is
/// none
bool place_inset(Layout& layout, const Scene& scene, const Image& picture, Rgb paper);
/// Changes the inset to a panel beside the picture.
void move_inset_to_panel(Layout& layout);

/// Computes the layout. The panel is as wide as its contents, up to a limit.
Layout layout_of(const DrawOptions& options, const Scene& scene, bool has_title, std::span<const DrawMark> marks);

void draw_title(Canvas& canvas, const Layout& layout, const std::string& title);
/// Draws colour bar, swatches, and the texts of marks.
void draw_legend(Canvas& canvas, const Layout& layout, const Scene& scene, std::span<const DrawMark> marks);
/// Draws the directions of x, y and z; in orthographic views also a length scale.
void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera);
/// Draws the lines of discs and their names. \pre drawn before marks
void draw_lines(Canvas& canvas, const Layout& layout, const Camera& camera, const Scene& scene);
void draw_marks(Canvas& canvas, const Layout& layout, const Camera& camera, std::span<const DrawMark> marks);

/// Returns about `n` round numbers from low to high: 1, 2 or 5 times powers of ten; for logarithmic scales powers of ten, or 1, 2, 5 times these if there are
/// few.
std::vector<double> ticks_of(double low, double high, bool is_log, int n);

}  // namespace sterna::draw
