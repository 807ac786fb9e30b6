// A file has an XML head with the offset of each array, then the arrays. Each array has a header of block sizes, then the compressed blocks. Sizes and offsets
// are known only after compression: space is reserved for them and filled in when the arrays are written.
#include "io/grammar/vtu_document.h"

#include <lz4.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <limits>

#include "geom/base/error.h"
#include "io/input/xml_tags.h"
#include "io/output/atomic_file.h"
#include "io/output/ordered_output.h"

namespace sterna::io {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are in memory");

std::size_t size_of(VtuType type) {
  switch (type) {
    case VtuType::uint8: return 1;
    case VtuType::int32:
    case VtuType::float32: return 4;
    case VtuType::int64:
    case VtuType::float64: return 8;
  }
  return 0;
}

std::string_view name_of(VtuType type) {
  switch (type) {
    case VtuType::uint8: return "UInt8";
    case VtuType::int32: return "Int32";
    case VtuType::int64: return "Int64";
    case VtuType::float32: return "Float32";
    case VtuType::float64: return "Float64";
  }
  return "";
}

/// Returns all arrays of a document in file order.
std::vector<const VtuArray*> arrays_of(const VtuDocument& document) {
  std::vector<const VtuArray*> arrays = {&document.points, &document.connectivity, &document.offsets};
  if (document.kind == VtuKind::unstructured_grid) arrays.push_back(&document.types);
  for (const VtuArray& array : document.point_data) arrays.push_back(&array);
  for (const VtuArray& array : document.cell_data) arrays.push_back(&array);
  return arrays;
}

std::string_view compressor_attribute(VtuPacking packing) {
  switch (packing) {
    case VtuPacking::zlib: return " compressor=\"vtkZLibDataCompressor\"";
    case VtuPacking::lz4: return " compressor=\"vtkLZ4DataCompressor\"";
    case VtuPacking::none: break;
  }
  return "";
}

std::string head(const VtuDocument& document, const std::vector<std::uint64_t>& offsets) {
  std::size_t next = 0;
  const auto array_tag = [&](const VtuArray& array) {
    return "<DataArray type=\"" + std::string(name_of(array.type)) + "\" Name=\"" + xml_escaped(array.name) + "\"" +
           (array.n_components > 1 ? " NumberOfComponents=\"" + std::to_string(array.n_components) + "\"" : "") + " format=\"appended\" offset=\"" +
           std::to_string(offsets[next++]) + "\"/>\n";
  };
  const bool is_surface = document.kind == VtuKind::poly_data;
  const std::string kind = is_surface ? "PolyData" : "UnstructuredGrid";
  const std::string cells = is_surface ? "Polys" : "Cells";
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind + "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"" +
                     std::string(compressor_attribute(document.packing)) + ">\n<" + kind + ">\n";
  if (!document.field_data.empty()) {
    text += "<FieldData>\n";
    for (const auto& [name, value] : document.field_data)
      text += "<DataArray type=\"Int32\" Name=\"" + xml_escaped(name) + "\" NumberOfTuples=\"1\" format=\"ascii\">" + std::to_string(value) + "</DataArray>\n";
    text += "</FieldData>\n";
  }
  text += "<Piece NumberOfPoints=\"" + std::to_string(document.n_points) + "\" NumberOf" + cells + "=\"" + std::to_string(document.n_cells) + "\">\n";
  text += "<Points>\n" + array_tag(document.points) + "</Points>\n";
  text += "<" + cells + ">\n" + array_tag(document.connectivity);
  text += array_tag(document.offsets);
  if (!is_surface) text += array_tag(document.types);
  text += "</" + cells + ">\n";
  if (!document.point_data.empty()) {
    text += "<PointData>\n";
    for (const VtuArray& array : document.point_data) text += array_tag(array);
    text += "</PointData>\n";
  }
  text += "<CellData>\n";
  for (const VtuArray& array : document.cell_data) text += array_tag(array);
  text += "</CellData>\n</Piece>\n</" + kind + ">\n";
  return text;
}

void pack_zlib(const VtuArray& array, const char* raw, std::size_t n_bytes, ByteBuffer& out) {
  uLongf n_packed = compressBound(static_cast<uLong>(n_bytes));
  char* const location = out.reserve(n_packed);
  const int state = compress2(reinterpret_cast<Bytef*>(location), &n_packed, reinterpret_cast<const Bytef*>(raw), static_cast<uLong>(n_bytes), k_zlib_level);
  if (state != Z_OK)
    throw Error({.code = ErrorCode::internal, .attempted = "compressing the array " + array.name, .problem = "zlib answers " + std::to_string(state)});
  out.end_at(location + n_packed);
}

/// Compresses to a raw LZ4 block, not a frame. \pre n_bytes <= k_vtu_block, far below LZ4's limit of 2 GB
void pack_lz4(const char* raw, std::size_t n_bytes, ByteBuffer& out) {
  const int n_most = LZ4_compressBound(static_cast<int>(n_bytes));
  char* const location = out.reserve(static_cast<std::size_t>(n_most));
  out.end_at(location + LZ4_compress_default(raw, location, static_cast<int>(n_bytes), n_most));
}

void compress_block(const VtuArray& array, VtuPacking packing, std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
  const std::size_t n_bytes = (end - begin) * size_of(array.type);
  if (packing == VtuPacking::none) {
    char* const location = out.reserve(n_bytes);
    array.fill(begin, end, location);
    out.end_at(location + n_bytes);
    return;
  }
  const auto raw = std::make_unique_for_overwrite<char[]>(n_bytes);
  array.fill(begin, end, raw.get());
  if (packing == VtuPacking::lz4) pack_lz4(raw.get(), n_bytes, out);
  else pack_zlib(array, raw.get(), n_bytes, out);
}

/// Appends an array. With packing it is "[number of blocks][block size][size of a shorter last block or 0][packed sizes]", then the blocks; without packing the
/// number of bytes, then the bytes.
void append_array(AtomicFile& file, const VtuArray& array, VtuPacking packing, const RunContext& context) {
  const std::uint64_t per_block = k_vtu_block / size_of(array.type);
  const std::uint64_t n_blocks = (array.n_values + per_block - 1) / per_block;
  std::vector<std::uint64_t> header(3 + n_blocks, 0);
  header[0] = n_blocks;
  header[1] = k_vtu_block;
  header[2] = array.n_values % per_block * size_of(array.type);
  if (packing == VtuPacking::none) header.assign(1, array.n_values * size_of(array.type));
  const auto header_bytes = [&] { return std::string_view(reinterpret_cast<const char*>(header.data()), header.size() * sizeof(header[0])); };
  const std::uint64_t header_location = file.size();
  file.append(header_bytes());
  write_ordered(
      file, n_blocks,
      [&](std::size_t block, ByteBuffer& out) {
        compress_block(array, packing, block * per_block, std::min((block + 1) * per_block, array.n_values), out);
        if (packing != VtuPacking::none) header[3 + block] = out.size();
      },
      context);
  file.overwrite(header_location, header_bytes());
}

}  // namespace

