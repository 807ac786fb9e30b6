// Makes cellZones of OpenFOAM for the refinement regions of a mesh.
#pragma once

#include <filesystem>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"
#include "io/volume/volume_foam.h"
#include "scripting/values/verbs.h"
#include "volmesh/case/size_sources.h"

namespace sterna::scripting {

/// Returns a zone "source_N_KIND" (N from 1 on) for each source with a volume. It has the cells whose centre lies in the source. Used for momentum sources and
/// for pictures.
std::vector<io::FoamZone> zones_of_sources(const HybridMesh& mesh, const std::vector<volmesh::SizeSource>& sources);

/// Writes the mesh like write_mesh_alone() for OpenFOAM, with the zones of the sources that the mesh was made with.
/// \throws as io::write_numbered_foam
void write_zoned_foam(const MeshValue& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context);

}  // namespace sterna::scripting
