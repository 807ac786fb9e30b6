// Inside geom/cad only: repairs defects left by translators and other CAD systems.
#pragma once

#include "geom/cad/occt_shape.h"
#include "geom/cad/read_cad.h"

class Message_ProgressRange;

namespace sterna::cad {

/// Heals a shape in steps, each reported in `report.repaired`: removes duplicate faces; repairs borders, seams, degenerate edges and orientation of faces
/// (ShapeFix); removes small edges and faces; joins free faces (sewing, tolerances from small to large until nothing more closes, then edges that share their
/// ends); caps flat openings if requested; makes closed shells solids, oriented outwards. Labels follow their faces. Call it inside run_occt.
void heal(LabelledShape& labelled, const ReadCadOptions& options, CadReport& report, const Message_ProgressRange& progress, const RunContext& context);

}  // namespace sterna::cad
