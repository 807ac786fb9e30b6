// Splits of the tetrahedra's boundary carried down to the wall: envelope and wall stay topologically equal (docs/method/tetrahedra.md, "Boundary splits"; [ET15
// §3.3]).
#pragma once

#include <memory>

#include "volmesh/case/mesh_case.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/layer/true_surface.h"

namespace sterna::volmesh {

/// What is around the tetrahedra after an engine has split triangles there.
struct SplitLayer {
  std::unique_ptr<const TriMesh> wall;    ///< its vertices first, then the new ones; parts of a triangle have its patch
  std::unique_ptr<const TriMesh> outer;   ///< likewise
  std::unique_ptr<const LayerBase> base;  ///< of the wall
  Envelope envelope;
  Extrusion extrusion;
  FillBoundary boundary;
  EnvelopeCertificate certificate;  ///< of the envelope, proved; its cells are to be counted still
  bool is_filled = false;           ///< the tetrahedra are proven with the tops where they are; else cells of split columns made lower heights necessary
};

/// Splits wall, envelope and outer boundary as tets.splits says; each new wall vertex is moved to the true surface (where `true_surface` is not empty) and its
/// line ends where the engine put the new point of the envelope. Extrudes again, proves again.
/// \pre tets fill fill_boundary() of these; no vertex of the base has a constraint.
/// \post tets are those of the new boundary, without splits; where not is_filled they have to be made anew.
/// \throws Error of the stages where wall or layer would not be valid.
SplitLayer split_layer(const LayerBase& base, const Envelope& envelope, const TriMesh& outer, const MeshCase& options, const TrueSurface& true_surface,
                       TetraResult& tets, const RunContext& context);

}  // namespace sterna::volmesh
