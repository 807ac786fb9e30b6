// Steps: polygons are projected and divided into triangles in parallel (project); triangles are assigned to tiles (deal); tiles are drawn in parallel, each
// with its triangles in their order (Tile). A tile holds only the samples of its own pixels, which are averaged at the end.
#include "geom/draw/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::draw {
namespace {

/// Samples along each side of a pixel.
constexpr int k_samples = 3;
/// Number of pixels along a side of a tile. A tile is so small that its 9216 samples, with a depth and a colour each, stay in the cache.
constexpr int k_tile = 32;
constexpr std::size_t k_polygon_chunk = 4096;
/// Geometry nearer to the eye than this fraction of the distance is clipped.
constexpr double k_near = 0.02;
/// Width of a polygon, in pixels, below which its edges are not drawn, and above which they are drawn in full.
constexpr double k_edges_fade = 1.5, k_edges_full = 6.0;
constexpr double k_edge_opacity = 0.6;
constexpr Rgb k_edge_color{20, 24, 32};
/// Main light from the upper left behind the viewer, and a weaker one from the right. Components: to the right, up, towards the viewer.
constexpr Vec3 k_key_light{-0.3482, 0.4975, 0.7945}, k_fill_light{0.7682, 0.0960, 0.6330};
constexpr double k_ambient = 0.48, k_key = 0.50, k_fill = 0.14;

struct ScreenTriangle {
  std::array<float, 3> x, y, depth;
  Rgb fill;
  std::uint8_t edges = 0;  ///< bit k: the edge from corner k to k + 1 is an edge of the polygon
  float edge_opacity = 0.0f;
};

struct Color {
  float r = 0, g = 0, b = 0;
};

double brightness(const Camera& camera, const Vec3& normal) {
  const Vec3 n{dot(normal, camera.right), dot(normal, camera.up), dot(normal, camera.toward)};
  return k_ambient + k_key * std::max(0.0, dot(n, k_key_light)) + k_fill * std::max(0.0, dot(n, k_fill_light));
}

Rgb shaded(Rgb color, double light) {
  const auto channel = [&](std::uint8_t c) { return static_cast<std::uint8_t>(std::min(255.0, std::floor(c * light + 0.5))); };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

/// Projects polygons; keeps the visible triangles.
class Projector {
 public:
  Projector(const Camera& camera, const RasterOptions& options) : camera_(camera), options_(options) {}

  void add(std::span<const Point> corners, const PolygonStyle& style, std::vector<ScreenTriangle>& triangles) {
    Vec3 normal;
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) normal += area_vector(corners[0], corners[k], corners[k + 1]);
    normal = normalized(normal);
    const bool is_front = dot(normal, camera_.to_eye(corners[0])) >= 0.0;
    const Rgb base = is_front ? style.front : style.back;
    const Rgb fill = style.is_lit ? shaded(base, brightness(camera_, is_front ? normal : -normal)) : base;
    clip(corners);
    const std::size_t n = clipped_.size();
    if (n < 3) return;
    screen_.clear();
    for (const Corner& corner : clipped_) screen_.push_back(camera_.project(corner.point));
    const float opacity = options_.edges && style.has_edges ? edge_opacity() : 0.0f;
    for (std::size_t k = 1; k + 1 < n; ++k) {
      ScreenTriangle t;
      t.fill = fill;
      t.edge_opacity = opacity;
      const std::array<std::size_t, 3> at = {0, k, k + 1};
      for (std::size_t i = 0; i < 3; ++i) {
        t.x[i] = static_cast<float>(screen_[at[i]].x);
        t.y[i] = static_cast<float>(screen_[at[i]].y);
        t.depth[i] = static_cast<float>(screen_[at[i]].depth);
      }
      if (k == 1 && clipped_[0].is_edge) t.edges |= 1;
      if (clipped_[k].is_edge) t.edges |= 2;
      if (k + 2 == n && clipped_[k + 1].is_edge) t.edges |= 4;
      if (is_seen(t)) triangles.push_back(t);
    }
  }

 private:
  struct Corner {
    Point point;
    bool is_edge;  ///< the side from this corner to the next is an edge of the polygon
  };

  /// Clips to the region in front of the eye.
  void clip(std::span<const Point> corners) {
    clipped_.clear();
    const auto room = [&](const Point& p) { return camera_.is_perspective() ? camera_.ahead(p) - k_near * camera_.distance : 1.0; };
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
      const double from = room(a), to = room(b);
      if (from > 0.0) clipped_.push_back({a, true});
      if ((from > 0.0) != (to > 0.0)) clipped_.push_back({a + (from / (from - to)) * (b - a), from <= 0.0});
    }
  }

