#include "io/format_table.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "geom/base/error.h"
#include "io/surface_msh.h"
#include "io/surface_obj.h"
#include "io/surface_off.h"
#include "io/surface_ply.h"
#include "io/surface_stl.h"
#include "io/surface_su2.h"
#include "io/surface_ugrid.h"
#include "io/volume_su2.h"
#include "io/volume_ugrid.h"
#include "io/volume_vtu.h"

namespace sterna::io {
namespace {

constexpr std::array k_formats = {
    Format{.name = "STL", .extensions = ".stl", .read_surface = read_stl, .carries_patch_names = true},
    Format{.name = "OBJ", .extensions = ".obj", .read_surface = read_obj, .carries_patch_names = true},
    Format{.name = "OFF", .extensions = ".off", .read_surface = read_off},
    Format{.name = "PLY", .extensions = ".ply", .read_surface = read_ply, .carries_patch_names = true},
    Format{.name = "Gmsh MSH", .extensions = ".msh", .read_surface = read_msh, .carries_patch_names = true},
    Format{.name = "UGRID", .extensions = ".lb8.ugrid .b8.ugrid .lb8l.ugrid .b8l.ugrid .lb4.ugrid .b4.ugrid .ugrid", .read_surface = read_ugrid, .read_volume = read_volume_ugrid,
           .write_volume = write_volume_ugrid, .carries_patch_names = true},
    Format{.name = "SU2", .extensions = ".su2", .read_surface = read_su2, .read_volume = read_volume_su2, .write_volume = write_volume_su2, .carries_patch_names = true},
    Format{.name = "VTU", .extensions = ".vtu", .read_volume = read_volume_vtu, .write_volume = write_volume_vtu, .carries_patch_names = true},
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
  std::string text;
  for (const Format& format : k_formats)
    for_each_extension(format.extensions, [&](std::string_view extension) { text += (text.empty() ? "" : " ") + std::string(extension); });
  return text;
}

}  // namespace

std::span<const Format> formats() { return k_formats; }

const Format& format_of(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  const Format* found = nullptr;
  std::size_t longest = 0;  // "wing.lb8.ugrid" could also end in a plain ".ugrid"
  for (const Format& format : k_formats) {
    for_each_extension(format.extensions, [&](std::string_view extension) {
      if (extension.size() <= longest || !name.ends_with(extension)) return;
      found = &format;
      longest = extension.size();
    });
  }
  if (found) return *found;
  throw Error({.code = ErrorCode::unsupported_format,
               .attempted = "finding the format of " + path.string(),
               .problem = "its extension is not known",
               .hint = "known extensions: " + known_extensions() + " (each also with .gz for reading)"});
}

}  // namespace sterna::io
