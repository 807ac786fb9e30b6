#include "io/output/face_connectivity.h"

#include <string>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_count_interval = 1024;  // number of cells between two stored counts: 1 MB for 62 M cells, and some microseconds to count from a
                                                  // stored value
constexpr std::uint32_t k_unmatched = std::numeric_limits<std::uint32_t>::max() - 1;
constexpr std::uint32_t k_matched_often = std::numeric_limits<std::uint32_t>::max() - 2;
constexpr std::uint64_t k_most_slots = k_matched_often;
/// Kinds of explicit cells in the order of for_each_cell().
constexpr std::array<CellKind, 4> k_explicit_kinds = {CellKind::prism, CellKind::pyramid, CellKind::hexahedron, CellKind::tetrahedron};

/// Returns the key of a face for comparison: its nodes in ascending order, the fourth invalid for triangles.
std::array<NodeId, 4> key_of(const CellFace& face) {
  std::array<NodeId, 4> key{};
  std::copy_n(face.nodes.begin(), face.size, key.begin());
  std::sort(key.begin(), key.begin() + face.size);
  return key;
}

std::string location_of(const HybridMesh& mesh, const CellFace& face) {
  Point centre;
  std::string nodes;
  for (const NodeId node : face.span()) {
    centre += (1.0 / static_cast<double>(face.size)) * mesh.points[node];
    nodes += (nodes.empty() ? "" : ", ") + std::to_string(node.value());
  }
  return "the face of nodes " + nodes + " at " + format_point(centre);
}

[[noreturn]] void throw_invalid(const std::string& problem) {
  throw Error({.code = ErrorCode::mesh_invalid,
               .attempted = "finding the cells on both sides of the faces",
               .problem = problem,
               .hint = "run `sterna check` to list the defects of the mesh"});
}

}  // namespace

MeshFaces::MeshFaces(Borrowed<const HybridMesh> mesh, const RunContext& context) : mesh_(&mesh.get()) {
  number_cells();
  pair_sides();
  match_loose_faces(context);
  require_all_matched();
  count_internal(context);
}

void MeshFaces::number_cells() {
  const LayerBlock& layers = mesh_->layers;
  for (std::size_t c = 0; c < layers.n_columns(); ++c) n_live_ += layers.layers_of_column(c) > 0 ? 1 : 0;
  if (n_live_ < layers.n_columns()) {
    live_.reserve(n_live_);
    for (std::size_t c = 0; c < layers.n_columns(); ++c)
      if (layers.layers_of_column(c) > 0) live_.push_back(static_cast<std::uint32_t>(c));
  }
  if (layers.n_layers == 0) n_live_ = 0;
  cells_ = LayerNumbers(layers, n_live_, [&](std::uint64_t live) { return static_cast<std::uint64_t>(layers.layers_of_column(column_of(live))); });
  n_column_cells_ = cells_.size();
  const std::array<std::uint64_t, 4> counts = {mesh_->prisms.size(), mesh_->pyramids.size(), mesh_->hexahedra.size(), mesh_->tetrahedra.size()};
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    blocks_[k] = {.kind = k_explicit_kinds[k], .first_cell = n_column_cells_ + n_explicit_, .n_cells = counts[k], .first_slot = 0};
    n_explicit_ += counts[k];
  }
  if (n_cells() > k_most_slots)
    throw Error({.code = ErrorCode::overflow,
                 .attempted = "finding the cells on both sides of the faces",
                 .problem = std::to_string(n_cells()) + " cells, but cells are numbered up to " + std::to_string(k_most_slots)});
}

