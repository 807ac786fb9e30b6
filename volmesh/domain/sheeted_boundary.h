// The fluid's boundary with wake sheets: what the user gave gets them, and is completed anew around them.
#pragma once

#include <functional>

#include "volmesh/case/wake_sheet.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/domain/split_needles.h"
#include "volmesh/domain/wake_sheets.h"

namespace sterna::volmesh {

struct SheetedBoundary {
  TriMesh boundary;
  NeedleSplits needles;  ///< its sources and weights: of all triangles, sheets have that of the wall at the trailing edge, no weights
  DoubledSheets sheets;  ///< in numbers of the boundary, of which what they have added are the last
};

/// Takes what came from the user out of a boundary that is complete, with its needles split, adds wake sheets and completes it again. Given symmetry patches in
/// a plane x, y or z = constant are triangulated anew, as those that are added are, and so are given periodic sides, whose borders stay images of each other.
/// \p n_given: triangles of the user's surface, the first ones of the boundary before needles were split
/// \p periodic: sides of the boundary, whose vertices are on their images
/// \p complete_again: complete_boundary(), or more, of what it is given; the triangles that it is given are the first of its result
/// \throws as add_wake_sheets() and complete_boundary(); Error(bad_argument) for given periodic sides in no such plane
SheetedBoundary with_wake_sheets(const TriMesh& complete, std::size_t n_given, const NeedleSplits& needles, std::span<const PeriodicPatches> periodic,
                                 std::span<const WakeSheet> wakes, double first_height, const std::function<TriMesh(const TriMesh&)>& complete_again,
                                 const RunContext& context);

/// The sheets in numbers of a domain's wall; vertices on their rims get no layer there.
/// \pre domain of split_domain() on the boundary, all walls at the sheets have layers
void hold_sheets(const SheetedBoundary& sheeted, Domain& domain);

}  // namespace sterna::volmesh
