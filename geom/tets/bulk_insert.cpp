#include "geom/tets/bulk_insert.h"

#include <algorithm>
#include <array>
#include <limits>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna::tets {
namespace {

constexpr std::size_t k_most_blocks = 64;
/// Every other pass has its limits in the middle of the blocks before. Later ones have fewer seeds and so fewer and larger blocks: where tetrahedra are large.
constexpr int k_most_block_passes = 4;
constexpr std::size_t k_block_seeds = 2048;
/// Of a mesh with more, finding the owners takes longer than another thread saves.
constexpr std::size_t k_tets_per_seed = 1000;  ///< at least, in the mean
/// New places that a block gets for each seed: a point makes six and a half tetrahedra more in the mean, and not every seed is inserted.
constexpr std::size_t k_places_per_seed = 3;
constexpr std::size_t k_more_places = 256;
constexpr std::size_t k_stop_seeds = 4096;  ///< between two looks at the stop token

/// Where a tetrahedron belongs that reaches far: at most of its corners.
std::uint32_t at_shortest_edge(const TetMesh& mesh, const Corners& v) {
  std::uint32_t at = v[0];
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double length = norm2(mesh.points[v[i]] - mesh.points[v[j]]);
      if (length >= shortest) continue;
      shortest = length;
      at = v[j];
    }
  }
  return at;
}

}  // namespace

BulkInserter::BulkInserter(TetMesh& mesh, const RunContext& context, std::uint32_t n_corners, std::size_t most_effort)
    : mesh_(mesh), n_corners_(n_corners), most_effort_(most_effort), curve_(mesh.points) {
  const std::size_t n = mesh.nodes.size();
  mark_.assign(n, 0);
  state_.assign(n, 0);
  is_changed_.assign(n / k_chunk + 1, 1);
  key_.assign(n, 0);
  parallel_for(context, n, [&](std::size_t t) {
    if (mesh_.nodes[t][0] != k_none) key_[t] = curve_.key(mesh_.points[at_shortest_edge(mesh_, mesh_.nodes[t])]);
  });
  for (std::size_t t = n; t-- > 0;)
    if (mesh.nodes[t][0] == k_none) free_.push_back(static_cast<std::uint32_t>(t));
}

void BulkInserter::make_room(std::size_t n_places) {
  if (n_places >= k_most_tets)
    throw Error({.code = ErrorCode::overflow,
                 .attempted = "refining tetrahedra",
                 .problem = std::to_string(n_places) + " tetrahedra, limit " + std::to_string(k_most_tets - 1),
                 .hint = "a size, or a source, is very small in a large region"});
  if (n_places > mesh_.nodes.capacity()) {  // an eighth more, not twice: memory
    const std::size_t capacity = n_places + n_places / 8;
    mesh_.nodes.reserve(capacity);
    mesh_.neighbours.reserve(capacity);
    for (std::vector<std::uint8_t>* bytes : {&mark_, &state_}) bytes->reserve(capacity);
    key_.reserve(capacity);
  }
  mesh_.nodes.resize(n_places, {k_none, k_none, k_none, k_none});
  mesh_.neighbours.resize(n_places, {k_none, k_none, k_none, k_none});
  mark_.resize(n_places, 0);
  state_.resize(n_places, 0);
  is_changed_.resize(n_places / k_chunk + 1, 0);
  key_.resize(n_places, 0);
}

/// Block of a key: how many splitters are not above it.
void BulkInserter::set_owners(std::vector<std::uint64_t> splitters, const RunContext& context) {
  splitters.resize(k_most_blocks - 1, ~std::uint64_t{0});
  owner_.resize(key_.size());
  parallel_for(
      context, key_.size(),
      [&](std::size_t t) {
        std::size_t block = 0;  // without branches: no two neighbours in the list need be near to each other
        for (std::size_t step = k_most_blocks / 2; step > 0; step /= 2) block += splitters[block + step - 1] <= key_[t] ? step : 0;
        owner_[t] = static_cast<std::uint8_t>(block);
      },
      std::size_t{1} << 16);
}

