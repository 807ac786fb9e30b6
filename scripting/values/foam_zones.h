// cellZones of OpenFOAM for the regions in which a mesh was asked to be fine.
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

/// Of each source with a volume the cells whose middle lies in it, "source_N_KIND" with N from 1 on: as sources of momentum and for pictures.
std::vector<io::FoamZone> zones_of_sources(const HybridMesh& mesh, const std::vector<volmesh::SizeSource>& sources);

/// write_mesh_alone() of OpenFOAM, with the zones of the sources that the mesh was made with.
/// \throws as io::write_numbered_foam
void write_zoned_foam(const MeshValue& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context);

}  // namespace sterna::scripting
