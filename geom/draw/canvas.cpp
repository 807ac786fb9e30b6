#include "geom/draw/canvas.h"

#include <cairo-ft.h>
#include <cairo.h>
#include <ft2build.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "geom/base/error.h"
#include "geom/draw/font.h"
#include FT_FREETYPE_H

namespace sterna::draw {
namespace {

[[noreturn]] void fail(const std::string& what) { throw Error({.code = ErrorCode::internal, .attempted = "drawing", .problem = what}); }

void require(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) fail(std::string("cairo: ") + cairo_status_to_string(status));
}

/// The font as a FreeType object. Cairo caches fonts, so it is released when cairo releases it.
struct Font {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  Font() = default;
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;
  ~Font() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }
};
const cairo_user_data_key_t k_font_key{};

cairo_font_face_t* open_font() {
  auto font = std::make_unique<Font>();
  const auto bytes = embedded_font();
  if (FT_Init_FreeType(&font->library) != 0) fail("the FreeType library cannot be initialised");
  if (FT_New_Memory_Face(font->library, bytes.data(), static_cast<FT_Long>(bytes.size()), 0, &font->face) != 0) fail("the embedded font cannot be read");
  cairo_font_face_t* const face = cairo_ft_font_face_create_for_ft_face(font->face, FT_LOAD_NO_HINTING);
  const cairo_status_t status = cairo_font_face_set_user_data(face, &k_font_key, font.get(), [](void* data) { delete static_cast<Font*>(data); });
  if (status != CAIRO_STATUS_SUCCESS) {
    cairo_font_face_destroy(face);
    require(status);
  }
  font.release();  // NOLINT: owned by cairo now
  return face;
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

}  // namespace

struct Canvas::Cairo {
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;
  Cairo() = default;
  Cairo(const Cairo&) = delete;
  Cairo& operator=(const Cairo&) = delete;
  ~Cairo() {
    if (context) cairo_destroy(context);
    if (surface) cairo_surface_destroy(surface);
  }

  void ink(Rgb color, double opacity = 1.0) const { cairo_set_source_rgba(context, color.r / 255.0, color.g / 255.0, color.b / 255.0, opacity); }
};

Canvas::Canvas(const Image& image) : cairo_(std::make_unique<Cairo>()) {
  cairo_->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height);
  require(cairo_surface_status(cairo_->surface));
  unsigned char* const data = cairo_image_surface_get_data(cairo_->surface);
  const int stride = cairo_image_surface_get_stride(cairo_->surface);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = image.at(x, y);
      const std::uint32_t word = (std::uint32_t{c.r} << 16) | (std::uint32_t{c.g} << 8) | c.b;
      std::memcpy(data + static_cast<std::ptrdiff_t>(y) * stride + 4 * x, &word, 4);
    }
  cairo_surface_mark_dirty(cairo_->surface);
  cairo_->context = cairo_create(cairo_->surface);
  require(cairo_status(cairo_->context));

  cairo_font_face_t* const font = open_font();
  cairo_set_font_face(cairo_->context, font);
  cairo_font_face_destroy(font);  // owned by the context
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo_->context, options);
  cairo_font_options_destroy(options);
  require(cairo_status(cairo_->context));
}

Canvas::~Canvas() = default;

double Canvas::width_of(std::string_view text, double size) {
  cairo_set_font_size(cairo_->context, size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_->context, std::string(text).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, std::string_view text, double size, Rgb color, Anchor anchor) {
  const double shift = anchor == Anchor::left ? 0.0 : anchor == Anchor::center ? 0.5 : 1.0;
  if (shift > 0.0) x -= shift * width_of(text, size);
  cairo_set_font_size(cairo_->context, size);
  cairo_->ink(color);
  cairo_move_to(cairo_->context, x, y);
  cairo_show_text(cairo_->context, std::string(text).c_str());
}

void Canvas::rectangle(double x, double y, double width, double height, Rgb fill, double opacity) {
  cairo_->ink(fill, opacity);
  cairo_rectangle(cairo_->context, x, y, width, height);
  cairo_fill(cairo_->context);
}

void Canvas::frame(double x, double y, double width, double height, Rgb color, double line_width) {
  cairo_->ink(color);
  cairo_set_line_width(cairo_->context, line_width);
  cairo_rectangle(cairo_->context, x, y, width, height);
  cairo_stroke(cairo_->context);
}

void Canvas::line(double x0, double y0, double x1, double y1, Rgb color, double line_width) {
  cairo_->ink(color);
  cairo_set_line_width(cairo_->context, line_width);
  cairo_move_to(cairo_->context, x0, y0);
  cairo_line_to(cairo_->context, x1, y1);
  cairo_stroke(cairo_->context);
}

void Canvas::circle(double x, double y, double radius, Rgb color, double line_width) {
  cairo_->ink(color);
  cairo_set_line_width(cairo_->context, line_width);
  cairo_new_path(cairo_->context);
  cairo_arc(cairo_->context, x, y, radius, 0.0, 2.0 * std::numbers::pi);
  cairo_stroke(cairo_->context);
}

void Canvas::disc(double x, double y, double radius, Rgb fill) {
  cairo_->ink(fill);
  cairo_new_path(cairo_->context);
  cairo_arc(cairo_->context, x, y, radius, 0.0, 2.0 * std::numbers::pi);
  cairo_fill(cairo_->context);
}

void Canvas::triangle(const std::array<double, 6>& c, Rgb fill) {
  cairo_->ink(fill);
  cairo_move_to(cairo_->context, c[0], c[1]);
  cairo_line_to(cairo_->context, c[2], c[3]);
  cairo_line_to(cairo_->context, c[4], c[5]);
  cairo_close_path(cairo_->context);
  cairo_fill(cairo_->context);
}

std::string Canvas::png() {
  require(cairo_status(cairo_->context));
  cairo_surface_flush(cairo_->surface);
  std::string bytes;
  require(cairo_surface_write_to_png_stream(cairo_->surface, append, &bytes));
  return bytes;
}

}  // namespace sterna::draw
