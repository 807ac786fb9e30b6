// This file only parses; the commands are executed in commands.cpp. CLI11 is slow to compile, so only the cli*.cpp include it.
#include "scripting/cli/cli.h"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <functional>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/unite.h"
#include "geom/cad/write_cad.h"
#include "geom/mesh/half.h"
#include "io/file/format_table.h"
#include "scripting/cli/case_commands.h"
#include "scripting/cli/cli_gates.h"
#include "scripting/cli/cli_scripts.h"
#include "scripting/cli/commands.h"
#include "scripting/cli/doctor.h"
#include "scripting/cli/inspect_command.h"
#include "scripting/cli/line_editor.h"
#include "scripting/cli/pentagrow_command.h"
#include "scripting/cli/prompt.h"
#include "scripting/cli/shell_help.h"
#include "scripting/command/cli_options.h"
#include "scripting/interpreter/script_manual.h"
#include "scripting/lua/foreign_error.h"
#include "scripting/report/report_command.h"
#include "scripting/terminal/console.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/terminal/interrupt.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/draw_command.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/view/view_command.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::scripting {
namespace {

/// Largest accepted number of threads. It is far above that of any machine and far below the limit of the system, so a larger number is a typing error.
constexpr int k_max_threads = 1024;
constexpr int k_max_tasks = 1000000;

/// Options common to all commands.
struct CommonSettings {
  ConsoleSettings console;
  int threads = 0;
  std::uint64_t seed = 1;
  std::filesystem::path dump_directory;
  bool only_options = false;
};

/// The request of the command line: one command, and a file for the picture of a failure.
struct Request {
  std::function<int(const CommandContext&)> execute;
  std::filesystem::path trouble;  ///< path of the picture: beside the output, or beside the input of commands that write nothing
  bool is_prompt = false;
  bool prints_findings = false;  ///< the command prints the findings on the input as its result, so the log omits them unless it is verbose
};

void add_common_options(CLI::App& app, CommonSettings& common) {
  app.add_option("--threads", common.threads, "number of worker threads; 0 = all threads of the machine. The result does not depend on this number")
      ->check(CLI::Range(0, k_max_threads));
  app.add_option("--seed", common.seed, "seed of random numbers (math.random of scripts)");
  app.add_flag("-q,--quiet", common.console.is_quiet, "no log and no progress, only results, warnings and errors");
  app.add_flag("-v,--verbose", common.console.is_verbose, "write a more detailed log");
  app.add_option("--log", common.console.log_file, "write every log line with its time to this file")->type_name("FILE");
  app.add_flag("--show-options", common.only_options,
               "print the options that mesh, surface, half, union, convert, draw or report would use, as JSON, and stop");
  app.add_option("--dump-dir", common.dump_directory, "folder for VTU pictures of failures; default: beside the output")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
}

std::filesystem::path beside(const std::filesystem::path& file) { return file.string() + ".trouble.vtu"; }

void add_cache_options(CLI::App& command, CacheChoice& cache) {
  command
      .add_option("--cache", cache.folder, "store results of stages in this folder and reuse them if all their inputs are unchanged; the output is the same")
      ->type_name("FOLDER");
  command
      .add_option("--cache-limit", cache.limit,
                  "largest size of that folder in bytes; when exceeded, the least recently used results are removed; default: 20e9")
      ->needs("--cache")
      ->check(CLI::PositiveNumber)
      ->type_name("BYTES");
}

void add_cache_command(CLI::App& app, CacheCommand& cache, Request& request) {
  CLI::App* command = app.add_subcommand("cache", "list the content of a cache, or empty it");
  command->add_option("--folder", cache.folder, "folder of the cache, as given to --cache")->required()->type_name("FOLDER");
  command->add_flag("--list", cache.is_listed, "list every entry");
  command->add_flag("--clear", cache.is_cleared, "remove all entries");
  command->final_callback([&] { request.execute = [&](const CommandContext& context) { return execute(cache, context); }; });
}

void add_run_command(CLI::App& app, RunCommand& run, Request& request) {
  CLI::App* command = app.add_subcommand("run", "run a Lua case");
  command
      ->add_option("script", run.script, "case.lua; input files are searched in the current folder, then beside the script; outputs go to the current folder")
      ->required();
  add_script_arguments(*command, run.arguments);
  add_set_option(*command, run.overrides);
  command->add_option("--tasks", run.tasks, "number of cases of a series that run at the same time, instead of the value in the script")
      ->check(CLI::Range(1, k_max_tasks));
  command->add_flag("--retry", run.retries, "series: repeat all cases that failed in an earlier run, whatever the script sets");
  command->add_option("--series-case", run.series_case, "")->group("");  // not listed in the help: set by series{} for its workers
  command->add_option("--look-in", run.input_folder, "")->group("");     // not listed in the help: set by `sterna determinism` for its runs
  add_cache_options(*command, run.cache);
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(run, context); };
    request.trouble = beside(run.script.filename());
  });
}

