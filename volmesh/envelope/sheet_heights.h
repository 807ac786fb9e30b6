// First heights that grow along wake sheets, and the removal of layers that this growth makes unnecessary.
#pragma once

#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Changes the layer targets on wake sheets. From row to row first heights grow by BaseVertex::height_growth, but by no more than the layer's own heights
/// upstream of the trailing edge, up to k_tallest_first of a regular tetrahedron on the sheet. The total height is the same as without this growth (beside a
/// free edge, as high as the free edge allows). The number of layers keeps the growth ratio upstream of the edge. If first heights grow like the layer, each
/// row therefore has one layer less, and the heights of the other layers continue. Both sides of a sheet get the same targets.
/// \pre base.demand contains the targets of the patches; vertex numbers of `sheets` refer to base.wall
/// \post numbers of layers of neighbours differ by at most one; the targets of the wall itself are unchanged
void grow_sheet_heights(const DoubledSheets& sheets, const EnvelopeOptions& options, LayerBase& base);

}  // namespace sterna::volmesh