/// Pairs the sides of columns. Two columns over the same edge of the base are neighbours layer by layer.
void MeshFaces::pair_sides() {
  struct Edge {
    std::uint64_t lines;
    std::uint64_t side;
    bool operator<(const Edge& other) const { return lines != other.lines ? lines < other.lines : side < other.side; }
  };
  const LayerBlock& layers = mesh_->layers;
  std::vector<Edge> edges;
  edges.reserve(3 * n_live_);
  for (std::uint64_t live = 0; live < n_live_; ++live) {
    const auto& base = layers.base[column_of(live)];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(base[k], base[(k + 1) % 3]);
      if (!layers.is_collapsed[low] || !layers.is_collapsed[high]) edges.push_back({std::uint64_t{low} << 32 | high, 3 * live + k});
    }
  }
  std::sort(edges.begin(), edges.end());
  beside_.assign(3 * n_live_, k_boundary);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].lines == edges[i].lines) ++end;
    if (end == i + 2) {
      beside_[edges[i].side] = static_cast<std::uint32_t>(edges[i + 1].side / 3);
      beside_[edges[i + 1].side] = static_cast<std::uint32_t>(edges[i].side / 3);
    } else {
      for (std::size_t k = i; k < end; ++k) open_sides_.push_back(edges[k].side);
    }
    i = end;
  }
  std::sort(open_sides_.begin(), open_sides_.end());
  for (std::size_t i = 0; i < open_sides_.size(); ++i) beside_[open_sides_[i]] = static_cast<std::uint32_t>(n_live_ + i);
}

CellFace MeshFaces::side(std::size_t column, std::size_t k, int layer) const {
  const LayerBlock::Side side = mesh_->layers.side(column, k, layer);
  CellFace face;
  face.nodes = side.nodes;
  face.size = side.size;
  return face;
}

CellFace MeshFaces::cap(std::size_t column, int level, bool is_top) const {
  const auto& base = mesh_->layers.base[column];
  CellFace face;
  face.size = 3;
  for (std::size_t k = 0; k < 3; ++k) face.nodes[k] = mesh_->layers.node(base[is_top ? k : (3 - k) % 3], level);
  return face;
}

const MeshFaces::ExplicitBlock& MeshFaces::block_of(std::uint64_t cell) const {
  std::size_t k = 0;
  while (cell >= blocks_[k].first_cell + blocks_[k].n_cells) ++k;
  return blocks_[k];
}

CellKind MeshFaces::kind(std::uint64_t number) const {
  const std::uint64_t cell = old_of(number);
  if (cell >= n_column_cells_) return block_of(cell).kind;
  const auto [live, layer] = cells_.at(cell);
  return mesh_->layers.kind(column_of(live), static_cast<int>(layer));
}

std::span<const NodeId> MeshFaces::explicit_nodes(CellKind kind, std::uint64_t i) const {
  switch (kind) {
    case CellKind::tetrahedron: return mesh_->tetrahedra[i];
    case CellKind::pyramid: return mesh_->pyramids[i];
    case CellKind::prism: return mesh_->prisms[i];
    case CellKind::hexahedron: return mesh_->hexahedra[i];
  }
  return {};
}

CellFace MeshFaces::explicit_face(CellKind kind, std::uint64_t i, std::size_t k) const {
  const std::span<const NodeId> nodes = explicit_nodes(kind, i);
  const LocalFace& local = cell_faces(kind)[k];
  CellFace face;
  face.size = local.size;
  for (std::size_t n = 0; n < local.size; ++n) face.nodes[n] = nodes[local.nodes[n]];
  return face;
}

std::size_t MeshFaces::faces_of(std::uint64_t cell, std::array<CellFace, k_most_faces>& faces) const {
  const std::size_t n = given_faces_of(old_of(cell), faces);
  if (new_of_old_.empty()) return n;
  for (std::size_t k = 0; k < n; ++k)
    if (faces[k].size > 0 && faces[k].neighbour != k_boundary) faces[k].neighbour = new_of_old_[faces[k].neighbour];
  return n;
}