void add_script_commands(CLI::App& app, CheckScriptCommand& check, Request& request) {
  CLI::App* command = app.add_subcommand(
      "check-script", "find mistakes in a Lua case without meshing or writing files: unknown verbs and keys, wrong types, units and ranges, missing files");
  command->add_option("script", check.script.script, "case.lua")->required();
  add_script_arguments(*command, check.script.arguments);
  add_set_option(*command, check.script.overrides);
  command->final_callback([&] { request.execute = [&](const CommandContext& context) { return execute(check, context); }; });
  app.add_subcommand(
         "prompt",
         "run Lua statements interactively, with all verbs; the default of `sterna` without a command on a terminal. Statements can also come from a pipe")
      ->final_callback([&] { request.is_prompt = true; });
  app.add_subcommand("manual", "print the reference of verbs, objects, options and commands (docs/lua.md)")->final_callback([&] {
    request.execute = [&](const CommandContext& context) {
      context.console.print(manual_text(commands_markdown(app)));
      return k_exit_success;
    };
  });
}

void add_mesh_command(CLI::App& app, MeshCommand& mesh, OptionOverrides& set, Request& request) {
  CLI::App* command = app.add_subcommand("mesh", "mesh the space around a surface or a model: prism layers and tetrahedra");
  command
      ->add_option("surfaces", mesh.inputs,
                   "surface files; several are joined to one wall. Or model files (STEP, IGES, BREP, sumo, CPACS), whose faces are meshed first. `sterna "
                   "formats` lists the formats")
      ->required();
  command->add_option("-o,--output", mesh.outputs, "mesh file: " + io::list_formats_with(io::FormatUse::write_volume) + "; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--stats", mesh.stats, "write sizes, times and memory of this run as JSON")->type_name("FILE");
  command
      ->add_option(
          "--stages", mesh.stages,
          "write surface, envelope, tetrahedra and mesh to this .sterna file; `sterna mesh case.sterna -o ...` continues after the last step in the file")
      ->type_name("FILE");
  add_volume_arguments(*command, mesh.volume, mesh.options, "mesh");
  command->add_flag("--auto", mesh.is_auto,
                    "take the files unchanged if they can be meshed, otherwise repair them, otherwise wrap them; remesh triangulations with many sliver "
                    "triangles; unite crossing parts of models, or mesh their faces with triangles first. Summary and manifest begin with the changes");
  command->add_flag("--repair", mesh.is_repaired,
                    "repair the files first, see `sterna repair --help`; options of repair with --set repair.gap=1e-3 --set repair.hole=0.5");
  command->add_flag("--wrap", mesh.is_wrapped, "wrap the files first, see `sterna wrap --help`; options of wrap with --set wrap.edge=5mm --set wrap.gap=20mm");
  command->add_flag("--remesh", mesh.is_remeshed,
                    "remesh the surface first, as `sterna remesh`; options of remesh with --set remesh.max_edge=0.1 --set remesh.curvature_angle=10*deg");
  command->add_option_function<std::string>(
      "--fill-crevices", [&mesh](const std::string& width) { mesh.crevices.emplace_back("width", width); },
      "make crevices and gaps between facing walls solid up to this width, for example 20mm; other options with --set fill_crevices.angle=45*deg");
  surfmesh::StitchOptions surface;
  volmesh::MeshCase volume;
  OptionTable of_triangulations = sterna::options_of(surface), of_both = volmesh::options_of(volume);
  ReadCadOptions reading;
  OptionTable of_models = sterna::options_of(reading);
  const std::string unit_help = "length of 1 unit of the file in metres (for models: " + std::ranges::find(of_models, "unit", &Option::name)->range_text() +
                                ", instead of the unit in the file's header)";
  for (const char* const name : {"fluid", "unit"}) {  // options that also apply to reading a model
    const auto shared = std::ranges::find(of_triangulations, name, &Option::name);
    of_both.insert(of_both.begin(), *shared);
    if (shared->name == "unit") of_both.front().help = unit_help;
    of_triangulations.erase(shared);
  }
  add_schema_options(*command, of_triangulations, mesh.options, "for triangulations only");
  add_schema_options(*command, of_both, mesh.options);
  WriteOptions writing;
  add_schema_options(*command, sterna::options_of(writing), mesh.writing);
  add_set_option(*command, set);
  add_cache_options(*command, mesh.cache);
  command->footer(
      "--time-limit applies to the tetrahedra engines and to reading of models (read_cad.time_limit). Numbers can have units: 0.5mm, 35deg, --unit inch; "
      "without units they are metres, degrees, kelvin. Heights can be computed from the flow: --first-height \"y_plus 1 mach=0.78 altitude=11000 length=4.2\", "
      "--total-height \"boundary_layer factor=1.3 reynolds=6e6 length=1\"; for details run help(y_plus) in `sterna prompt`. For models, options of the surface "
      "mesh are set with --set surface_mesh.max_edge=0.2; `sterna surface --help` lists them.");
  command->final_callback([&, command] {
    for (const auto& [name, value] : set)
      (name.starts_with("half.")            ? mesh.volume.half
       : name.starts_with("remesh.")        ? mesh.remesh
       : name.starts_with("fill_crevices.") ? mesh.crevices
       : name.starts_with("write.")         ? mesh.writing
                                            : mesh.options)
          .emplace_back(name, value);
    mesh.given = given_options(*command);
    request.execute = [&](const CommandContext& context) { return execute(mesh, context); };
    request.trouble = beside(mesh.outputs.front());
  });
}

