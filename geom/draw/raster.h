// Renders polygons in space to a picture: custom z-buffer, tile by tile, 3 x 3 samples per pixel. No display, no graphics card.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/draw/camera.h"
#include "geom/draw/image.h"

namespace sterna::draw {

struct PolygonStyle {
  Rgb front, back;     ///< colours of the side to which the right-hand normal points, and of the other side
  bool is_lit = true;  ///< shaded by its direction; false: drawn in the unchanged colour
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

/// Renders polygons. The nearest polygon is visible; at equal depth the first one. Edges are drawn as lines on their polygons, so they are visible only where
/// the polygon is. One half of each line lies on each of the two neighbours. Lines fade out where polygons are too small to distinguish. Samples on an edge
/// belong to exactly one of the neighbours. The same bytes for any number of threads.
Image rasterise(const Polygons& polygons, const Camera& camera, const RasterOptions& options, const RunContext& context);

}  // namespace sterna::draw
