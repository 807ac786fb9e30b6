// Wall perpendicularity c_t of eq. (12) as a field over the wall. It has its full value where the layer allows it, and less around the growth lines that
// require less (docs/method/prisms.md, "Curving").
#pragma once

#include <array>
#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

class Curving {
 public:
  /// Sets c_t to `target` everywhere.
  Curving(Borrowed<const LayerBase> base, double target);

  double operator[](VertexId v) const { return c_t_[v]; }
  /// Limits c_t to at most `c_t` at v, from the next call of smooth() on.
  void limit(VertexId v, double c_t);
  /// Computes the field from the limits: the smallest limit of a vertex and its neighbours, followed by a few sweeps of averaging that never exceed the
  /// vertex's own limit. Vertices that must grow alike get the smallest of their values. The field only falls from call to call. Returns the vertices where it
  /// changed, ascending.
  std::vector<VertexId> smooth(const RunContext& context);

  /// Returns the numbers of growth lines by the fraction of the target c_t that they have: zero (straight), up to 1/4, 1/2, 3/4, below 1.
  std::array<std::int64_t, 5> distribution() const;

 private:
  const LayerBase& base_;
  double target_;
  Column<VertexId, double> c_t_, limit_;
  std::vector<VertexId> limited_;  ///< vertices where limit_ < wanted_
};

}  // namespace sterna::volmesh
