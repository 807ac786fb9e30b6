#include "io/field/point_field.h"

#include <cmath>

#include "geom/base/error.h"
#include "io/grammar/vtu_arrays.h"

namespace sterna::io {
namespace {

struct Piece {
  const XmlTag* points = nullptr;
  const XmlTag* values = nullptr;
};

struct FieldOutline {
  std::vector<Piece> pieces;
  std::string names;  ///< names of all point data arrays, for the message
};

FieldOutline outline_of(const std::vector<XmlTag>& tags, const std::string& name) {
  FieldOutline outline;
  std::string section;
  for (const XmlTag& tag : tags) {
    if (tag.name == "Piece") outline.pieces.emplace_back();
    if (tag.name == "Points" || tag.name == "Cells" || tag.name == "CellData" || tag.name == "PointData" || tag.name == "FieldData") section = tag.name;
    if (tag.name != "DataArray" || outline.pieces.empty()) continue;
    if (section == "Points") outline.pieces.back().points = &tag;
    if (section != "PointData") continue;
    if (tag.attribute("Name") == name) outline.pieces.back().values = &tag;
    if (outline.pieces.size() == 1) outline.names += (outline.names.empty() ? "\"" : ", \"") + std::string(tag.attribute("Name")) + "\"";
  }
  return outline;
}

}  // namespace

PointField read_point_field(const std::filesystem::path& path, const std::string& name, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const std::vector<XmlTag> tags = scan_xml_tags(buffer.text(), "AppendedData", buffer.source);
  const FieldOutline outline = outline_of(tags, name);
  const VtuDecoder decoder(buffer, tags, context);
  PointField field;
  for (const Piece& piece : outline.pieces) {
    if (!piece.points) throw_malformed(buffer.source, "a piece", "found no array \"Points\"");
    const std::string where = "piece at byte " + std::to_string(piece.points->offset);
    const VtuValues coordinates = decoder.decode(*piece.points);
    const std::size_t n = coordinates.size() / 3;
    if (n == 0) continue;
    if (!piece.values)
      throw_malformed(buffer.source, where, "found no point data \"" + name + "\", available: " + (outline.names.empty() ? "none" : outline.names));
    const VtuValues values = decoder.decode(*piece.values);
    if (values.size() != n)
      throw_malformed(buffer.source, where, "found " + std::to_string(values.size()) + " values of \"" + name + "\" for " + std::to_string(n) + " points");
    for (std::size_t i = 0; i < n; ++i) {
      field.points.push_back({coordinates.real(3 * i), coordinates.real(3 * i + 1), coordinates.real(3 * i + 2)});
      field.values.push_back(values.real(i));
      if (!is_finite(field.points.back()) || !std::isfinite(field.values.back()))
        throw_malformed(buffer.source, where, "point " + std::to_string(i) + " or its value is not finite");
    }
  }
  if (field.points.empty()) throw_malformed(buffer.source, "byte 0", "found no points");
  return field;
}

}  // namespace sterna::io
