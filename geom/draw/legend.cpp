#include "geom/draw/legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geom/base/number_text.h"

namespace sterna::draw {
namespace {

/// Letter height relative to the height of a picture of the usual shape; never too small to read.
constexpr double k_text_share = 0.020, k_least_text = 9.0;
/// Lengths in letter heights: minimum width of the legend with a colour bar, minimum width with limits, and maximum width; width of the colour bar; line
/// spacing.
constexpr double k_least_panel = 10.0, k_panel_with_limits = 12.5, k_most_panel = 20.0, k_bar_width = 1.5, k_bar_height = 22.0, k_line = 1.55;
constexpr int k_ticks = 6;
/// Maximum number of colours of a legend inside the picture.
constexpr std::size_t k_most_inset = 8;
/// Marks nearer than this, in letter heights, share one label with their numbers.
constexpr double k_same_mark = 1.5;
/// Size of the smaller letters of remarks, relative to normal letters.
constexpr double k_small = 0.8;
constexpr Rgb k_frame_color{90, 96, 106};

std::string short_number(double value) {
  std::string text = number_text(value, 3);
  if (const std::size_t e = text.find("e"); e != std::string::npos) {  // 1e-06 as 1e-6
    const std::size_t digits = e + 2;
    while (digits + 1 < text.size() && text[digits] == '0') text.erase(digits, 1);
  }
  return text;
}

/// Returns as much of the text as fits, with an ellipsis if it is cut.
std::string fitted(Canvas& canvas, std::string text, double size, double width) {
  if (canvas.width_of(text, size) <= width) return text;
  while (!text.empty() && canvas.width_of(text + "\u2026", size) > width) {
    do text.pop_back();
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0u) == 0x80u);  // whole UTF-8 characters
    if (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0u) == 0xC0u) text.pop_back();
  }
  return text + "\u2026";
}

std::string title_of(const ColorBar& bar) { return bar.title + (bar.unit.empty() ? "" : ", " + bar.unit); }

std::string range_text(const ColorBar& bar) { return "from " + short_number(bar.smallest) + " to " + short_number(bar.largest); }

double draw_bar(Canvas& canvas, const Layout& layout, const Scene& scene, double x, double y) {
  const ColorBar& bar = *scene.bar;
  const double t = layout.text, room = layout.panel - 1.2 * t, width = k_bar_width * t;
  const double height = std::min(k_bar_height * t, 0.55 * layout.height);
  const std::string title = title_of(bar);
  canvas.text(x, y + t, fitted(canvas, title, canvas.width_of(title, t) > room ? k_small * t : t, room), canvas.width_of(title, t) > room ? k_small * t : t,
              k_text_color);
  y += k_line * t + 0.6 * t;
  const int n = static_cast<int>(height);
  for (int i = 0; i < n; ++i) {
    const double share = 1.0 - (i + 0.5) / n;
    canvas.rectangle(x, y + i, width, 1.0, scale_color(bar.scale, bar.scale == Scale::judged && bar.is_low_bad ? 1.0 - share : share));
  }
  canvas.frame(x, y, width, n, k_frame_color, 1.0);
  const auto level = [&](double value) { return y + n * (1.0 - bar.share_of(value)); };
  for (const double value : ticks_of(bar.low, bar.high, bar.is_log, k_ticks)) {
    canvas.line(x + width, level(value), x + width + 0.35 * t, level(value), k_frame_color, 1.0);
    canvas.text(x + width + 0.6 * t, level(value) + 0.35 * t, short_number(value), t, k_text_color);
  }
  for (const auto& [value, text] : bar.limits) {
    if (value < bar.low || value > bar.high) continue;
    canvas.line(x - 0.2 * t, level(value), x + width + 0.2 * t, level(value), k_text_color, 2.0);
    canvas.text(x + width + 3.6 * t, level(value) + 0.3 * t, text + " " + short_number(value), k_small * t, k_text_color);
  }
  y += n + k_line * t;
  canvas.text(x, y, range_text(bar), k_small * t, k_text_color);
  return y + 0.6 * t;
}

