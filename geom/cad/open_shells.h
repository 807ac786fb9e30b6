// Inside geom/cad only: removes open shells beside closed solids, such as sketches and construction planes left in CAD files.
#pragma once

#include "geom/cad/occt_shape.h"
#include "geom/cad/read_cad.h"

namespace sterna::cad {

/// Removes open shells and loose faces according to ReadCadOptions::sheets, with a warning for each in the report: name, area, location. Models without a
/// closed solid keep all of them. Call it inside run_occt.
void drop_sheets(LabelledShape& labelled, const ReadCadOptions& options, CadReport& report);

}  // namespace sterna::cad