void add_surface_command(CLI::App& app, SurfaceCommand& surface, OptionOverrides& set, Request& request) {
  CLI::App* command =
      app.add_subcommand("surface", "mesh the faces of a model (STEP, IGES, BREP, sumo, CPACS) with triangles, closed where the model is closed");
  command->add_option("models", surface.inputs, "model files; several models stay separate. Components of sumo and CPACS files are united first")->required();
  command->add_option("-o,--output", surface.outputs, "surface file: " + io::list_formats_with(io::FormatUse::write_surface) + "; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->take_all();
  command->add_flag("--auto", surface.is_auto,
                    "unite, repair or wrap if faces cross or the surface is open; triangulations are also repaired or wrapped if required");
  surfmesh::SurfaceMeshOptions options;
  ReadCadOptions reading;
  add_schema_options(*command, model_surface_options(options, reading), surface.options);
  add_set_option(*command, set);
  add_cache_options(*command, surface.cache);
  add_patch_option(*command, surface.patches,
                   "options of faces with matching names, e.g. --patch \"wing*:max_edge=0.1,curvature_angle=8\": max_edge, min_edge, curvature_angle, "
                   "chord_error, leading_edge_factor, trailing_edge_factor; also the options of `sterna mesh --patch` (kind, layers, first_height ...), which "
                   "are stored for the volume mesh; may be given several times");
  command
      ->add_option("--source", surface.sources,
                   "shorter edges in a region, e.g. --source \"line 0 0 0 8 0 0 size=0.02 radius=0.5\"; point, line, box, sphere, cylinder, wake; may be given "
                   "several times")
      ->type_name("SOURCE")
      ->allow_extra_args(false)
      ->take_all();
  command->footer("Numbers can have units: 5mm, 12deg; without units they are metres and degrees.");
  command->final_callback([&] {
    surface.options.insert(surface.options.end(), set.begin(), set.end());
    request.execute = [&](const CommandContext& context) { return execute(surface, context); };
    request.trouble = beside(surface.outputs.front());
  });
}

void add_half_command(CLI::App& app, HalfCommand& half, Request& request) {
  CLI::App* command = app.add_subcommand("half", "cut a surface at a plane and write one half; its open boundary is one closed line in the plane");
  command->add_option("surface", half.input, "surface file. `sterna formats` lists the formats")->required();
  command->add_option("-o,--output", half.output, "surface file: " + io::list_formats_with(io::FormatUse::write_surface))->required();
  HalfOptions options;
  add_schema_options(*command, sterna::options_of(options), half.options);
  command->add_option_function<std::string>(
      "--unit", [&half](const std::string& text) { half.options.emplace_back("unit", text); }, "length of one unit of the file: mm, inch, 0.5mm ...");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(half, context); };
    request.trouble = beside(half.output);
  });
}

