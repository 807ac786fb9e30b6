// The layer below a known envelope. Prisms are extruded, the envelope is certified, the outer boundary is closed around it, and everything except the
// tetrahedra is assembled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "geom/base/run_context.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/layer/layer_cells.h"
#include "volmesh/layer/layer_report.h"
#include "volmesh/layer_domain/layer_domain.h"

namespace sterna::volmesh {

/// A layer with all results except the check of its cells (prove_layer).
struct LaidLayer {
  HybridMesh mesh;                               ///< made by assemble_layers(): growth lines of the layer, then the outer boundary, without tetrahedra
  FillBoundary boundary;                         ///< boundary of the volume for the tetrahedra
  std::optional<HybridMesh> opened = {};         ///< with opened ridges or wake sheets: the layer before DomainFeature::finish()
  std::array<std::int64_t, 5> curving_shares{};  ///< as in Extrusion::curving_shares
  LayerReport report;
  EnvelopeCertificate certificate;  ///< passed certificate of the envelope; the layer's cells are not counted yet
  ClearProof clear;                 ///< proof for `boundary`; not given if patches were re-meshed around the layer
};

/// Returns the layer below the present envelope. May lower the envelope.
/// \pre, \post the envelope is valid and clear
/// \throws the errors of the stages; Error(envelope_failed) if the certificate fails; MultiNormalError if opened ridges get no valid cells
LaidLayer lay_out(LayerDomain& layer_domain, Envelope& envelope, const RunContext& context);

/// Results of the layer checks that run while an engine makes the tetrahedra.
struct LayerProof {
  LayerCertificate cells;
  LayerCheck check;
};
/// Certifies and checks the layer. \p mesh made by assemble_layers()
LayerProof prove_layer(const HybridMesh& mesh, const RunContext& context);

/// Adds the counts of the layer's cells to the certificate.
/// \throws Error if a cell is not proved valid
void require_proved_cells(const LayerCertificate& cells, EnvelopeCertificate& certificate);

}  // namespace sterna::volmesh
