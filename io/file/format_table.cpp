#include "io/file/format_table.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "geom/base/error.h"
#include "io/input/file_buffer.h"
#include "io/input/text_scanner.h"
#include "io/names/edge_conditions.h"
#include "io/names/names_file.h"
#include "io/names/tau_mapping.h"
#include "io/surface/surface_cart3d.h"
#include "io/surface/surface_cgns.h"
#include "io/surface/surface_dwfs.h"
#include "io/surface/surface_msh.h"
#include "io/surface/surface_nastran.h"
#include "io/surface/surface_obj.h"
#include "io/surface/surface_off.h"
#include "io/surface/surface_plot3d.h"
#include "io/surface/surface_ply.h"
#include "io/surface/surface_stl.h"
#include "io/surface/surface_su2.h"
#include "io/surface/surface_tau.h"
#include "io/surface/surface_tetgen.h"
#include "io/surface/surface_ugrid.h"
#include "io/surface/surface_vtk.h"
#include "io/surface/surface_vtkhdf.h"
#include "io/surface/surface_vtu.h"
#include "io/surface/surface_wgs.h"
#include "io/surface/surface_zml.h"
#include "io/volume/fluent.h"
#include "io/volume/medit.h"
#include "io/volume/sterna_file.h"
#include "io/volume/volume_cgns.h"
#include "io/volume/volume_edge.h"
#include "io/volume/volume_foam.h"
#include "io/volume/volume_msh.h"
#include "io/volume/volume_su2.h"
#include "io/volume/volume_tau.h"
#include "io/volume/volume_ugrid.h"
#include "io/volume/volume_vtkhdf.h"
#include "io/volume/volume_vtu.h"

