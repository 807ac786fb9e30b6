// Polygons in space to a picture: a z-buffer of our own, tile by tile, 3 x 3 samples a pixel. No display, no graphics card.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/draw/camera.h"
#include "geom/draw/image.h"

namespace sterna::draw {

struct PolygonStyle {
  Rgb front, back;     ///< of the side to which the right-hand normal points, and of the other
  bool is_lit = true;  ///< shaded by its direction; else the colour as it is
  bool has_edges = true;
};

/// Convex polygons, one after the other.
struct Polygons {
  std::vector<Point> corners;
  std::vector<std::uint64_t> first{0};
  std::vector<PolygonStyle> styles;

  std::size_t size() const { return styles.size(); }
  void close(const PolygonStyle& style) {
    first.push_back(corners.size());
    styles.push_back(style);
  }
};

struct RasterOptions {
  int width = 0, height = 0;  ///< pixels
  bool edges = true;
  double edge_width = 1.0;  ///< pixels
  Rgb background{255, 255, 255};
};

/// Nearest polygon wins, of equal ones the first. Edges of polygons are lines on them: hidden where the polygon is, drawn half on each of two neighbours,
/// fading out where polygons get too small to tell. Samples on an edge belong to one of the neighbours, never to both or none. The same bytes for any number of
/// threads.
Image rasterise(const Polygons& polygons, const Camera& camera, const RasterOptions& options, const RunContext& context);

}  // namespace sterna::draw
