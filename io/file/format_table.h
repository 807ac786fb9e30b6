// The table of file formats: name, extensions, supported reading and writing. Used by dispatch, `sterna formats`, --help and the manual.
// A format is one line of k_formats in format_table.cpp. Several lines may share an extension. A file is then read by the line whose `is_content` accepts its
// first bytes, and written by the first line with a writer, unless the format is named.
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
/// Returns the files of a mesh that consists of several files, in a fixed order.
using FileList = std::vector<std::filesystem::path> (*)(const std::filesystem::path&);
/// Throws Error(write_failed) if `path` must not be written; called before the computation whose result it will hold.
using OutputTest = void (*)(const std::filesystem::path&);
/// Returns the path of the second file that states the kinds of the patches; empty if there is none.
using KindsPath = std::filesystem::path (*)(const std::filesystem::path&);
/// Returns true if a file that begins with these bytes (unpacked, at most k_sniffed_bytes) has this format.
using ContentTest = bool (*)(std::string_view head);

struct Format {
  std::string_view name;             ///< "SU2"
  std::string_view extensions;       ///< blank-separated, lower case, with dots: ".su2", ".lb8.ugrid"
  ContentTest is_content = nullptr;  ///< needed if another line has the same extension and also a reader
  SurfaceReader read_surface = nullptr;
  SurfaceWriter write_surface = nullptr;
  VolumeReader read_volume = nullptr;
  VolumeWriter write_volume = nullptr;
  bool carries_patch_names = false;
  FileList files = nullptr;
  OutputTest require_output = nullptr;
  bool carries_patch_kinds = false;         ///< the file states the kinds of patches (wall, inflow ...)
  KindsPath kinds_beside = nullptr;         ///< path of the second file that states them, which hash_input does not cover
  Consumers consumers;                      ///< kinds of solvers that read the format
  NumberedWriter write_numbered = nullptr;  ///< for formats with one numbering for cells of all kinds: write_volume with a cell order

  bool is_read() const { return read_surface || read_volume; }
};

/// Use of a format.
enum class FormatUse { read_surface, write_surface, read_volume, write_volume };
bool has_use(const Format& format, FormatUse use);

inline constexpr std::size_t k_sniffed_bytes = 4096;

std::span<const Format> formats();

/// Returns true if the file, or the second file beside it, states the kinds of the patches. Otherwise the kinds follow from the names only.
bool states_patch_kinds(const std::filesystem::path& path);

/// Returns the format for reading a file: by its extension (case-insensitive, without ".gz") and, where several formats share the extension, by its first
/// bytes.
/// A file that cannot be opened or matches none of them is assigned to the first of these formats, whose reader reports the error.
/// \throws Error(unsupported_format) with the list of known extensions.
const Format& format_of(const std::filesystem::path& path);
/// Returns the format for reading, as above; if the extension is unknown, the error lists the formats that have this use.
const Format& format_of(const std::filesystem::path& path, FormatUse use);
/// Returns true if format_of() knows the extension.
bool is_known_format(const std::filesystem::path& path);

/// Returns the format for writing `path`: the first with that extension that writes surfaces (volumes), or the format called `name` (case-insensitive) for any
/// extension.
/// \pre use is write_surface or write_volume
/// \throws Error(unsupported_format) with the list of formats that have the use.
const Format& format_to_write(const std::filesystem::path& path, FormatUse use, std::string_view name = {});

/// Returns the formats with this use, each once, for hints and help: "SU2 (.su2), VTU (.vtu)".
std::string list_formats_with(FormatUse use);

}  // namespace sterna::io
