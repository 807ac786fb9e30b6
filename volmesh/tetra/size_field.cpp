// The octree of a size field. Steps: collect size points from boundary and samples; refine level by level until no leaf is longer than the size at its centre
// allows, with all cells of a level in parallel; compute values at the corners; pack.
//
// No source is missed, however small. Within a cell of edge e the distance of the source from the centre is at most e sqrt(3)/2. At the centre it therefore
// requires at most its size + slope e sqrt(3)/2. The cell is split as long as that is below e / k_edge_over_size, and k_edge_over_size is lowered for steep
// slopes.

#include "volmesh/tetra/size_field.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/mesh/size_points.h"

namespace sterna::volmesh {
namespace {

/// Largest ratio of a leaf's edge to the size at its centre. With 2 the number of leaves is about a thirtieth of the number of tetrahedra. Along a plane wall,
/// where sizes grow linearly, interpolation is exact for any edge.
constexpr double k_edge_over_size = 2.0;
/// Margin around the boundary's box, as a fraction of its edge. With it, locations on the boundary are inside the root despite rounding.
constexpr double k_margin = 1e-3;
/// Largest number of leaves: about 1 GB of buffer and a minute of computing, for a mesh of half a billion tetrahedra.
constexpr std::uint64_t k_max_leaves = 1u << 24;
/// Number of leaves per task. The leaves of a task are consecutive along a space-filling curve and form a compact block, in which they share most of their
/// corners.
constexpr std::size_t k_leaf_chunk = 1024;

struct Octant {
  std::uint32_t x = 0, y = 0, z = 0;  ///< position in units of the edge of its level
  std::uint32_t hint = 0;             ///< size point that was nearest to the centre of the parent
};

class Builder {
 public:
  Builder(const TetraBoundary& boundary, std::span<const SizeSource> sources, const SizeFieldOptions& options, const RunContext& context)
      : slope_(options.size_growth - 1.0),
        largest_(is_automatic(options.size_max) ? std::numeric_limits<double>::infinity() : options.size_max),
        edge_over_size_(std::min(k_edge_over_size, 1.0 / slope_)),
        sources_(sources),
        context_(context),
        size_points_(size_points_of(boundary, sources), slope_, context) {
    Box box;
    for (const Vec3& p : boundary.points) box.add(p);
    edge_ = (1.0 + 2.0 * k_margin) * box.longest_side();
    origin_ = box.center() - 0.5 * Vec3{edge_, edge_, edge_};
  }

  SizeField build(double growth) {
    refine();
    const std::vector<float> values = corner_values();
    return pack(values, growth);
  }

 private:
  static std::vector<SizePoint> size_points_of(const TetraBoundary& boundary, std::span<const SizeSource> sources);
  /// Returns the exact value of the field, before interpolation.
  double size_at(const Vec3& p, std::uint32_t& hint) const {
    double size = std::min(size_points_.smallest(p, hint), largest_);
    for (const SizeSource& source : sources_) size = std::min(size, size_of(source, p, slope_));
    return size;
  }
  double edge_of(int level) const { return std::ldexp(edge_, -level); }
  void refine();
  std::vector<float> corner_values() const;
  SizeField pack(const std::vector<float>& values, double growth) const;

