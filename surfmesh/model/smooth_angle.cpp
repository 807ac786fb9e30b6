// Each face measures its inner edges and lists those of its border with the exact normals at their ends; lists are sorted together, and edges of two triangles
// whose normals agree on both sides are measured, too.
#include "surfmesh/model/smooth_angle.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

/// Faces that join at less than this have no crease: CAD systems take faces for tangent within about a degree, fitted surfaces miss it by a few.
constexpr double k_tangent = 5.0 * std::numbers::pi / 180.0;

struct LocalEdge {
  std::uint32_t low, high;
  std::uint32_t triangle;  ///< of the face
  auto operator<=>(const LocalEdge&) const = default;
};

/// An edge that only one triangle of its face has; vertices by their numbers in all faces.
struct BorderEdge {
  std::uint32_t low = 0, high = 0;
  FaceId face;
  std::uint32_t triangle = 0;
  std::array<Vec3, 2> exact;  ///< outward normals of the surface at low and high; zero where it has none
  Vec3 normal;                ///< of the triangle
  Point middle;
  bool before(const BorderEdge& other) const {
    return std::array{low, high, face.value(), triangle} < std::array{other.low, other.high, other.face.value(), other.triangle};
  }
};

struct FaceAngles {
  SmoothAngle inner;
  std::vector<BorderEdge> border;
};

void keep_larger(SmoothAngle& best, double angle, const Point& place) {
  if (angle > best.angle) best = {angle, place};
}

FaceAngles measure_face(const ModelFace& model_face, FaceId f, const MeshedFace& face) {
  const FaceMesh& mesh = face.mesh;
  FaceAngles result;
  std::vector<LocalEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k].value(), b = mesh.triangles[t][(k + 1) % 3].value();
      edges.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(edges.begin(), edges.end());
  const double side = model_face.is_reversed ? -1.0 : 1.0;
  const auto normal = [&](std::uint32_t t) {
    const TriangleVertices& v = mesh.triangles[t];
    const Point& a = mesh.points[v[0].index()];
    return side * cross(mesh.points[v[1].index()] - a, mesh.points[v[2].index()] - a);
  };
  const auto exact_normal = [&](std::uint32_t v) {
    const SurfaceDerivatives d = model_face.surface->derivatives(mesh.uv[v]);
    return side * cross(d.du, d.dv);
  };
  for (std::size_t i = 0; i < edges.size();) {
    const LocalEdge& e = edges[i];
    if (i + 1 < edges.size() && edges[i + 1].low == e.low && edges[i + 1].high == e.high) {
      keep_larger(result.inner, angle_between(normal(e.triangle), normal(edges[i + 1].triangle)), 0.5 * (mesh.points[e.low] + mesh.points[e.high]));
      i += 2;
      continue;
    }
    ++i;
    if (e.high >= mesh.n_border) continue;  // of a triangle that stands for a point of a pole
    BorderEdge edge{.face = f,
                    .triangle = e.triangle,
                    .exact = {exact_normal(e.low), exact_normal(e.high)},
                    .normal = normal(e.triangle),
                    .middle = 0.5 * (mesh.points[e.low] + mesh.points[e.high])};
    edge.low = face.border_ids[e.low].value();
    edge.high = face.border_ids[e.high].value();
    if (edge.low > edge.high) {
      std::swap(edge.low, edge.high);
      std::swap(edge.exact[0], edge.exact[1]);
    }
    result.border.push_back(edge);
  }
  return result;
}

bool is_tangent(const BorderEdge& a, const BorderEdge& b) {
  for (std::size_t k = 0; k < 2; ++k)
    if (norm(a.exact[k]) > 0.0 && norm(b.exact[k]) > 0.0 && angle_between(a.exact[k], b.exact[k]) > k_tangent) return false;
  return true;
}

}  // namespace

SmoothAngle measure_smooth_angle(const Model& model, const Column<FaceId, MeshedFace>& faces, const RunContext& context) {
  Column<FaceId, FaceAngles> angles(faces.size());
  parallel_for(
      context, faces.size(),
      [&](std::size_t i) {
        const FaceId f(static_cast<std::uint64_t>(i));
        if (!faces[f].failure) angles[f] = measure_face(model.faces[f], f, faces[f]);
      },
      1);
  SmoothAngle best;
  std::vector<BorderEdge> border;
  for (const FaceAngles& face : angles) {
    keep_larger(best, face.inner.angle, face.inner.place);
    border.insert(border.end(), face.border.begin(), face.border.end());
  }
  std::sort(border.begin(), border.end(), [](const BorderEdge& a, const BorderEdge& b) { return a.before(b); });
  for (std::size_t i = 0; i + 1 < border.size(); ++i) {
    const BorderEdge &a = border[i], &b = border[i + 1];
    if (a.low != b.low || a.high != b.high || !is_tangent(a, b)) continue;
    keep_larger(best, angle_between(a.normal, b.normal), a.middle);
  }
  return best;
}

}  // namespace sterna::surfmesh