void add_remesh_command(CLI::App& app, RemeshCommand& remesh, OptionOverrides& set, Request& request) {
  CLI::App* command = app.add_subcommand("remesh", "remesh a surface by curvature and sizes: removes sliver triangles, keeps sharp edges and patches");
  command->add_option("surface", remesh.input, "surface file. `sterna formats` lists the formats")->required();
  command->add_option("-o,--output", remesh.outputs, "surface file: " + io::list_formats_with(io::FormatUse::write_surface) + "; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->take_all();
  surfmesh::RemeshOptions options;
  add_schema_options(*command, sterna::options_of(options), remesh.options);
  add_set_option(*command, set);
  add_cache_options(*command, remesh.cache);
  add_patch_option(*command, remesh.patches,
                   "options of patches with matching names, e.g. --patch \"wing*:max_edge=0.1,curvature_angle=8\": max_edge, min_edge, curvature_angle, "
                   "chord_error, leading_edge_chordwise, trailing_edge_chordwise ...; may be given several times");
  command
      ->add_option("--source", remesh.sources,
                   "shorter edges in a region, e.g. --source \"line 0 0 0 8 0 0 size=0.02 radius=0.5\"; point, line, box, sphere, cylinder, wake; may be given "
                   "several times")
      ->type_name("SOURCE")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option_function<std::string>(
      "--unit", [&remesh](const std::string& text) { remesh.options.emplace_back("unit", text); }, "length of one unit of the file: mm, inch, 0.5mm ...");
  command->footer("Numbers can have units: 5mm, 12deg; without units they are metres and degrees.");
  command->final_callback([&] {
    remesh.options.insert(remesh.options.end(), set.begin(), set.end());
    request.execute = [&](const CommandContext& context) { return execute(remesh, context); };
    request.trouble = beside(remesh.outputs.front());
  });
}

void add_union_command(CLI::App& app, UnionCommand& unite, Request& request) {
  CLI::App* command =
      app.add_subcommand("union", "unite closed surfaces that intersect, or the crossing parts of one file, to one wall; or unite models to one model");
  command->add_option("parts", unite.inputs, "surface files, or model files (STEP, IGES, BREP, sumo, CPACS). `sterna formats` lists the formats")->required();
  command
      ->add_option("-o,--output", unite.output,
                   "surface file: " + io::list_formats_with(io::FormatUse::write_surface) + "; for models: STEP, IGES, BREP (.step, .iges, .brep)")
      ->required();
  UnionOptions options;
  UniteOptions models;
  add_schema_options(*command, sterna::options_of(options), unite.options);
  add_schema_options(*command, sterna::options_of(models), unite.options);
  command->add_option_function<std::string>(
      "--unit", [&unite](const std::string& text) { unite.options.emplace_back("unit", text); }, "length of one unit of the files: mm, inch, 0.5mm ...");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(unite, context); };
    request.trouble = beside(unite.output);
  });
}