  /// Returns the opacity of edges: full for polygons that are wide in the picture.
  float edge_opacity() const {
    double area = 0.0, longest = 0.0;
    const std::size_t n = screen_.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Projected &a = screen_[k], &b = screen_[(k + 1) % n];
      area += 0.5 * (a.x * b.y - b.x * a.y);
      longest = std::max(longest, std::hypot(b.x - a.x, b.y - a.y));
    }
    if (!(longest > 0.0)) return 0.0f;
    const double width = (n == 3 ? 2.0 : 1.0) * std::abs(area) / longest;
    return static_cast<float>(k_edge_opacity * std::clamp((width - k_edges_fade) / (k_edges_full - k_edges_fade), 0.0, 1.0));
  }

  bool is_seen(const ScreenTriangle& t) const {
    const auto [x0, x1] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y0, y1] = std::minmax({t.y[0], t.y[1], t.y[2]});
    return x1 > 0.0f && y1 > 0.0f && x0 < static_cast<float>(options_.width) && y0 < static_cast<float>(options_.height);
  }

  const Camera& camera_;
  const RasterOptions& options_;
  std::vector<Corner> clipped_;
  std::vector<Projected> screen_;
};

std::vector<ScreenTriangle> project(const Polygons& polygons, const Camera& camera, const RasterOptions& options, const RunContext& context) {
  return parallel_reduce(
      context, polygons.size(), std::vector<ScreenTriangle>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<ScreenTriangle> triangles;
        Projector projector(camera, options);
        for (std::size_t i = begin; i < end; ++i)
          projector.add({polygons.corners.data() + polygons.first[i], polygons.first[i + 1] - polygons.first[i]}, polygons.styles[i], triangles);
        return triangles;
      },
      [](std::vector<ScreenTriangle> all, std::vector<ScreenTriangle> more) {
        if (all.empty()) return more;
        all.insert(all.end(), more.begin(), more.end());
        return all;
      },
      k_polygon_chunk);
}

/// Triangles of each tile, in their order.
struct Deal {
  int n_x = 0, n_y = 0;
  std::vector<std::uint64_t> first;
  std::vector<std::uint32_t> triangles;
};

Deal deal(const std::vector<ScreenTriangle>& triangles, const RasterOptions& options) {
  Deal result;
  result.n_x = (options.width + k_tile - 1) / k_tile;
  result.n_y = (options.height + k_tile - 1) / k_tile;
  result.first.assign(static_cast<std::size_t>(result.n_x) * static_cast<std::size_t>(result.n_y) + 1, 0);
  const auto for_each_tile = [&](const ScreenTriangle& t, const auto& f) {
    const auto [x0, x1] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y0, y1] = std::minmax({t.y[0], t.y[1], t.y[2]});
    const auto tile = [](float v, int n) { return static_cast<int>(std::clamp(std::floor(v / k_tile), 0.0f, static_cast<float>(n - 1))); };
    for (int j = tile(y0, result.n_y); j <= tile(y1, result.n_y); ++j)
      for (int i = tile(x0, result.n_x); i <= tile(x1, result.n_x); ++i)
        f(static_cast<std::size_t>(j) * static_cast<std::size_t>(result.n_x) + static_cast<std::size_t>(i));
  };
  for (const ScreenTriangle& t : triangles) for_each_tile(t, [&](std::size_t tile) { ++result.first[tile + 1]; });
  for (std::size_t k = 1; k < result.first.size(); ++k) result.first[k] += result.first[k - 1];
  result.triangles.resize(result.first.back());
  std::vector<std::uint64_t> cursor(result.first.begin(), result.first.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) for_each_tile(triangles[t], [&](std::size_t tile) { result.triangles[cursor[tile]++] = t; });
  return result;
}

/// Line through two corners: distance in pixels, positive on the triangle's side; both triangles of an edge get the same number except for its sign.
struct Line {
  double x, y, constant;
  bool takes_zero;  ///< exactly one of the two triangles of an edge contains the points on it
  double at(double px, double py) const { return x * px + y * py + constant; }
};

Line line_of(double ax, double ay, double bx, double by, bool is_clockwise) {
  const bool is_swapped = bx < ax || (bx == ax && by < ay);
  if (is_swapped) {
    std::swap(ax, bx);
    std::swap(ay, by);
  }
  const double length = std::hypot(bx - ax, by - ay), sense = is_swapped != is_clockwise ? -1.0 : 1.0;
  Line line{-(by - ay) / length, (bx - ax) / length, 0.0, sense > 0.0};
  line.constant = -(line.x * ax + line.y * ay);
  return {sense * line.x, sense * line.y, sense * line.constant, line.takes_zero};
}

class Tile {
 public:
  Tile(const RasterOptions& options, int i, int j)
      : options_(options), x0_(i * k_tile), y0_(j * k_tile), x1_(std::min(x0_ + k_tile, options.width)), y1_(std::min(y0_ + k_tile, options.height)) {
    depth_.fill(-std::numeric_limits<float>::infinity());
    color_.fill(of(options.background));
  }

