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
// - Its tetrahedra are positive in CGNS order; two runs are identical to the bit.

#include <cstdio>
#include <new>
#include <string>
#include <tetgen.h>
#include <vector>

#include "volmesh/tetra/helper_side.h"

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
