// Items of measures: their locations, names, nodes and cells. Private to the check_*.cpp files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Adds the nodes of a cell and the cell.
inline void gather_cell(const CellNumbers& cells, std::uint64_t number, GateExtent& extent) {
  for (const NodeId node : cells.cell(number).span()) extent.nodes.push_back(node.value());
  extent.cells.push_back(number);
}
/// Adds the nodes of a face and the cell that identifies the face.
inline void gather_face(std::span<const NodeId> nodes, std::uint64_t cell, GateExtent& extent) {
  for (const NodeId node : nodes) extent.nodes.push_back(node.value());
  extent.cells.push_back(cell);
}

/// Items whose ids are nodes.
struct NodeItems {
  const HybridMesh& mesh;
  std::pair<Point, std::string> operator()(std::uint64_t id) const { return describe_node(mesh, id); }
  void gather(std::uint64_t id, GateExtent& extent) const { extent.nodes.push_back(static_cast<std::uint32_t>(id)); }
};

/// Items whose ids are cell numbers.
struct CellItems {
  const CellNumbers& cells;
  std::pair<Point, std::string> operator()(std::uint64_t id) const { return {cells.center(id), cells.name(id)}; }
  void gather(std::uint64_t id, GateExtent& extent) const { gather_cell(cells, id, extent); }
};

/// Items whose ids are slots of cell faces.
struct SlotItems {
  const FaceSlots& slots;
  std::string_view prefix;  ///< "face of "
  std::pair<Point, std::string> operator()(std::uint64_t id) const {
    const auto slot = static_cast<std::uint32_t>(id);
    return {slots.center(slot), std::string(prefix) + slots.name(slot)};
  }
  void gather(std::uint64_t id, GateExtent& extent) const {
    const Face face = slots.face(static_cast<std::uint32_t>(id));
    gather_face(std::span(face.nodes).first(face.size), slots.owner(static_cast<std::uint32_t>(id)), extent);
  }
};

/// Counts the locations of all gates, and the share of the volume for items that are not areas; empties the extents.
/// \pre indices are in range
void count_locations(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, CheckReport& report);

}  // namespace sterna::check_parts
