// Wall perpendicularity c_t of eq. (12) as a field over the wall: full where the layer allows it, less around the lines that need it (docs/method/prisms.md,
// "Curving").
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
  /// From the next smooth() on c_t is at most `c_t` at v.
  void limit(VertexId v, double c_t);
  /// The field from the limits: smallest limit of vertex and neighbours, then a few sweeps of averaging that never exceed a vertex's own limit; vertices that
  /// must grow alike get the smallest of theirs. It only falls from call to call. Returns the vertices where it changed, ascending.
  std::vector<VertexId> smooth(const RunContext& context);

  /// Lines by their share of the wanted c_t: straight, up to 1/4, 1/2, 3/4, below 1.
  std::array<std::int64_t, 5> distribution() const;

 private:
  const LayerBase& base_;
  double wanted_;
  Column<VertexId, double> c_t_, limit_;
  std::vector<VertexId> limited_;  ///< where limit_ < wanted_
};

}  // namespace sterna::volmesh