  double slope_;
  double largest_;
  double edge_over_size_;
  std::span<const SizeSource> sources_;
  const RunContext& context_;
  SizePointTree size_points_;
  Vec3 origin_;
  double edge_ = 0.0;
  std::vector<std::uint32_t> nodes_;
  std::vector<Octant> leaves_;
  std::vector<std::uint8_t> leaf_level_;
};

/// Returns the size points: boundary vertices with the geometric mean of their edges, and the samples. (The geometric mean favours neither long nor short
/// edges; slivers have no short edge.)
std::vector<SizePoint> Builder::size_points_of(const TetraBoundary& boundary, std::span<const SizeSource> sources) {
  std::vector<double> logs(boundary.points.size(), 0.0);
  std::vector<std::uint32_t> counts(boundary.points.size(), 0);
  for (const auto& t : boundary.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      // In a closed surface each edge occurs once in each direction.
      const double length = distance(boundary.points[t[k]], boundary.points[t[(k + 1) % 3]]);
      logs[t[k]] += std::log(length);
      ++counts[t[k]];
    }
  }
  std::vector<SizePoint> size_points;
  size_points.reserve(boundary.points.size());
  for (std::size_t i = 0; i < boundary.points.size(); ++i)
    if (counts[i] > 0) size_points.push_back({boundary.points[i], std::exp(logs[i] / counts[i])});
  for (const SizeSource& source : sources)
    for (std::size_t i = 0; i < source.points.size() && source.kind == SourceKind::samples; ++i) size_points.push_back({source.points[i], source.sizes[i]});
  return size_points;
}

/// Refines the octree. The children of a level are in the order of their parents, so every level is sorted along the same space-filling curve.
void Builder::refine() {
  std::vector<Octant> level{Octant{}};
  nodes_.assign(1, 0);
  std::size_t first = 0;  // node of the first octant of the level
  for (int depth = 0; !level.empty(); ++depth) {
    context_.check_stop();
    const double edge = edge_of(depth);
    std::vector<std::uint8_t> is_split(level.size(), 0);
    parallel_for(
        context_, level.size(),
        [&](std::size_t i) {
          Octant& o = level[i];
          const Vec3 center = origin_ + edge * Vec3{o.x + 0.5, o.y + 0.5, o.z + 0.5};
          is_split[i] = depth < SizeFieldView::k_max_depth && edge > edge_over_size_ * size_at(center, o.hint);
        },
        256);
    std::vector<Octant> next;
    const std::size_t next_first = nodes_.size();
    for (std::size_t i = 0; i < level.size(); ++i) {
      const Octant& o = level[i];
      if (!is_split[i]) {
        nodes_[first + i] = SizeFieldView::k_leaf_bit | static_cast<std::uint32_t>(leaves_.size());
        leaves_.push_back(o);
        leaf_level_.push_back(static_cast<std::uint8_t>(depth));
        continue;
      }
      nodes_[first + i] = static_cast<std::uint32_t>(next_first + next.size());
      for (std::uint32_t k = 0; k < 8; ++k) next.push_back({2 * o.x + (k & 1u), 2 * o.y + (k >> 1 & 1u), 2 * o.z + (k >> 2), o.hint});
    }
    if (leaves_.size() + next.size() > k_max_leaves)
      throw Error({.code = ErrorCode::overflow,
                   .attempted = "building the size field",
                   .problem = "more than " + std::to_string(k_max_leaves) + " leaves are needed",
                   .hint = "size_max or a source requests a very small size in a large region: use a larger size or a smaller region"});
    nodes_.resize(next_first + next.size(), 0);
    first = next_first;
    level = std::move(next);
  }
}

std::vector<float> Builder::corner_values() const {
  std::vector<float> values(8 * leaves_.size());
  parallel_chunks(context_, leaves_.size(), k_leaf_chunk, [&](std::size_t begin, std::size_t end) {
    struct Corner {
      std::uint64_t xy;
      std::uint64_t z;
      bool operator==(const Corner&) const = default;
    };
    struct Hash {
      std::size_t operator()(const Corner& c) const { return (c.xy ^ (c.z * 0x9e3779b97f4a7c15ull)) * 0xff51afd7ed558ccdull >> 7; }
    };
    std::unordered_map<Corner, float, Hash> known;
    known.reserve(2 * (end - begin));
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      const Octant& o = leaves_[leaf];
      const int level = leaf_level_[leaf];
      const int shift = SizeFieldView::k_max_depth - level;
      std::uint32_t hint = o.hint;
      for (std::uint32_t k = 0; k < 8; ++k) {
        const std::uint64_t x = static_cast<std::uint64_t>(o.x + (k & 1u)) << shift, y = static_cast<std::uint64_t>(o.y + (k >> 1 & 1u)) << shift,
                            z = static_cast<std::uint64_t>(o.z + (k >> 2)) << shift;
        const auto [it, is_new] = known.try_emplace({x << 32 | y, z}, 0.0f);
        if (is_new) {
          const Vec3 at{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          it->second = static_cast<float>(size_at(origin_ + edge_of(SizeFieldView::k_max_depth) * at, hint));
        }
        values[8 * leaf + k] = it->second;
      }
    }
  });
  return values;
}

SizeField Builder::pack(const std::vector<float>& values, double growth) const {
  SizeFieldView::Header header;
  header.n_nodes = nodes_.size();
  header.n_leaves = leaves_.size();
  for (std::size_t axis = 0; axis < 3; ++axis) header.origin[axis] = origin_[axis];
  header.edge = edge_;
  const auto [smallest, largest] = std::ranges::minmax(values);
  header.smallest = static_cast<double>(smallest);
  header.largest = static_cast<double>(largest);
  header.growth = growth;
  std::vector<double> words(SizeFieldView::size_bytes(header.n_nodes, header.n_leaves) / sizeof(double), 0.0);
  std::byte* at = reinterpret_cast<std::byte*>(words.data());
  std::memcpy(at, &header, sizeof header);
  std::memcpy(at + sizeof header, nodes_.data(), 4 * nodes_.size());
  std::memcpy(at + sizeof header + 8 * ((nodes_.size() + 1) / 2), values.data(), 4 * values.size());
  return SizeField(std::move(words));
}

void require_sane(const TetraBoundary& boundary, std::span<const SizeSource> sources, double growth) {
  if (boundary.triangles.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "building the size field", .problem = "the boundary has no triangles"});
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::string problem = problem_of(sources[i], growth);
    const double n_leaves = volume_of(sources[i]) / std::pow(k_edge_over_size * std::max(sources[i].size, sources[i].size_end), 3.0);
    if (problem.empty() && n_leaves > static_cast<double>(k_max_leaves))
      problem = "at this size its region needs more than " + std::to_string(k_max_leaves) + " leaves of the field";
    if (problem.empty()) continue;
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "building the size field",
                 .problem = "source " + std::to_string(i + 1) + " (" + std::string(to_string(sources[i].kind)) + "): " + problem,
                 .locations = {{sources[i].from, "source"}}});
  }
}

}  // namespace