std::size_t MeshFaces::given_faces_of(std::uint64_t cell, std::array<CellFace, k_most_faces>& faces) const {
  if (cell >= n_column_cells_) {
    const ExplicitBlock& block = block_of(cell);
    const std::size_t n = cell_faces(block.kind).size();
    const std::uint64_t i = cell - block.first_cell;
    for (std::size_t k = 0; k < n; ++k) {
      faces[k] = explicit_face(block.kind, i, k);
      faces[k].neighbour = partner_[block.first_slot + i * n + k];
    }
    return n;
  }
  const auto [live, layer_number] = cells_.at(cell);
  const int layer = static_cast<int>(layer_number);
  const std::size_t column = column_of(live);
  faces[0] = cap(column, layer, false);
  faces[0].neighbour = layer == 0 ? partner_[live] : static_cast<std::uint32_t>(cell - 1);
  faces[1] = cap(column, layer + 1, true);
  faces[1].neighbour = layer_number + 1 == cells_.n_layers(live) ? partner_[n_live_ + live] : static_cast<std::uint32_t>(cell + 1);
  for (std::size_t k = 0; k < 3; ++k) {
    faces[2 + k] = side(column, k, layer);
    const std::uint32_t beside = beside_[3 * live + k];
    if (faces[2 + k].size == 0) continue;
    faces[2 + k].neighbour = beside < n_live_ ? static_cast<std::uint32_t>(cells_.first(beside) + layer_number)
                                              : partner_[first_open_ + open_faces_.first(beside - n_live_) + layer_number];
  }
  return 5;
}

CellFace MeshFaces::loose_face(Slot slot) const {
  CellFace face;
  if (slot < 2 * n_live_) {
    const bool is_top = slot >= n_live_;
    const std::uint64_t live = is_top ? slot - n_live_ : slot;
    const std::uint64_t n_layers = cells_.n_layers(live);
    face = cap(column_of(live), is_top ? static_cast<int>(n_layers) : 0, is_top);
    face.neighbour = static_cast<std::uint32_t>(cells_.first(live) + (is_top ? n_layers - 1 : 0));
    return face;
  }
  if (slot < blocks_[0].first_slot) {
    const auto [i, layer] = open_faces_.at(slot - first_open_);
    const std::uint64_t open = open_sides_[i];
    face = side(column_of(open / 3), open % 3, static_cast<int>(layer));
    face.neighbour = static_cast<std::uint32_t>(cells_.first(open / 3) + layer);
    return face;
  }
  if (slot < first_boundary_) {
    std::size_t b = blocks_.size() - 1;
    while (slot < blocks_[b].first_slot) --b;
    const std::size_t n = cell_faces(blocks_[b].kind).size();
    const std::uint64_t i = (slot - blocks_[b].first_slot) / n;
    face = explicit_face(blocks_[b].kind, i, (slot - blocks_[b].first_slot) % n);
    face.neighbour = static_cast<std::uint32_t>(blocks_[b].first_cell + i);
    return face;
  }
  const std::uint64_t i = slot - first_boundary_, n_triangles = mesh_->boundary_triangles.size();
  const std::span<const NodeId> nodes =
      i < n_triangles ? std::span<const NodeId>(mesh_->boundary_triangles[i].nodes) : std::span<const NodeId>(mesh_->boundary_quads[i - n_triangles].nodes);
  face.size = static_cast<std::uint32_t>(nodes.size());
  std::copy(nodes.begin(), nodes.end(), face.nodes.begin());
  face.neighbour = k_boundary;
  return face;
}

