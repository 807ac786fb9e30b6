// Faces are matched by vertex numbers without a global sort. They are distributed into buckets by their lowest vertex, by counting and then scattering, both in
// fixed chunks. Each bucket fits into the cache and is distributed to its vertices in the same way. Then the two dozen faces of each vertex are sorted and
// compared. A boundary triangle takes part as the face of an outside cell.

#include "volmesh/tetra/verify.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/predicates.h"
#include "volmesh/tetra/boundary_check.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_owner_limit = std::size_t{1} << 29;  ///< limit, because owner, face and orientation of a face share 32 bits
constexpr std::size_t k_owner_chunk = 1 << 14;               ///< number of owners per chunk
constexpr std::size_t k_bucket_owners = 1 << 12;             ///< mean number of owners per bucket: 16 000 faces, or 256 kB, fit into the second-level cache
constexpr std::size_t k_most_buckets = 4096;
constexpr std::size_t k_buckets_per_task = 4;
constexpr std::size_t k_locations_kept = 1000;

enum class Fault : std::uint8_t { bad_index, not_positive, missing_boundary, free_face, crowded_face, same_sense };
constexpr std::array<const char*, 6> k_fault_text = {
    "tetrahedra with a node out of range or repeated", "tetrahedra without positive volume", "boundary triangles that are not a face of a tetrahedron",
    "outer faces that are not a boundary triangle",    "faces of more than two cells",       "faces with both cells on the same side"};

struct Defect {
  Fault fault;
  std::size_t owner;  ///< number of the tetrahedron, or number of tetrahedra + boundary triangle
  int face = 0;
};

struct Defects {
  std::array<std::int64_t, k_fault_text.size()> counts{};
  std::vector<Defect> kept;

  void add(const Defect& finding) {
    ++counts[static_cast<std::size_t>(finding.fault)];
    if (kept.size() < k_locations_kept) kept.push_back(finding);
  }
  bool empty() const { return kept.empty(); }
};

Defects joined_defects(Defects a, const Defects& b) {
  for (std::size_t i = 0; i < a.counts.size(); ++i) a.counts[i] += b.counts[i];
  const std::size_t room = std::min(b.kept.size(), k_locations_kept - a.kept.size());
  a.kept.insert(a.kept.end(), b.kept.begin(), b.kept.begin() + static_cast<std::ptrdiff_t>(room));
  return a;
}

/// Boundary and new points as one list of nodes.
struct Nodes {
  const TetraBoundary& boundary;
  const TetraResult& result;
  std::size_t n_boundary = boundary.points.size();
  std::size_t size() const { return n_boundary + result.new_points.size(); }
  const Vec3& operator[](std::size_t i) const { return i < n_boundary ? boundary.points[i] : result.new_points[i - n_boundary]; }
};

/// Faces of a tetrahedron in SIDS (CGNS) order, with normals outwards.
constexpr std::array<std::array<std::uint8_t, 3>, 4> k_tet_faces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

/// Owners of faces: tetrahedra first, then boundary triangles. The normals of boundary triangles point into the domain, that is, out of "their" cell.
struct Owners {
  const TetraBoundary& boundary;
  const TetraResult& result;
  std::size_t n_tetrahedra = result.tetrahedra.size();
  std::size_t size() const { return n_tetrahedra + boundary.triangles.size(); }
  bool is_boundary(std::size_t owner) const { return owner >= n_tetrahedra; }
  std::array<std::uint32_t, 3> face(std::size_t owner, int face) const {
    if (is_boundary(owner)) return boundary.triangles[owner - n_tetrahedra];
    const auto& tet = result.tetrahedra[owner];
    const auto& local = k_tet_faces[static_cast<std::size_t>(face)];
    return {tet[local[0]], tet[local[1]], tet[local[2]]};
  }
  int n_faces(std::size_t owner) const { return is_boundary(owner) ? 1 : 4; }
};

