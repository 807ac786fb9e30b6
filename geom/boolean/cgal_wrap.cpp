#include "geom/boolean/cgal_wrap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/exceptions.h>

#include <string>

#include "geom/base/error.h"

namespace sterna {
namespace {

using WrapKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using WrapPoint = WrapKernel::Point_3;
using WrapMesh = CGAL::Surface_mesh<WrapPoint>;

/// Number of points between two progress updates.
constexpr std::int64_t k_points_per_step = 64;

/// Counts the inserted points, to report progress, check for a stop and enforce the limit.
struct PointCounter : CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
  const AlphaWrapInput* input = nullptr;
  const RunContext* context = nullptr;
  std::int64_t n = 0;

  template <class Wrapper, class VertexHandle>
  void after_Steiner_point_insertion(const Wrapper&, VertexHandle) {
    ++n;
    if (input->max_points > 0 && n > input->max_points)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "wrapping",
                   .problem = "the wrap has more than " + std::to_string(input->max_points) + " points",
                   .hint = "a larger edge"});
    if (n % k_points_per_step != 0) return;
    const double expected = static_cast<double>(std::max<std::int64_t>(input->expected_points, 1));
    context->progress(static_cast<double>(n) / (static_cast<double>(n) + 0.2 * expected));
  }
};

}  // namespace

WrapSurface alpha_wrap(const AlphaWrapInput& input, const RunContext& context) {
  std::vector<WrapPoint> points;
  points.reserve(input.points.size());
  for (const Vec3& p : input.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<WrapPoint> seeds;
  for (const Vec3& p : input.seeds) seeds.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  triangles.reserve(input.triangles.size());
  for (const auto& t : input.triangles)
    if (!CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) triangles.push_back({t[0], t[1], t[2]});
  WrapSurface wrap;
  if (triangles.empty()) return wrap;

  PointCounter counter;
  counter.input = &input;
  counter.context = &context;
  WrapMesh mesh;
  try {
    const auto in = CGAL::parameters::default_values();
    if (seeds.empty()) CGAL::alpha_wrap_3(points, triangles, input.alpha, input.offset, mesh, in, CGAL::parameters::visitor(std::ref(counter)));
    else CGAL::alpha_wrap_3(points, triangles, input.alpha, input.offset, mesh, in, CGAL::parameters::visitor(std::ref(counter)).seed_points(std::ref(seeds)));
  } catch (const CGAL::Failure_exception& failure) {
    throw Error({.code = ErrorCode::geometry_failed, .attempted = "wrapping", .problem = "CGAL failed (" + failure.expression() + ")"});
  }
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices(), 0);
  for (const auto v : mesh.vertices()) {
    number[v] = static_cast<std::uint32_t>(wrap.points.size());
    const WrapPoint& p = mesh.point(v);
    wrap.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    auto& triangle = wrap.triangles.emplace_back();
    std::size_t corner = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) triangle[corner++] = number[v];
  }
  return wrap;
}

}  // namespace sterna
