// sterna-tet-tetgen: one call of TetGen in a process of its own. Reads the request from file descriptor 3, writes the reply to 4 (wire.h).
//
// Why a process: TetGen's licence (AGPL), its crashes on input it does not like, its memory, and symbols that it shares with libgmsh.
// What it prints goes to the parent through stdout and stderr. It never outlives its parent.
//
// What is known of TetGen 1.5.0 as Debian builds it (all measured):
// - Its vertices must be farther apart than -T (default 1e-8) of the longest side of the box, which the farfield makes long; closer ones are merged, and
//   then it crashes. -M stops the merging: slabs of 1e-12 and wedges of 1e-8 radians in a box of 100 pass with it and crash without.
// - With -Y the boundary stays as it is, triangle for triangle, on everything tried so far; verify_tetrahedra() watches over it.
// - Self-intersecting, duplicate or degenerate facets make it crash, or answer with facets missing; it rarely reports them.
// - An open boundary gives 0 tetrahedra and no error; an index out of range is read as it is.
// - Points that it adds and removes again during boundary recovery are left out of the answer, but not with -J (pygeo_bwb).
// - A tetunsuitable callback is asked for every tetrahedron, and obeyed; its volume argument is nothing.
// - Its tetrahedra are positive in CGNS order; two runs are identical to the bit.

#include <array>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <tetgen.h>
#include <vector>

#include "volmesh/tetra/helper_side.h"
#include "volmesh/tetra/size_field_view.h"

namespace {

using namespace sterna::volmesh;
using helper::Request;

/// Facets of one triangle each, made in bulk; the vertex lists point into the request.
struct Facets {
  explicit Facets(const Request& request)
      : polygons(request.header->n_triangles), facets(request.header->n_triangles), markers(request.header->n_triangles) {
    for (std::size_t t = 0; t < facets.size(); ++t) {
      polygons[t] = {request.triangles + 3 * t, 3};
      facets[t] = {&polygons[t], 1, nullptr, 0};
      markers[t] = static_cast<int>(t) + 1;  // 1-based boundary triangle: TetGen's messages name it
    }
  }
  std::vector<tetgenio::polygon> polygons;
  std::vector<tetgenio::facet> facets;
  std::vector<int> markers;
};

/// The input borrows all its arrays; they must be gone before tetgenio's destructor would delete them.
struct BorrowedInput {
  BorrowedInput(const Request& request, Facets& facets) {
    io.firstnumber = 0;
    io.pointlist = request.points;
    io.numberofpoints = static_cast<int>(request.header->n_points);
    io.holelist = request.header->n_holes > 0 ? request.holes : nullptr;
    io.numberofholes = static_cast<int>(request.header->n_holes);
    io.facetlist = facets.facets.data();
    io.facetmarkerlist = facets.markers.data();
    io.numberoffacets = static_cast<int>(facets.facets.size());
  }
  ~BorrowedInput() { io.initialize(); }
  tetgenio io;
};

/// A tetrahedron is split when its circumradius over the wanted edge length exceeds this: then the geometric mean of the edges is the wanted length (measured in a field
/// of constant size). A regular tetrahedron of that length has 0.61.
constexpr double k_radius_limit = 1.1 / 1.46;

/// What TetGen's callback, which gets no data of ours, needs; set once, before TetGen runs.
struct SizeTest {
  SizeFieldView sizes;
  double scale = 1.0;
};
SizeTest& size_test() {
  static SizeTest test;
  return test;
}

double circumradius(const double* a, const double* b, const double* c, const double* d) {
  std::array<double, 3> u, v, w;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
    w[k] = d[k] - a[k];
  }
  const auto cross = [](const auto& x, const auto& y) { return std::array{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]}; };
  const auto dot = [](const auto& x, const auto& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
  const auto vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  std::array<double, 3> sum;
  for (std::size_t k = 0; k < 3; ++k) sum[k] = uu * vw[k] + vv * wu[k] + ww * uv[k];
  return std::sqrt(dot(sum, sum)) / (2.0 * std::abs(dot(u, vw)));
}

/// TetGen asks for every tetrahedron that it might refine.
bool is_too_large(double* a, double* b, double* c, double* d, double*, double) {
  const SizeTest& test = size_test();
  const double s = 0.25 / test.scale;
  const double wanted = test.scale * test.sizes(s * (a[0] + b[0] + c[0] + d[0]), s * (a[1] + b[1] + c[1] + d[1]), s * (a[2] + b[2] + c[2] + d[2]));
  return circumradius(a, b, c, d) > k_radius_limit * wanted;
}

/// -p boundary, -q<ratio> quality, -Y keep the boundary, -M merge nothing, -F write no faces, -Q quiet,
/// -T tolerance below the rounding error of the box's size: never call a feature too small (error 4).
std::string switches(const wire::RequestHeader& header) {
  char text[64];
  std::snprintf(text, sizeof text, "pq%.9gYMFQT1e-16", header.radius_edge);
  return text;
}

int run(const Request& request) {
  Facets facets(request);
  BorrowedInput in(request, facets);
  if (request.size_field) {
    size_test() = {SizeFieldView(request.size_field, request.header->size_bytes), request.header->scale};
    if (!size_test().sizes.is_valid()) return helper::reply_failure(wire::Outcome::bad_request, 0, 0.0);
    in.io.tetunsuitable = is_too_large;
  }
  tetgenio out;
  std::string text = switches(*request.header);
  const helper::Stopwatch watch;
  try {
    tetrahedralize(text.data(), &in.io, &out);
  } catch (int code) {
    // 1 is TetGen's "out of memory"; see terminatetetgen() in tetgen.h.
    return helper::reply_failure(code == 1 ? wire::Outcome::out_of_memory : wire::Outcome::engine_code, code, watch.seconds());
  } catch (const std::bad_alloc&) {
    return helper::reply_failure(wire::Outcome::out_of_memory, 0, watch.seconds());
  } catch (...) {
    return helper::reply_failure(wire::Outcome::exception, 0, watch.seconds());
  }
  helper::reply_mesh(out.pointlist, static_cast<std::size_t>(out.numberofpoints), out.tetrahedronlist, static_cast<std::size_t>(out.numberoftetrahedra), watch.seconds());
}

}  // namespace

int main() {
  const Request request = helper::map_request();
  if (!request.header) return helper::reply_failure(wire::Outcome::bad_request, 0, 0.0);
  helper::limit_resources(request.header->memory_limit);
  try {
    return run(request);
  } catch (const std::bad_alloc&) {
    return helper::reply_failure(wire::Outcome::out_of_memory, 0, 0.0);
  }
}
