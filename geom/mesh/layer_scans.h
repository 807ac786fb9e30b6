// The scans of check_ahead(), chunk by chunk, so that only the chunks around moved lines are scanned again. Private to the check_*.cpp and dual_*.cpp files.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/mesh/cell_centred.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Results of a scan for each chunk of its items. Copies share the results.
template <class Scan>
class ScanChunks {
 public:
  ScanChunks(std::size_t n, std::size_t chunk) : n_(n), chunk_(chunk), parts_((n + chunk - 1) / chunk) {}

  /// Discards the chunks that contain these items.
  void forget(std::span<const std::uint32_t> items) {
    for (const std::uint32_t item : items) parts_[item / chunk_].reset();
  }
  /// Calls map(begin, end) -> Scan for each chunk without a result; parallel.
  template <class Map>
  void fill(const RunContext& context, const Map& map) {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (!parts_[i]) missing.push_back(i);
    parallel_chunks(context, missing.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t i = missing[k];
        parts_[i] = std::make_shared<const Scan>(map(i * chunk_, std::min(n_, (i + 1) * chunk_)));
      }
    });
  }
  /// Combines the results with all = combine(all, part), from the first chunk to the last, and returns `all`. This is the result of parallel_reduce for the
  /// same chunks.
  /// \pre fill() was called
  template <class Combine>
  Scan joined(Scan all, const Combine& combine) const {
    for (const std::shared_ptr<const Scan>& part : parts_) all = combine(std::move(all), Scan(*part));
    return all;
  }

 private:
  std::size_t n_, chunk_;
  std::vector<std::shared_ptr<const Scan>> parts_;
};

/// Columns per chunk of scan_columns(); each column holds some 30 cells.
inline constexpr std::size_t k_column_chunk = 64;
CellScan scan_column_chunk(const HybridMesh& mesh, bool with_quality, const GateTable& limits, std::size_t begin, std::size_t end);
CellScan joined(CellScan all, CellScan more);

/// Columns per chunk of scan_column_centres(). Cell centres of a chunk are held together. Centres of neighbouring columns outside the chunk are computed
/// again, so chunks must not be too small.
inline constexpr std::size_t k_centre_chunk = 512;
CellCentredScan scan_centre_chunk(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours, const GateTable& limits, std::size_t begin,
                                  std::size_t end);
CellCentredScan joined(CellCentredScan all, const CellCentredScan& more);

/// Lines per chunk of scan_lines(); large enough that the cost of constructing the scans of a chunk is negligible.
inline constexpr std::size_t k_line_chunk = 512;
void fill_lines(ScanChunks<DualScan>& chunks, const HybridMesh& mesh, const GateTable& limits, const RunContext& context);
DualScan joined(DualScan all, DualScan more);

}  // namespace sterna::check_parts
