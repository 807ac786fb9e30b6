// `sterna convert`: converts a surface or a volume mesh from one format to another. Nothing is added or repaired.
#include <fmt/format.h>

#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/file/input_hash.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "scripting/cli/commands.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/manifest.h"
#include "scripting/values/mesh_manifest.h"
#include "scripting/values/models.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_manifest.h"

namespace sterna::scripting {
namespace {

constexpr double k_convert_read_end = 0.5;  // reading and writing take about the same time

struct ConvertSettings {
  std::string format;               ///< name of the output's format; empty: by the extension
  bool as_surface = false;          ///< take the boundary of a volume mesh
  WriteOptions writing;             ///< for volume meshes
  bool is_numbering_given = false;  ///< --numbering is given, which is an error if there are no cells
};

/// Writes the manifest too, because the output's format may not hold its data (kinds of patches, periodic sides, options).
std::string convert_volume(const InputPath& input, const MeshValue& value, const std::filesystem::path& output, const ConvertSettings& settings,
                           const RunContext& context) {
  const HybridMesh& mesh = value.mesh;
  const std::optional<Json> manifest = fitting_manifest(input, value.inputs.front().hash, RunContext());
  write_mesh_alone(mesh, output, settings.format, settings.writing, context);
  if (manifest) write_manifest_of_copy(*manifest, output, io::rounding_of_volume_file(mesh, output, context, settings.format));
  else write_manifest(value, output, context, settings.format);
  return fmt::format("volume mesh, {} nodes, {} cells, {} patches", count_text(static_cast<std::int64_t>(mesh.points.size())),
                     count_text(count_cells(mesh).total()), mesh.patches.size());
}

std::string convert_surface(const InputPath& input, const std::filesystem::path& output, const std::string& format, const RunContext& context) {
  const std::string hash = io::hash_input(input.path);
  const bool has_manifest = read_surface_manifest(input, hash, context).has_value();
  const std::optional<Json> manifest = has_manifest ? fitting_manifest(input, hash, RunContext()) : std::nullopt;
  const TriMesh mesh = io::to_tri_mesh(io::read_surface_file(input.path, context.part("read", 0.0, k_convert_read_end)));
  io::write_surface_file(mesh, output, context.part("write", k_convert_read_end, 1.0), format);
  if (manifest) write_manifest_of_copy(*manifest, output);
  return fmt::format("surface, {} triangles, {} patches", count_text(static_cast<std::int64_t>(mesh.n_triangles())), mesh.patches.size());
}

/// Returns true if the output's format supports that use; the format must exist.
bool can_write(const std::filesystem::path& output, io::FormatUse use, const std::string& format) {
  try {
    io::format_to_write(output, use, format);
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unsupported_format) throw;
    return false;
  }
}

/// Converts the file. Volume meshes stay volume meshes if the output's format supports them; otherwise it is an error unless the boundary is requested.
/// Connectivity, coordinates and order are kept, unless `writing` requests another order. Data that the format cannot hold (names, digits) are reported in the
/// log.
/// \returns what was written: "surface, 12 triangles, 2 patches"
/// \throws Error of io; unsupported_format if the output's format cannot hold the type of the input, before anything is written.
std::string convert(const InputPath& input, const std::filesystem::path& output, const ConvertSettings& settings, const RunContext& context) {
  const io::Format& from = io::format_of(input.path);
  const bool has_volume = can_write(output, io::FormatUse::write_volume, settings.format);
  if (!has_volume && !can_write(output, io::FormatUse::write_surface, settings.format))  // the error lists the formats for the most likely type of input
    io::format_to_write(output, from.read_volume && !settings.as_surface ? io::FormatUse::write_volume : io::FormatUse::write_surface, settings.format);
  const auto require_no_numbering = [&](const std::string& why) {
    if (settings.is_numbering_given)
      throw Error({.code = ErrorCode::bad_argument, .attempted = "converting " + input.name, .problem = "--numbering has no effect: " + why});
  };
  if (settings.as_surface || !from.read_volume) {
    require_no_numbering("the output is a surface, which has no cells");
    io::format_to_write(output, io::FormatUse::write_surface, settings.format);
    return convert_surface(input, output, settings.format, context);
  }
  const MeshValue value = read_mesh(input, context.part("read", 0.0, k_convert_read_end), io::Incomplete::completed);
  const HybridMesh& mesh = value.mesh;
  if (count_cells(mesh).total() == 0) {
    require_no_numbering("the file has a surface, which has no cells");
    io::format_to_write(output, io::FormatUse::write_surface, settings.format);
    return convert_surface(input, output, settings.format, context);
  }
  if (!has_volume)
    throw Error(
        {.code = ErrorCode::unsupported_format,
         .attempted = "converting " + input.name + " into " + output.string(),
         .problem = "the input is a volume mesh of " + count_text(count_cells(mesh).total()) + " cells, but the format of the output stores surfaces only",
         .hint = "give --surface to write the boundary; formats of volume meshes are " + io::list_formats_with(io::FormatUse::write_volume)});
  return convert_volume(input, value, output, settings, context.part("write", k_convert_read_end, 1.0));
}

}  // namespace

int convert_command(const CommandLine& line, const CommandContext& context) {
  const std::string input = line.word("input"), output = line.word("output");
  if (is_model_file(input)) return convert_model(line, context);
  ConvertSettings settings{.format = line.word("format"), .as_surface = line.flag("surface")};
  const OptionTable of_mesh = sterna::options_of(settings.writing);
  OptionOverrides of_models = line.options;
  const OptionOverrides writing = take_options(of_models, of_mesh);
  set_options(of_mesh, writing, context);
  settings.is_numbering_given = !writing.empty();
  if (!of_models.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "convert",
                 .problem = "option " + of_models.front().first + " applies to models (STEP, IGES, BREP, sumo, CPACS); " + input + " is not a model"});
  const std::string what = convert({input, input}, output, settings, context.run);
  context.console.end_progress();
  context.run.info("wrote " + output + ": " + what);
  return k_exit_success;
}

}  // namespace sterna::scripting
