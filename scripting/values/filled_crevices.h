// fill_crevices on surfaces of scripts: the new wall with its comparison, report and warnings.
#pragma once

#include "geom/base/run_context.h"
#include "scripting/values/verbs.h"
#include "volmesh/fill_crevices.h"

namespace sterna::scripting {

/// Returns the wall with filled crevices. Its inputs, its rules for layers and the kinds of its patches are kept. The crevices are reported in the log, in the
/// report's messages and in the changes. If there are none, the surface is returned unchanged, with a warning.
/// \throws Error of volmesh::fill_crevices
SurfaceValue filled_crevices(const SurfaceValue& wall, const volmesh::CreviceOptions& options, const RunContext& context);

}  // namespace sterna::scripting