/// The seeds that are to be tried later, in the same order.
std::vector<std::uint32_t> BulkInserter::run_pass(std::span<const Seed> seeds, std::span<const Ordered> order, std::size_t n_blocks, bool is_shifted,
                                                  std::uint32_t first_point, std::vector<Insertion>& results, const RunContext& context) {
  // Shifted blocks have their limits in the middle of the others'.
  const std::size_t n = order.size(), shift = is_shifted ? n / n_blocks / 2 : 0;
  std::vector<std::uint64_t> splitters;
  std::vector<std::size_t> first = {0};
  for (std::size_t i = 1; i < n_blocks; ++i) {
    const std::size_t at = i * n / n_blocks + shift;
    splitters.push_back(order[at].key);
    // A key belongs to one block.
    first.push_back(static_cast<std::size_t>(std::ranges::lower_bound(order, order[at].key, {}, &Ordered::key) - order.begin()));
  }
  first.push_back(n);
  if (n_blocks > 1) set_owners(splitters, context);

  // Places that are free are dealt out by their owners' blocks; each block has new ones behind.
  std::vector<std::vector<std::uint32_t>> free(n_blocks);
  std::size_t n_places = mesh_.nodes.size();
  std::vector<std::uint32_t> first_new(n_blocks + 1);
  if (n_blocks == 1) free[0] = std::move(free_);
  for (std::size_t i = 0; n_blocks > 1 && i < free_.size(); ++i) free[owner_[free_[i]]].push_back(free_[i]);
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const std::size_t wanted =
        k_places_per_seed * (first[block + 1] - first[block]) + (n_blocks > 1 ? k_more_places : 2 * most_effort_ + 4);  // one block: enough for any point
    first_new[block] = static_cast<std::uint32_t>(n_places);
    if (wanted > free[block].size()) n_places += wanted - free[block].size();
  }
  first_new[n_blocks] = static_cast<std::uint32_t>(n_places);
  make_room(n_places);

  const InsertTarget target{mesh_, mark_, state_, is_changed_, key_, n_corners_, first_point, most_effort_, n_blocks > 1 ? &owner_ : nullptr};
  std::vector<std::vector<std::uint32_t>> later(n_blocks);
  parallel_chunks(context, n_blocks, 1, [&](std::size_t block, std::size_t) {
    Inserter inserter(target, static_cast<std::uint8_t>(block), std::move(free[block]), first_new[block], first_new[block + 1]);
    for (std::size_t i = first[block]; i < first[block + 1]; ++i) {
      if ((i - first[block] + 1) % k_stop_seeds == 0) context.check_stop();
      const std::uint32_t seed = order[i].seed;
      results[seed] = inserter.insert(first_point + seed, order[i].key, seeds[seed].start, seeds[seed].room);
      if (results[seed] == Insertion::foreign) later[block].push_back(static_cast<std::uint32_t>(i));
    }
    free[block] = inserter.take_free();
  });
  free_.clear();
  std::vector<std::uint32_t> all_later;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    free_.insert(free_.end(), free[block].begin(), free[block].end());
    all_later.insert(all_later.end(), later[block].begin(), later[block].end());
  }
  return all_later;
}

std::vector<BulkInserter::Ordered> BulkInserter::ordered(std::span<const Seed> seeds, const RunContext& context) const {
  std::vector<Ordered> order(seeds.size());
  parallel_for(context, seeds.size(), [&](std::size_t i) { order[i] = {curve_.key(seeds[i].position), static_cast<std::uint32_t>(i)}; });
  parallel_sort(context, order, [](const Ordered& a, const Ordered& b) { return a.key != b.key ? a.key < b.key : a.seed < b.seed; });
  return order;
}

void BulkInserter::find_starts(std::span<Seed> seeds, const RunContext& context) const {
  std::vector<Ordered> tets;
  for (std::uint32_t t = 0; t < mesh_.nodes.size(); ++t)
    if (mesh_.is_alive(t)) tets.push_back({key_[t], t});
  parallel_sort(context, tets, [](const Ordered& a, const Ordered& b) { return a.key != b.key ? a.key < b.key : a.seed < b.seed; });
  parallel_for(context, seeds.size(), [&](std::size_t i) {
    const auto at = std::ranges::lower_bound(tets, curve_.key(seeds[i].position), {}, &Ordered::key);
    seeds[i].start = at == tets.end() ? tets.back().seed : at->seed;
  });
}

std::vector<std::uint32_t> BulkInserter::order_along_curve(std::span<const Seed> seeds, const RunContext& context) const {
  std::vector<std::uint32_t> order;
  order.reserve(seeds.size());
  for (const Ordered& o : ordered(seeds, context)) order.push_back(o.seed);
  return order;
}

std::vector<Insertion> BulkInserter::insert(std::span<const Seed> seeds, const RunContext& context) {
  const std::size_t first_point = mesh_.points.size();
  if (first_point + seeds.size() >= k_none)
    throw Error({.code = ErrorCode::overflow, .attempted = "refining tetrahedra", .problem = std::to_string(first_point + seeds.size()) + " points"});
  if (first_point + seeds.size() > mesh_.points.capacity()) mesh_.points.reserve((first_point + seeds.size()) * 9 / 8);
  std::vector<Ordered> order = ordered(seeds, context);
  for (const Seed& seed : seeds) mesh_.points.push_back(seed.position);

  std::vector<Insertion> results(seeds.size(), Insertion::foreign);
  for (int pass = 0; pass < k_most_block_passes; ++pass) {
    const std::size_t n_blocks = std::min(k_most_blocks, order.size() / k_block_seeds);
    if (n_blocks < 2 || order.size() < mesh_.nodes.size() / k_tets_per_seed) break;
    const std::vector<std::uint32_t> later = run_pass(seeds, order, n_blocks, pass % 2 == 1, static_cast<std::uint32_t>(first_point), results, context);
    for (std::size_t i = 0; i < later.size(); ++i) order[i] = order[later[i]];
    order.resize(later.size());
  }
  n_serial_ += static_cast<std::int64_t>(order.size());
  while (!order.empty()) {  // more than once only where the new places were too few
    const std::vector<std::uint32_t> later = run_pass(seeds, order, 1, false, static_cast<std::uint32_t>(first_point), results, context);
    for (std::size_t i = 0; i < later.size(); ++i) order[i] = order[later[i]];
    order.resize(later.size());
  }
  return results;
}

}  // namespace sterna::tets
