// The tags are parsed first, then the arrays of each piece.
#include "io/grammar/vtu_grid.h"

#include <algorithm>
#include <array>
#include <optional>

#include "io/grammar/vtk_cells.h"
#include "io/grammar/vtu_arrays.h"
#include "io/input/file_buffer.h"
#include "io/input/xml_tags.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_grid_type = "UnstructuredGrid";
constexpr std::string_view k_surface_type = "PolyData";

/// A section of cells and the VTK type of all its cells; 0: types are in the array "types". PolyData counts its cells in this order.
struct VtuSection {
  std::string_view name;
  int type = 0;
};
constexpr std::array<VtuSection, 5> k_sections = {{{"Cells", 0}, {"Verts", 2}, {"Lines", 4}, {"Polys", 7}, {"Strips", 6}}};

struct CellTags {
  const XmlTag* connectivity = nullptr;
  const XmlTag* offsets = nullptr;
  const XmlTag* types = nullptr;
};

/// Tags of the arrays of one piece.
struct PieceTags {
  const XmlTag* tag = nullptr;
  const XmlTag* points = nullptr;
  std::array<CellTags, k_sections.size()> cells;
  std::vector<const XmlTag*> cell_data;
};

struct VtuOutline {
  bool is_surface = false;
  std::vector<PieceTags> pieces;
  std::vector<const XmlTag*> field_data;
};

void take_array(const XmlTag& tag, std::string_view section, VtuOutline& outline) {
  if (section == "FieldData") outline.field_data.push_back(&tag);
  if (outline.pieces.empty()) return;
  PieceTags& piece = outline.pieces.back();
  if (section == "Points") piece.points = &tag;
  if (section == "CellData") piece.cell_data.push_back(&tag);
  for (std::size_t i = 0; i < k_sections.size(); ++i) {
    if (section != k_sections[i].name) continue;
    const std::string_view name = tag.attribute("Name");
    if (name == "connectivity") piece.cells[i].connectivity = &tag;
    if (name == "offsets") piece.cells[i].offsets = &tag;
    if (name == "types") piece.cells[i].types = &tag;
  }
}

bool is_section(std::string_view name) {
  if (name == "Points" || name == "CellData" || name == "PointData" || name == "FieldData") return true;
  return std::any_of(k_sections.begin(), k_sections.end(), [name](const VtuSection& section) { return section.name == name; });
}

VtuOutline outline_of(const std::vector<XmlTag>& tags, std::string_view source) {
  VtuOutline outline;
  std::string section;
  bool is_vtk = false;
  for (const XmlTag& tag : tags) {
    if (tag.name == "VTKFile") {
      is_vtk = true;
      const std::string_view type = tag.attribute("type");
      if (type != k_grid_type && type != k_surface_type)
        throw_unsupported(source, "the file holds " + quoted_excerpt(type) + ", not an UnstructuredGrid or PolyData");
      outline.is_surface = type == k_surface_type;
    } else if (tag.name == "Piece") {
      outline.pieces.emplace_back().tag = &tag;
    } else if (tag.name == "DataArray") {
      take_array(tag, section, outline);
    } else if (is_section(tag.name)) {
      section = tag.name;
    } else if (tag.name == "/" + section) {
      section.clear();
    }
  }
  if (outline.pieces.empty()) throw_malformed(source, "byte 0", "found no <Piece> of an UnstructuredGrid or PolyData");
  if (!is_vtk) throw_malformed(source, "byte 0", "found no <VTKFile>, expected a file of VTK in XML");
  return outline;
}

class PieceDecoder {
 public:
  PieceDecoder(const VtuDecoder& decoder, std::string_view source, const PieceTags& tags) : decoder_(decoder), source_(source), tags_(tags) {}

  VtkPiece decode(bool& is_single) const {
    VtkPiece piece;
    piece.where = where();
    piece.points = points(is_single);
    for (std::size_t i = 0; i < k_sections.size(); ++i) {
      const CellTags& cells = tags_.cells[i];
      if (!cells.connectivity && !cells.offsets) continue;
      VtkCells& added = piece.cells.emplace_back();
      added.type = k_sections[i].type;
      added.connectivity = integers(cells.connectivity, "connectivity");
      added.ends = integers(cells.offsets, "offsets");
      if (added.type == 0) added.types = integers(cells.types, "types");
    }
    if (piece.cells.empty() && tags_.tag->attribute("NumberOfCells", "0") != "0") fail("found no array \"connectivity\"");
    take_markers(piece);
    return piece;
  }

 private:
  std::vector<Point> points(bool& is_single) const {
    const std::string_view announced = tags_.tag->attribute("NumberOfPoints");
    if (!tags_.points && announced == "0") return {};
    const VtuValues values = array(tags_.points, "Points");
    if (values.size() % 3 != 0) fail("found " + std::to_string(values.size()) + " coordinates, not a multiple of 3");
    if (announced != std::to_string(values.size() / 3))
      fail("found " + std::to_string(values.size() / 3) + " points, expected " + std::string(announced) + " (NumberOfPoints)");
    is_single = is_single || tags_.points->attribute("type") == "Float32";
    std::vector<Point> points(values.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {values.real(3 * i), values.real(3 * i + 1), values.real(3 * i + 2)};
    return points;
  }

  VtuValues array(const XmlTag* tag, const char* what) const {
    if (!tag) fail(std::string("found no array \"") + what + "\"");
    return decoder_.decode(*tag);
  }
  VtuValues integers(const XmlTag* tag, const char* what) const {
    VtuValues values = array(tag, what);
    if (!values.is_integer()) fail(std::string("the array \"") + what + "\" is not of integers");
    return values;
  }

  void take_markers(VtkPiece& piece) const {
    for (const std::string_view name : k_vtk_marker_names) {
      for (const XmlTag* tag : tags_.cell_data) {
        if (tag->attribute("Name") != name || tag->attribute("type").starts_with("Float")) continue;
        piece.markers = decoder_.decode(*tag);
        piece.marker_name = name;
        return;
      }
    }
  }

  std::string where() const { return "piece at byte " + std::to_string(tags_.tag->offset); }
  [[noreturn]] void fail(const std::string& problem) const { throw_malformed(source_, where(), problem); }

  const VtuDecoder& decoder_;
  std::string_view source_;
  const PieceTags& tags_;
};

}  // namespace

VtkGrid read_vtu_grid(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const std::vector<XmlTag> tags = scan_xml_tags(buffer.text(), "AppendedData", buffer.source);
  const VtuOutline outline = outline_of(tags, buffer.source);
  const VtuDecoder decoder(buffer, tags, context);
  VtkGrid grid{.source = buffer.source, .is_surface = outline.is_surface};
  for (const XmlTag* tag : outline.field_data) {
    if (!tag->attribute("Name").starts_with(k_vtk_patch_prefix)) continue;
    const VtuValues values = decoder.decode(*tag);
    if (values.size() == 1 && values.is_integer()) grid.add_patch(tag->attribute("Name"), values.id(0));
  }
  for (const PieceTags& piece : outline.pieces) grid.pieces.push_back(PieceDecoder(decoder, buffer.source, piece).decode(grid.single_precision));
  return grid;
}

}  // namespace sterna::io
