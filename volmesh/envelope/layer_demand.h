// What is asked of the layer, vertex by vertex, where walls ask for different things.
#pragma once

#include <cstdint>

#include "geom/base/ids.h"

namespace sterna::volmesh {

/// One entry per wall vertex; all columns empty: what EnvelopeOptions says holds everywhere.
struct LayerDemand {
  Column<VertexId, double> first_height;   ///< m
  Column<VertexId, double> max_growth;     ///< ratio
  Column<VertexId, double> max_thickness;  ///< m
  Column<VertexId, double> total_height;   ///< m; automatic: by eq. (1). Empty: nowhere given
  Column<VertexId, std::uint16_t> layers;  ///< the same for all vertices of a triangle
  bool is_empty() const { return first_height.empty(); }
};

}  // namespace sterna::volmesh
