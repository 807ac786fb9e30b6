// The fluid's boundary with wake sheets. The user's surface gets the sheets, and is completed again around them.
#pragma once

#include <functional>

#include "volmesh/case/wake_sheet.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/domain/split_slivers.h"
#include "volmesh/domain/wake_sheets.h"

namespace sterna::volmesh {

struct SheetedBoundary {
  TriMesh boundary;
  SliverSplits slivers;  ///< sources and weights of all triangles; sheet triangles have the source of the wall at the trailing edge, and no weights
  DoubledSheets sheets;  ///< sheets in vertex and triangle numbers of the boundary; the entries that the sheets add are the last ones
};

/// Extracts the user's surface from a complete boundary with split sliver triangles, adds wake sheets to it, and completes it again. Given symmetry patches in
/// a plane x, y or z = constant are re-meshed like added planes. The same applies to given periodic sides, whose borders stay images of each other. \p n_given
/// number of triangles of the user's surface, which were the first triangles of the boundary before sliver triangles were split. \p periodic sides of the
/// boundary whose vertices are on their images. \p complete_again calls complete_boundary(), possibly with further steps; its input triangles are the first
/// triangles of its result
/// \throws the errors of add_wake_sheets() and complete_boundary(); Error(bad_argument) for given periodic sides that are not in such a plane
SheetedBoundary with_wake_sheets(const TriMesh& complete, std::size_t n_given, const SliverSplits& slivers, std::span<const PeriodicPatches> periodic,
                                 std::span<const WakeSheet> wakes, double first_height, const std::function<TriMesh(const TriMesh&)>& complete_again,
                                 const RunContext& context);

/// Stores the sheets in vertex numbers of a domain's wall. Vertices on the free edges of the sheets get no layer.
/// \pre the domain was made by split_domain() from the boundary, and all walls at the sheets have layers
void hold_sheets(const SheetedBoundary& sheeted, Domain& domain);

}  // namespace sterna::volmesh