VtuPacking vtu_packing(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".raw.vtu")) return VtuPacking::none;
  return name.ends_with(".lz4.vtu") ? VtuPacking::lz4 : VtuPacking::zlib;
}

VtuArray vtu_array(std::string name, Borrowed<const std::vector<std::int32_t>> borrowed) {
  const std::vector<std::int32_t>& values = borrowed;
  return {.name = std::move(name), .type = VtuType::int32, .n_values = values.size(), .fill = [&values](std::uint64_t begin, std::uint64_t end, char* out) {
            std::memcpy(out, values.data() + begin, (end - begin) * sizeof(values[0]));
          }};
}

void write_vtu(const VtuDocument& document, const std::filesystem::path& path, const RunContext& context) {
  const std::vector<const VtuArray*> arrays = arrays_of(document);
  std::vector<std::uint64_t> offsets(arrays.size(), std::numeric_limits<std::uint64_t>::max());
  const std::size_t n_head = head(document, offsets).size();
  AtomicFile file(path);
  file.append(std::string(n_head, ' '));
  file.append("<AppendedData encoding=\"raw\">\n_");
  const std::uint64_t data_begin = file.size();
  double n_bytes_in_all = 1.0;
  for (const VtuArray* array : arrays) n_bytes_in_all += static_cast<double>(array->n_values * size_of(array->type));
  double n_bytes = 0.0;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    offsets[i] = file.size() - data_begin;
    const double n_after = n_bytes + static_cast<double>(arrays[i]->n_values * size_of(arrays[i]->type));
    append_array(file, *arrays[i], document.packing, context.part(arrays[i]->name, n_bytes / n_bytes_in_all, n_after / n_bytes_in_all));
    n_bytes = n_after;
  }
  file.append("\n</AppendedData>\n</VTKFile>\n");
  std::string text = head(document, offsets);
  text.resize(n_head, ' ');  // blanks between tags are ignored
  file.overwrite(0, text);
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
