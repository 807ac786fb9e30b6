// Options of a report page.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geom/base/schema.h"

namespace sterna::scripting {

struct ReportOptions {
  std::string title = "automatic";
  bool automatic_cuts = true;
  bool times = true;
  int max_triangles = 250000;
  int max_polygons = 100000;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::ReportOptions> {
  using O = scripting::ReportOptions;
  static constexpr std::string_view stage = "report";
  static constexpr double k_most = 5e6;  ///< limit on triangles and polygons, set by the speed of browsers
  static constexpr std::array fields = {
      Field<O>{.name = "title", .member = &O::title, .help = "title of the page; automatic: the file's name"},
      Field<O>{.name = "automatic_cuts",
               .member = &O::automatic_cuts,
               .help = "add cuts at informative locations: leading and trailing edge, tip, junction, symmetry plane, sections"},
      Field<O>{.name = "times", .member = &O::times, .help = "show times and memory of this run; false: the same mesh gives the same bytes"},
      Field<O>{.name = "max_triangles",
               .member = &O::max_triangles,
               .min = 1,
               .max = k_most,
               .help = "largest number of boundary triangles; a larger boundary is thinned, with a note on the page"},
      Field<O>{.name = "max_polygons",
               .member = &O::max_polygons,
               .min = 1,
               .max = k_most,
               .help = "largest number of polygons of all cuts together; each cut shows those nearest to its focus"},
  };
};

}  // namespace sterna
