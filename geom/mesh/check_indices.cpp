// First step of the walker: checks that all indices are valid and that every node is used.
#include <atomic>

#include "geom/base/error.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

template <class Nodes>
bool has_repeated_node(const Nodes& nodes) {
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    for (std::size_t j = i + 1; j < nodes.size(); ++j)
      if (nodes[i] == nodes[j]) return true;
  return false;
}

/// Returns the entities of one array that break a rule, in order.
template <class IsBad>
std::vector<std::uint64_t> find_bad(const RunContext& context, std::size_t n, const IsBad& is_bad) {
  return parallel_reduce(
      context, n, std::vector<std::uint64_t>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> bad;
        for (std::size_t i = begin; i < end; ++i)
          if (is_bad(i)) bad.push_back(i);
        return bad;
      },
      concatenate<std::uint64_t>);
}

class IndexWalker {
 public:
  IndexWalker(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, Findings& findings)
      : mesh_(mesh), cells_(cells), context_(context), findings_(findings) {}

  bool is_safe() const { return is_safe_; }

  void check_points() {
    for (const std::uint64_t i : find_bad(context_, mesh_.points.size(), [&](std::size_t n) { return !is_finite(mesh_.points.raw()[n]); })) {
      is_safe_ = false;
      findings_.add(Violation::bad_point, [&] { return std::pair(mesh_.points.raw()[i], "node " + std::to_string(i) + " is not finite"); });
    }
  }

  /// Checks the tables of the columns; returns false if lines cannot be looked up at all.
  void check_columns() {
    const LayerBlock& layers = mesh_.layers;
    if (layers.is_collapsed.size() != layers.n_lines() || layers.n_layers < 0 || (layers.n_layers == 0 && layers.n_columns() > 0)) {
      add_unsafe("columns: " + std::to_string(layers.n_layers) + " layers, " + std::to_string(layers.n_lines()) + " lines, " +
                 std::to_string(layers.is_collapsed.size()) + " collapse flags");
      return;
    }
    if (!layers.is_uniform() && layers.line_layers.size() != layers.n_lines()) {
      add_unsafe("columns: " + std::to_string(layers.n_lines()) + " lines, numbers of layers for " + std::to_string(layers.line_layers.size()));
      return;
    }
    for (const std::uint64_t k : find_bad(context_, layers.line_layers.size(),
                                          [&](std::size_t line) { return layers.line_layers[line] < 1 || layers.line_layers[line] > layers.n_layers; }))
      add_unsafe("line " + std::to_string(k) + ": " + std::to_string(layers.line_layers[k]) + " layers, expected 1 to " + std::to_string(layers.n_layers));
    for (const std::uint64_t k :
         find_bad(context_, layers.n_lines(), [&](std::size_t line) { return layers.is_collapsed[line] > 1 || end_of_line(line) > mesh_.points.size(); }))
      add_unsafe("line " + std::to_string(k) + ": nodes " + std::to_string(layers.first_node[k]) + " to " + std::to_string(end_of_line(k) - 1) + " of " +
                 std::to_string(mesh_.points.size()));
    for (const std::uint64_t c : find_bad(context_, layers.n_columns(), [&](std::size_t column) {
           const auto& b = layers.base[column];
           return std::any_of(b.begin(), b.end(), [&](std::uint32_t line) { return line >= layers.n_lines(); });
         }))
      add_unsafe("column " + std::to_string(c) + ": line index out of range, " + std::to_string(layers.n_lines()) + " lines");
    if (!is_safe_) return;
    for (const std::uint64_t c : find_bad(context_, layers.is_uniform() ? 0 : layers.n_columns(), [&](std::size_t column) {
           const std::array<int, 3> ends = layers.ends_of_column(column);
           const int shortest = ends[0] > 0 ? ends[0] : ends[1] > 0 ? ends[1] : ends[2];
           return ends[2] > shortest + 1;
         }))
      add_unsafe("column " + std::to_string(c) + ": the layer counts of its lines differ by more than one");
    if (!is_safe_) return;
    for (const std::uint64_t c : find_bad(context_, layers.n_columns(), [&](std::size_t column) { return has_repeated_node(layers.base[column]); }))
      findings_.add(Violation::bad_index,
                    [&] { return std::pair(mesh_.points[layers.node(layers.base[c][0], 0)], "column " + std::to_string(c) + " repeats a line"); });
    check_lines();
  }

  template <class Entities, class NodesOf, class Name>
  void check_nodes(const Entities& entities, const NodesOf& nodes_of, const Name& name) {
    const std::size_t n_points = mesh_.points.size();
    const auto is_out_of_range = [&](NodeId node) { return node.index() >= n_points; };
    for (const std::uint64_t i : find_bad(context_, entities.size(), [&](std::size_t entity) {
           const auto& n = nodes_of(entities[entity]);
           return std::any_of(n.begin(), n.end(), is_out_of_range) || has_repeated_node(n);
         })) {
      const auto& nodes = nodes_of(entities[i]);
      const auto bad = std::find_if(nodes.begin(), nodes.end(), is_out_of_range);
      if (bad != nodes.end()) is_safe_ = false;
      findings_.add(Violation::bad_index, [&] {
        const auto good = std::find_if_not(nodes.begin(), nodes.end(), is_out_of_range);
        return std::pair(
            good != nodes.end() ? mesh_.points[*good] : Point{},
            name(i) + (bad != nodes.end() ? ": node " + std::to_string(bad->value()) + " of " + std::to_string(n_points) : std::string(" repeats a node")));
      });
    }
  }

