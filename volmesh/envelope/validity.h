// Which macro-elements (the one wedge, pyramid or tet between a wall triangle and its envelope triangle) are valid with margin, and changes of the
// envelope that keep them so.
#pragma once

#include <vector>

#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Corner data of a macro-element: height and direction at its three vertices.
struct MacroElement {
  std::array<Point, 3> wall;
  std::array<Vec3, 3> direction;
  std::array<double, 3> height;  ///< 0 = collapsed corner
};
MacroElement macro_element(const LayerBase& base, const Envelope& envelope, TriangleId t);

/// Valid by the exact test of its element type, and with margin: the envelope triangle keeps a share of the wall triangle's projected area (g_1 of
/// eq. (6)) and is not seen too flatly along any growth edge, unless the wall triangle itself is seen so.
bool is_macro_valid(const MacroElement& element);

/// Triangles whose macro-element is not valid, ascending. With `dirty`, only triangles with a marked vertex are looked at.
std::vector<TriangleId> invalid_macros(const LayerBase& base, const Envelope& envelope, const RunContext& context,
                                       const Column<VertexId, std::uint8_t>* dirty = nullptr);

/// Moves `envelope` to `proposal` (direction and height) at every vertex where this leaves its macro-elements valid: all at once, then vertices of
/// invalid elements go back, until none is invalid that was not so before. \pre same wall; vertices with proposal == envelope are not touched.
/// With `dirty`, only elements at marked vertices are looked at first: the others are known to be valid in the proposal.
void apply_where_valid(const LayerBase& base, Envelope& envelope, const Envelope& proposal, const RunContext& context,
                       const Column<VertexId, std::uint8_t>* dirty = nullptr);

}  // namespace sterna::volmesh