void add_repair_command(CLI::App& app, RepairCommand& repair, OptionOverrides& set, Request& request) {
  CLI::App* command = app.add_subcommand(
      "repair", "close seams and holes of surfaces, cut crossing facets, remove sheets and inner walls; changes as little as possible and reports each change");
  command->add_option("parts", repair.inputs, "surface files. `sterna formats` lists the formats")->required();
  command->add_option("-o,--output", repair.output, "surface file: " + io::list_formats_with(io::FormatUse::write_surface))->required();
  command->add_option("--changes", repair.changes, "write a VTU file with the changed and removed facets")->type_name("FILE");
  command->add_option("--report", repair.report, "write a JSON file with every change (kind, location, size, facets) and the distances")->type_name("FILE");
  surfmesh::StitchOptions stitching;
  surfmesh::RepairOptions options;
  add_schema_options(*command, repair_options(stitching, options), repair.options);
  add_set_option(*command, set);
  add_cache_options(*command, repair.cache);
  command->footer("docs/dirty_surfaces.md describes the steps, their order and limits.");
  command->final_callback([&] {
    repair.options.insert(repair.options.end(), set.begin(), set.end());
    request.execute = [&](const CommandContext& context) { return execute(repair, context); };
    request.trouble = beside(repair.output);
  });
}

void add_wrap_command(CLI::App& app, WrapCommand& wrap, OptionOverrides& set, Request& request) {
  CLI::App* command = app.add_subcommand("wrap", "wrap damaged surfaces in one closed surface close to them, with their sharp edges and patches");
  command->add_option("parts", wrap.inputs, "surface files. `sterna formats` lists the formats")->required();
  command->add_option("-o,--output", wrap.output, "surface file: " + io::list_formats_with(io::FormatUse::write_surface))->required();
  command->add_option("--changes", wrap.changes, "write a VTU file with the triangles that close openings, and those at leaks")->type_name("FILE");
  command->add_option("--report", wrap.report, "write a JSON file with every closure and leak (kind, location, size) and the distances")->type_name("FILE");
  surfmesh::WrapOptions options;
  add_schema_options(*command, sterna::options_of(options), wrap.options);
  add_set_option(*command, set);
  add_cache_options(*command, wrap.cache);
  command->footer(
      "Numbers can have units: --edge 5mm, --gap 20mm, --features 35deg, --unit inch; without units they are metres and degrees. docs/wrap.md describes the "
      "steps and limits.");
  command->final_callback([&] {
    wrap.options.insert(wrap.options.end(), set.begin(), set.end());
    request.execute = [&](const CommandContext& context) { return execute(wrap, context); };
    request.trouble = beside(wrap.output);
  });
}

