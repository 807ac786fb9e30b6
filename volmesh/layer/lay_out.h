// The layer under a known envelope: prisms extruded, the envelope certified, the outer boundary closed around it, all but the tetrahedra assembled.
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
#include "volmesh/site/site.h"

namespace sterna::volmesh {

/// A layer, with all results except the proof of its cells (prove_layer).
struct LaidLayer {
  HybridMesh mesh;                               ///< from assemble_layers(): growth lines of the layer, then the outer boundary; no tetrahedra
  FillBoundary boundary;                         ///< boundary of the volume for the tetrahedra
  std::optional<HybridMesh> opened = {};         ///< for opened ridges or wake sheets: the layer before close_opened()
  std::array<std::int64_t, 5> curving_shares{};  ///< Extrusion::curving_shares
  LayerReport report;
  EnvelopeCertificate certificate;  ///< certificate of the envelope, proved; the layer's cells are not yet counted
};

/// Returns the layer under the present envelope; may lower the envelope.
/// \pre, \post envelope valid and clear
/// \throws Error of the stages; envelope_failed if the certificate fails; FanError if opened ridges get no valid cells
LaidLayer lay_out(MeshingSite& site, Envelope& envelope, const RunContext& context);

/// Converts a layer on a wall with opened ridges, or with wake sheets, to the cells of the given wall.
/// \throws as close_fans() and close_wakes()
void close_opened(const Domain& domain, HybridMesh& layers, FillBoundary& boundary);

/// Results of the layer checks that run while an engine makes the tetrahedra.
struct LayerProof {
  LayerCertificate cells;
  LayerCheck check;
};
/// Certifies and checks the layer. \p mesh: from assemble_layers()
LayerProof prove_layer(const HybridMesh& mesh, const RunContext& context);

/// Adds the counts of the layer's cells to the certificate.
/// \throws Error if a cell is not proved
void require_proved_cells(const LayerCertificate& cells, EnvelopeCertificate& certificate);

}  // namespace sterna::volmesh
