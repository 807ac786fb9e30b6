// First heights that grow along wake sheets, and the layers that become unnecessary because of this growth.
#pragma once

#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Changes the layer targets on wake sheets: from row to row first heights grow by Foot::height_growth, but by no more than the layer's own heights before
/// the trailing edge, up to k_tallest_first of a regular tetrahedron on the sheet. The total height stays as without this growth (beside a free edge as high
/// as the free edge allows), and the number of layers is the one that keeps the growth ratio before the edge: where first heights grow like the layer, each
/// row has one layer less, and the heights of the other layers continue. Both sides of a sheet get the same targets.
/// \pre base.demand is that of the patches; vertex numbers of `sheets` refer to base.wall
/// \post neighbours differ by one layer at most; the targets of the wall itself are unchanged
void grow_sheet_heights(const DoubledSheets& sheets, const EnvelopeOptions& options, LayerBase& base);

}  // namespace sterna::volmesh
