// Certificate of an envelope after all changes: results of the exact tests, and the measured minima.
#pragma once

#include <cstdint>
#include <string>

#include "volmesh/case/clear_proof.h"
#include "volmesh/envelope/collide.h"

namespace sterna::volmesh {

/// Quality of the worst element: 1 for a right prism or the corner of a cube. It is positive if and only if the element is valid (except for rounding).
struct WorstElement {
  double quality = 1.0;
  Point location;
  std::string what;  ///< type of the element, and its wall triangle
};

struct EnvelopeCertificate {
  /// Numbers of tests between envelope, sides, wall and outer boundary: triangles that were tested against each other, pairs with overlapping boxes (tested
  /// exactly), and pairs that cross.
  std::int64_t n_triangles = 0;
  std::int64_t n_pairs = 0;
  std::int64_t n_crossings = 0;
  std::int64_t n_swallowings = 0;  ///< number of parts of the boundary that lie within the layer of another part
  /// Number of macro-elements tested by the exact wedge, pyramid or tetrahedron test, and number of failures. Elements without height are no cells and are not
  /// tested.
  std::int64_t n_macro_elements = 0;
  std::int64_t n_invalid_macro_elements = 0;
  WorstElement worst_macro_element;
  /// The same numbers for cells of the extruded layer. The driver sets them after the extrusion.
  std::int64_t n_layer_cells = 0;
  std::int64_t n_invalid_layer_cells = 0;
  WorstElement worst_layer_cell;

  bool is_proved() const { return n_crossings == 0 && n_swallowings == 0 && n_invalid_macro_elements == 0 && n_invalid_layer_cells == 0; }
};

/// Rejects input defects that no layer height can repair. Returns the number of pairs tested exactly.
/// \throws Error(self_intersection) with locations and geometry if the wall crosses itself or the outer boundary.
std::int64_t require_clear_input(Collider& collider, const RunContext& context);

/// A certificate as the tests return it, with their proof.
struct TestedEnvelope : EnvelopeCertificate {
  ClearProof clear;  ///< given if there are neither crossings nor swallowings
};

/// Tests the envelope against itself, sides, wall and outer boundary, and tests every macro-element. Counts failures, but does not throw.
TestedEnvelope certify_envelope(const LayerBase& base, Collider& collider, const EnvelopeShape& envelope, const RunContext& context);

/// \throws Error(envelope_failed) with counts and the worst locations unless all tests have passed
void require_proved(const EnvelopeCertificate& certificate);

/// Returns one line, such as "proved: 316420 boundary triangles clear of each other (1.2e6 pairs), 79218 macro-elements valid (worst 0.031 at (...)), ...".
std::string to_text(const EnvelopeCertificate& certificate);

}  // namespace sterna::volmesh