namespace sterna::io {
namespace {

bool is_xml(std::string_view head) { return head.substr(std::min(head.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), head.size())).starts_with('<'); }
bool is_gmsh(std::string_view head) { return head.find("$MeshFormat") != std::string_view::npos; }
/// Returns true if the head contains the data set keyword in upper or lower case.
bool has_data_set(std::string_view head, std::string_view upper, std::string_view lower) {
  return head.find(upper) != std::string_view::npos || head.find(lower) != std::string_view::npos;
}
bool is_vtk_surface(std::string_view head) { return has_data_set(head, "DATASET POLYDATA", "dataset polydata"); }
bool is_vtk_grid(std::string_view head) { return has_data_set(head, "DATASET UNSTRUCTURED_GRID", "dataset unstructured_grid"); }
/// Returns true if the head is an S-expression.
bool is_fluent(std::string_view head) {
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && head[first] == '(';
}

/// Returns the existing file of .aboc and .bboc.
std::filesystem::path edge_kinds_path(const std::filesystem::path& path) {
  const std::filesystem::path text = edge_conditions_path(path);
  std::filesystem::path binary = text;
  binary.replace_extension(".bboc");
  std::error_code ignored;  // if the file cannot be accessed
  return std::filesystem::exists(text, ignored) ? text : binary;
}

// One line per format; the order matters where extensions are shared.
constexpr std::array k_formats = {
    Format{.name = "STL", .extensions = ".stl", .read_surface = read_stl, .write_surface = write_stl, .carries_patch_names = true},
    Format{.name = "STL binary", .extensions = ".stl", .write_surface = write_stl_binary},
    Format{.name = "STL text", .extensions = ".stl", .write_surface = write_stl_text, .carries_patch_names = true},
    Format{.name = "OBJ", .extensions = ".obj", .read_surface = read_obj, .write_surface = write_obj, .carries_patch_names = true},
    Format{.name = "OFF", .extensions = ".off", .read_surface = read_off, .write_surface = write_off},
    Format{.name = "PLY", .extensions = ".ply", .read_surface = read_ply, .write_surface = write_ply, .carries_patch_names = true},
    Format{.name = "Gmsh MSH",
           .extensions = ".msh .bin.msh",
           .is_content = is_gmsh,
           .read_surface = read_msh,
           .write_surface = write_msh,
           .read_volume = read_volume_msh,
           .write_volume = write_volume_msh,
           .carries_patch_names = true},
    Format{.name = "Gmsh MSH 2.2", .extensions = ".msh", .write_surface = write_msh_2_2, .carries_patch_names = true},
    Format{.name = "Fluent",
           .extensions = ".msh .fluent.msh",
           .is_content = is_fluent,
           .read_surface = read_surface_fluent,
           .read_volume = read_volume_fluent,
           .write_volume = write_volume_fluent,
           .carries_patch_names = true,
           .carries_patch_kinds = true,
           .consumers = k_cell_centred_alone,
           .write_numbered = write_numbered_fluent},
    Format{.name = "Medit",
           .extensions = ".mesh .meshb",
           .read_surface = read_surface_medit,
           .write_surface = write_surface_medit,
           .read_volume = read_volume_medit,
           .write_volume = write_volume_medit,
           .carries_patch_names = true,
           .kinds_beside = names_path},
    Format{.name = "dwfs", .extensions = ".msh", .is_content = is_xml, .read_surface = read_dwfs, .write_surface = write_dwfs, .carries_patch_names = true},
    Format{.name = "UGRID",
           .extensions = ".lb8.ugrid .b8.ugrid .lb8l.ugrid .b8l.ugrid .lb4.ugrid .b4.ugrid .ugrid",
           .read_surface = read_ugrid,
           .write_surface = write_ugrid,
           .read_volume = read_volume_ugrid,
           .write_volume = write_volume_ugrid,
           .carries_patch_names = true,
           .kinds_beside = ugrid_kinds_path},
    Format{.name = "CGNS",
           .extensions = ".cgns .adf.cgns",
           .read_surface = read_cgns,
           .write_surface = write_cgns,
           .read_volume = read_volume_cgns,
           .write_volume = write_volume_cgns,
           .carries_patch_names = true,
           .carries_patch_kinds = true},
    Format{.name = "TAU",
           .extensions = ".taumesh .grid .netcdf .nc",
           .read_surface = read_tau,
           .write_surface = write_tau,
           .read_volume = read_volume_tau,
           .write_volume = write_volume_tau,
           .carries_patch_names = true,
           .kinds_beside = bmap_path,
           .consumers = k_node_centred_alone},
    Format{.name = "SU2",
           .extensions = ".su2",
           .read_surface = read_su2,
           .write_surface = write_su2,
           .read_volume = read_volume_su2,
           .write_volume = write_volume_su2,
           .carries_patch_names = true,
           .consumers = k_node_centred_alone},
    Format{.name = "VTKHDF",
           .extensions = ".vtkhdf .hdf",
           .read_surface = read_surface_vtkhdf,
           .write_surface = write_surface_vtkhdf,
           .read_volume = read_volume_vtkhdf,
           .write_volume = write_volume_vtkhdf,
           .carries_patch_names = true,
           .carries_patch_kinds = true},
    Format{.name = "VTU",
           .extensions = ".vtu",
           .read_surface = read_surface_vtu,
           .write_surface = write_surface_vtu,
           .read_volume = read_volume_vtu,
           .write_volume = write_volume_vtu,
           .carries_patch_names = true,
           .carries_patch_kinds = true},
    Format{.name = "VTK",
           .extensions = ".vtk",
           .is_content = is_vtk_surface,
           .read_surface = read_surface_vtk,
           .write_surface = write_surface_vtk,
           .carries_patch_names = true},
    Format{.name = "VTK grid",
           .extensions = ".vtk",
           .is_content = is_vtk_grid,
           .read_surface = read_surface_vtk,
           .read_volume = read_volume_vtk,
           .carries_patch_names = true,
           .carries_patch_kinds = true},
    Format{.name = "VTK text", .extensions = ".vtk", .write_surface = write_surface_vtk_text, .carries_patch_names = true},
    Format{.name = "VTP", .extensions = ".vtp", .read_surface = read_surface_vtu, .write_surface = write_surface_vtp, .carries_patch_names = true},
    Format{.name = "Nastran", .extensions = ".nas .bdf", .read_surface = read_nastran, .write_surface = write_nastran, .carries_patch_names = true},
    Format{.name = "Cart3D", .extensions = ".tri .triq", .read_surface = read_cart3d, .write_surface = write_cart3d, .carries_patch_names = true},
    Format{.name = "Cart3D binary", .extensions = ".bin.tri", .read_surface = read_cart3d, .write_surface = write_cart3d_binary, .carries_patch_names = true},
    Format{.name = "TetGen smesh", .extensions = ".smesh", .read_surface = read_tetgen, .write_surface = write_smesh, .carries_patch_names = true},
    Format{.name = "TetGen poly", .extensions = ".poly", .read_surface = read_tetgen, .write_surface = write_poly, .carries_patch_names = true},
    Format{.name = "zml", .extensions = ".zml", .read_surface = read_zml, .carries_patch_names = true},
    Format{.name = "LaWGS", .extensions = ".wgs", .read_surface = read_wgs, .carries_patch_names = true},
    Format{.name = "PLOT3D", .extensions = ".fmt .xyz .p3d", .read_surface = read_plot3d},
    Format{.name = "sterna",
           .extensions = ".sterna",
           .read_surface = read_surface_sterna,
           .write_surface = write_surface_sterna,
           .read_volume = read_volume_sterna,
           .write_volume = write_volume_sterna,
           .carries_patch_names = true,
           .carries_patch_kinds = true},
    Format{.name = "OpenFOAM",
           .extensions = ".foam .text.foam polymesh",
           .read_volume = read_volume_foam,
           .write_volume = write_volume_foam,
           .carries_patch_names = true,
           .files = polymesh_files,
           .require_output = require_foam_location,
           .carries_patch_kinds = true,
           .consumers = k_cell_centred_alone,
           .write_numbered = write_numbered_foam},
    Format{.name = "Edge",
           .extensions = ".bmsh .v2.bmsh",
           .read_volume = read_volume_edge,
           .write_volume = write_volume_edge,
           .carries_patch_names = true,
           .kinds_beside = edge_kinds_path,
           .consumers = k_node_centred_alone},
    Format{.name = "Edge text",
           .extensions = ".amsh",
           .read_volume = read_volume_edge,
           .carries_patch_names = true,
           .kinds_beside = edge_kinds_path,
           .consumers = k_node_centred_alone},
};

/// Calls f(extension) for each blank-separated word.
template <class F>
void for_each_extension(std::string_view extensions, const F& f) {
  while (!extensions.empty()) {
    const std::size_t end = std::min(extensions.find(' '), extensions.size());
    if (end > 0) f(extensions.substr(0, end));
    extensions.remove_prefix(std::min(end + 1, extensions.size()));
  }
}

std::string known_extensions() {
  std::vector<std::string_view> known;
  std::string text;
  for (const Format& format : k_formats) {
    for_each_extension(format.extensions, [&](std::string_view extension) {
      if (std::find(known.begin(), known.end(), extension) != known.end()) return;
      known.push_back(extension);
      text += (text.empty() ? "" : " ") + std::string(extension);
    });
  }
  return text;
}

std::string lower_case_name(const std::filesystem::path& path) {
  std::string name = (path.has_filename() ? path : path.parent_path()).filename().string();  // a folder may end in a slash
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name;
}

/// Returns true for an OpenFOAM case folder, either existing ("case" with constant/polyMesh or system in it) or to be created ("case/").
bool is_case_folder(const std::filesystem::path& path) {
  std::error_code ignored;  // a path that cannot be accessed is treated as missing
  if (!std::filesystem::exists(path, ignored)) return !path.has_filename() && path.has_parent_path();
  if (!std::filesystem::is_directory(path, ignored)) return false;
  return !path.has_filename() || std::filesystem::exists(path / "system" / "controlDict", ignored) ||
         std::filesystem::exists(path / "constant" / "polyMesh", ignored);
}

/// Returns the lines with the longest extension that ends the name ("wing.lb8.ugrid" also ends in a plain ".ugrid"), in table order.
std::vector<const Format*> formats_of_name(const std::filesystem::path& path) {
  const std::string name = lower_case_name(path);
  std::vector<const Format*> found;
  std::size_t longest = 0;
  for (const Format& format : k_formats) {
    for_each_extension(format.extensions, [&](std::string_view extension) {
      if (extension.size() < longest || !name.ends_with(extension)) return;
      if (extension.size() > longest) found.clear();
      longest = extension.size();
      found.push_back(&format);
    });
  }
  if (found.empty() && is_case_folder(path)) found.push_back(&*std::ranges::find(k_formats, "OpenFOAM", &Format::name));
  return found;
}

[[noreturn]] void throw_unknown_extension(std::string attempted, std::string hint) {
  throw Error({.code = ErrorCode::unsupported_format, .attempted = std::move(attempted), .problem = "the file extension is unknown", .hint = std::move(hint)});
}

}  // namespace

