// Inside geom/cad only: mends what translators and other systems left.
#pragma once

#include "geom/cad/occt_shape.h"
#include "geom/cad/read_cad.h"

class Message_ProgressRange;

namespace sterna::cad {

/// Steps, each told in `report.mended`: doubled faces dropped; borders, seams, degenerate edges and orientation of faces (ShapeFix); small edges and faces;
/// free faces joined (sewing, tolerances from small to large until nothing more closes, then edges that share their ends); flat openings capped if wanted;
/// closed shells made solids, turned outwards. Labels follow their faces. Call it inside run_occt.
void heal(LabelledShape& labelled, const ReadCadOptions& options, CadReport& report, const Message_ProgressRange& progress, const RunContext& context);

}  // namespace sterna::cad
