// What every reader owes whatever the bytes: a sound result, or a refusal that says where. For the tests of damaged files and the fuzz target.
#pragma once

#include <string>

#include "geom/base/error.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::test {

/// What is wrong with indices and numbers of the result; empty = it can be used without further checks.
std::string flaw_of(const SurfaceSoup& soup);
std::string flaw_of(const HybridMesh& mesh);

/// Whether the text of a refusal says where in the file: at which line or byte, in which cell (formats that store faces), or, for containers that describe
/// themselves (CGNS, TAU, VTKHDF), in which group, dataset, variable or attribute.
bool says_where(const Error& error, bool is_container);

}  // namespace sterna::test
