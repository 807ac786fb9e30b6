// The one table of formats: name, extensions, what is read and written. Feeds dispatch, `sterna formats`, --help and the manual.
// A format is one line of k_formats in format_table.cpp. Several lines may share an extension: a file that is read then goes to the line whose `is_content`
// accepts its first bytes, a file that is written to the first line that writes it, unless the format is named.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

using SurfaceReader = SurfaceSoup (*)(const std::filesystem::path&, const RunContext&);
using SurfaceWriter = void (*)(const TriMesh&, const std::filesystem::path&, const RunContext&);
using VolumeReader = HybridMesh (*)(const std::filesystem::path&, const RunContext&);
using VolumeWriter = void (*)(const HybridMesh&, const std::filesystem::path&, const RunContext&);
using NumberedWriter = void (*)(const HybridMesh&, const std::filesystem::path&, Numbering, const RunContext&);
/// The files of a mesh that is more than one, in a fixed order.
using FileList = std::vector<std::filesystem::path> (*)(const std::filesystem::path&);
/// Throws Error(write_failed) where `path` must not be written; called before the work whose result it is to hold.
using OutputTest = void (*)(const std::filesystem::path&);
/// The file beside a mesh that says what its patches are; empty where there is none.
using KindsPath = std::filesystem::path (*)(const std::filesystem::path&);
/// Whether a file that begins with these bytes (unpacked, at most k_sniffed_bytes) is of the format.
using ContentTest = bool (*)(std::string_view head);

struct Format {
  std::string_view name;             ///< "SU2"
  std::string_view extensions;       ///< blank-separated, lower case, with dots: ".su2", ".lb8.ugrid"
  ContentTest is_content = nullptr;  ///< needed where another line has the same extension and reads it too
  SurfaceReader read_surface = nullptr;
  SurfaceWriter write_surface = nullptr;
  VolumeReader read_volume = nullptr;
  VolumeWriter write_volume = nullptr;
  bool carries_patch_names = false;
  FileList files = nullptr;
  OutputTest require_output = nullptr;
  bool carries_patch_kinds = false;         ///< what patches are (wall, inflow ...) stands in the file
  KindsPath kinds_beside = nullptr;         ///< or in this second file, which hash_input does not cover
  Consumers consumers;                      ///< kinds of solvers that read the format
  NumberedWriter write_numbered = nullptr;  ///< of formats that number the cells of all kinds as one: the same as write_volume, with an order of the cells

  bool is_read() const { return read_surface || read_volume; }
};

/// What of a format is meant.
enum class FormatUse { read_surface, write_surface, read_volume, write_volume };
bool has_use(const Format& format, FormatUse use);

inline constexpr std::size_t k_sniffed_bytes = 4096;

std::span<const Format> formats();

/// Whether the file, or the one beside it, says of what kind its patches are; else only their names do.
bool states_patch_kinds(const std::filesystem::path& path);

/// The format of a file that is to be read, by its name (case-insensitive; ".gz" peeled off) and, where several formats have that extension, by what the file
/// begins with. A file that cannot be opened, or that is none of them, goes to the first of them: its reader says what it misses.
/// \throws Error(unsupported_format) with the list of known extensions.
const Format& format_of(const std::filesystem::path& path);
/// The same; where the extension is not known, the error lists the formats that have this use.
const Format& format_of(const std::filesystem::path& path, FormatUse use);
/// Whether format_of knows the extension.
bool is_known_format(const std::filesystem::path& path);

/// The format to write `path` in: the first of that extension that writes surfaces (volumes), or the one of that name (case-insensitive), whatever the
/// extension.
/// \pre use is write_surface or write_volume
/// \throws Error(unsupported_format) with the list of those that do.
const Format& format_to_write(const std::filesystem::path& path, FormatUse use, std::string_view name = {});

/// "SU2 (.su2), VTU (.vtu)": the formats for which it holds, each once, for hints and help.
std::string list_formats_with(FormatUse use);

}  // namespace sterna::io
