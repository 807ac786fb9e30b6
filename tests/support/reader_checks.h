// Requirement for every reader and any input: a sound result, or an error with its location. For the tests of damaged files and the fuzz target.
#pragma once

#include <string>

#include "geom/base/error.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::test {

/// Returns the first invalid index or number of the result; empty = usable without further checks.
std::string flaw_of(const SurfaceSoup& soup);
std::string flaw_of(const HybridMesh& mesh);

/// Returns true if the error text states the location in the file: line or byte, cell (formats that store faces), or, for self-describing containers (CGNS,
/// TAU, VTKHDF), group, dataset, variable or attribute.
bool says_where(const Error& error, bool is_container);

}  // namespace sterna::test
