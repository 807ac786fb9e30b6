// Wake sheets: zero-thickness surfaces behind trailing edges, on which the layers of both sides of a wing continue.
#pragma once

#include <optional>
#include <string>

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