std::span<const Format> formats() { return k_formats; }

bool has_use(const Format& format, FormatUse use) {
  switch (use) {
    case FormatUse::read_surface: return format.read_surface != nullptr;
    case FormatUse::write_surface: return format.write_surface != nullptr;
    case FormatUse::read_volume: return format.read_volume != nullptr;
    case FormatUse::write_volume: return format.write_volume != nullptr;
  }
  return false;
}

const Format& format_of(const std::filesystem::path& path) {
  std::vector<const Format*> candidates = formats_of_name(path);
  if (candidates.empty()) {
    const std::string attempted = "finding the format of " + path.string();
    std::error_code ignored;  // a path that cannot be accessed is not a folder
    if (std::filesystem::is_directory(path, ignored))
      throw Error({.code = ErrorCode::unsupported_format,
                   .attempted = attempted,
                   .problem = "the path is a folder",
                   .hint = "name a file in the folder; the only folders that are read are OpenFOAM cases and polyMesh"});
    if (path == "-" || path.string().starts_with("/dev/"))
      throw Error({.code = ErrorCode::unsupported_format,
                   .attempted = attempted,
                   .problem = "the format follows from the file extension, and files are read more than once",
                   .hint = "write the piped data to a file such as wall.stl first"});
    throw_unknown_extension(attempted, "known extensions: " + known_extensions() + " (each also with .gz)");
  }
  const Format* const first = candidates.front();
  std::erase_if(candidates, [](const Format* format) { return !format->is_read(); });
  if (candidates.size() <= 1) return candidates.empty() ? *first : *candidates.front();
  const std::string head = file_head(path, k_sniffed_bytes);
  for (const Format* format : candidates)
    if (format->is_content && format->is_content(head)) return *format;
  return *candidates.front();
}

