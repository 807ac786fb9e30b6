// sterna-tet-tetgen: one call of TetGen in a separate process. Reads the request from file descriptor 3, and writes the reply to file descriptor 4 (wire.h).
//
// A separate process is used because of TetGen's licence (AGPL), its crashes on unsuitable input, its memory, and symbols that it shares with libgmsh. Its
// output goes to the parent process through stdout and stderr. The process never outlives its parent.
//
// Known properties of TetGen 1.5.0 as built by Debian (all measured):
// - The distance of its vertices must be more than -T (default 1e-8) of the longest side of the box, which the farfield makes long. Nearer vertices are merged,
//   and TetGen then crashes. -M disables the merging. Slabs of 1e-12 and wedges of 1e-8 radians in a box of 100 are meshed with -M, and crash without it.
// - With -Y the boundary stays unchanged, triangle for triangle, in nearly all tests so far. Around slivers and folds, some of the points that it temporarily
//   inserts on edges may stay there (asb_talon: one point, which splits two of 31 000 triangles). Without -F the faces of the result show the locations.
// - Self-intersecting, duplicate or degenerate facets make it crash or return a result without some facets. It rarely reports such facets.
// - An open boundary gives 0 tetrahedra and no error. An index out of range is read without a check.
// - Points that it adds and removes again during boundary recovery are not in the result, but with -J they are (pygeo_bwb).
// - A tetunsuitable callback is called for every tetrahedron, and its result is used. Its volume argument has no meaning.
// - Without -Y it splits boundary triangles, and each face of the result has the marker of its source facet. Even without -q it splits thousands of triangles
//   on an envelope of bodies, because edges must then be Delaunay (pygeo_bwb: 2671 of 4964 triangles; with -q1.2 all of them, into 24 parts each). With -Y,
//   points in the volume ensure that edges are Delaunay.
// - With -q and -Y it does not terminate next to strips of triangles that are 2000 times longer than wide. The cavity of every new point contains thousands of
//   points, and the point is rejected because it encroaches upon the boundary (NACA0012).
// - Its tetrahedra are positive in CGNS order. Two runs are bit-identical.

#include <tetgen.h>
#include <array>
#include <cmath>
#include <cstdio>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "volmesh/tetra/helper_side.h"

