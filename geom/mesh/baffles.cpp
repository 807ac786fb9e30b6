#include "geom/mesh/baffles.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace sterna {
namespace {

/// A face with the locations of its corners, ascending; the last entry of a triangle is k_no_side.
struct Candidate {
  std::array<std::uint32_t, 4> locations;
  std::uint32_t face;
  bool operator<(const Candidate& b) const { return locations != b.locations ? locations < b.locations : face < b.face; }
};

class Finder {
 public:
  /// Finds the coincident faces. \p nodes_of: face -> up to four node numbers. \p faces: candidate faces, ascending.
  template <class NodesOf>
  BaffleSides find(std::span<const Point> points, std::size_t n_faces, const std::vector<std::uint32_t>& faces, const NodesOf& nodes_of) {
    number_locations(points, faces, nodes_of);
    std::vector<Candidate> candidates;
    for (const std::uint32_t face : faces) {
      Candidate c{{k_no_side, k_no_side, k_no_side, k_no_side}, face};
      const auto nodes = nodes_of(face);
      for (std::size_t k = 0; k < nodes.size(); ++k) c.locations[k] = location_of(nodes[k]);
      std::ranges::sort(c.locations);
      candidates.push_back(c);
    }
    std::sort(candidates.begin(), candidates.end());
    BaffleSides sides;
    for (std::size_t i = 0; i + 1 < candidates.size(); ++i) {
      const Candidate &a = candidates[i], &b = candidates[i + 1];
      if (a.locations != b.locations || !is_turned(nodes_of(a.face), nodes_of(b.face))) continue;
      if (sides.empty()) {
        sides.other_side.assign(n_faces, k_no_side);
        sides.twin.resize(points.size());
        std::iota(sides.twin.begin(), sides.twin.end(), 0u);
      }
      sides.other_side[a.face] = b.face;
      sides.other_side[b.face] = a.face;
      for (const std::uint32_t first : nodes_of(a.face))
        for (const std::uint32_t second : nodes_of(b.face))
          if (location_of(first) == location_of(second)) sides.twin[std::max(first, second)] = std::min(first, second);
      ++i;
    }
    return sides;
  }

 private:
  template <class NodesOf>
  void number_locations(std::span<const Point> points, const std::vector<std::uint32_t>& faces, const NodesOf& nodes_of) {
    for (const std::uint32_t face : faces)
      for (const std::uint32_t node : nodes_of(face)) nodes_.push_back(node);
    std::ranges::sort(nodes_);
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    std::vector<std::uint32_t> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
      const Point& p = points[nodes_[i]];
      return std::array{p.x + 0.0, p.y + 0.0, p.z + 0.0};  // + 0.0: -0 and 0 are the same location
    };
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    locations_.resize(nodes_.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      locations_[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? locations_[order[i - 1]] : nodes_[order[i]];
  }
  std::uint32_t location_of(std::uint32_t node) const { return locations_[static_cast<std::size_t>(std::ranges::lower_bound(nodes_, node) - nodes_.begin())]; }
  /// Returns true if b passes through the same locations in the opposite sense.
  template <class Nodes>
  bool is_turned(const Nodes& a, const Nodes& b) const {
    const std::size_t n = a.size();
    if (b.size() != n) return false;
    for (std::size_t start = 0; start < n; ++start) {
      bool is_same = true;
      for (std::size_t k = 0; k < n; ++k) is_same &= location_of(a[k]) == location_of(b[(start + n - k) % n]);
      if (is_same) return true;
    }
    return false;
  }

  std::vector<std::uint32_t> nodes_;      ///< nodes of the faces, ascending
  std::vector<std::uint32_t> locations_;  ///< for each node: the lowest node at the same location
};

/// Up to four numbers.
struct FaceNodes {
  std::array<std::uint32_t, 4> value{};
  std::uint32_t n = 3;
  std::size_t size() const { return n; }
  std::uint32_t operator[](std::size_t k) const { return value[k]; }
  const std::uint32_t* begin() const { return value.data(); }
  const std::uint32_t* end() const { return value.data() + n; }
};

}  // namespace

BaffleSides find_baffle_sides(const HybridMesh& mesh) {
  const auto is_interface = [&](PatchId patch) { return patch.index() < mesh.patches.size() && mesh.patches[patch].kind == PatchKind::interface; };
  if (std::ranges::none_of(mesh.patches, [](const Patch& patch) { return patch.kind == PatchKind::interface; })) return {};
  const std::size_t n_triangles = mesh.boundary_triangles.size(), n_faces = n_triangles + mesh.boundary_quads.size();
  std::vector<std::uint32_t> faces;
  for (std::size_t i = 0; i < n_faces; ++i)
    if (is_interface(i < n_triangles ? mesh.boundary_triangles[i].patch : mesh.boundary_quads[i - n_triangles].patch))
      faces.push_back(static_cast<std::uint32_t>(i));
  return Finder().find(mesh.points.raw(), n_faces, faces, [&](std::uint32_t face) {
    FaceNodes nodes;
    if (face < n_triangles) {
      for (std::size_t k = 0; k < 3; ++k) nodes.value[k] = mesh.boundary_triangles[face].nodes[k].value();
    } else {
      nodes.n = 4;
      for (std::size_t k = 0; k < 4; ++k) nodes.value[k] = mesh.boundary_quads[face - n_triangles].nodes[k].value();
    }
    return nodes;
  });
}

BaffleSides find_baffle_sides(const TriMesh& mesh) {
  std::vector<std::uint32_t> faces;
  for (const TriangleId t : mesh.triangles.ids())
    if (mesh.patches[mesh.triangle_patch[t]].kind == PatchKind::interface) faces.push_back(t.value());
  if (faces.empty()) return {};
  return Finder().find(mesh.points.raw(), mesh.n_triangles(), faces, [&](std::uint32_t face) {
    FaceNodes nodes;
    for (std::size_t k = 0; k < 3; ++k) nodes.value[k] = mesh.triangles[TriangleId(face)][k].value();
    return nodes;
  });
}

}  // namespace sterna