/// A face with sorted vertices low < middle < high. `tag` is owner << 3 | face << 1 | 1 for an odd permutation.
struct FaceEntry {
  std::uint64_t low_middle;
  std::uint64_t high_tag;
  std::uint32_t high() const { return static_cast<std::uint32_t>(high_tag >> 32); }
  std::size_t owner() const { return static_cast<std::uint32_t>(high_tag) >> 3; }
  int face() const { return static_cast<int>(high_tag >> 1 & 3); }
  bool is_odd() const { return (high_tag & 1) != 0; }
  bool same_vertices(const FaceEntry& b) const { return low_middle == b.low_middle && high() == b.high(); }
  friend bool operator<(const FaceEntry& a, const FaceEntry& b) { return a.low_middle != b.low_middle ? a.low_middle < b.low_middle : a.high_tag < b.high_tag; }
};

FaceEntry make_entry(std::array<std::uint32_t, 3> v, std::size_t owner, int face) {
  std::uint64_t odd = 0;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (v[i] <= v[j]) return;
    std::swap(v[i], v[j]);
    odd ^= 1;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return {std::uint64_t{v[0]} << 32 | v[1], std::uint64_t{v[2]} << 32 | owner << 3 | static_cast<std::uint64_t>(face) << 1 | odd};
}

/// The faces of all owners, bucket after bucket. A bucket contains all faces whose lowest vertex lies in its range.
struct FaceBuckets {
  std::vector<FaceEntry> entries;
  std::vector<std::size_t> first;  ///< start of each bucket, and the end of the last
  std::size_t nodes_per_bucket = 1;
  std::span<const FaceEntry> bucket(std::size_t i) const { return {entries.data() + first[i], first[i + 1] - first[i]}; }
};

FaceBuckets throw_into_buckets(const Owners& owners, std::size_t n_nodes, const RunContext& context) {
  const std::size_t n_buckets = std::clamp<std::size_t>(owners.size() / k_bucket_owners, 1, k_most_buckets);
  const std::size_t nodes_per_bucket = n_nodes / n_buckets + 1;
  const std::size_t n_chunks = (owners.size() + k_owner_chunk - 1) / k_owner_chunk;
  const auto bucket_of = [&](const FaceEntry& e) { return (e.low_middle >> 32) / nodes_per_bucket; };
  const auto for_faces = [&](std::size_t begin, std::size_t end, const auto& f) {
    for (std::size_t owner = begin; owner < end; ++owner) {
      for (int face = 0; face < owners.n_faces(owner); ++face) f(make_entry(owners.face(owner, face), owner, face));
    }
  };

  std::vector<std::size_t> location(n_chunks * n_buckets, 0);  // first the counts, then the next free position of each chunk in each bucket
  parallel_chunks(context, owners.size(), k_owner_chunk, [&](std::size_t begin, std::size_t end) {
    std::size_t* count = location.data() + begin / k_owner_chunk * n_buckets;
    for_faces(begin, end, [&](const FaceEntry& e) { ++count[bucket_of(e)]; });
  });
  FaceBuckets buckets;
  buckets.nodes_per_bucket = nodes_per_bucket;
  buckets.first.assign(n_buckets + 1, 0);
  std::size_t total = 0;
  for (std::size_t bucket = 0; bucket < n_buckets; ++bucket) {
    buckets.first[bucket] = total;
    for (std::size_t chunk = 0; chunk < n_chunks; ++chunk) total += std::exchange(location[chunk * n_buckets + bucket], total);
  }
  buckets.first[n_buckets] = total;
  buckets.entries.resize(total);
  parallel_chunks(context, owners.size(), k_owner_chunk, [&](std::size_t begin, std::size_t end) {
    std::size_t* next = location.data() + begin / k_owner_chunk * n_buckets;
    for_faces(begin, end, [&](const FaceEntry& e) { buckets.entries[next[bucket_of(e)]++] = e; });
  });
  return buckets;
}

