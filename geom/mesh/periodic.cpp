// Partners of nodes are searched along the axis in which a side is widest, within a window of the tolerance. Faces are matched by the partners of their nodes.
#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/mesh/periodic.h"

namespace sterna {
namespace {

/// A face of one side, its nodes ascending; the last node of a triangle is 0xffffffff.
struct SideFace {
  std::array<std::uint32_t, 4> nodes;
  std::uint32_t number;
};

struct Side {
  std::string name;
  std::vector<std::uint32_t> nodes;  ///< ascending
  std::vector<SideFace> faces;
};

std::string metres(double value) { return in_metres(value, 3); }

class Matcher {
 public:
  Matcher(std::span<const Point> points, const Side& first, const Side& second, double tolerance)
      : points_(points), first_(first), second_(second), tolerance_(tolerance) {}

  PeriodicMatch match() {
    for (const Side* side : {&first_, &second_})
      if (side->faces.empty()) fail("patch \"" + side->name + "\" has no faces");
    match_.translation = middle(second_) - middle(first_);
    require_flat();
    match_nodes();
    match_faces();
    return std::move(match_);
  }

 private:
  [[noreturn]] void fail(std::string problem) {
    error_.code = ErrorCode::bad_argument;
    error_.attempted = "matching periodic sides \"" + first_.name + "\" and \"" + second_.name + "\"";
    error_.problem = std::move(problem);
    error_.hint = "both sides must be flat and have the same triangles, moved by one translation: mesh one side and copy it";
    throw Error(std::move(error_));
  }
  void note(const Point& location, std::string what) {
    ++error_.n_locations;
    if (error_.locations.size() < k_max_locations) error_.locations.push_back({location, std::move(what)});
  }
  Point middle(const Side& side) const {
    // Coordinates are relative to one node, so that small sides far from the origin keep their digits.
    const Point origin = points_[side.nodes.front()];
    Vec3 sum;
    for (const std::uint32_t n : side.nodes) sum += points_[n] - origin;
    return origin + sum / static_cast<double>(side.nodes.size());
  }

  void require_flat() {
    for (const Side* side : {&first_, &second_}) {
      const Point center = middle(*side);
      Vec3 normal;
      for (const SideFace& face : side->faces) {
        const Vec3 n = cross(points_[face.nodes[1]] - points_[face.nodes[0]], points_[face.nodes[2]] - points_[face.nodes[0]]);
        normal += dot(n, normal) < 0.0 ? -n : n;
      }
      normal = normalized(normal);
      double worst = 0.0;
      for (const std::uint32_t n : side->nodes) {
        const double off = std::abs(dot(points_[n] - center, normal));
        if (off > tolerance_) note(points_[n], "off the plane by " + metres(off));
        worst = std::max(worst, off);
      }
      if (error_.n_locations > 0) fail("patch \"" + side->name + "\" is not flat: " + metres(worst) + ", limit " + metres(tolerance_));
    }
  }

  void match_nodes() {
    Box box;
    for (const std::uint32_t n : second_.nodes) box.add(points_[n]);
    const Vec3 side = box.max - box.min;
    const std::size_t axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    std::vector<std::pair<double, std::uint32_t>> sorted;
    for (const std::uint32_t n : second_.nodes) sorted.emplace_back(points_[n][axis], n);
    std::sort(sorted.begin(), sorted.end());
    std::map<std::uint32_t, std::uint32_t> taken;
    for (const std::uint32_t n : first_.nodes) {
      const Point image = points_[n] + match_.translation;
      double least = std::numeric_limits<double>::infinity();
      std::uint32_t nearest = 0;
      for (auto it = std::lower_bound(sorted.begin(), sorted.end(), std::pair(image[axis] - tolerance_, std::uint32_t{0}));
           it != sorted.end() && it->first <= image[axis] + tolerance_; ++it) {
        const double d = distance(image, points_[it->second]);
        if (d >= least) continue;
        least = d;
        nearest = it->second;
      }
      if (least > tolerance_ || !taken.try_emplace(nearest, n).second) {
        note(points_[n], "no node at the image of this node");
        continue;
      }
      match_.worst = std::max(match_.worst, least);
      match_.nodes.push_back({NodeId(n), NodeId(nearest)});
      partner_[n] = nearest;
    }
    for (const std::uint32_t n : second_.nodes)
      if (!taken.contains(n)) note(points_[n], "this node is not the image of a node");
    if (error_.n_locations > 0) fail(std::to_string(error_.n_locations) + " nodes have no partner within " + metres(tolerance_));
  }