double draw_swatches(Canvas& canvas, const Layout& layout, const std::vector<Swatch>& swatches, double x, double y) {
  const double t = layout.text;
  for (const Swatch& swatch : swatches) {
    if (y + k_line * t > layout.height) break;
    canvas.rectangle(x, y, t, t, swatch.color);
    canvas.frame(x, y, t, t, k_frame_color, 1.0);
    canvas.text(x + 1.5 * t, y + 0.85 * t, fitted(canvas, swatch.text, t, std::max(layout.panel, layout.inset) - 2.6 * t), t, k_text_color);
    y += k_line * t;
  }
  return y;
}

}  // namespace

std::vector<double> ticks_of(double low, double high, bool is_log, int n) {
  std::vector<double> ticks;
  if (!(low < high)) return {low};
  if (is_log) {
    const double decades = std::log10(high / low);
    const int every = std::max(1, static_cast<int>(std::ceil(decades / n)));
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= static_cast<int>(std::ceil(std::log10(high))); ++e) {
      if (every > 1 && e % every != 0) continue;
      for (const double m : {1.0, 2.0, 5.0}) {
        if (m > 1.0 && decades > 0.5 * n) continue;
        const double value = m * std::pow(10.0, e);
        if (value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9)) ticks.push_back(value);
      }
    }
    if (ticks.size() >= 2) return ticks;
    ticks.clear();
  }
  const double rough = (high - low) / n, power = std::pow(10.0, std::floor(std::log10(rough))), lead = rough / power;
  const double step = power * (lead <= 1.0 ? 1.0 : lead <= 2.0 ? 2.0 : lead <= 5.0 ? 5.0 : 10.0);
  const auto first = static_cast<std::int64_t>(std::ceil(low / step - 1e-9)), last = static_cast<std::int64_t>(std::floor(high / step + 1e-9));
  for (std::int64_t i = first; i <= last && i - first < 50; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

Layout layout_of(const DrawOptions& options, const Scene& scene, bool has_title, std::span<const DrawMark> marks) {
  Layout layout{static_cast<double>(options.width), static_cast<double>(options.height), 0.0};
  const double t = layout.text = std::max(k_least_text, k_text_share * std::min(layout.height, layout.width / 1.6));
  layout.head = has_title ? 2.6 * t : 0.0;
  if (!options.legend) return layout;
  Canvas measure(Image{1, 1, {{255, 255, 255}}});
  double needed = 0.0;
  for (const Swatch& swatch : scene.swatches) needed = std::max(needed, measure.width_of(swatch.text, t) + 3.2 * t);
  for (const DrawMark& mark : marks) needed = std::max(needed, measure.width_of(mark.text, k_small * t) + 3.2 * t);
  if (scene.bar)
    needed = std::max({needed, measure.width_of(title_of(*scene.bar), k_small * t) + 2.0 * t, measure.width_of(range_text(*scene.bar), k_small * t) + 1.2 * t,
                       (scene.bar->limits.empty() ? k_least_panel : k_panel_with_limits) * t});
  needed = std::min({needed, k_most_panel * t, 0.4 * layout.width});
  const bool is_short = !scene.bar && marks.empty() && scene.swatches.size() <= k_most_inset;
  (is_short ? layout.inset : layout.panel) = needed;
  return layout;
}

namespace {

double inset_height(const Layout& layout, const Scene& scene) { return (k_line * static_cast<double>(scene.swatches.size()) + 0.7) * layout.text; }

}  // namespace

bool place_inset(Layout& layout, const Scene& scene, const Image& picture, Rgb paper) {
  const double gap = 0.6 * layout.text, height = inset_height(layout, scene);
  const double right = layout.width - layout.inset - gap, top = layout.head + gap, bottom = layout.height - height - gap;
  const auto is_empty = [&](double x0, double y0) {
    const auto limit = [](double value, int n) { return std::clamp(static_cast<int>(value), 0, n); };
    for (int y = limit(y0, picture.height); y < limit(std::ceil(y0 + height), picture.height); ++y)
      for (int x = limit(x0, picture.width); x < limit(std::ceil(x0 + layout.inset), picture.width); ++x)
        if (picture.at(x, y) != paper) return false;
    return true;
  };
  for (const auto& [x, y] : {std::pair(right, top), std::pair(gap, top), std::pair(right, bottom)})
    if (is_empty(x, y)) {
      layout.inset_x = x;
      layout.inset_y = y;
      return true;
    }
  return false;
}

void move_inset_to_panel(Layout& layout) { layout.panel = std::exchange(layout.inset, 0.0); }

void draw_title(Canvas& canvas, const Layout& layout, const std::string& title) {
  const double size = 1.15 * layout.text;
  canvas.text(layout.text, 1.7 * layout.text, fitted(canvas, title, size, layout.width - 2.0 * layout.text), size, k_text_color);
}

void draw_legend(Canvas& canvas, const Layout& layout, const Scene& scene, std::span<const DrawMark> marks) {
  if (layout.inset > 0.0) {
    const double t = layout.text, x = layout.inset_x, y = layout.inset_y;
    canvas.rectangle(x, y, layout.inset, inset_height(layout, scene), {255, 255, 255}, 0.85);
    draw_swatches(canvas, layout, scene.swatches, x + 0.6 * t, y + 0.6 * t);
  }
  if (layout.panel <= 0.0) return;
  const double t = layout.text, x = layout.width - layout.panel + 0.6 * t;
  canvas.rectangle(layout.width - layout.panel, layout.head, layout.panel, layout.height - layout.head, {255, 255, 255});
  double y = layout.head + 0.8 * t;
  if (scene.bar) y = draw_bar(canvas, layout, scene, x, y) + 0.6 * t;
  std::vector<Swatch> swatches = scene.swatches;
  if (scene.bar && scene.has_faces_without_value) swatches.push_back({k_no_value, "no value"});
  y = draw_swatches(canvas, layout, swatches, x, y) + 0.8 * t;
  for (std::size_t i = 0; i < marks.size(); ++i, y += k_line * k_small * t) {
    if (y + t > layout.height) break;
    canvas.text(x, y + k_small * t, std::to_string(i + 1), k_small * t, k_mark_color);
    canvas.text(x + 1.4 * t, y + k_small * t, fitted(canvas, marks[i].text, k_small * t, layout.panel - 2.4 * t), k_small * t, k_text_color);
  }
}

void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera) {
  const double t = layout.text, length = 2.4 * t, x0 = 4.3 * t, y0 = layout.height - 4.3 * t;
  canvas.rectangle(0.5 * t, layout.height - 8.1 * t, 7.6 * t, 7.6 * t, {255, 255, 255}, 0.7);
  struct Axis {
    Vec3 direction;
    std::string_view name;
    Rgb color;
  };
  std::array<Axis, 3> axes = {{{{1, 0, 0}, "x", {196, 48, 48}}, {{0, 1, 0}, "y", {40, 140, 60}}, {{0, 0, 1}, "z", {48, 84, 196}}}};
  std::stable_sort(axes.begin(), axes.end(), [&](const Axis& a, const Axis& b) { return dot(a.direction, camera.toward) < dot(b.direction, camera.toward); });
  for (const Axis& axis : axes) {
    const double dx = dot(axis.direction, camera.right), dy = -dot(axis.direction, camera.up), reach = std::hypot(dx, dy);
    if (reach < 0.05) {
      canvas.disc(x0, y0, 0.2 * t, axis.color);
      canvas.text(x0 - 0.7 * t, y0 + 1.1 * t, axis.name, k_small * t, axis.color, Anchor::center);
      continue;
    }
    const double x1 = x0 + length * dx, y1 = y0 + length * dy, ux = dx / reach, uy = dy / reach, head = 0.45 * t;
    canvas.line(x0, y0, x1, y1, axis.color, 0.12 * t);
    canvas.triangle({x1 + head * ux, y1 + head * uy, x1 - 0.45 * head * uy, y1 + 0.45 * head * ux, x1 + 0.45 * head * uy, y1 - 0.45 * head * ux}, axis.color);
    canvas.text(x1 + 1.0 * t * ux, y1 + 1.0 * t * uy + 0.3 * t, axis.name, k_small * t, axis.color, Anchor::center);
  }
  if (camera.is_perspective()) return;
  const double most = 0.16 * (layout.width - layout.panel) / camera.scale, power = std::pow(10.0, std::floor(std::log10(most)));
  const double metres = power * (most >= 5.0 * power ? 5.0 : most >= 2.0 * power ? 2.0 : 1.0), pixels = metres * camera.scale;
  const std::string text = metres >= 0.5    ? short_number(metres) + " m"
                           : metres >= 5e-4 ? short_number(1e3 * metres) + " mm"
                                            : short_number(1e6 * metres) + " \u00b5m";
  const double x = 9.5 * t, y = layout.height - 1.6 * t;
  canvas.rectangle(x - 0.4 * t, y - 1.5 * t, pixels + 0.8 * t, 2.0 * t, {255, 255, 255}, 0.7);
  canvas.line(x, y, x + pixels, y, k_text_color, 0.12 * t);
  for (const double end : {x, x + pixels}) canvas.line(end, y - 0.3 * t, end, y + 0.3 * t, k_text_color, 0.12 * t);
  canvas.text(x + 0.5 * pixels, y - 0.5 * t, text, k_small * t, k_text_color, Anchor::center);
}

