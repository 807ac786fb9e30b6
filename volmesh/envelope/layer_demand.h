// Layer targets of each vertex, for walls with different layer settings.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "geom/base/columns.h"
#include "geom/base/ids.h"

namespace sterna::volmesh {

/// Layer targets with one entry per wall vertex. If all columns are empty, EnvelopeOptions apply everywhere.
struct LayerDemand {
  Column<VertexId, double> first_height;   ///< m
  Column<VertexId, double> max_growth;     ///< largest growth ratio
  Column<VertexId, double> max_thickness;  ///< m
  Column<VertexId, double> total_height;   ///< m; automatic: height of eq. (1). Empty: no vertex has a given height
  Column<VertexId, std::uint16_t> layers;  ///< equal for all vertices of a triangle; on wake sheets they differ by at most one
  bool is_empty() const { return first_height.empty(); }
};

/// Returns the columns; this is the only list of them (for_each_column). A new member does not compile until it is listed here.
template <class Demand>
requires std::is_same_v<std::remove_const_t<Demand>, LayerDemand>
auto columns_of(Demand& demand) {
  auto& [first_height, max_growth, max_thickness, total_height, layers] = demand;
  return std::tie(first_height, max_growth, max_thickness, total_height, layers);
}

}  // namespace sterna::volmesh
