// Measured figures of the layer on each boundary triangle. Private to the *.cpp files of geom/mesh.
#pragma once

#include <vector>

#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {

enum LayerField : std::size_t {
  k_layer_height,
  k_first_height,
  k_coverage,
  k_layers,
  k_growth,
  k_skew,
  k_stack_angle,
  k_interface_jump,
  k_worst_jacobian,
  k_n_layer_fields
};

/// Returns one column of values per LayerField, one value per boundary triangle, as listed in surface_field_table(); angles in degrees.
/// \pre check_indices() found all indices valid
std::vector<std::vector<double>> layer_fields(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context);

}  // namespace sterna::check_parts