void MeshFaces::match_loose_faces(const RunContext& context) {
  first_open_ = 2 * n_live_;
  open_faces_ = LayerNumbers(mesh_->layers, open_sides_.size(), [&](std::uint64_t i) {
    const auto& base = mesh_->layers.base[column_of(open_sides_[i] / 3)];
    const std::size_t k = open_sides_[i] % 3;
    return static_cast<std::uint64_t>(std::max(mesh_->layers.n_steps(base[k]), mesh_->layers.n_steps(base[(k + 1) % 3])));
  });
  n_slots_ = first_open_ + open_faces_.size();
  for (ExplicitBlock& block : blocks_) {
    block.first_slot = n_slots_;
    n_slots_ += block.n_cells * cell_faces(block.kind).size();
  }
  first_boundary_ = n_slots_;
  n_slots_ += mesh_->boundary_triangles.size() + mesh_->boundary_quads.size();
  if (n_slots_ > k_most_slots)
    throw Error(
        {.code = ErrorCode::overflow,
         .attempted = "finding the cells on both sides of the faces",
         .problem = std::to_string(n_slots_) + " faces of cells outside the prism columns, but faces are numbered up to " + std::to_string(k_most_slots)});

  const std::size_t n_nodes = mesh_->points.size();
  std::vector<std::uint32_t> end_of(n_nodes + 1, 0);
  for (Slot slot = 0; slot < n_slots_; ++slot) {
    const CellFace face = loose_face(slot);
    NodeId lowest = face.nodes[0];
    for (const NodeId node : face.span()) {
      if (node.index() >= n_nodes) throw_invalid("a face has node " + std::to_string(node.value()) + ", there are " + std::to_string(n_nodes));
      lowest = std::min(lowest, node);
    }
    ++end_of[lowest.index() + 1];
  }
  for (std::size_t i = 0; i < n_nodes; ++i) end_of[i + 1] += end_of[i];
  std::vector<std::uint32_t> sorted(n_slots_);
  // Filling moves each node's start to its end. Afterwards the slots of node i are [end_of[i - 1], end_of[i]).
  for (Slot slot = 0; slot < n_slots_; ++slot) {
    const CellFace face = loose_face(slot);
    sorted[end_of[std::min_element(face.nodes.begin(), face.nodes.begin() + face.size)->index()]++] = static_cast<std::uint32_t>(slot);
  }

  struct Entry {
    std::array<NodeId, 4> key;
    std::uint32_t cell, slot;
    bool operator<(const Entry& other) const { return key != other.key ? key < other.key : slot < other.slot; }
  };
  partner_.assign(n_slots_, k_unmatched);
  parallel_chunks(context, n_nodes, k_default_chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Entry> entries;
    for (std::size_t node = begin; node < end; ++node) {
      entries.clear();
      for (std::uint32_t i = node == 0 ? 0 : end_of[node - 1]; i < end_of[node]; ++i) {
        const CellFace face = loose_face(sorted[i]);
        entries.push_back({key_of(face), face.neighbour, sorted[i]});
      }
      std::sort(entries.begin(), entries.end());
      for (std::size_t i = 0; i < entries.size();) {
        std::size_t last = i + 1;
        while (last < entries.size() && entries[last].key == entries[i].key) ++last;
        if (last == i + 2) {
          partner_[entries[i].slot] = entries[i + 1].cell;
          partner_[entries[i + 1].slot] = entries[i].cell;
        }
        for (std::size_t k = i; last > i + 2 && k < last; ++k) partner_[entries[k].slot] = k_matched_often;
        i = last;
      }
    }
  });
}

void MeshFaces::require_all_matched() const {
  for (Slot slot = 0; slot < n_slots_; ++slot) {
    const std::uint32_t partner = partner_[slot];
    if (partner < k_matched_often || (partner == k_boundary && slot < first_boundary_)) continue;
    const std::string face = location_of(*mesh_, loose_face(slot));
    if (partner == k_matched_often) throw_invalid(face + " occurs more than twice among cells and boundary");
    if (partner == k_boundary) throw_invalid(face + " is twice in the boundary");
    throw_invalid(slot < first_boundary_ ? face + " belongs to one cell only and is not in the boundary"
                                         : face + " is in the boundary, but belongs to no cell");
  }
}

void MeshFaces::count_internal(const RunContext& context) {
  const std::uint64_t n = (n_cells() + k_count_interval - 1) / k_count_interval;
  internal_before_.assign(n + 1, {});
  parallel_for(
      context, n,
      [&](std::size_t i) {
        Count count;
        for_each_internal(i * k_count_interval, std::min((i + 1) * k_count_interval, n_cells()), [&](std::uint64_t, const CellFace& face) {
          ++count.faces;
          count.nodes += face.size;
        });
        internal_before_[i + 1] = count;
      },
      16);
  for (std::size_t i = 0; i < n; ++i) {
    internal_before_[i + 1].faces += internal_before_[i].faces;
    internal_before_[i + 1].nodes += internal_before_[i].nodes;
  }
}

