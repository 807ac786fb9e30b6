#include "geom/cad/cad_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace sterna::cad {
namespace {

/// Column of the section letter in a line of an IGES file, from 0.
constexpr std::size_t k_iges_section = 72;

constexpr std::array<std::pair<std::string_view, CadFormat>, 6> k_extensions = {{{".step", CadFormat::step},
                                                                                 {".stp", CadFormat::step},
                                                                                 {".iges", CadFormat::iges},
                                                                                 {".igs", CadFormat::iges},
                                                                                 {".brep", CadFormat::brep},
                                                                                 {".egads", CadFormat::brep}}};

std::string_view first_line(std::string_view bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) return {};
  return bytes.substr(start, bytes.find_first_of("\r\n", start) - start);
}

}  // namespace

std::string_view to_string(CadFormat format) {
  switch (format) {
    case CadFormat::step: return "STEP";
    case CadFormat::iges: return "IGES";
    case CadFormat::brep: return "BREP";
  }
  return {};
}

std::optional<CadFormat> format_of_name(std::string_view file_name) {
  std::string name(file_name);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  for (const auto& [extension, format] : k_extensions)
    if (name.ends_with(extension)) return format;
  return std::nullopt;
}

std::optional<CadFormat> format_of_bytes(std::string_view bytes) {
  const std::string_view line = first_line(bytes);
  if (line.starts_with("ISO-10303-21")) return CadFormat::step;
  if (line.starts_with("DBRep_DrawableShape") || line.starts_with("CASCADE Topology")) return CadFormat::brep;
  if (bytes.size() > k_iges_section && bytes[k_iges_section] == 'S' && bytes.substr(0, k_iges_section).find_first_of("\r\n") == std::string_view::npos)
    return CadFormat::iges;
  return std::nullopt;
}

}  // namespace sterna::cad
