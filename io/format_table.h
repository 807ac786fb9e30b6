// The one table of formats: name, extensions, what is read and written. Feeds dispatch, `sterna formats`, --help and the manual.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

using SurfaceReader = SurfaceSoup (*)(const std::filesystem::path&, const RunContext&);
using VolumeReader = HybridMesh (*)(const std::filesystem::path&, const RunContext&);
using VolumeWriter = void (*)(const HybridMesh&, const std::filesystem::path&, const RunContext&);

struct Format {
  std::string_view name;        ///< "SU2"
  std::string_view extensions;  ///< blank-separated, lower case, with dots: ".su2", ".lb8.ugrid"
  SurfaceReader read_surface = nullptr;
  VolumeReader read_volume = nullptr;
  VolumeWriter write_volume = nullptr;
  bool carries_patch_names = false;
};

std::span<const Format> formats();

/// The format of a file name (case-insensitive; ".gz" peeled off). \throws Error(unsupported_format) with the list of known extensions.
const Format& format_of(const std::filesystem::path& path);

}  // namespace sterna::io