void add_check_command(CLI::App& app, CheckCommand& check, Request& request) {
  CLI::App* command = app.add_subcommand("check",
                                         "prove that a volume mesh tiles its domain and measure its quality; exit status 0 only if it is VALID. For a model "
                                         "(STEP ...): report whether it is closed, and list open edges");
  command->add_option("mesh", check.input, "mesh file, or model file")->required();
  command->add_flag("--json", check.is_json, "print the report as JSON");
  command
      ->add_option(
          "--model", check.models,
          "compare the walls of the mesh with the model from which it was made (gates G17, G18): STEP, IGES, BREP, sumo, CPACS; may be given several times")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--findings-per-kind", check.options.findings_per_kind, "number of locations listed for each kind of violation")
      ->check(CLI::PositiveNumber);
  command->add_flag("--strict", check.options.strict, "exit status 3 also if a QUALITY gate FAILs for the solvers of --for");
  command
      ->add_option("--for", check.options.solvers,
                   "solvers of the verdict, e.g. --for su2,openfoam: " + known_solvers() + "; default: the solvers that read the format of the file")
      ->type_name("SOLVER,...");
  command->add_flag("--cell-centred,!--no-cell-centred", check.options.cell_centred,
                    "also compute the measures of cell-centred solvers: OpenFOAM's non-orthogonality, skewness ... (default)");
  command
      ->add_option("--cells", check.cells,
                   "write the mesh with the quality of each cell (scaled Jacobian, volume, dihedral angles as VTK defines them) to this .vtu file")
      ->type_name("FILE");
  command
      ->add_option("--gate", check.gates,
                   "limits of a QUALITY gate, instead of the defaults, e.g. --gate orthogonality:hard=3deg,target=15deg --gate face_weight:none; help "
                   "\"mesh:check\" lists them; may be given several times")
      ->type_name("MEASURE:LIMITS")
      ->allow_extra_args(false)
      ->take_all();
  command->add_flag("--intersections,!--no-intersections", check.options.intersections, "test boundaries exactly for intersection (default)");
  command->final_callback([&, command] {
    check.given = given_options(*command);
    request.execute = [&](const CommandContext& context) { return execute(check, context); };
    request.trouble = beside(std::filesystem::path(check.input).filename());
  });
}

void add_info_command(CLI::App& app, InfoCommand& info, Request& request) {
  CLI::App* command =
      app.add_subcommand("info", "describe a surface, mesh or model file: counts, patches, bounding box, units; for models also areas, volumes, mean chords");
  command->add_option("file", info.input, "surface, mesh or model file")->required();
  command->add_option("--unit", info.unit, "length of one unit of the file: mm, inch, 0.5mm ...");
  command->add_flag("--json", info.is_json, "print JSON (schema sterna-info-1)");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(info, context); };
    request.prints_findings = true;
    request.trouble = beside(std::filesystem::path(info.input).filename());
  });
}

void add_convert_command(CLI::App& app, ConvertCommand& convert, Request& request) {
  CLI::App* command = app.add_subcommand("convert", "write a surface, a volume mesh or a model in another format");
  command->add_option("input", convert.input, "surface, mesh or model file (STEP, IGES, BREP, sumo .smx, CPACS .xml)")->required();
  command->add_option("output", convert.output, "file to write; `sterna formats` lists the formats")->required();
  command->add_option("--format", convert.settings.format, "format of the output by its name in `sterna formats`, e.g. \"STL text\"; default: by the extension")
      ->type_name("NAME");
  command->add_flag("--surface", convert.settings.as_surface, "write the boundary of a volume mesh");
  ReadCadOptions reading;
  WriteCadOptions writing;
  for (const OptionTable& table : {sterna::options_of(reading), sterna::options_of(writing)}) add_schema_options(*command, table, convert.options);
  WriteOptions of_mesh;
  add_schema_options(*command, sterna::options_of(of_mesh), convert.writing);
  command->final_callback([&, command] {
    convert.given = given_options(*command);
    request.execute = [&](const CommandContext& context) { return execute(convert, context); };
    request.trouble = beside(convert.output);
  });
}

void add_draw_command(CLI::App& app, DrawCommand& draw, Request& request) {
  add_draw_arguments(app, draw)->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(draw, context); };
    request.trouble = beside(draw.output);
  });
}

void add_report_command(CLI::App& app, ReportCommand& report, Request& request) {
  add_report_arguments(app, report)->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(report, context); };
    request.trouble = beside(report.output);
  });
}