  void match_faces() {
    std::map<std::array<std::uint32_t, 4>, std::uint32_t> others;
    for (const SideFace& face : second_.faces) others[face.nodes] = face.number;
    for (const SideFace& face : first_.faces) {
      std::array<std::uint32_t, 4> image = face.nodes;
      for (std::uint32_t& n : image)
        if (n != 0xffffffffu) n = partner_.at(n);
      std::sort(image.begin(), image.end());
      const auto other = others.find(image);
      if (other != others.end()) match_.faces.push_back({face.number, other->second});
      else note((points_[face.nodes[0]] + points_[face.nodes[1]] + points_[face.nodes[2]]) / 3.0, "no face at the image of this face");
    }
    if (error_.n_locations > 0) fail(std::to_string(error_.n_locations) + " faces have no partner");
    if (first_.faces.size() != second_.faces.size())
      fail(std::to_string(first_.faces.size()) + " faces on one side, " + std::to_string(second_.faces.size()) + " on the other");
  }

  std::span<const Point> points_;
  const Side& first_;
  const Side& second_;
  double tolerance_;
  PeriodicMatch match_;
  std::map<std::uint32_t, std::uint32_t> partner_;
  ErrorInfo error_;
};

template <class Nodes>
void add_face(const Nodes& nodes, std::uint32_t number, Side& side) {
  SideFace face{{0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu}, number};
  std::size_t k = 0;
  for (const auto n : nodes) {
    face.nodes[k++] = n.value();
    side.nodes.push_back(n.value());
  }
  std::sort(face.nodes.begin(), face.nodes.end());
  side.faces.push_back(face);
}

void finish(Side& side) {
  std::sort(side.nodes.begin(), side.nodes.end());
  side.nodes.erase(std::unique(side.nodes.begin(), side.nodes.end()), side.nodes.end());
}

}  // namespace

double periodic_tolerance(const HybridMesh& mesh) {
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  return k_periodic_share * box.longest_side();
}

PeriodicMatch match_periodic(const HybridMesh& mesh, PatchId first, PatchId second, double tolerance) {
  std::array<Side, 2> sides;
  const std::array<PatchId, 2> patches = {first, second};
  const auto n_triangles = static_cast<std::uint32_t>(mesh.boundary_triangles.size());
  for (std::size_t i = 0; i < 2; ++i) {
    sides[i].name = mesh.patches[patches[i]].name;
    for (std::uint32_t t = 0; t < n_triangles; ++t)
      if (mesh.boundary_triangles[t].patch == patches[i]) add_face(mesh.boundary_triangles[t].nodes, t, sides[i]);
    for (std::uint32_t q = 0; q < mesh.boundary_quads.size(); ++q)
      if (mesh.boundary_quads[q].patch == patches[i]) add_face(mesh.boundary_quads[q].nodes, n_triangles + q, sides[i]);
    finish(sides[i]);
  }
  return Matcher(mesh.points.raw(), sides[0], sides[1], tolerance).match();
}

PeriodicMatch match_periodic(const TriMesh& surface, PatchId first, PatchId second, double tolerance) {
  std::array<Side, 2> sides;
  const std::array<PatchId, 2> patches = {first, second};
  for (std::size_t i = 0; i < 2; ++i) {
    sides[i].name = surface.patches[patches[i]].name;
    for (const TriangleId t : surface.triangles.ids())
      if (surface.triangle_patch[t] == patches[i]) add_face(surface.triangles[t], t.value(), sides[i]);
    finish(sides[i]);
  }
  return Matcher(surface.points.raw(), sides[0], sides[1], tolerance).match();
}

}  // namespace sterna
