// Contents of a picture: polygons with their colours, the meaning of the colours, and the view.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geom/draw/choices.h"
#include "geom/draw/colours.h"
#include "geom/draw/raster.h"

namespace sterna::draw {

struct Swatch {
  Rgb color;
  std::string text;
};

/// Colour scale of numbers, from low to high as in the picture; for judged quantities either end may be the bad one.
struct ColorBar {
  std::string title, unit;
  Scale scale = Scale::neutral;
  bool is_log = false;
  bool is_low_bad = false;                             ///< the scale runs from high to low
  double low = 0.0, high = 1.0;                        ///< values of the first and last colour
  double smallest = 0.0, largest = 0.0;                ///< extremes of the values shown
  std::vector<std::pair<double, std::string>> limits;  ///< limits of the gate for this quantity

  /// Returns the relative position between low and high, clamped to [0, 1].
  double share_of(double value) const;
  Rgb color_of(double value) const;
};

/// Intersection lines of a plane with a patch that has no thickness: an actuator disc, a wake sheet.
struct SceneLines {
  std::string name;  ///< name of the patch
  Rgb color;
  std::vector<std::array<Point, 2>> segments;
};

struct Scene {
  Polygons polygons;
  std::vector<SceneLines> lines;  ///< drawn on top of the polygons
  std::vector<Swatch> swatches;
  std::optional<ColorBar> bar;
  bool has_faces_without_value = false;
  Vec3 toward;                  ///< from the mesh to the eye
  std::optional<Sphere> focus;  ///< region that fills the picture; empty: everything
  std::string caption;          ///< "quality", "leading edge: cells by kind"
};

/// Builds a scene. Pictures of surfaces show both sides of walls in their colour (`is_surface`).
/// \throws errors of draw_png
Scene build_scene(const HybridMesh& mesh, bool is_surface, const DrawOptions& options, const RunContext& context);

}  // namespace sterna::draw