namespace {

using namespace sterna::volmesh;
using helper::Request;

/// A closed surface in the request, or in a result of TetGen.
struct Surface {
  double* points = nullptr;
  std::size_t n_points = 0;
  int* triangles = nullptr;
  std::size_t n_triangles = 0;
};

/// Facets of one triangle each, made in bulk. The vertex lists point into the surface.
struct Facets {
  explicit Facets(const Surface& surface) : polygons(surface.n_triangles), facets(surface.n_triangles), markers(surface.n_triangles) {
    for (std::size_t t = 0; t < facets.size(); ++t) {
      polygons[t] = {surface.triangles + 3 * t, 3};
      facets[t] = {&polygons[t], 1, nullptr, 0};
      markers[t] = static_cast<int>(t) + 1;  // number of the boundary triangle, counted from 1, which TetGen uses in its messages
    }
  }
  std::vector<tetgenio::polygon> polygons;
  std::vector<tetgenio::facet> facets;
  std::vector<int> markers;
};

/// All arrays of the input are borrowed. The pointers must be reset before the destructor of tetgenio would delete the arrays.
struct BorrowedInput {
  BorrowedInput(const Request& request, const Surface& surface, Facets& facets) {
    io.firstnumber = 0;
    io.pointlist = surface.points;
    io.numberofpoints = static_cast<int>(surface.n_points);
    io.holelist = request.header->n_holes > 0 ? request.holes : nullptr;
    io.numberofholes = static_cast<int>(request.header->n_holes);
    io.facetlist = facets.facets.data();
    io.facetmarkerlist = facets.markers.data();
    io.numberoffacets = static_cast<int>(facets.facets.size());
  }
  ~BorrowedInput() { io.initialize(); }
  tetgenio io;
};

/// A tetrahedron is split if the ratio of its circumradius to the target edge length exceeds this value. The geometric mean of the edges is then the target
/// length (measured in a field of constant size). For a regular tetrahedron of that length the ratio is 0.61.
constexpr double k_radius_limit = 1.1 / 1.46;

/// Data for TetGen's callback, which has no user argument. It is set once, before TetGen runs.
helper::LateSizes*& sizes_of_callback() {
  static helper::LateSizes* sizes = nullptr;
  return sizes;
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

/// Callback of TetGen for every tetrahedron that it might refine.
bool is_too_large(double* a, double* b, double* c, double* d, double*, double) {
  const auto middle = [&](std::size_t k) { return 0.25 * (a[k] + b[k] + c[k] + d[k]); };
  const double target = (*sizes_of_callback())(middle(0), middle(1), middle(2));
  return circumradius(a, b, c, d) > k_radius_limit * target;
}

/// Switches: -p boundary, -q<ratio> quality, -Y keep the boundary, -M merge nothing (every edge of the boundary stays a single edge), -F write no faces, -Q
/// quiet, -T tolerance. The tolerance is below the rounding error of the box's size, so that TetGen never reports a feature as too small (error 4).
std::string switches(const char* format, double radius_edge) {
  char text[64];
  std::snprintf(text, sizeof text, format, radius_edge);
  return text;
}
constexpr const char* k_keep_boundary = "pq%.9gYMFQT1e-16";
constexpr const char* k_report_boundary = "pq%.9gYMQT1e-16";
constexpr const char* k_recover_only = "pYMFQT1e-16";
constexpr const char* k_split_for_quality = "pq%.9gMQT1e-16";
constexpr const char* k_split_to_recover = "pMQT1e-16";

/// The new boundary in a result with faces.
struct SplitSurface {
  /// Points in the volume are left out if `is_boundary_only` is set.
  SplitSurface(const tetgenio& out, std::size_t n_kept, bool is_boundary_only)
      : triangles(out.trifacelist, out.trifacelist + 3 * static_cast<std::size_t>(out.numberoftrifaces)) {
    const auto n_points = static_cast<std::size_t>(out.numberofpoints);
    parents.reserve(triangles.size() / 3);
    for (std::size_t t = 0; t < triangles.size() / 3; ++t) parents.push_back(out.trifacemarkerlist[t] - 1);
    if (!is_boundary_only) return;
    std::vector<int> old2new(n_points, -1);
    for (std::size_t i = 0; i < n_kept; ++i) old2new[i] = static_cast<int>(i);
    for (const int v : triangles) old2new[static_cast<std::size_t>(v)] = 0;
    int n = 0;
    for (std::size_t i = 0; i < n_points; ++i) {
      if (old2new[i] < 0) continue;
      old2new[i] = n++;
      points.insert(points.end(), out.pointlist + 3 * i, out.pointlist + 3 * i + 3);
    }
    for (int& v : triangles) v = old2new[static_cast<std::size_t>(v)];
  }
  Surface surface() { return {points.data(), points.size() / 3, triangles.data(), triangles.size() / 3}; }
  helper::SplitBoundary reply() const { return {triangles.data(), parents.data(), parents.size()}; }
  std::vector<double> points;
  std::vector<int> triangles;
  std::vector<int> parents;
};

void tetrahedralize_surface(const Request& request, const Surface& surface, std::string text, tetgenio& out) {
  Facets facets(surface);
  BorrowedInput in(request, surface, facets);
  if (request.header->has_size_field && !request.header->is_recovery_only) in.io.tetunsuitable = is_too_large;
  tetrahedralize(text.data(), &in.io, &out);
}

/// Runs TetGen once or twice, and replies. With splits for recovery, the first run splits the boundary where necessary, and the second run keeps the split
/// boundary.
[[noreturn]] void mesh(const Request& request, const helper::Stopwatch& watch) {
  const Surface whole{request.points, request.header->n_points, request.triangles, request.header->n_triangles};
  const double radius_edge = request.header->radius_edge;
  tetgenio out;
  std::optional<SplitSurface> split;
  switch (request.header->splits) {
    case wire::Splits::none:
      tetrahedralize_surface(request, whole, request.header->is_recovery_only ? k_recover_only : switches(k_keep_boundary, radius_edge), out);
      break;
    case wire::Splits::leftovers:
      tetrahedralize_surface(request, whole, switches(k_report_boundary, radius_edge), out);
      if (static_cast<std::size_t>(out.numberoftrifaces) != whole.n_triangles) split.emplace(out, whole.n_points, false);
      break;
    case wire::Splits::quality:
      tetrahedralize_surface(request, whole, switches(k_split_for_quality, radius_edge), out);
      split.emplace(out, whole.n_points, false);
      break;
    case wire::Splits::recovery: {
      tetgenio first;
      tetrahedralize_surface(request, whole, k_split_to_recover, first);
      split.emplace(first, whole.n_points, true);
      tetrahedralize_surface(request, split->surface(), switches(k_keep_boundary, radius_edge), out);
      break;
    }
  }
  helper::reply_mesh(out.pointlist, static_cast<std::size_t>(out.numberofpoints), out.tetrahedronlist, static_cast<std::size_t>(out.numberoftetrahedra),
                     watch.seconds() - sizes_of_callback()->waited_seconds(), split ? split->reply() : helper::SplitBoundary{});
}

int run(const Request& request) {
  helper::LateSizes sizes(*request.header);
  sizes_of_callback() = &sizes;
  const helper::Stopwatch watch;
  try {
    mesh(request, watch);
  } catch (int code) {
    // Code 1 is TetGen's "out of memory" (see terminatetetgen() in tetgen.h).
    return helper::reply_failure(code == 1 ? wire::Outcome::out_of_memory : wire::Outcome::engine_code, code, watch.seconds());
  } catch (const std::bad_alloc&) {
    return helper::reply_failure(wire::Outcome::out_of_memory, 0, watch.seconds());
  } catch (...) {
    return helper::reply_failure(wire::Outcome::exception, 0, watch.seconds());
  }
}

}  // namespace

int main() {
  const Request request = helper::map_request();
  if (!request.header) return helper::reply_failure(wire::Outcome::bad_request, 0, 0.0);
  helper::limit_resources(*request.header);
  try {
    return run(request);
  } catch (const std::bad_alloc&) {
    return helper::reply_failure(wire::Outcome::out_of_memory, 0, 0.0);
  }
}