  template <class Faces>
  void check_patches(const Faces& faces, const char* what) {
    for (const std::uint64_t i : find_bad(context_, faces.size(), [&](std::size_t face) { return faces[face].patch.index() >= mesh_.patches.size(); }))
      findings_.add(Violation::bad_index, [&] {
        return std::pair(mesh_.points[faces[i].nodes[0]],
                         what + std::to_string(i) + ": patch " + std::to_string(faces[i].patch.value()) + " of " + std::to_string(mesh_.patches.size()));
      });
  }

  /// \pre is_safe()
  void check_use() {
    std::vector<std::uint8_t> is_used(mesh_.points.size(), 0);
    const auto use = [&](std::size_t node) {
      const std::atomic_ref<std::uint8_t> flag(is_used[node]);
      if (flag.load(std::memory_order_relaxed) == 0) flag.store(1, std::memory_order_relaxed);
    };
    const LayerBlock& layers = mesh_.layers;
    std::vector<std::uint8_t> is_line_used(layers.n_lines(), 0);
    for (std::size_t c = 0; c < layers.n_columns(); ++c)
      if (layers.layers_of_column(c) > 0)
        for (const std::uint32_t line : layers.base[c]) is_line_used[line] = 1;
    parallel_for(context_, layers.n_lines(), [&](std::size_t k) {
      if (is_line_used[k])
        for (std::size_t node = layers.first_node[k]; node < end_of_line(k); ++node) use(node);
    });
    const auto use_all = [&](const auto& cells) {
      parallel_for(context_, cells.size(), [&](std::size_t c) {
        for (const NodeId node : cells[c]) use(node.index());
      });
    };
    use_all(mesh_.prisms);
    use_all(mesh_.pyramids);
    use_all(mesh_.hexahedra);
    use_all(mesh_.tetrahedra);
    for (const std::uint64_t i : find_bad(context_, is_used.size(), [&](std::size_t node) { return is_used[node] == 0; }))
      findings_.add(Violation::unused_node, [&] {
        const Point& p = mesh_.points.raw()[i];
        return std::pair(p, "node " + std::to_string(i) + " belongs to no cell" + near_patch(mesh_, p));
      });
  }

 private:
  std::uint64_t end_of_line(std::size_t k) const { return std::uint64_t{mesh_.layers.first_node[k]} + 1 + static_cast<std::uint64_t>(mesh_.layers.n_steps(k)); }

  void add_unsafe(std::string what) {
    is_safe_ = false;
    findings_.add(Violation::bad_index, [&] { return std::pair(Point{}, std::move(what)); });
  }

  /// Checks that no node is on two lines: sorted by their first node, each line ends before the next one starts.
  void check_lines() {
    const LayerBlock& layers = mesh_.layers;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted(layers.n_lines());
    for (std::uint32_t k = 0; k < sorted.size(); ++k) sorted[k] = {layers.first_node[k], k};
    if (!std::is_sorted(sorted.begin(), sorted.end())) parallel_sort(context_, sorted, std::less<>{});
    std::size_t longest = 0;  // the line with the largest end so far
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      const std::uint32_t before = sorted[longest].second, line = sorted[i].second;
      if (end_of_line(before) > sorted[i].first)
        findings_.add(Violation::broken_line, [&] {
          const Point& p = mesh_.points.raw()[sorted[i].first];
          return std::pair(
              p, "lines " + std::to_string(before) + " and " + std::to_string(line) + " share node " + std::to_string(sorted[i].first) + near_patch(mesh_, p));
        });
      if (end_of_line(line) >= end_of_line(before)) longest = i;
    }
  }

  const HybridMesh& mesh_;
  const CellNumbers& cells_;
  const RunContext& context_;
  Findings& findings_;
  bool is_safe_ = true;
};

}  // namespace

bool check_indices(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, Findings& findings) {
  IndexWalker walker(mesh, cells, context, findings);
  const auto itself = [](const auto& nodes) -> const auto& { return nodes; };
  const auto nodes_of_face = [](const auto& face) -> const auto& { return face.nodes; };
  const auto cell_name = [&](std::uint64_t first) { return [&cells, first](std::uint64_t i) { return cells.name(first + i); }; };
  const auto face_name = [](const char* what) { return [what](std::uint64_t i) { return what + std::to_string(i); }; };

  walker.check_points();
  walker.check_nodes(mesh.boundary_triangles, nodes_of_face, face_name("boundary triangle "));
  walker.check_nodes(mesh.boundary_quads, nodes_of_face, face_name("boundary quad "));
  if (!walker.is_safe()) return false;
  walker.check_patches(mesh.boundary_triangles, "boundary triangle ");
  walker.check_patches(mesh.boundary_quads, "boundary quad ");
  walker.check_columns();
  if (!walker.is_safe()) return false;
  walker.check_nodes(mesh.prisms, itself, cell_name(cells.first_prism()));
  walker.check_nodes(mesh.pyramids, itself, cell_name(cells.first_pyramid()));
  walker.check_nodes(mesh.hexahedra, itself, cell_name(cells.first_hexahedron()));
  walker.check_nodes(mesh.tetrahedra, itself, cell_name(cells.first_tetrahedron()));
  if (!walker.is_safe()) return false;
  walker.check_use();
  return true;
}

}  // namespace sterna::check_parts
