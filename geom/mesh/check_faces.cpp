// Matches faces by their vertex ids. A face falls into the bucket of its lowest node. Inside a bucket the faces are sorted by the remaining nodes in a
// canonical order that keeps the cycle (quads match only with the same cycle), with one bit for the sense. Buckets are filled by counting (with atomic
// cursors: the order inside a bucket is restored by its sort), in batches of node ranges that bound the memory.
#include <algorithm>
#include <atomic>
#include <string>

#include "geom/mesh/check_parts.h"
#include "geom/mesh/open_faces.h"

namespace sterna::check_parts {
namespace {

/// Nodes per chunk of the matching loops; some 20 faces each.
constexpr std::size_t k_used_node_chunk = 4096;

/// A face without its lowest node a. Triangle (a, b, c): b < c. Quad (a, b, d, c) in cyclic order: b < c, and d is opposite to a.
struct FaceKey {
  std::uint32_t b, c;
  std::uint32_t d;               ///< NodeId::k_invalid for a triangle
  std::uint32_t slot_and_sense;  ///< 2 * slot + (1 if the face runs a, c, .., b)

  std::uint32_t slot() const { return slot_and_sense >> 1; }
  bool is_reversed() const { return (slot_and_sense & 1u) != 0; }
  bool is_same_face(const FaceKey& other) const { return b == other.b && c == other.c && d == other.d; }
  friend auto operator<=>(const FaceKey&, const FaceKey&) = default;
};

struct KeyedFace {
  std::uint32_t lowest = 0;
  FaceKey key{};
};

std::size_t lowest_corner(const Face& face) {
  std::size_t lowest = 0;
  for (std::size_t k = 1; k < face.size; ++k)
    if (face.nodes[k] < face.nodes[lowest]) lowest = k;
  return lowest;
}

KeyedFace canonical(std::uint32_t slot, const Face& face) {
  const std::size_t k = lowest_corner(face);
  const auto at = [&](std::size_t i) { return face.nodes[(k + i) % face.size].value(); };
  const std::uint32_t after = at(1), before = at(face.size - 1u);
  const std::uint32_t opposite = face.size == 4 ? at(2) : NodeId::k_invalid;
  return {at(0), {std::min(after, before), std::max(after, before), opposite, 2 * slot + (after > before ? 1u : 0u)}};
}

/// Classifies one face from all its occurrences. Cells come first, because boundary slots are the highest.
void judge(const FaceSlots& slots, const FaceKey* face, std::size_t n, std::span<const double> tet_volumes, std::span<std::uint32_t> cap_neighbours,
           FaceMatch& match) {
  std::size_t n_cells = 0;
  while (n_cells < n && !slots.is_boundary(face[n_cells].slot())) ++n_cells;
  const std::size_t n_boundary = n - n_cells;
  const auto add = [&](Violation violation, std::size_t of, std::size_t other) {
    match.issues.push_back({violation, static_cast<std::uint32_t>(n_cells), face[of].slot(), face[other].slot()});
  };
  for (std::size_t i = n_cells + 1; i < n; ++i) add(Violation::duplicate_marker, i, n_cells);
  if (n_cells == 0) return add(Violation::stray_boundary_face, 0, 0);
  if (n_cells > 2 || (n_cells == 2 && n_boundary > 0)) return add(Violation::overmatched_face, 0, n_cells > 2 ? 1 : 2);
  if (n_cells == 2) {
    if (face[0].is_reversed() == face[1].is_reversed()) return add(Violation::same_sense_face, 0, 1);
    if (match.with_pairs) match.pairs.push_back({face[0].slot(), face[1].slot()});
    // If only one of the two slots belongs to the layer, it is the lower one.
    for (std::size_t i = 0; i < 2 && !cap_neighbours.empty(); ++i)
      if (const auto cap = slots.prism_cap(face[i].slot())) cap_neighbours[*cap] = face[1 - i].slot();
    const bool is_layer = slots.is_layer(face[0].slot());
    if (is_layer && !slots.is_layer(face[1].slot())) {
      match.interface.push_back(face[0].slot());
      match.interface_tets.push_back(face[1].slot());
    }
    if (!is_layer && match.tet_growth) {
      const auto [small, large] = std::minmax(tet_volumes[slots.tet_of(face[0].slot())], tet_volumes[slots.tet_of(face[1].slot())]);
      match.tet_growth->add(small > 0.0 ? large / small : std::numeric_limits<double>::infinity(), face[0].slot());
    }
    return;
  }
  if (n_boundary == 0) return add(Violation::unmatched_face, 0, 0);
  match.outer.push_back(face[0].slot());
  match.outer_boundary.push_back(face[1].slot());
  for (std::size_t i = 1; i < n; ++i)
    if (face[i].is_reversed() != face[0].is_reversed()) add(Violation::same_sense_face, i, 0);
}

void append(FaceMatch& all, FaceMatch&& more) {
  all.issues = concatenate(std::move(all.issues), std::move(more.issues));
  all.outer.insert(all.outer.end(), more.outer.begin(), more.outer.end());
  all.outer_boundary.insert(all.outer_boundary.end(), more.outer_boundary.begin(), more.outer_boundary.end());
  all.interface.insert(all.interface.end(), more.interface.begin(), more.interface.end());
  all.interface_tets.insert(all.interface_tets.end(), more.interface_tets.begin(), more.interface_tets.end());
  all.pairs = concatenate(std::move(all.pairs), std::move(more.pairs));
  if (all.tet_growth) all.tet_growth->merge(*more.tet_growth);
}

}  // namespace

FaceMatch match_faces(const FaceSlots& slots, std::size_t n_points, std::uint64_t faces_at_a_time, std::span<const double> tet_volumes, bool with_pairs,
                      const GateTable& limits, const RunContext& context) {
  const auto make_match = [&] {
    FaceMatch match;
    match.with_pairs = with_pairs;
    if (!tet_volumes.empty()) match.tet_growth.emplace(info_of(Measure::tet_growth), limits[Measure::tet_growth]);
    return match;
  };
  std::vector<std::uint32_t> cursor(n_points, 0);
  slots.for_each(context, [&](std::uint32_t, const Face& face) {
    std::atomic_ref<std::uint32_t>(cursor[face.nodes[lowest_corner(face)].index()]).fetch_add(1, std::memory_order_relaxed);
  });
  std::vector<std::uint64_t> first(n_points + 1, 0);
  for (std::size_t node = 0; node < n_points; ++node) first[node + 1] = first[node] + cursor[node];

  FaceMatch match = make_match();
  std::vector<std::uint32_t> cap_neighbours(slots.n_prism_caps(), k_no_slot);  // each entry is written once: a face is judged once
  std::vector<FaceKey> keys;
  for (std::size_t begin_node = 0; begin_node < n_points;) {
    std::size_t end_node = begin_node + 1;
    while (end_node < n_points && first[end_node + 1] - first[begin_node] <= faces_at_a_time) ++end_node;
    const std::uint64_t first_key = first[begin_node];
    keys.resize(first[end_node] - first_key);
    std::fill(cursor.begin() + static_cast<std::ptrdiff_t>(begin_node), cursor.begin() + static_cast<std::ptrdiff_t>(end_node), 0u);
    slots.for_each(context, [&](std::uint32_t slot, const Face& face) {
      const std::size_t lowest = face.nodes[lowest_corner(face)].index();
      if (lowest < begin_node || lowest >= end_node) return;
      const std::uint32_t i = std::atomic_ref<std::uint32_t>(cursor[lowest]).fetch_add(1, std::memory_order_relaxed);
      keys[first[lowest] - first_key + i] = canonical(slot, face).key;
    });
    FaceMatch batch = parallel_reduce(
        context, end_node - begin_node, make_match(),
        [&](std::size_t begin, std::size_t end) {
          FaceMatch part = make_match();
          for (std::size_t node = begin_node + begin; node < begin_node + end; ++node) {
            FaceKey* const bucket = keys.data() + (first[node] - first_key);
            const std::size_t n = first[node + 1] - first[node];
            std::sort(bucket, bucket + n);
            for (std::size_t i = 0, e = 0; i < n; i = e) {
              for (e = i; e < n && bucket[e].is_same_face(bucket[i]);) ++e;
              judge(slots, bucket + i, e - i, tet_volumes, cap_neighbours, part);
            }
          }
          return part;
        },
        [](FaceMatch all, FaceMatch more) {
          append(all, std::move(more));
          return all;
        },
        k_used_node_chunk);
    append(match, std::move(batch));
    begin_node = end_node;
  }
  std::sort(match.issues.begin(), match.issues.end());
  match.cap_neighbours = std::move(cap_neighbours);
  return match;
}

void report_faces(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, Findings& findings) {
  for (const FaceIssue& issue : match.issues) {
    findings.add(issue.violation, [&] {
      const Point center = slots.center(issue.slot);
      const std::string shape = slots.face(issue.slot).size == 3 ? "triangle" : "quad";
      std::string what;
      switch (issue.violation) {
        case Violation::unmatched_face:
          what = shape + " of " + slots.name(issue.slot) + near_patch(mesh, center) + " has no other cell and no boundary face";
          break;
        case Violation::overmatched_face:
          what = shape + " of " + slots.name(issue.slot) + " belongs to " + std::to_string(issue.n_cells) + " cells" +
                 (slots.is_boundary(issue.other) ? " and to " : ", among them ") + slots.name(issue.other);
          if (!slots.is_boundary(issue.other)) what += near_patch(mesh, center);
          break;
        case Violation::same_sense_face:
          what = slots.is_boundary(issue.slot)
                     ? slots.name(issue.slot) + " points into its cell, " + slots.name(issue.other)
                     : slots.name(issue.slot) + " and " + slots.name(issue.other) + near_patch(mesh, center) + " lie on the same side of their " + shape;
          break;
        case Violation::stray_boundary_face: what = slots.name(issue.slot) + " is a face of no cell"; break;
        default: what = slots.name(issue.slot) + " marks the face of " + slots.name(issue.other) + " again"; break;
      }
      return std::pair(center, std::move(what));
    });
  }
}

}  // namespace sterna::check_parts

