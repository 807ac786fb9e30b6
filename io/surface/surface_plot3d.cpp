// A file has the number of blocks, the three dimensions of each, then for each block all x, all y, all z. It is text or binary of either byte order, the latter
// with or without Fortran record sizes. The variant is derived from the first numbers and the size of the file.
#include "io/surface/surface_plot3d.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "io/input/byte_reader.h"
#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_grid.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_probed_plot3d_bytes = 256;
constexpr std::uint32_t k_count_record = 4;  // bytes of a record with one integer
constexpr std::string_view k_cut_hint = "the file may have been cut short: copy or write it again";

/// A block as a network of points. The index that is constant in the block is left out.
struct GridBlock {
  std::uint64_t n_points = 0, n_lines = 0;
  std::uint64_t size() const { return n_points * n_lines; }
};

/// Returns the block as a grid; nullopt for a block that is not a surface. Dimensions are positive.
std::optional<GridBlock> block_of(const std::array<std::uint64_t, 3>& n) {
  if (n[2] == 1) return GridBlock{n[0], n[1]};
  if (n[1] == 1) return GridBlock{n[0], n[2]};
  if (n[0] == 1) return GridBlock{n[1], n[2]};
  return std::nullopt;
}

[[noreturn]] void throw_volume(const std::string& source, std::size_t block, const std::array<std::uint64_t, 3>& n) {
  throw_unsupported(source,
                    "block " + std::to_string(block + 1) + " is a volume of " + std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " +
                        std::to_string(n[2]) + " points",
                    "only surfaces, with one dimension of 1, are read");
}

/// Adds a block; axis(a) returns coordinate a of the next point.
template <class Next>
void add_block(SurfaceBuilder& builder, std::size_t number, const GridBlock& block, const RunContext& context, const Next& next) {
  std::vector<Vec3> points(block.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i % k_stop_interval == 0) context.check_stop();
      points[i][axis] = next();
    }
  }
  const auto first = static_cast<std::uint32_t>(builder.n_points());
  for (const Vec3& p : points) builder.add_point(p);
  builder.set_patch(numbered_patch(static_cast<std::int64_t>(number) + 1));
  add_network(builder, first, block.n_points, block.n_lines);
}

SurfaceSoup finished(SurfaceBuilder& builder, std::size_t n_blocks, const RunContext& context) {
  SurfaceSoup soup = builder.finish(context);
  soup.has_names = n_blocks > 1;
  return soup;
}

// ---- text

SurfaceSoup read_text_blocks(const FileBuffer& buffer, const RunContext& context) {
  constexpr std::size_t k_min_block_bytes = 6;  // three dimensions
  TextScanner scanner(buffer);
  const std::size_t n_blocks = scanner.count("the number of blocks", k_min_block_bytes);
  if (n_blocks == 0) scanner.fail_expected("1 or more blocks");
  std::vector<GridBlock> blocks;
  for (std::size_t i = 0; i < n_blocks; ++i) {
    std::array<std::uint64_t, 3> n;
    for (std::uint64_t& dimension : n) {
      dimension = scanner.count("a dimension of a block", 1);
      if (dimension == 0) scanner.fail_expected("a dimension of 1 or more");
    }
    const std::optional<GridBlock> block = block_of(n);
    if (!block) throw_volume(buffer.source, i, n);
    blocks.push_back(*block);
  }
  SurfaceBuilder builder(buffer.source);
  for (std::size_t i = 0; i < n_blocks; ++i) {
    constexpr std::size_t k_min_point_bytes = 6;
    if (blocks[i].n_points > (scanner.remaining() + 1) / k_min_point_bytes / blocks[i].n_lines)
      scanner.fail("the file ends before the " + std::to_string(blocks[i].size()) + " points of block " + std::to_string(i + 1), k_cut_hint);
    add_block(builder, i, blocks[i], context, [&] { return scanner.coordinate("a coordinate"); });
  }
  if (!scanner.at_end()) scanner.fail("found more after the last of " + std::to_string(n_blocks) + " blocks, expected the end of the file");
  return finished(builder, n_blocks, context);
}

// ---- bytes

class BinaryReader {
 public:
  BinaryReader(const FileBuffer& buffer, std::endian order, bool has_records, const RunContext& context)
      : buffer_(buffer), reader_(buffer, order), has_records_(has_records), context_(context) {}

