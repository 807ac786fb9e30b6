// Certificate of an envelope after all changes: results of exact tests, with measured minima.
#pragma once

#include <cstdint>
#include <string>

#include "volmesh/envelope/collide.h"

namespace sterna::volmesh {

/// Quality of the worst element: 1 for a right prism or the corner of a cube, positive iff valid (up to rounding).
struct WorstElement {
  double quality = 1.0;
  Point place;
  std::string what;  ///< element and wall triangle
};

struct EnvelopeCertificate {
  /// Envelope, sides, wall and outer boundary: triangles tested against each other, pairs with overlapping boxes (tested exactly), pairs that cross.
  std::int64_t n_triangles = 0;
  std::int64_t n_pairs = 0;
  std::int64_t n_crossings = 0;
  std::int64_t n_swallowings = 0;  ///< parts of the boundary within the layer of another part
  /// Macro-elements tested by the exact wedge, pyramid or tet test (elements without height are no cells), and the number of failures.
  std::int64_t n_macro_elements = 0;
  std::int64_t n_invalid_macro_elements = 0;
  WorstElement worst_macro_element;
  /// Cells of the extruded layer, counted in the same way; filled by the driver after extrusion.
  std::int64_t n_layer_cells = 0;
  std::int64_t n_invalid_layer_cells = 0;
  WorstElement worst_layer_cell;

  bool is_proved() const { return n_crossings == 0 && n_swallowings == 0 && n_invalid_macro_elements == 0 && n_invalid_layer_cells == 0; }
};

/// Rejects input defects that no layer height can repair. Returns the number of pairs tested exactly.
/// \throws Error(self_intersection) with locations and geometry if the wall crosses itself or the outer boundary.
std::int64_t require_clear_input(Collider& collider, const RunContext& context);

/// Tests the envelope against itself, sides, wall and outer boundary, and tests every macro-element. Counts failures, does not throw.
EnvelopeCertificate certify_envelope(const LayerBase& base, Collider& collider, const EnvelopeShape& envelope, const RunContext& context);

/// \throws Error(envelope_failed) with counts and the worst locations unless everything is proved.
void require_proved(const EnvelopeCertificate& certificate);

/// Returns one line, e.g. "proved: 316420 boundary triangles clear of each other (1.2e6 pairs), 79218 macro-elements valid (worst 0.031 at (...)), ...".
std::string to_text(const EnvelopeCertificate& certificate);

}  // namespace sterna::volmesh
