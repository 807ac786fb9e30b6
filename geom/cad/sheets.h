// Inside geom/cad only: open sheets beside closed solids, as sketches and construction planes are left in CAD files.
#pragma once

#include "geom/cad/occt_shape.h"
#include "geom/cad/read_cad.h"

namespace sterna::cad {

/// Leaves open shells and loose faces out as ReadCadOptions::sheets says, with a warning for each in the report: name, area, place. Models without a closed
/// solid keep all of theirs. Call it inside run_occt.
void drop_sheets(LabelledShape& labelled, const ReadCadOptions& options, CadReport& report);

}  // namespace sterna::cad
