#include "geom/tets/bulk_insert.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna::tets {
namespace {

constexpr int k_most_block_halvings = 6;
/// Fractions of the points in the lower parts, one for each pass. The planes differ from pass to pass, so most seeds that a plane blocked are inside a block in
/// the next pass.
constexpr std::array<double, 3> k_shares = {0.5, 0.4, 0.6};
constexpr std::size_t k_block_seeds = 4096;  ///< smallest mean number of seeds per block
/// New slots of a block per seed. A point adds six and a half tetrahedra in the mean, but not every seed is inserted.
constexpr std::size_t k_locations_per_seed = 3;
constexpr std::size_t k_more_locations = 256;
constexpr std::size_t k_stop_seeds = 4096;  ///< seeds between two checks of the stop token

/// Returns the corner that determines the block of a large tetrahedron: the one nearest to another corner.
std::uint8_t nearest_corner(const TetMesh& mesh, const Corners& v) {
  std::uint8_t at = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::uint8_t i = 0; i < 4; ++i) {
    for (std::uint8_t j = 0; j < i; ++j) {
      const double length = norm2(mesh.points[v[i]] - mesh.points[v[j]]);
      if (length >= shortest) continue;
      shortest = length;
      at = j;
    }
  }
  return at;
}

/// Returns the new index of corner i if `last` becomes the last corner and the orientation is kept.
std::size_t corner_after(std::size_t i, std::uint8_t last) {
  if (last == 3) return i;
  if (i == last) return 3;
  if (i == 3) return last;
  return 3 - last - i;
}

/// Orders the corners of each tetrahedron such that the last one determines its block. Empty slots have no block.
void put_owners_last(TetMesh& mesh, const RunContext& context) {
  const std::size_t n = mesh.nodes.size();
  std::vector<std::uint8_t> last(n, 3);
  parallel_for(context, n, [&](std::size_t t) {
    if (mesh.is_alive(static_cast<std::uint32_t>(t))) last[t] = nearest_corner(mesh, mesh.nodes[t]);
  });
  parallel_for(context, n, [&](std::size_t t) {
    const Corners nodes = mesh.nodes[t], neighbours = mesh.neighbours[t];
    const bool is_gone = nodes[0] == k_none;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t to = corner_after(i, last[t]);
      const std::uint32_t n_i = neighbours[i];
      mesh.nodes[t][to] = is_gone ? k_none : nodes[i];
      mesh.neighbours[t][to] = is_gone || n_i == k_none ? k_none : n_i / 4 * 4 + static_cast<std::uint32_t>(corner_after(n_i % 4, last[n_i / 4]));
    }
  });
}

}  // namespace

BulkInserter::BulkInserter(TetMesh& mesh, const RunContext& context, std::uint32_t n_corners, std::size_t most_effort)
    : mesh_(mesh), n_corners_(n_corners), most_effort_(most_effort), curve_(mesh.points) {
  const std::size_t n = mesh.nodes.size();
  mark_.assign(n, 0);
  state_.assign(n, 0);
  is_changed_.assign(n / k_chunk + 1, 1);
  put_owners_last(mesh_, context);
  for (std::size_t t = n; t-- > 0;)
    if (mesh.nodes[t][0] == k_none) free_.push_back(static_cast<std::uint32_t>(t));
}

std::uint32_t BulkInserter::first_alive() const {
  std::uint32_t t = 0;
  while (!mesh_.is_alive(t)) ++t;
  return t;
}

void BulkInserter::reserve(std::size_t n) {
  mesh_.nodes.reserve(n);
  mesh_.neighbours.reserve(n);
  mark_.reserve(n);
  state_.reserve(n);
}

void BulkInserter::make_room(std::size_t n_locations) {
  if (n_locations >= k_most_tets)
    throw Error({.code = ErrorCode::overflow,
                 .attempted = "refining tetrahedra",
                 .problem = std::to_string(n_locations) + " tetrahedra, limit " + std::to_string(k_most_tets - 1),
                 .hint = "use larger sizes: a size or a source is very small in a large region"});
  if (n_locations > mesh_.nodes.capacity()) reserve(n_locations + n_locations / 4);  // less than doubled, to save memory
  mesh_.nodes.resize(n_locations, {k_none, k_none, k_none, k_none});
  mesh_.neighbours.resize(n_locations, {k_none, k_none, k_none, k_none});
  mark_.resize(n_locations, 0);
  state_.resize(n_locations, 0);
  is_changed_.resize(n_locations / k_chunk + 1, 0);
}

