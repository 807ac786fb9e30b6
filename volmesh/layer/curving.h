// Wall perpendicularity c_t of eq. (12) as a field over the wall: full where the layer allows it, less around the growth lines that need less
// (docs/method/prisms.md, "Curving").
#pragma once

#include <array>
#include <vector>

#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

class Curving {
 public:
  /// c_t = `wanted` everywhere.
  Curving(const LayerBase& base, double wanted);

  double operator[](VertexId v) const { return c_t_[v]; }
  /// Limits c_t to at most `c_t` at v from the next smooth() on.
  void limit(VertexId v, double c_t);
  /// Computes the field from the limits: smallest limit of vertex and neighbours, then a few sweeps of averaging that never exceed a vertex's own limit;
  /// vertices that must grow alike get the smallest of their values. The field only falls from call to call. Returns the vertices where it changed,
  /// ascending.
  std::vector<VertexId> smooth(const RunContext& context);

  /// Returns the number of growth lines by their share of the target c_t: straight, up to 1/4, 1/2, 3/4, below 1.
  std::array<std::int64_t, 5> distribution() const;

 private:
  const LayerBase& base_;
  double wanted_;
  Column<VertexId, double> c_t_, limit_;
  std::vector<VertexId> limited_;  ///< vertices where limit_ < wanted_
};

}  // namespace sterna::volmesh
