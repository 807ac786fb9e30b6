// Writes VTU files of any content. They consist of named arrays, which are generated block by block, compressed in parallel and appended raw
// (docs/method/formats.md, "VTU and VTP").
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/borrowed.h"
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

/// Compression of arrays. zlib is smallest and most widely supported; LZ4 compresses several times faster (meshio does not read it); none is fastest.
enum class VtuPacking { zlib, lz4, none };
/// Returns the compression from the name: x.raw.vtu none, x.lz4.vtu LZ4, others zlib.
VtuPacking vtu_packing(const std::filesystem::path& path);

/// VTK data set type: cells of any kind (.vtu), or a surface of polygons (.vtp).
enum class VtuKind { unstructured_grid, poly_data };

/// A grid with one piece.
struct VtuDocument {
  VtuKind kind = VtuKind::unstructured_grid;
  std::uint64_t n_points = 0;
  std::uint64_t n_cells = 0;
  VtuArray points;                        ///< 3 components
  VtuArray connectivity, offsets, types;  ///< nodes in VTK order, end position of each cell, VTK types (types are not used for PolyData)
  std::vector<VtuArray> point_data;
  std::vector<VtuArray> cell_data;
  std::vector<std::pair<std::string, std::int32_t>> field_data;  ///< single numbers by name
  VtuPacking packing = VtuPacking::zlib;
};

/// Returns an array over values.
VtuArray vtu_array(std::string name, Borrowed<const std::vector<std::int32_t>> values);

/// Writes binary appended data, compressed as specified in the document (zlib: level k_zlib_level), little endian, UInt64 headers. The bytes do not depend on
/// the number of threads.
/// \throws Error write_failed, cancelled, and errors of fill functions.
void write_vtu(const VtuDocument& document, const std::filesystem::path& path, const RunContext& context);

/// The fastest level, which shrinks a mesh to about 40 %. Level 6 gains a few percent more and takes five times as long.
inline constexpr int k_zlib_level = 1;
/// Bytes per compressed block; a multiple of 24, so that points and values do not cross block boundaries.
inline constexpr std::size_t k_vtu_block = 3u << 19;

}  // namespace sterna::io
