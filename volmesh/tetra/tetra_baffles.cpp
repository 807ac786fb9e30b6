// Separation of both sides: at a point with two sides, the corners of tetrahedra are joined across faces that do not belong to the sheet. Each joined set lies
// on one side, and a face of the sheet identifies the side.

#include "volmesh/tetra/tetra_baffles.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"

namespace sterna::volmesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::uint32_t k_no_node = 0xffffffffu;

[[noreturn]] void throw_bad(std::string problem, std::vector<ErrorLocation> locations, std::string hint = {}) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "joining the two sides of baffles in the boundary of the tetrahedra",
               .problem = std::move(problem),
               .locations = std::move(locations),
               .hint = std::move(hint)});
}

/// Corners in ascending order, and the parity of the permutation that sorts them.
struct SortedFace {
  Triangle corners;
  bool is_odd = false;
  explicit SortedFace(const Triangle& t) : corners(t) {
    const auto order = [&](std::size_t i, std::size_t j) {
      if (corners[i] <= corners[j]) return;
      std::swap(corners[i], corners[j]);
      is_odd = !is_odd;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
  }
};

/// Returns a number for the location of each point, in the order of the first points at the locations.
std::vector<std::uint32_t> number_locations(const TetraBoundary& boundary, JoinedBoundary& joined) {
  std::vector<std::uint32_t> order(boundary.points.size()), location(boundary.points.size(), k_no_node), first(boundary.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    const Vec3& p = boundary.points[v];
    return std::array{p.x + 0.0, p.y + 0.0, p.z + 0.0};  // adding 0.0 converts -0 to 0, which is the same location
  };
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_twin = i > 0 && key(order[i - 1]) == key(order[i]);
    first[order[i]] = is_twin ? first[order[i - 1]] : order[i];
    if (is_twin && i > 1 && key(order[i - 2]) == key(order[i]))
      throw_bad("three points at one location", {{boundary.points[order[i]], "point " + std::to_string(order[i])}}, "baffles must not meet each other");
  }
  for (std::uint32_t v = 0; v < location.size(); ++v) {
    if (first[v] == v) {
      location[v] = static_cast<std::uint32_t>(joined.points.size());
      joined.points.push_back(boundary.points[v]);
      joined.sources.push_back({v, v});
    } else {
      location[v] = location[first[v]];
      joined.sources[location[v]][1] = v;  // the side is determined later from the sheets
    }
  }
  return location;
}

}  // namespace

JoinedBoundary join_baffles(const TetraBoundary& boundary, const RunContext& context) {
  for (const Triangle& t : boundary.triangles)
    for (const std::uint32_t v : t)
      if (v >= boundary.points.size()) throw_bad("a triangle has point " + std::to_string(v) + " of " + std::to_string(boundary.points.size()), {});
  JoinedBoundary joined;
  const std::vector<std::uint32_t> location = number_locations(boundary, joined);
  context.check_stop();

  // Only triangles whose corners each have a twin or are border vertices of the sheet can lie back to back.
  struct Candidate {
    SortedFace face;
    std::uint32_t triangle;
  };
  std::vector<Candidate> candidates;
  const auto has_twin = [&](std::uint32_t v) { return joined.sources[location[v]][0] != joined.sources[location[v]][1]; };
  const auto joined_corners = [&](std::size_t t) {
    const Triangle& v = boundary.triangles[t];
    return Triangle{location[v[0]], location[v[1]], location[v[2]]};
  };
  for (std::uint32_t t = 0; t < boundary.triangles.size(); ++t)
    if (std::ranges::any_of(boundary.triangles[t], has_twin)) candidates.push_back({SortedFace(joined_corners(t)), t});
  std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
    return a.face.corners != b.face.corners ? a.face.corners < b.face.corners : a.triangle < b.triangle;
  });
  std::vector<std::uint8_t> is_baffle(boundary.triangles.size(), 0);
  std::vector<std::array<std::uint32_t, 2>> sides;
  for (std::size_t i = 0; i + 1 < candidates.size(); ++i) {
    const Candidate &a = candidates[i], &b = candidates[i + 1];
    if (a.face.corners != b.face.corners || a.face.is_odd == b.face.is_odd) continue;
    is_baffle[a.triangle] = is_baffle[b.triangle] = 1;
    sides.push_back({a.triangle, b.triangle});
    ++i;
  }
  std::ranges::sort(sides);
  if (sides.empty()) throw_bad("no triangle lies back to back on another triangle", {});

  const auto add = [&](std::uint32_t t) {
    joined.facets.push_back(joined_corners(t));
    joined.facet2triangle.push_back(t);
  };
  for (std::uint32_t t = 0; t < boundary.triangles.size(); ++t)
    if (!is_baffle[t]) add(t);
  // The first side of a sheet is that of the patch that comes first. The same holds for the points of the side.
  std::vector<std::uint8_t> is_known(joined.points.size(), 0);
  for (const auto& [front, back] : sides) {
    add(front);
    bool has_inner_point = false;
    for (const std::uint32_t v : boundary.triangles[front]) {
      std::array<std::uint32_t, 2>& sources = joined.sources[location[v]];
      has_inner_point |= sources[0] != sources[1];
      if (sources[0] == sources[1]) continue;
      if (is_known[location[v]] && sources[0] != v)
        throw_bad("the triangles on one side of a baffle use points of both sides", {{boundary.points[v], "point " + std::to_string(v)}},
                  "the triangles of both sides must have the same order");
      if (sources[0] != v) std::swap(sources[0], sources[1]);
      is_known[location[v]] = 1;
    }
    if (has_inner_point) continue;
    const Triangle& t = boundary.triangles[front];
    throw_bad("a triangle of a baffle has all corners on the free edge of the baffle",
              {{(boundary.points[t[0]] + boundary.points[t[1]] + boundary.points[t[2]]) / 3.0, "triangle " + std::to_string(front)}},
              "every triangle of a baffle needs a corner that is not on its free edge");
  }
  joined.n_baffles = sides.size();
  return joined;
}