/// Distributes the free slots. Those of former tetrahedra go to their block, so that walks from them start nearby; the others are divided into equal parts.
std::vector<std::vector<std::uint32_t>> BulkInserter::dealt_out(const Blocks& blocks, const RunContext& context) {
  std::vector<std::vector<std::uint32_t>> free(blocks.size());
  if (blocks.size() == 1) {
    free[0] = std::move(free_);
    free_.clear();
    return free;
  }
  constexpr std::uint8_t k_anybody = 255;
  std::vector<std::uint8_t> owner(free_.size());
  parallel_for(context, free_.size(), [&](std::size_t i) {
    const std::uint32_t v = mesh_.nodes[free_[i]][3];
    owner[i] = v == k_none ? k_anybody : static_cast<std::uint8_t>(blocks.find(mesh_.points[v]));
  });
  const auto n_new = static_cast<std::size_t>(std::ranges::count(owner, k_anybody));
  for (std::size_t i = 0, k = 0; i < free_.size(); ++i)
    if (owner[i] == k_anybody) free[k++ * blocks.size() / n_new].push_back(free_[i]);
  for (std::size_t i = 0; i < free_.size(); ++i)
    if (owner[i] != k_anybody) free[owner[i]].push_back(free_[i]);
  free_.clear();
  return free;
}

/// Runs one pass. Returns the seeds to be retried, in the same order.
std::vector<std::uint32_t> BulkInserter::run_pass(std::span<const Seed> seeds, std::span<const std::uint32_t> order, const Blocks& blocks,
                                                  std::uint32_t first_point, std::vector<Insertion>& results, const RunContext& context) {
  const std::size_t n_blocks = blocks.size();
  struct Start {
    std::uint8_t block;
    bool is_own;  ///< the start of the seed is also in its block
  };
  std::vector<Start> starts(order.size());
  parallel_for(context, order.size(), [&](std::size_t i) {
    const Seed& seed = seeds[order[i]];
    const std::size_t block = blocks.find(seed.position);
    starts[i] = {static_cast<std::uint8_t>(block), seed.start < mesh_.nodes.size() && mesh_.nodes[seed.start][3] != k_none && is_in(seed.start, blocks[block])};
  });
  std::vector<std::vector<std::uint32_t>> own(n_blocks);  // positions in `order`, by block
  for (std::size_t i = 0; i < order.size(); ++i) own[starts[i].block].push_back(static_cast<std::uint32_t>(i));

  std::vector<std::vector<std::uint32_t>> free = dealt_out(blocks, context);
  std::size_t n_locations = mesh_.nodes.size();
  std::vector<std::uint32_t> first_new(n_blocks + 1);
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const std::size_t needed =
        k_locations_per_seed * own[block].size() + (n_blocks > 1 ? k_more_locations : 2 * most_effort_ + 4);  // one block: slots for any point
    first_new[block] = static_cast<std::uint32_t>(n_locations);
    if (needed > free[block].size()) n_locations += needed - free[block].size();
  }
  first_new[n_blocks] = static_cast<std::uint32_t>(n_locations);
  make_room(n_locations);

  const InsertTarget target{mesh_, mark_, state_, is_changed_, n_corners_, first_point, most_effort_};
  parallel_chunks(context, n_blocks, 1, [&](std::size_t block, std::size_t) {
    const std::uint32_t first_start = n_blocks == 1 ? first_alive() : k_none;
    Inserter inserter(target, blocks[block], std::move(free[block]), first_new[block], first_new[block + 1], first_start);
    std::size_t n_done = 0;
    for (const std::uint32_t i : own[block]) {
      if (++n_done % k_stop_seeds == 0) context.check_stop();
      const std::uint32_t seed = order[i];
      results[seed] = inserter.insert(first_point + seed, starts[i].is_own ? seeds[seed].start : k_none, seeds[seed].room);
    }
    free[block] = inserter.take_free();
  });
  for (const std::vector<std::uint32_t>& left : free) free_.insert(free_.end(), left.begin(), left.end());
  std::vector<std::uint32_t> later;
  for (const std::uint32_t seed : order)
    if (results[seed] == Insertion::foreign) later.push_back(seed);
  return later;
}