double SizeField::volume_over_cubes() const {
  const SizeFieldView::Header& header = view_.header();
  // size_field_view.h describes the layout of the buffer.
  const auto* nodes = reinterpret_cast<const std::uint32_t*>(bytes().data() + sizeof(SizeFieldView::Header));
  const auto* values = reinterpret_cast<const float*>(bytes().data() + sizeof(SizeFieldView::Header) + 8 * ((header.n_nodes + 1) / 2));
  struct Location {
    std::uint32_t node;
    double edge;
  };
  double sum = 0.0;
  std::vector<Location> open{{0, header.edge}};
  while (!open.empty()) {
    const auto [at, edge] = open.back();
    open.pop_back();
    const std::uint32_t node = nodes[at];
    if (node & SizeFieldView::k_leaf_bit) {
      const float* corners = values + 8 * static_cast<std::size_t>(node & ~SizeFieldView::k_leaf_bit);
      double cubes = 0.0;
      for (int k = 0; k < 8; ++k) cubes += std::pow(edge / static_cast<double>(corners[k]), 3.0);
      sum += cubes / 8.0;
      continue;
    }
    for (std::uint32_t k = 0; k < 8; ++k) open.push_back({node + k, 0.5 * edge});
  }
  return sum;
}

SizeField build_size_field(const TetraBoundary& boundary, std::span<const SizeSource> sources, const SizeFieldOptions& options, const RunContext& context) {
  require_sane(boundary, sources, options.size_growth);
  return Builder(boundary, sources, options, context).build(options.size_growth);
}

}  // namespace sterna::volmesh