void add_pentagrow_command(CLI::App& app, PentagrowCommand& pentagrow, Request& request) {
  CLI::App* command = app.add_subcommand(
      "pentagrow",
      "mesh the space around a surface by a configuration of pentagrow, with pentagrow's file names; also available as the program pentagrow beside sterna");
  command->add_option("surface", pentagrow.surface, "surface file")->required();
  command->add_option("config", pentagrow.config, "configuration file with lines Key = value; default: the defaults of pentagrow");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(pentagrow, context); };
    request.trouble = beside("hybrid");
  });
}

int execute_request(const Request& request, const CommonSettings& common) {
  InterruptGuard interrupt;
  Console console(common.console);
  const RunSettings settings{.threads = common.threads,
                             .seed = common.seed,
                             .stop = interrupt.token(),
                             .dump_directory = common.dump_directory,
                             .log =
                                 [&](LogLevel level, std::string_view text) {
                                   const bool is_reported = request.prints_findings && level == LogLevel::info && !common.console.is_verbose;
                                   if (!is_reported) console.log(level, text);
                                 },
                             .progress = [&](const ProgressState& state) { console.progress(state); }};
  if (request.is_prompt)
    return run_prompt({.script = {.script = "prompt", .overrides = {}, .print = [&](std::string_view text) { console.print(text); }, .on_mesh = {}},
                       .run = settings,
                       .history_file = default_history_file()},
                      console, interrupt);
  const RunContext context(settings);
  try {
    return request.execute({console, context, common.only_options, [&](bool is_left) { interrupt.leave_to_work(is_left); }});
  } catch (const OptionsShown& shown) {
    console.print(shown.json);
    return k_exit_success;
  } catch (const Error& error) {
    const std::filesystem::path trouble = common.dump_directory.empty() ? request.trouble : common.dump_directory / request.trouble.filename();
    console.end_progress();
    console.error(error.what() + draw_trouble(error, trouble));
    return exit_status_of(error.code());
  }
}