std::vector<std::uint32_t> BulkInserter::order_along_curve(std::span<const Seed> seeds, const RunContext& context) const {
  struct Ordered {
    std::uint64_t key;
    std::uint32_t seed;
  };
  std::vector<Ordered> along(seeds.size());
  parallel_for(context, seeds.size(), [&](std::size_t i) { along[i] = {curve_.key(seeds[i].position), static_cast<std::uint32_t>(i)}; });
  parallel_sort(context, along, [](const Ordered& a, const Ordered& b) { return a.key != b.key ? a.key < b.key : a.seed < b.seed; });
  std::vector<std::uint32_t> order(seeds.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = along[i].seed;
  return order;
}

void BulkInserter::find_starts(std::span<Seed> seeds, const RunContext& context) const {
  struct Location {
    std::uint64_t key;
    std::uint32_t tet;
  };
  std::vector<Location> locations;
  for (std::uint32_t t = 0; t < mesh_.nodes.size(); ++t)
    if (mesh_.is_alive(t)) locations.push_back({0, t});
  parallel_for(context, locations.size(), [&](std::size_t i) { locations[i].key = curve_.key(mesh_.points[mesh_.nodes[locations[i].tet][3]]); });
  parallel_sort(context, locations, [](const Location& a, const Location& b) { return a.key != b.key ? a.key < b.key : a.tet < b.tet; });
  parallel_for(context, seeds.size(), [&](std::size_t i) {
    const auto at = std::ranges::lower_bound(locations, curve_.key(seeds[i].position), {}, &Location::key);
    seeds[i].start = at == locations.end() ? locations.back().tet : at->tet;
  });
}

std::vector<Insertion> BulkInserter::insert(std::span<const Seed> seeds, const RunContext& context) {
  return insert(seeds, order_along_curve(seeds, context), context);
}

std::vector<Insertion> BulkInserter::insert_in_order(std::span<const Seed> seeds, const RunContext& context) {
  std::vector<std::uint32_t> order(seeds.size());
  std::iota(order.begin(), order.end(), 0u);
  return insert(seeds, std::move(order), context);
}

std::vector<Insertion> BulkInserter::insert(std::span<const Seed> seeds, std::vector<std::uint32_t> order, const RunContext& context) {
  const std::size_t first_point = mesh_.points.size();
  if (first_point + seeds.size() >= k_none)
    throw Error({.code = ErrorCode::overflow, .attempted = "refining tetrahedra", .problem = std::to_string(first_point + seeds.size()) + " points"});
  if (first_point + seeds.size() > mesh_.points.capacity()) mesh_.points.reserve((first_point + seeds.size()) * 9 / 8);
  for (const Seed& seed : seeds) mesh_.points.push_back(seed.position);

  std::vector<Insertion> results(seeds.size(), Insertion::foreign);
  for (const double share : k_shares) {
    int n_halvings = 0;
    while (n_halvings < k_most_block_halvings && order.size() >> (n_halvings + 1) >= k_block_seeds) ++n_halvings;
    if (n_halvings == 0) break;
    std::vector<Vec3> locations(mesh_.points.begin() + static_cast<std::ptrdiff_t>(first_point), mesh_.points.end());
    order = run_pass(seeds, order, Blocks(std::move(locations), n_halvings, share, context), static_cast<std::uint32_t>(first_point), results, context);
  }
  n_serial_ += static_cast<std::int64_t>(order.size());
  // Repeated only if the new slots were not sufficient.
  while (!order.empty()) order = run_pass(seeds, order, Blocks({}, 0, 0.5, context), static_cast<std::uint32_t>(first_point), results, context);
  return results;
}

}  // namespace sterna::tets
