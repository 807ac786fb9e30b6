// First heights that grow along wake sheets, and the layers that are not needed any more because of that.
#pragma once

#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Changes what is asked of the layer on sheets: from row to row first heights grow by Foot::height_growth, but by no more than the layer's own heights do
/// before the trailing edge, up to k_tallest_first of a regular tetrahedron on the sheet. All layers together are as high as they would be without that (beside
/// a rim as high as it lets them be), and of as many as it takes to grow as before the edge: where first heights grow like the layer, each row has one layer
/// less, and the heights of the others go on. Both sides of a sheet are asked for the same. \pre base.demand is that of the patches; sheets in numbers of
/// base.wall \post neighbours differ by one layer at most; the wall itself is asked for what it was
void grow_sheet_heights(const DoubledSheets& sheets, const EnvelopeOptions& options, LayerBase& base);

}  // namespace sterna::volmesh