/// Returns the names of the commands of the program, or the long options of a command.
std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
    for (const std::string& alias : command->get_aliases()) names.push_back(alias);
  }
  return names;
}
std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* level = &app; level; level = level->get_parent())
    for (const CLI::Option* option : level->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Returns the misspelt name in a command line that was refused, with a suggestion; empty if every name is known and the problem is another one.
std::string misspelling(const CLI::App& app, int argc, const char* const* argv) {
  const std::vector<std::string> commands = command_names(app);
  const auto with_suggestion = [](const std::string& what, const std::string& word, const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(word, known);
    return "there is no " + what + " " + word + (nearest.empty() ? "" : ", did you mean " + nearest + "?");
  };
  const CLI::App* command = nullptr;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    if (!word.starts_with("--")) {
      if (command || word.starts_with("-")) continue;
      if (std::find(commands.begin(), commands.end(), word) == commands.end()) return with_suggestion("command", word, commands);
      command = app.get_subcommand(word);
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    const std::vector<std::string> known = long_options(command ? *command : app);
    if (std::find(known.begin(), known.end(), name) == known.end())
      return with_suggestion(command ? "option of " + command->get_name() : "option", name, known);
    const CLI::Option* option = (command ? *command : app).get_option_no_throw(name);
    if (!option) option = app.get_option_no_throw(name);
    if (!command && option && option->get_items_expected_min() > 0 && word.find('=') == std::string::npos)
      ++i;  // the value of an option is not the name of a
            // command
  }
  return {};
}

int parse_and_execute(int argc, const char* const* argv) {
  CLI::App app("sterna: hybrid meshes (prism layers and tetrahedra) around aircraft, for RANS solvers", "sterna");
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", "sterna " STERNA_VERSION);
  app.footer(k_exit_status_help);
  CommonSettings common;
  RunCommand run;
  CheckScriptCommand check_script;
  MeshCommand mesh;
  SurfaceCommand surface;
  HalfCommand half;
  RemeshCommand remesh;
  CacheCommand cache;
  UnionCommand unite;
  RepairCommand repair;
  WrapCommand wrap;
  CheckCommand check;
  GateCommands gates;
  InfoCommand info;
  InspectCommand inspect;
  ConvertCommand convert;
  DrawCommand draw;
  ReportCommand report;
  CaseCommands cases;
  PentagrowCommand pentagrow;
  OptionOverrides set;
  Request request;
  add_common_options(app, common);
  add_run_command(app, run, request);
  add_script_commands(app, check_script, request);
  add_mesh_command(app, mesh, set, request);
  add_surface_command(app, surface, set, request);
  add_half_command(app, half, request);
  add_remesh_command(app, remesh, set, request);
  add_cache_command(app, cache, request);
  add_union_command(app, unite, request);
  add_repair_command(app, repair, set, request);
  add_wrap_command(app, wrap, set, request);
  add_check_command(app, check, request);
  add_gate_commands(app, gates, [&](std::function<int(const CommandContext&)> execute) { request.execute = std::move(execute); });
  add_info_command(app, info, request);
  add_inspect_arguments(*app.add_subcommand("inspect", std::string(k_inspect_summary)), inspect, [&] {
    request.execute = [&](const CommandContext& context) { return execute(inspect, context); };
    request.trouble = beside(std::filesystem::path(inspect.inputs.front()).filename());
  });
  add_convert_command(app, convert, request);
  add_draw_command(app, draw, request);
  add_report_command(app, report, request);
  add_case_commands(app, cases, [&](std::function<int(const CommandContext&)> execute) { request.execute = std::move(execute); });
  ViewCommand view;
  add_view_arguments(app, view)->final_callback([&] { request.execute = [&](const CommandContext& context) { return execute(view, context); }; });
  add_pentagrow_command(app, pentagrow, request);
  add_doctor_command(app, [&](std::function<int(const CommandContext&)> execute) { request.execute = std::move(execute); });
  add_shell_commands(app, [&](std::function<int(const CommandContext&)> execute) { request.execute = std::move(execute); });
  app.add_subcommand("formats", "list the file formats")->final_callback([&] { request.execute = list_formats; });
  // Without arguments and at a terminal the program is a prompt.
  constexpr std::array k_prompt = {"sterna", "prompt"};
  const bool is_alone = argc == 1 && ::isatty(STDIN_FILENO) != 0;
  try {
    if (is_alone) app.parse(static_cast<int>(k_prompt.size()), k_prompt.data());
    else app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (const std::string wrong = misspelling(app, argc, argv); !wrong.empty()) {
      std::fprintf(stderr, "error: %s\nRun with --help for more information.\n", wrong.c_str());
      return k_exit_usage;
    }
    app.exit(error);
    return k_exit_usage;
  }
  return execute_request(request, common);
}

}  // namespace

int run_command_line(int argc, const char* const* argv) noexcept {
  // Before the console exists, and for exceptions other than Error, stderr is the only output.
  try {
    std::vector<const char*> arguments(argv, argv + argc);
    if (argc > 0 && std::filesystem::path(argv[0]).filename() == "pentagrow") arguments.insert(arguments.begin() + 1, "pentagrow");
    // `sterna help --auto` requests help on an option; --auto is no option of help.
    if (argc == 3 && std::string_view(argv[1]) == "help" && std::string_view(argv[2]).starts_with("--") && std::string_view(argv[2]) != "--help")
      arguments[2] += 2;
    return parse_and_execute(static_cast<int>(arguments.size()), arguments.data());
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return exit_status_of(error.code());
  } catch (const std::bad_alloc&) {  // avoid allocating a string here
    std::fputs("error: not enough memory\n  try: a larger limit (ulimit -v, the job's memory)\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", Error(foreign_error(error, "sterna")).what());
  }
  return k_exit_failed;
}

}  // namespace sterna::scripting
