// Transfers splits of the boundary of the tetrahedra to the wall, so that envelope and wall keep the same topology (docs/method/tetrahedra.md, "Boundary
// splits"; [ET15 §3.3]).
#pragma once

#include <memory>

#include "volmesh/case/mesh_case.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/layer/true_surface.h"

namespace sterna::volmesh {

/// Surfaces and layer around the tetrahedra after an engine has split boundary triangles.
struct SplitLayer {
  std::unique_ptr<const TriMesh> wall;    ///< original vertices first, then the new ones; the parts of a triangle have its patch
  std::unique_ptr<const TriMesh> outer;   ///< vertices and patches in the same order as in `wall`
  std::unique_ptr<const LayerBase> base;  ///< layer base of the new wall
  Envelope envelope;
  Extrusion extrusion;
  FillBoundary boundary;
  EnvelopeCertificate certificate;  ///< passed certificate of the envelope; the layer's cells are not counted yet
  ClearProof clear;                 ///< proof for `boundary`
  /// True: the tetrahedra are still valid with the present tops; false: heights were lowered because of invalid cells in split columns.
  bool is_filled = false;
};

/// Splits wall, envelope and outer boundary according to tets.splits. Each new wall vertex is moved to the true surface, unless `true_surface` is empty. Its
/// growth line ends at the engine's new point of the envelope. The layer is extruded and checked again.
/// \pre the tetrahedra fill fill_boundary() of these arguments; no vertex of the base has a constraint
/// \post the tetrahedra refer to the new boundary, without splits; if is_filled is false, they have to be made again
/// \throws the errors of the stages if wall or layer would be invalid
SplitLayer split_layer(const LayerBase& base, const Envelope& envelope, const TriMesh& outer, const MeshCase& options, const TrueSurface& true_surface,
                       TetraResult& tets, const RunContext& context);

}  // namespace sterna::volmesh