void draw_lines(Canvas& canvas, const Layout& layout, const Camera& camera, const Scene& scene) {
  const double t = layout.text;
  for (const SceneLines& lines : scene.lines) {
    Projected middle;
    double longest = -1.0;
    for (const auto& [a, b] : lines.segments) {
      if (camera.is_perspective() && (camera.ahead(a) <= 0.0 || camera.ahead(b) <= 0.0)) continue;
      const Projected p = camera.project(a), q = camera.project(b);
      canvas.line(p.x, p.y, q.x, q.y, lines.color, 0.3 * t);
      const double x = 0.5 * (p.x + q.x), y = 0.5 * (p.y + q.y), length = std::hypot(q.x - p.x, q.y - p.y);
      const bool is_inside = x > 0.0 && x < layout.width - layout.panel && y > layout.head && y < layout.height;
      if (!is_inside || length <= longest) continue;
      longest = length;
      middle = {x, y, 0.0};
    }
    if (longest < 0.0) continue;
    const double width = canvas.width_of(lines.name, t) + 0.4 * t, x = std::clamp(middle.x + 0.5 * t, 0.0, std::max(0.0, layout.width - layout.panel - width));
    canvas.rectangle(x, middle.y - 0.7 * t, width, 1.4 * t, {255, 255, 255}, 0.8);
    canvas.text(x + 0.2 * t, middle.y + 0.35 * t, lines.name, t, lines.color);
  }
}

