#include "scripting/verbs/draw_command.h"

#include <CLI/CLI.hpp>

#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/file/input_hash.h"
#include "io/file/surface_file.h"
#include "io/output/atomic_file.h"
#include "scripting/command/cli_options.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/models.h"
#include "scripting/values/surface_manifest.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

// Fractions of the progress of `sterna draw`.
constexpr double k_draw_read_end = 0.4, k_check_end = 0.6;

/// Adds "1600x1000" as two options.
void add_size(OptionOverrides& options, const std::string& text) {
  const std::size_t by = text.find('x');
  if (by == std::string::npos || by == 0 || by + 1 == text.size())
    throw CLI::ValidationError("--size", "\"" + text + "\" is not WIDTHxHEIGHT, such as 1600x1000");
  options.emplace_back("width", text.substr(0, by));
  options.emplace_back("height", text.substr(by + 1));
}

void write_bytes(const std::string& png, const DrawOptions& options, const std::filesystem::path& path, const RunContext& context) {
  io::write_whole(path, png);
  context.info("wrote " + path.string() + ": " + std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels");
}

}  // namespace

CLI::App* add_draw_arguments(CLI::App& app, DrawCommand& draw) {
  CLI::App* command =
      app.add_subcommand("draw", "draw a surface or volume mesh as a PNG picture: walls, cells along a plane, colours by quality; needs no display");
  command->add_option("mesh", draw.input, "surface or mesh file. `sterna formats` lists the formats")->required();
  command->add_option("-o,--output", draw.output, "picture.png")->required();
  DrawOptions options;
  add_schema_options(*command, sterna::options_of(options), draw.options);
  command
      ->add_option_function<std::string>(
          "--size", [&draw](const std::string& text) { add_size(draw.options, text); }, "width and height in pixels, 1600x1000")
      ->type_name("WIDTHxHEIGHT");
  command->footer(
      "sterna draw mesh.su2 -o wing.png --view iso --color quality; --cut \"leading edge\"; --cut x=1.2 --focus \"1.2,3,0 radius=0.1\" --color volume");
  return command;
}

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

int execute(const DrawCommand& command, const CommandContext& context) {
  require_picture_output(command.output);
  DrawOptions options;
  set_options(sterna::options_of(options), command.options, context);
  require_draw_options(options);
  const auto drawable = read_drawable({command.input, command.input}, options.unit, context.run.part("read", 0.0, k_draw_read_end));
  const std::string name = std::filesystem::path(command.input).filename().string();
  const RunContext run = context.run.part("draw", k_draw_read_end, 1.0);
  if (const auto* mesh = std::get_if<HybridMesh>(&drawable)) write_picture(*mesh, nullptr, options, name, command.output, run);
  else write_picture(std::get<TriMesh>(drawable), options, name, command.output, run);
  context.console.end_progress();
  return k_exit_success;
}

}  // namespace sterna::scripting