namespace {

/// Corners of tetrahedra at points with two sides, joined across faces. A corner has the number 4 * index in the list + corner.
class Sides {
 public:
  explicit Sides(std::size_t n_tets) : sets_(4 * n_tets), side_(4 * n_tets, 0) {}
  void join(std::uint32_t a, std::uint32_t b) { sets_.join(a, b); }
  /// \pre all corners have been joined. \p side 1: first side, 2: second side
  void mark(std::uint32_t a, std::uint8_t side) { side_[sets_.root(a)] |= side; }
  std::uint8_t side(std::uint32_t a) { return side_[sets_.root(a)]; }

 private:
  DisjointSets sets_;
  std::vector<std::uint8_t> side_;
};

/// Faces of a tetrahedron in SIDS (CGNS) order, with normals outwards.
constexpr std::array<std::array<std::uint8_t, 3>, 4> k_baffle_tet_faces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

}  // namespace

void part_baffles(const TetraBoundary& boundary, const JoinedBoundary& joined, TetraResult& result) {
  const std::size_t n_joined = joined.points.size();
  const auto has_sides = [&](std::uint32_t v) { return v < n_joined && joined.sources[v][0] != joined.sources[v][1]; };
  std::vector<std::uint32_t> tets;
  for (std::uint32_t t = 0; t < result.tetrahedra.size(); ++t)
    if (std::ranges::any_of(result.tetrahedra[t], has_sides)) tets.push_back(t);

  struct Entry {
    SortedFace face;
    std::uint32_t tet;  ///< index in `tets`; k_no_node: the entry is a triangle of a sheet
    bool operator<(const Entry& b) const { return face.corners != b.face.corners ? face.corners < b.face.corners : tet < b.tet; }
  };
  std::vector<Entry> entries;
  for (std::uint32_t i = 0; i < tets.size(); ++i) {
    const auto& v = result.tetrahedra[tets[i]];
    for (const auto& f : k_baffle_tet_faces)
      if (has_sides(v[f[0]]) || has_sides(v[f[1]]) || has_sides(v[f[2]])) entries.push_back({SortedFace({v[f[0]], v[f[1]], v[f[2]]}), i});
  }
  for (const Triangle& t : joined.baffles()) entries.push_back({SortedFace(t), k_no_node});
  std::sort(entries.begin(), entries.end());

  Sides sides(tets.size());
  const auto corner = [&](std::uint32_t tet, std::uint32_t v) {
    const auto& c = result.tetrahedra[tets[tet]];
    return 4 * tet + static_cast<std::uint32_t>(std::ranges::find(c, v) - c.begin());
  };
  const auto for_each_face = [&](const auto& f) {
    for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
      for (end = begin; end < entries.size() && entries[end].face.corners == entries[begin].face.corners;) ++end;
      f(std::span(entries).subspan(begin, end - begin));
    }
  };
  for_each_face([&](std::span<const Entry> same) {
    if (same.size() != 2 || same[1].tet == k_no_node) return;
    for (const std::uint32_t v : same[0].face.corners)
      if (has_sides(v)) sides.join(corner(same[0].tet, v), corner(same[1].tet, v));
  });
  for_each_face([&](std::span<const Entry> same) {
    if (same.back().tet != k_no_node) return;
    for (const Entry& e : same.first(same.size() - 1)) {
      // For the tetrahedron on the first side, the outward face is the sheet's triangle with reversed orientation.
      const std::uint8_t side = e.face.is_odd != same.back().face.is_odd ? 1 : 2;
      for (const std::uint32_t v : e.face.corners)
        if (has_sides(v)) sides.mark(corner(e.tet, v), side);
    }
  });

  ErrorInfo error{.code = ErrorCode::tetra_result_invalid, .attempted = "separating the tetrahedra on the two sides of a baffle"};
  const auto shift = static_cast<std::uint32_t>(boundary.points.size() - n_joined);
  std::uint32_t next = 0;
  for (std::uint32_t t = 0; t < result.tetrahedra.size(); ++t) {
    const bool is_listed = next < tets.size() && tets[next] == t;
    for (std::uint32_t k = 0; k < 4; ++k) {
      std::uint32_t& v = result.tetrahedra[t][k];
      if (v >= n_joined) {
        v += shift;
        continue;
      }
      std::uint8_t side = 1;
      if (is_listed && has_sides(v)) {
        side = sides.side(4 * next + k);
        if (side != 1 && side != 2) {
          if (error.locations.size() < k_max_locations)
            error.locations.push_back({joined.points[v], "the baffle does not separate the tetrahedra at this point"});
          ++error.n_locations;
          side = 1;
        }
      }
      v = joined.sources[v][side - 1u];
    }
    next += is_listed;
  }
  if (error.n_locations == 0) return;
  error.problem = "a triangle of a baffle is missing among the faces at " + std::to_string(error.n_locations) + " corners of tetrahedra";
  throw Error(std::move(error));
}

}  // namespace sterna::volmesh