/// Checks the faces [begin, end), which have the same vertices.
void judge_group(const Owners& owners, const FaceEntry* begin, const FaceEntry* end, Defects& findings) {
  const auto find = [&](Fault fault, const FaceEntry& e) { findings.add({fault, e.owner(), e.face()}); };
  const bool first_is_boundary = owners.is_boundary(begin->owner());
  if (end - begin == 1) {
    find(first_is_boundary ? Fault::missing_boundary : Fault::free_face, *begin);
  } else if (end - begin > 2) {
    find(Fault::crowded_face, *begin);
  } else if (begin->is_odd() == begin[1].is_odd()) {
    find(Fault::same_sense, *begin);
  } else if (first_is_boundary) {
    find(Fault::missing_boundary, *begin);  // two boundary triangles lie back to back, and neither has a tetrahedron
  }
}

/// Sorts buckets. Its memory is reused for the next bucket.
class BucketSorter {
 public:
  explicit BucketSorter(std::size_t nodes_per_bucket) : first_(nodes_per_bucket + 1) {}

  /// Returns the faces of the bucket in a total order, in which faces with the same vertices are adjacent.
  std::span<const FaceEntry> sorted(std::span<const FaceEntry> bucket, std::size_t first_node) {
    std::ranges::fill(first_, 0);
    for (const FaceEntry& e : bucket) ++first_[(e.low_middle >> 32) - first_node + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(bucket.size());
    for (const FaceEntry& e : bucket) entries_[first_[(e.low_middle >> 32) - first_node]++] = e;
    // Each first_[i] now points to the end of the faces of its vertex.
    std::size_t begin = 0;
    for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
      std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(begin), entries_.begin() + static_cast<std::ptrdiff_t>(first_[i]));
      begin = first_[i];
    }
    return entries_;
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<FaceEntry> entries_;
};

Defects match_faces(const Owners& owners, std::size_t n_nodes, const RunContext& context) {
  const FaceBuckets buckets = throw_into_buckets(owners, n_nodes, context);
  return parallel_reduce(
      context, buckets.first.size() - 1, Defects{},
      [&](std::size_t begin, std::size_t end) {
        Defects findings;
        BucketSorter sorter(buckets.nodes_per_bucket);
        for (std::size_t bucket = begin; bucket < end; ++bucket) {
          const std::span<const FaceEntry> faces = sorter.sorted(buckets.bucket(bucket), bucket * buckets.nodes_per_bucket);
          for (const FaceEntry *e = faces.data(), *const last = e + faces.size(); e != last;) {
            const FaceEntry* next = e + 1;
            while (next != last && next->same_vertices(*e)) ++next;
            judge_group(owners, e, next, findings);
            e = next;
          }
        }
        return findings;
      },
      joined_defects, k_buckets_per_task);
}

Defects judge_tetrahedra(const Nodes& nodes, const TetraResult& result, const RunContext& context) {
  return parallel_reduce(
      context, result.tetrahedra.size(), Defects{},
      [&](std::size_t begin, std::size_t end) {
        Defects findings;
        for (std::size_t i = begin; i < end; ++i) {
          const auto& t = result.tetrahedra[i];
          const bool is_repeated = t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
          if (is_repeated || std::ranges::any_of(t, [&](std::uint32_t v) { return v >= nodes.size(); })) {
            findings.add({Fault::bad_index, i});
          } else if (orient3d(nodes[t[0]], nodes[t[1]], nodes[t[2]], nodes[t[3]]) <= 0) {
            findings.add({Fault::not_positive, i});
          }
        }
        return findings;
      },
      joined_defects, k_owner_chunk);
}

ErrorInfo invalid(std::string problem) {
  return {.code = ErrorCode::tetra_result_invalid, .attempted = "verifying the tetrahedra", .problem = std::move(problem)};
}

