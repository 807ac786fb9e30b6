// Wake sheets: surfaces behind trailing edges, without thickness, on which the layers of both sides of a wing go on.
#pragma once

#include <optional>
#include <string>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// What is asked for behind the trailing edges of some walls (domain/wake_sheets.h). The sheet is no patch: cells of both sides share its faces.
struct WakeSheet {
  std::string wing = "*";              ///< patches with trailing edges, a pattern as in rules of patches
  double length = 2.0;                 ///< local chords
  double growth = 1.2;                 ///< largest ratio of consecutive edges along the stream
  double height_growth = 1.2;          ///< largest ratio of first heights of consecutive rows of cells along the stream
  std::optional<Vec3> direction = {};  ///< of the free stream, any length; empty: what the domain says (domain/wake_sheets.h, stream_of)
};

}  // namespace sterna::volmesh