std::uint64_t MeshFaces::unit_of(std::uint64_t cell, bool is_by_column) const {
  if (!is_by_column) return cell;
  return cell < n_column_cells_ ? cells_.at(cell).i : n_live_ + (cell - n_column_cells_);
}

NeighbourGraph MeshFaces::unit_graph(bool is_by_column, const RunContext& context) const {
  const std::uint64_t n_units = is_by_column ? n_live_ + n_explicit_ : n_cells();
  NeighbourGraph graph;
  graph.first.assign(n_units + 1, 0);
  const auto gather = [&](std::uint64_t unit, std::vector<std::uint32_t>& found) {
    found.clear();
    std::array<CellFace, k_most_faces> faces;
    const bool is_column = is_by_column && unit < n_live_;
    const std::uint64_t begin = is_column ? cells_.first(unit) : is_by_column ? n_column_cells_ + (unit - n_live_) : unit;
    const std::uint64_t end = is_column ? begin + cells_.n_layers(unit) : begin + 1;
    for (std::uint64_t cell = begin; cell < end; ++cell) {
      const std::size_t n = given_faces_of(cell, faces);
      for (std::size_t k = 0; k < n; ++k) {
        if (faces[k].size == 0 || faces[k].neighbour == k_boundary) continue;
        const std::uint64_t other = unit_of(faces[k].neighbour, is_by_column);
        if (other != unit) found.push_back(static_cast<std::uint32_t>(other));
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  };
  for (const bool is_counting : {true, false}) {
    parallel_chunks(context, n_units, k_default_chunk, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> found;
      for (std::size_t unit = begin; unit < end; ++unit) {
        gather(unit, found);
        if (is_counting) graph.first[unit + 1] = found.size();
        else std::copy(found.begin(), found.end(), graph.neighbours.begin() + static_cast<std::ptrdiff_t>(graph.first[unit]));
      }
    });
    if (!is_counting) break;
    for (std::uint64_t unit = 0; unit < n_units; ++unit) graph.first[unit + 1] += graph.first[unit];
    graph.neighbours.resize(graph.first.back());
  }
  return graph;
}

NeighbourGraph MeshFaces::cell_graph(const RunContext& context) const { return unit_graph(false, context); }

void MeshFaces::order_cells(Numbering numbering, const RunContext& context) {
  old_of_new_.clear();
  new_of_old_.clear();
  if (numbering != Numbering::lines) {
    const bool is_by_column = numbering == Numbering::both;
    old_of_new_.reserve(n_cells());
    for (const std::uint32_t unit : bandwidth_order(unit_graph(is_by_column, context))) {
      const bool is_column = is_by_column && unit < n_live_;
      const std::uint64_t begin = is_column ? cells_.first(unit) : is_by_column ? n_column_cells_ + (unit - n_live_) : unit;
      const std::uint64_t end = is_column ? begin + cells_.n_layers(unit) : begin + 1;
      for (std::uint64_t cell = begin; cell < end; ++cell) old_of_new_.push_back(static_cast<std::uint32_t>(cell));
    }
    new_of_old_.resize(n_cells());
    for (std::uint32_t i = 0; i < old_of_new_.size(); ++i) new_of_old_[old_of_new_[i]] = i;
  }
  count_internal(context);
}

MeshFaces::Count MeshFaces::internal_before(std::uint64_t cell) const {
  const std::uint64_t i = cell / k_count_interval;
  Count count = internal_before_[i];
  for_each_internal(i * k_count_interval, cell, [&](std::uint64_t, const CellFace& face) {
    ++count.faces;
    count.nodes += face.size;
  });
  return count;
}

}  // namespace sterna::io
