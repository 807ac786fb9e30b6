// The scans of check_ahead(), chunk by chunk, so that those around lines that move can be made anew. Private to the check_*.cpp and dual_*.cpp files.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/mesh/cell_centred.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// What a scan has found in each chunk of its items. Copies share it.
template <class Scan>
class ScanChunks {
 public:
  ScanChunks(std::size_t n, std::size_t chunk) : n_(n), chunk_(chunk), parts_((n + chunk - 1) / chunk) {}

  /// Forgets the chunks that have these items.
  void forget(std::span<const std::uint32_t> items) {
    for (const std::uint32_t item : items) parts_[item / chunk_].reset();
  }
  /// map(begin, end) -> Scan for each chunk that is not known; parallel.
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
  /// all = combine(all, part), from the first chunk to the last: what parallel_reduce gives for the same chunks.
  /// \pre filled
  template <class Combine>
  Scan joined(Scan all, const Combine& combine) const {
    for (const std::shared_ptr<const Scan>& part : parts_) all = combine(std::move(all), Scan(*part));
    return all;
  }

 private:
  std::size_t n_, chunk_;
  std::vector<std::shared_ptr<const Scan>> parts_;
};

/// Columns per chunk of scan_columns(); each holds some 30 cells.
inline constexpr std::size_t k_column_chunk = 64;
CellScan scan_column_chunk(const HybridMesh& mesh, bool with_quality, const GateTable& limits, std::size_t begin, std::size_t end);
CellScan joined(CellScan all, CellScan more);

/// Columns per chunk of scan_column_centres(). Their places are held together; those of columns beyond are found again, so that chunks are not too small.
inline constexpr std::size_t k_centre_chunk = 512;
CellCentredScan scan_centre_chunk(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours, const GateTable& limits, std::size_t begin,
                                  std::size_t end);
CellCentredScan joined(CellCentredScan all, const CellCentredScan& more);

/// Lines per chunk of scan_lines(); large enough that making the scans of a chunk does not count.
inline constexpr std::size_t k_line_chunk = 512;
void fill_lines(ScanChunks<DualScan>& chunks, const HybridMesh& mesh, const GateTable& limits, const RunContext& context);
DualScan joined(DualScan all, DualScan more);

}  // namespace sterna::check_parts