void draw_marks(Canvas& canvas, const Layout& layout, const Camera& camera, std::span<const DrawMark> marks) {
  const double t = layout.text;
  struct Label {
    Projected at;
    std::string numbers;
  };
  std::vector<Label> labels;  // coincident marks share one label
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (camera.is_perspective() && camera.ahead(marks[i].position) <= 0.0) continue;
    const Projected at = camera.project(marks[i].position);
    if (at.x < 0.0 || at.y < 0.0 || at.x > layout.width - layout.panel || at.y > layout.height) continue;
    canvas.circle(at.x, at.y, 0.5 * t, {255, 255, 255}, 0.3 * t);
    canvas.circle(at.x, at.y, 0.5 * t, k_mark_color, 0.14 * t);
    const auto near =
        std::find_if(labels.begin(), labels.end(), [&](const Label& label) { return std::hypot(label.at.x - at.x, label.at.y - at.y) < k_same_mark * t; });
    if (near == labels.end()) labels.push_back({at, std::to_string(i + 1)});
    else near->numbers += ", " + std::to_string(i + 1);
  }
  for (const Label& label : labels) {
    const double width = canvas.width_of(label.numbers, t) + 0.4 * t, x = std::max(0.0, std::min(label.at.x + 0.7 * t, layout.width - layout.panel - width));
    canvas.rectangle(x, label.at.y - 1.5 * t, width, 1.3 * t, {255, 255, 255}, 0.8);
    canvas.text(x + 0.2 * t, label.at.y - 0.45 * t, label.numbers, t, k_mark_color);
  }
}

}  // namespace sterna::draw
