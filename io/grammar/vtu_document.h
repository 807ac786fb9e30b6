// VTU files of any content: named arrays, made on the fly block by block, compressed by all threads, appended raw (docs/method/formats.md, "VTU and VTP").
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"

namespace sterna::io {

enum class VtuType { uint8, int32, int64, float32, float64 };

/// One DataArray. `fill` writes the values [begin, end) (counted over all components) to `out`; called from any thread.
struct VtuArray {
  std::string name;
  VtuType type = VtuType::int32;
  int n_components = 1;
  std::uint64_t n_values = 0;
  std::function<void(std::uint64_t begin, std::uint64_t end, char* out)> fill;
};

/// How arrays are packed. zlib is smallest and read by all; LZ4 is packed several times faster (meshio does not read it); none is fastest.
enum class VtuPacking { zlib, lz4, none };
/// From the name: x.raw.vtu none, x.lz4.vtu LZ4, others zlib.
VtuPacking vtu_packing(const std::filesystem::path& path);

/// What a file is to VTK: cells of any kind (.vtu), or a surface of polygons (.vtp).
enum class VtuKind { unstructured_grid, poly_data };

/// A grid of one piece.
struct VtuDocument {
  VtuKind kind = VtuKind::unstructured_grid;
  std::uint64_t n_points = 0;
  std::uint64_t n_cells = 0;
  VtuArray points;                        ///< 3 components
  VtuArray connectivity, offsets, types;  ///< VTK node order, end positions, VTK numbers (not of PolyData)
  std::vector<VtuArray> point_data;
  std::vector<VtuArray> cell_data;
  std::vector<std::pair<std::string, std::int32_t>> field_data;  ///< single numbers by name
  VtuPacking packing = VtuPacking::zlib;
};

/// An array over values that live as long as the document.
VtuArray vtu_array(std::string name, const std::vector<std::int32_t>& values);

/// Binary appended, packed as the document says (zlib: level k_zlib_level), little endian, UInt64 headers. Same bytes for any number of threads.
/// \throws Error write_failed, cancelled, and what a fill function throws.
void write_vtu(const VtuDocument& document, const std::filesystem::path& path, const RunContext& context);

/// Fastest level: a mesh shrinks to about 40 %; level 6 gains a few percent more for five times the time.
inline constexpr int k_zlib_level = 1;
/// Bytes per compressed block; a multiple of 24, so that points and values do not straddle blocks.
inline constexpr std::size_t k_vtu_block = 3u << 19;

}  // namespace sterna::io