bool states_patch_kinds(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  std::error_code ignored;  // if the file cannot be accessed
  return format.carries_patch_kinds || (format.kinds_beside && std::filesystem::exists(format.kinds_beside(path), ignored));
}

const Format& format_of(const std::filesystem::path& path, FormatUse use) {
  std::error_code ignored;  // a path that cannot be accessed is not a folder; format_of reports errors of folders
  if (!is_known_format(path) && !std::filesystem::is_directory(path, ignored) && path != "-" && !path.string().starts_with("/dev/")) {
    const bool is_surface = use == FormatUse::read_surface || use == FormatUse::write_surface;
    throw_unknown_extension("finding the format of " + path.string(),
                            std::string(is_surface ? "surfaces" : "volume meshes") + " are read from " + list_formats_with(use));
  }
  return format_of(path);
}

bool is_known_format(const std::filesystem::path& path) { return !formats_of_name(path).empty(); }

const Format& format_to_write(const std::filesystem::path& path, FormatUse use, std::string_view name) {
  const std::string attempted = "writing " + path.string();
  const std::string what = use == FormatUse::write_surface ? "surface" : "volume mesh";
  if (path.has_filename() && lower_case_name(path).size() != path.filename().string().size())
    throw Error({.code = ErrorCode::unsupported_format, .attempted = attempted, .problem = "gzip-compressed files cannot be written"});
  std::vector<const Format*> candidates;
  if (name.empty()) {
    candidates = formats_of_name(path);
    if (candidates.empty()) throw_unknown_extension(attempted, "a " + what + " is written as " + list_formats_with(use));
  } else {
    for (const Format& format : k_formats)
      if (equal_ignoring_case(format.name, name)) candidates.push_back(&format);
  }
  for (const Format* format : candidates)
    if (has_use(*format, use)) return *format;
  throw Error(
      {.code = ErrorCode::unsupported_format,
       .attempted = attempted,
       .problem = candidates.empty() ? "unknown format \"" + std::string(name) + "\"" : std::string(candidates.front()->name) + " is not written as a " + what,
       .hint = "a " + what + " is written as " + list_formats_with(use)});
}

std::string list_formats_with(FormatUse use) {
  std::string text;
  for (const Format& format : k_formats)
    if (has_use(format, use)) text += (text.empty() ? "" : ", ") + std::string(format.name) + " (" + std::string(format.extensions) + ")";
  return text;
}

}  // namespace sterna::io