namespace sterna {
namespace {

using check_parts::Face;
using check_parts::FaceSlots;

/// Returns a hash of the nodes of a face that is independent of their first node and sense.
std::uint64_t hash_of(const Face& face) {
  std::array<std::uint32_t, 4> nodes{};
  for (std::size_t k = 0; k < face.size; ++k) nodes[k] = face.nodes[k].value();
  std::sort(nodes.begin(), nodes.begin() + face.size);
  std::uint64_t hash = face.size;
  for (std::size_t k = 0; k < face.size; ++k) {  // the finaliser of splitmix64
    hash += 0x9e3779b97f4a7c15u + nodes[k];
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
    hash ^= hash >> 31;
  }
  return hash;
}

/// Returns true if every face occurs an even number of times; the probability of a false "true" is 2^-64.
bool is_paired(const FaceSlots& slots, const RunContext& context) {
  constexpr std::size_t k_words = 64;  // avoids contention between threads
  constexpr std::uint32_t k_slots_per_word = 4096;
  std::array<std::uint64_t, k_words> words{};
  slots.for_each(context, [&](std::uint32_t slot, const Face& face) {
    std::atomic_ref<std::uint64_t>(words[slot / k_slots_per_word % k_words]).fetch_xor(hash_of(face), std::memory_order_relaxed);
  });
  std::uint64_t all = 0;
  for (const std::uint64_t word : words) all ^= word;
  return all == 0;
}

template <class F>
void for_each_node(HybridMesh& mesh, const F& f) {
  const auto visit = [&f](auto& cells) {
    for (auto& nodes : cells)
      for (NodeId& node : nodes) f(node);
  };
  visit(mesh.prisms);
  visit(mesh.pyramids);
  visit(mesh.hexahedra);
  visit(mesh.tetrahedra);
  for (BoundaryTriangle& face : mesh.boundary_triangles)
    for (NodeId& node : face.nodes) f(node);
  for (BoundaryQuad& face : mesh.boundary_quads)
    for (NodeId& node : face.nodes) f(node);
}

}  // namespace

Point OpenFaces::first_location(const HybridMesh& mesh) const {
  Vec3 sum;
  const auto nodes = triangles.empty() ? std::span<const NodeId>(quads.front().nodes) : std::span<const NodeId>(triangles.front().nodes);
  for (const NodeId node : nodes) sum += mesh.points[node];
  return sum / static_cast<double>(nodes.size());
}

OpenFaces find_open_faces(const HybridMesh& mesh, const RunContext& context) {
  OpenFaces open;
  const check_parts::CellNumbers cells(mesh);
  const FaceSlots slots(mesh, cells, check_parts::find_open_sides(mesh.layers, context));
  if (is_paired(slots, context)) return open;
  const check_parts::FaceMatch match =
      check_parts::match_faces(slots, mesh.points.size(), static_cast<std::uint64_t>(CheckOptions().faces_at_a_time), {}, false, GateTable(), context);
  std::vector<std::uint32_t> found;
  for (const check_parts::FaceIssue& issue : match.issues)
    if (issue.violation == Violation::unmatched_face) found.push_back(issue.slot);
  std::sort(found.begin(), found.end());
  for (const std::uint32_t slot : found) {
    const Face face = slots.face(slot);
    if (face.size == 3) open.triangles.push_back({{face.nodes[0], face.nodes[1], face.nodes[2]}, PatchId{}});
    else open.quads.push_back({face.nodes, PatchId{}});
  }
  return open;
}

PatchId add_boundary(HybridMesh& mesh, const OpenFaces& faces, std::string_view name) {
  std::string free(name);
  const auto is_taken = [&] { return std::any_of(mesh.patches.begin(), mesh.patches.end(), [&](const Patch& patch) { return patch.name == free; }); };
  for (int i = 2; is_taken(); ++i) free = std::string(name) + "_" + std::to_string(i);
  const PatchId patch = mesh.patches.push_back({.name = free, .kind = PatchKind::wall});
  for (const BoundaryTriangle& face : faces.triangles) mesh.boundary_triangles.push_back({face.nodes, patch});
  for (const BoundaryQuad& face : faces.quads) mesh.boundary_quads.push_back({face.nodes, patch});
  return patch;
}

std::uint64_t count_unused_points(const HybridMesh& mesh) {
  std::vector<bool> is_used(mesh.points.size(), false);
  for_each_cell(mesh, [&](const Cell& cell) {
    for (const NodeId node : cell.span()) is_used[node.index()] = true;
  });
  const auto visit = [&](const auto& faces) {
    for (const auto& face : faces)
      for (const NodeId node : face.nodes) is_used[node.index()] = true;
  };
  visit(mesh.boundary_triangles);
  visit(mesh.boundary_quads);
  return static_cast<std::uint64_t>(std::count(is_used.begin(), is_used.end(), false));
}

void drop_unused_points(HybridMesh& mesh) {
  std::vector<NodeId> old2new(mesh.points.size());
  for_each_node(mesh, [&](NodeId node) { old2new[node.index()] = node; });
  Column<NodeId, Point> points;
  for (const NodeId node : mesh.points.ids())
    if (old2new[node.index()].is_valid()) old2new[node.index()] = points.push_back(mesh.points[node]);
  for_each_node(mesh, [&](NodeId& node) { node = old2new[node.index()]; });
  mesh.points = std::move(points);
}

}  // namespace sterna