void check_new_points(const TetraBoundary& boundary, const TetraResult& result) {
  const std::size_t n_boundary = boundary.points.size();
  std::vector<std::uint8_t> is_used(result.new_points.size(), 0);
  for (const auto& tet : result.tetrahedra) {
    for (const std::uint32_t v : tet) {
      if (v >= n_boundary) is_used[v - n_boundary] = 1;
    }
  }
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_finite(result.new_points[i])) throw Error(invalid("new point " + std::to_string(i) + " is not finite"));
    if (is_used[i]) continue;
    ErrorInfo error = invalid("new point " + std::to_string(i) + " is not used by any tetrahedron");
    error.locations.push_back({result.new_points[i], "new point " + std::to_string(i)});
    throw Error(std::move(error));
  }
}

ErrorLocation location_of(const Defect& finding, const Owners& owners, const Nodes& nodes) {
  if (owners.is_boundary(finding.owner)) return location_of_triangle(owners.boundary, finding.owner - owners.n_tetrahedra, "");
  Vec3 sum;
  int n = 0;
  const auto add = [&](std::uint32_t v) {
    if (v >= nodes.size()) return;
    sum += nodes[v];
    ++n;
  };
  const std::string name = "tetrahedron " + std::to_string(finding.owner);
  if (finding.fault == Fault::bad_index || finding.fault == Fault::not_positive) {
    for (const std::uint32_t v : owners.result.tetrahedra[finding.owner]) add(v);
    return {n > 0 ? sum / n : sum, name};
  }
  for (const std::uint32_t v : owners.face(finding.owner, finding.face)) add(v);
  return {sum / n, "face " + std::to_string(finding.face) + " of " + name};
}

void throw_if_any(const Defects& findings, const Owners& owners, const Nodes& nodes) {
  if (findings.empty()) return;
  ErrorInfo error = invalid("");
  for (std::size_t i = 0; i < findings.counts.size(); ++i) {
    if (findings.counts[i] == 0) continue;
    error.problem += (error.problem.empty() ? "" : ", ") + std::to_string(findings.counts[i]) + " " + k_fault_text[i];
    error.n_locations += findings.counts[i];
  }
  for (const Defect& finding : findings.kept) {
    if (error.locations.size() < k_max_locations) error.locations.push_back(location_of(finding, owners, nodes));
    if (owners.is_boundary(finding.owner)) {
      add_triangle(error.geometry, owners.boundary, finding.owner - owners.n_tetrahedra);
    } else {
      error.geometry.vertices.push_back(static_cast<std::uint32_t>(error.geometry.points.size()));
      error.geometry.points.push_back(location_of(finding, owners, nodes).position);
    }
  }
  if (findings.counts[static_cast<std::size_t>(Fault::missing_boundary)] > 0) {
    error.hint = "the boundary is not closed, intersects itself, or a hole point lies on the wrong side of the boundary";
  }
  throw Error(std::move(error));
}

}  // namespace

void verify_tetrahedra(const TetraBoundary& boundary, const TetraResult& result, const RunContext& context) {
  const Nodes nodes{boundary, result};
  const Owners owners{boundary, result};
  if (result.tetrahedra.empty()) {
    ErrorInfo error = invalid("there are no tetrahedra");
    error.hint = "the boundary is not closed, or a hole point lies in the domain";
    throw Error(std::move(error));
  }
  if (owners.size() >= k_owner_limit || nodes.size() >= k_owner_limit) {
    throw Error({.code = ErrorCode::overflow,
                 .attempted = "verifying the tetrahedra",
                 .problem = std::to_string(owners.size()) + " tetrahedra and boundary triangles, limit " + std::to_string(k_owner_limit)});
  }
  throw_if_any(judge_tetrahedra(nodes, result, context), owners, nodes);
  check_new_points(boundary, result);
  throw_if_any(match_faces(owners, nodes.size(), context), owners, nodes);
}

}  // namespace sterna::volmesh
