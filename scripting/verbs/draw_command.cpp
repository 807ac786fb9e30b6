#include "scripting/verbs/draw_command.h"

#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/file/input_hash.h"
#include "io/file/surface_file.h"
#include "io/output/atomic_file.h"
#include "scripting/values/models.h"
#include "scripting/values/surface_manifest.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

/// Fraction of the progress after a check.
constexpr double k_check_end = 0.6;

void write_bytes(const std::string& png, const DrawOptions& options, const std::filesystem::path& path, const RunContext& context) {
  io::write_whole(path, png);
  context.info("wrote " + path.string() + ": " + std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels");
}

}  // namespace

std::variant<TriMesh, HybridMesh> read_drawable(const InputPath& input, double unit, const RunContext& context) {
  if (is_model_file(input.path))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "drawing " + input.name,
                 .problem = "the file is a model, which has no mesh yet",
                 .hint = "`sterna surface " + input.name + " -o wall.vtu` meshes its faces; then draw wall.vtu"});
  if (io::format_of(input.path).read_volume) {
    HybridMesh mesh = read_mesh(input, context).mesh;
    for (Point& p : mesh.points) p *= unit;
    if (count_cells(mesh).total() > 0) return mesh;
  }
  TriMesh surface = io::to_tri_mesh(io::read_surface_file(input.path, context));
  if (const auto known = read_surface_manifest(input, io::hash_input(input.path), context)) set_kinds(surface.patches, known->kinds);
  for (Point& p : surface.points) p *= unit;
  return surface;
}

void require_picture_output(const std::filesystem::path& path) {
  if (path.extension() != ".png" && path.extension() != ".PNG")
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "drawing " + path.string(),
                 .problem = "pictures are written as PNG",
                 .hint = "give the file a name that ends in .png"});
}

void write_picture(const HybridMesh& mesh, const CheckReport* report, const DrawOptions& options, std::string_view name, const std::filesystem::path& path,
                   const RunContext& context) {
  std::vector<DrawMark> marks;
  if (options.places) marks = marks_of(report ? *report : check(mesh, {}, context.part("check", 0.0, k_check_end)));
  write_bytes(draw_png(mesh, options, name, marks, context.part("draw", k_check_end, 1.0)), options, path, context);
}

void write_picture(const TriMesh& surface, const DrawOptions& options, std::string_view name, const std::filesystem::path& path, const RunContext& context) {
  if (options.places)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "draw: option places",
                 .problem = "the worst locations exist for volume meshes only; this file is a surface"});
  write_bytes(draw_png(surface, options, name, {}, context.part("draw", k_check_end, 1.0)), options, path, context);
}

}  // namespace sterna::scripting
