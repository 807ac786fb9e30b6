// Options of a mesh picture.
#pragma once

#include <array>
#include <string>

#include "geom/base/schema.h"

namespace sterna {

struct DrawOptions {
  std::string view = "automatic";
  std::string color = "automatic";
  std::string cut = "none";
  std::string focus = "automatic";
  std::string patches = "automatic";
  std::string projection = "orthographic";
  int width = 1600;
  int height = 1000;
  bool edges = true;
  bool legend = true;
  double range_min = k_automatic;
  double range_max = k_automatic;
  std::string title = "automatic";
  bool places = false;
  double unit = 1.0;
};

template <>
struct Schema<DrawOptions> {
  using O = DrawOptions;
  static constexpr std::string_view stage = "draw";
  static constexpr double k_max_size = 16384;  ///< limit of a side, pixels: cairo's images end at 32767, memory is exhausted earlier
  static constexpr std::array fields = {
      Field<O>{.name = "view",
               .member = &O::view,
               .help = "iso, front, back, left, right, top, bottom; \"225 30\": azimuth and elevation of the viewer in degrees (180: ahead of the nose, "
                       "270: left); \"-1,-1,0.5\": the direction from the mesh to the viewer; automatic: iso; half models from the fluid side; a cut "
                       "along its normal"},
      Field<O>{.name = "color",
               .member = &O::color,
               .help = "patch, kind, quality, or a quantity of the faces (edge_length, skew, layer_height ...) or of cut cells (volume, layer); automatic: "
                       "patch; with a cut: kind"},
      Field<O>{.name = "cut",
               .member = &O::cut,
               .help = "show the cells that a plane crosses: a named location (\"leading edge\", \"tip\", \"section 50%\" ...), \"x=1.2\", or \"point=0,0,0 "
                       "normal=0,1,0\"; none: no cut"},
      Field<O>{
          .name = "focus",
          .member = &O::focus,
          .help = "region that fills the picture: \"1,2,0 radius=0.5\" (m), or a named location; automatic: everything shown; with a named cut: its location"},
      Field<O>{.name = "patches",
               .member = &O::patches,
               .help = "names or patterns of the patches that are shown, separated by blanks; automatic: walls; none: no patch"},
      Field<O>{.name = "projection", .member = &O::projection, .help = "projection of the view", .choices = "orthographic perspective"},
      Field<O>{.name = "width", .member = &O::width, .min = 100, .max = k_max_size, .help = "pixels"},
      Field<O>{.name = "height", .member = &O::height, .min = 100, .max = k_max_size, .help = "pixels"},
      Field<O>{.name = "edges", .member = &O::edges, .help = "draw the edges of faces and cells"},
      Field<O>{.name = "legend", .member = &O::legend, .help = "draw legend, axes and scale"},
      Field<O>{.name = "range_min",
               .member = &O::range_min,
               .help = "value of the first colour, in the unit of the quantity (degrees for angles)",
               .automatic = "excludes the lowest 1 % of the values shown"},
      Field<O>{.name = "range_max",
               .member = &O::range_max,
               .help = "value of the last colour, in the unit of the quantity (degrees for angles)",
               .automatic = "excludes the highest 1 % of the values shown"},
      Field<O>{.name = "title", .member = &O::title, .help = "text at the top; automatic: file name and content; none: no text"},
      Field<O>{.name = "places",
               .member = &O::places,
               .help = "mark the worst location of every gate that does not pass, and the defects that make the mesh INVALID"},
      Field<O>{.name = "unit",
               .member = &O::unit,
               .unit = Unit::metre,
               .min = 1e-9,
               .max = 1e9,
               .help = "length of one unit of the input file (mm, cm, inch, ft are numbers)"},
  };
};

}  // namespace sterna
