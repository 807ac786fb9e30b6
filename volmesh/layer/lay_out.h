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

/// A layer, and what is known of it beside its cells (prove_layer).
struct LaidLayer {
  HybridMesh mesh;                               ///< of assemble_layers(): lines of the layer, then the outer boundary; no tetrahedra
  FillBoundary boundary;                         ///< what the tetrahedra fill
  std::optional<HybridMesh> opened = {};         ///< where ridges are opened or wakes have sheets: the layer before close_opened()
  std::array<std::int64_t, 5> curving_shares{};  ///< Extrusion::curving_shares
  LayerReport report;
  EnvelopeCertificate certificate;  ///< of the envelope, proved; its cells are to be counted still
};

/// The layer under the envelope as it is now, which may get lower.
/// \pre, \post envelope valid and clear
/// \throws Error of the stages; envelope_failed where the certificate fails; FanError where opened ridges get no valid cells
LaidLayer lay_out(MeshingSite& site, Envelope& envelope, const RunContext& context);

/// Makes the given wall's cells of a layer on a wall with opened ridges, or with wake sheets.
/// \throws as close_fans() and close_wakes()
void close_opened(const Domain& domain, HybridMesh& layers, FillBoundary& boundary);

/// What can be found out about a layer while an engine makes the tetrahedra.
struct LayerProof {
  LayerCertificate cells;
  LayerCheck check;
};
/// \p mesh: of assemble_layers()
LayerProof prove_layer(const HybridMesh& mesh, const RunContext& context);

/// Counts the layer's cells in the certificate.
/// \throws Error where one of them is not proved
void require_proved_cells(const LayerCertificate& cells, EnvelopeCertificate& certificate);

}  // namespace sterna::volmesh