  void add(const ScreenTriangle& t) {
    const double twice_area = (double{t.x[1]} - t.x[0]) * (double{t.y[2]} - t.y[0]) - (double{t.x[2]} - t.x[0]) * (double{t.y[1]} - t.y[0]);
    if (twice_area == 0.0 || !std::isfinite(twice_area)) return;
    std::array<Line, 3> lines;
    for (std::size_t k = 0; k < 3; ++k) lines[k] = line_of(t.x[k], t.y[k], t.x[(k + 1) % 3], t.y[(k + 1) % 3], twice_area < 0.0);
    // The depth is computed relative to corner 0, so that differences stay small, whatever the size of the scene.
    const double d1 = double{t.depth[1]} - t.depth[0], d2 = double{t.depth[2]} - t.depth[0];
    const double slope_x = (d1 * (double{t.y[2]} - t.y[0]) - d2 * (double{t.y[1]} - t.y[0])) / twice_area;
    const double slope_y = (d2 * (double{t.x[1]} - t.x[0]) - d1 * (double{t.x[2]} - t.x[0])) / twice_area;
    const auto [left, right] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [top, bottom] = std::minmax({t.y[0], t.y[1], t.y[2]});
    const int i0 = sample_from(left, x0_, x1_), i1 = sample_after(right, x0_, x1_), j0 = sample_from(top, y0_, y1_), j1 = sample_after(bottom, y0_, y1_);
    const Color fill = of(t.fill), edge = of(k_edge_color);
    for (int j = j0; j < j1; ++j) {
      const double py = y0_ + (j + 0.5) / k_samples;
      for (int i = i0; i < i1; ++i) {
        const double px = x0_ + (i + 0.5) / k_samples;
        std::array<double, 3> away;
        bool is_inside = true;
        for (std::size_t k = 0; k < 3 && is_inside; ++k) {
          away[k] = lines[k].at(px, py);
          is_inside = away[k] > 0.0 || (away[k] == 0.0 && lines[k].takes_zero);
        }
        if (!is_inside) continue;
        const auto depth = static_cast<float>(t.depth[0] + slope_x * (px - t.x[0]) + slope_y * (py - t.y[0]));
        const std::size_t at = static_cast<std::size_t>(j) * k_row + static_cast<std::size_t>(i);
        if (!(depth > depth_[at])) continue;
        depth_[at] = depth;
        color_[at] = fill;
        if (t.edge_opacity <= 0.0f || t.edges == 0) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 3; ++k)
          if ((t.edges >> k & 1) != 0) nearest = std::min(nearest, away[k]);
        // Half of the edge's width is drawn on this side; it fades over the distance between samples.
        const double cover = std::clamp((0.5 * options_.edge_width - nearest) * k_samples + 0.5, 0.0, 1.0);
        if (cover > 0.0) color_[at] = mixed(fill, edge, static_cast<float>(cover) * t.edge_opacity);
      }
    }
  }

  void resolve(Image& image) const {
    for (int y = y0_; y < y1_; ++y)
      for (int x = x0_; x < x1_; ++x) {
        Color sum;
        for (int j = 0; j < k_samples; ++j)
          for (int i = 0; i < k_samples; ++i) {
            const Color& c = color_[static_cast<std::size_t>((y - y0_) * k_samples + j) * k_row + static_cast<std::size_t>((x - x0_) * k_samples + i)];
            sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b};
          }
        const auto mean = [](float s) { return static_cast<std::uint8_t>(s / (k_samples * k_samples) + 0.5f); };
        image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)] = {mean(sum.r), mean(sum.g),
                                                                                                                           mean(sum.b)};
      }
  }

 private:
  static constexpr std::size_t k_row = static_cast<std::size_t>(k_tile) * k_samples;

  static Color of(Rgb c) { return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)}; }
  static Color mixed(const Color& a, const Color& b, float share) { return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)}; }
  /// Returns the first sample of the tile whose centre is at a coordinate or behind it.
  static int sample_from(float at, int from, int to) {
    const double sample = std::ceil((double{at} - from) * k_samples - 0.5);
    return static_cast<int>(std::clamp(sample, 0.0, static_cast<double>((to - from) * k_samples)));
  }

  /// Returns the first sample of the tile whose centre is behind a coordinate.
  static int sample_after(float at, int from, int to) {
    const double sample = std::floor((double{at} - from) * k_samples - 0.5) + 1.0;
    return static_cast<int>(std::clamp(sample, 0.0, static_cast<double>((to - from) * k_samples)));
  }

  const RasterOptions& options_;
  int x0_, y0_, x1_, y1_;
  std::array<float, k_row * k_row> depth_;
  std::array<Color, k_row * k_row> color_;
};

}  // namespace

Image rasterise(const Polygons& polygons, const Camera& camera, const RasterOptions& options, const RunContext& context) {
  const std::vector<ScreenTriangle> triangles = project(polygons, camera, options, context);
  const Deal tiles = deal(triangles, options);
  Image image{options.width, options.height, std::vector<Rgb>(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height))};
  parallel_for(
      context, tiles.first.size() - 1,
      [&](std::size_t k) {
        const auto tile = std::make_unique<Tile>(options, static_cast<int>(k) % tiles.n_x, static_cast<int>(k) / tiles.n_x);
        for (std::uint64_t i = tiles.first[k]; i < tiles.first[k + 1]; ++i) tile->add(triangles[tiles.triangles[i]]);
        tile->resolve(image);
      },
      1);
  return image;
}

}  // namespace sterna::draw
