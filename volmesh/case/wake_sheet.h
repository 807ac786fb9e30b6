// Wake sheets: zero-thickness surfaces behind trailing edges, on which the layers of both sides of a wing continue.
#pragma once

#include <optional>
#include <string>

#include "geom/base/schema.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Request for a wake sheet behind the trailing edges of some walls (domain/wake_sheets.h). The sheet is no patch: cells of both sides share its faces.
struct WakeSheet {
  std::string wing = "*";              ///< patches with trailing edges; a pattern as in patch rules
  double length = 2.0;                 ///< length of the sheet, in local chords
  double growth = 1.2;                 ///< largest ratio of consecutive edges along the stream
  double height_growth = 1.2;          ///< largest ratio of first heights of consecutive rows of cells along the stream
  std::optional<Vec3> direction = {};  ///< free-stream direction, of any length; empty: derived from the domain (stream_of in domain/wake_sheets.h)
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::WakeSheet> {
  using O = volmesh::WakeSheet;
  static constexpr std::string_view stage = "wake_sheet";
  static constexpr std::array fields = {
      Field<O>{.name = "wing", .member = &O::wing, .help = "pattern of names of the wing's patches; the sheet starts at their trailing edges"},
      Field<O>{.name = "length",
               .member = &O::length,
               .min = 0.1,
               .max = 20.0,
               .help = "length of the sheet, in chords of the wing in front of it; larger values need more cells"},
      Field<O>{.name = "growth",
               .member = &O::growth,
               .min = 1.0,
               .max = 2.0,
               .help = "largest ratio of successive edges along the sheet; larger values need fewer cells"},
      Field<O>{.name = "height_growth",
               .member = &O::height_growth,
               .min = 1.0,
               .max = 2.0,
               .help = "largest ratio of first heights between successive rows along the sheet, which reduces the number of layers; 1: all layers continue to "
                       "the end of the sheet"},
      Field<O>{.name = "direction",
               .member = &O::direction,
               .help = "direction of the free stream, of any length, instead of alpha and beta",
               .automatic = "along the inflow in a tunnel, otherwise along x"},
  };
};

}  // namespace sterna