  SurfaceSoup read() {
    take_dimensions();
    SurfaceBuilder builder(buffer_.source);
    if (!has_records_) precision_ = precision_of(reader_.remaining(), total_points_);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const std::uint64_t n = blocks_[i].size();
      if (has_records_) precision_ = precision_of(begin_record(), n);
      reader_.require(n, bytes_per_point(), "points of block " + std::to_string(i + 1));
      add_block(builder, i, blocks_[i], context_, [this] { return coordinate(); });
      for (std::uint64_t k = 0; precision_.has_blanks && k < n; ++k) n_blank_ += reader_.take<std::int32_t>() == 0 ? 1 : 0;
      if (has_records_) end_record();
    }
    if (reader_.remaining() > 0)
      reader_.fail("found " + std::to_string(reader_.remaining()) + " bytes after the last of " + std::to_string(blocks_.size()) +
                   " blocks, expected the end of the file");
    if (n_blank_ > 0)
      context_.warn(buffer_.source + ": " + std::to_string(n_blank_) +
                    " points are blanked (iblank = 0); their faces are read like all other faces, so that blanked holes are closed");
    SurfaceSoup soup = finished(builder, blocks_.size(), context_);
    soup.single_precision = precision_.real_bytes == sizeof(float);
    return soup;
  }

 private:
  struct Precision {
    std::size_t real_bytes = sizeof(double);
    bool has_blanks = false;
  };

  void take_dimensions() {
    if (has_records_) begin_record();
    const std::int32_t n_blocks = reader_.read<std::int32_t>("the number of blocks");
    if (has_records_) end_record();
    if (n_blocks < 1) reader_.fail("found " + std::to_string(n_blocks) + " blocks before this byte, expected 1 or more");
    if (has_records_) begin_record();
    reader_.require(static_cast<std::uint64_t>(n_blocks), 3 * sizeof(std::int32_t), "dimensions of the blocks");
    for (std::int32_t i = 0; i < n_blocks; ++i) {
      std::array<std::uint64_t, 3> n;
      for (std::uint64_t& dimension : n) {
        const std::int32_t value = reader_.take<std::int32_t>();
        if (value < 1)
          reader_.fail("found the dimension " + std::to_string(value) + " of block " + std::to_string(i + 1) + " before this byte, expected 1 or more");
        dimension = static_cast<std::uint64_t>(value);
      }
      const std::optional<GridBlock> block = block_of(n);
      if (!block) throw_volume(buffer_.source, static_cast<std::size_t>(i), n);
      if (block->size() > buffer_.bytes.size() / (3 * sizeof(float)))
        reader_.fail("block " + std::to_string(i + 1) + " has " + std::to_string(block->size()) + " points, more than the file can hold", k_cut_hint);
      blocks_.push_back(*block);
      total_points_ += block->size();
    }
    if (has_records_) end_record();
  }

  /// Returns the precision of the reals from the number of bytes for n points.
  Precision precision_of(std::uint64_t n_bytes, std::uint64_t n) const {
    for (const std::size_t real : {sizeof(double), sizeof(float)})
      for (const bool has_blanks : {false, true})
        if (n_bytes % n == 0 && n_bytes / n == 3 * real + (has_blanks ? sizeof(std::int32_t) : 0)) return {real, has_blanks};
    reader_.fail("found " + std::to_string(n_bytes) + " bytes for " + std::to_string(n) + " points, expected 12, 16, 24 or 28 for each", k_cut_hint);
  }
  std::size_t bytes_per_point() const { return 3 * precision_.real_bytes + (precision_.has_blanks ? sizeof(std::int32_t) : 0); }

  double coordinate() { return precision_.real_bytes == sizeof(double) ? reader_.take<double>() : static_cast<double>(reader_.take<float>()); }

  std::uint32_t begin_record() {
    record_bytes_ = reader_.read<std::uint32_t>("the size of a record");
    reader_.require(record_bytes_, 1, "a record");
    record_end_ = reader_.offset() + record_bytes_;
    return record_bytes_;
  }
  void end_record() {
    if (reader_.offset() != record_end_ || reader_.read<std::uint32_t>("the size of the record again") != record_bytes_)
      reader_.fail("the record of " + std::to_string(record_bytes_) + " bytes before this byte has another size");
  }

  const FileBuffer& buffer_;
  ByteReader reader_;
  bool has_records_;
  const RunContext& context_;
  std::vector<GridBlock> blocks_;
  std::uint64_t total_points_ = 0, n_blank_ = 0;
  Precision precision_;
  std::uint32_t record_bytes_ = 0;
  std::size_t record_end_ = 0;
};

SurfaceSoup read_bytes(const FileBuffer& buffer, const RunContext& context) {
  constexpr std::size_t k_min_bytes = 4 * sizeof(std::int32_t);
  if (buffer.bytes.size() < k_min_bytes)
    throw_malformed(buffer.source, "byte 0", "found " + std::to_string(buffer.bytes.size()) + " bytes, expected a number of blocks and their dimensions",
                    k_cut_hint);
  for (const std::endian order : {std::endian::little, std::endian::big})
    if (ByteReader(buffer, order).take<std::uint32_t>() == k_count_record &&
        ByteReader(buffer, order, 2 * sizeof(std::uint32_t)).take<std::uint32_t>() == k_count_record)
      return BinaryReader(buffer, order, true, context).read();
  // The number of blocks is small, so the byte order that gives the smaller number is that of the file.
  const bool is_little = ByteReader(buffer, std::endian::little).take<std::uint32_t>() <= ByteReader(buffer, std::endian::big).take<std::uint32_t>();
  return BinaryReader(buffer, is_little ? std::endian::little : std::endian::big, false, context).read();
}

bool is_text(std::string_view text) {
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(text.size(), k_probed_plot3d_bytes)),
                     [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t'; });
}

}  // namespace

SurfaceSoup read_plot3d(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return is_text(buffer.text()) ? read_text_blocks(buffer, context) : read_bytes(buffer, context);
}

}  // namespace sterna::io
