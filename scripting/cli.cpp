// Parsing only: what the commands do is in commands.cpp. CLI11 is slow to compile, so this is the one file that includes it.
#include "scripting/cli.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <functional>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/unite.h"
#include "geom/cad/write_cad.h"
#include "io/format_table.h"
#include "scripting/commands.h"
#include "scripting/console.h"
#include "scripting/exit_status.h"
#include "scripting/interrupt.h"
#include "scripting/verbs.h"

namespace sterna::scripting {
namespace {

/// More threads are a slip of the keyboard: far above any machine, far below what the system refuses.
constexpr int k_max_threads = 1024;

/// Options that every command has.
struct CommonSettings {
  ConsoleSettings console;
  int threads = 0;
  std::uint64_t seed = 1;
  std::filesystem::path dump_directory;
};

/// What the command line asks for: one command, and where the picture of a failure goes.
struct Request {
  std::function<int(const CommandContext&)> execute;
  std::filesystem::path trouble;  ///< beside the output, or beside the input of commands that write nothing
};

std::string kebab(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

/// "stage.option=value" as name and value.
std::pair<std::string, std::string> split_assignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw CLI::ValidationError("--set", "\"" + text + "\" is not stage.option=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void add_set_option(CLI::App& command, OptionOverrides& overrides) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&overrides](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) overrides.push_back(split_assignment(text));
          },
          "any option of any stage, e.g. --set envelope.layers=24")
      ->type_name("STAGE.OPTION=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

/// One --kebab-name for each option of the schema, grouped by stage.
void add_schema_options(CLI::App& command, const OptionTable& table, OptionOverrides& overrides) {
  for (const Option& option : table) {
    const std::string name(option.name);
    std::string help = std::string(option.help) + "; " + option.default_text();
    if (const std::string range = option.range_text(); !range.empty()) help += "; " + range;
    // Given twice, both are kept: set_options refuses them where they differ.
    CLI::Option* added = command.add_option_function<std::vector<std::string>>(
        "--" + kebab(name),
        [&overrides, name](const std::vector<std::string>& texts) {
          for (const std::string& text : texts) overrides.emplace_back(name, text.empty() ? "true" : text);
        },
        help);
    added->group("Options of stage " + std::string(option.stage));
    added->type_name(option.kind == OptionKind::boolean ? "[true|false]" : option.kind == OptionKind::text ? "TEXT" : "NUMBER");
    added->allow_extra_args(false)->take_all();
    if (option.kind == OptionKind::boolean) added->expected(0, 1);
  }
}

void add_common_options(CLI::App& app, CommonSettings& common) {
  app.add_option("--threads", common.threads, "worker threads; 0 = all of the machine. The result does not depend on it")->check(CLI::Range(0, k_max_threads));
  app.add_option("--seed", common.seed, "seed of random numbers (math.random of scripts)");
  app.add_flag("-q,--quiet", common.console.is_quiet, "no log and no progress, only results, warnings and errors");
  app.add_flag("-v,--verbose", common.console.is_verbose, "more log");
  app.add_option("--log", common.console.log_file, "write every log line with its time to this file")->type_name("FILE");
  app.add_option("--dump-dir", common.dump_directory, "where VTU pictures of failures go; default: beside the output")->type_name("FOLDER")->check(CLI::ExistingDirectory);
}

std::filesystem::path beside(const std::filesystem::path& file) { return file.string() + ".trouble.vtu"; }

void add_run_command(CLI::App& app, RunCommand& run, Request& request) {
  CLI::App* command = app.add_subcommand("run", "run a Lua case");
  command->add_option("script", run.script, "case.lua; input files are looked for in the current folder, then beside it; outputs go to the current folder")->required();
  add_set_option(*command, run.overrides);
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(run, context); };
    request.trouble = beside(run.script.filename());
  });
}

void add_mesh_command(CLI::App& app, MeshCommand& mesh, OptionOverrides& set, Request& request) {
  CLI::App* command = app.add_subcommand("mesh", "mesh the space around a surface or a model: prism layers and tetrahedra");
  command->add_option("surfaces", mesh.inputs, "surface files; several are joined to one wall. Or model files (STEP, IGES, BREP, sumo, CPACS), whose faces are meshed first. `sterna formats` lists what is read")->required();
  command->add_option("-o,--output", mesh.outputs, "mesh file: " + io::list_formats_with(io::FormatUse::write_volume) + "; may be given several times")->required()->allow_extra_args(false)->take_all();
  command->add_option("--stats", mesh.stats, "write sizes, times and memory of this run as JSON")->type_name("FILE");
  command->add_option("--stages", mesh.stages, "keep surface, envelope, tetrahedra and mesh in this .sterna file; `sterna mesh case.sterna -o ...` continues behind the last step in it")->type_name("FILE");
  surfmesh::StitchOptions surface;
  volmesh::VolumeMeshOptions volume;
  add_schema_options(*command, all_options(surface, volume), mesh.options);
  add_set_option(*command, set);
  command->footer("Numbers take units: 2e-6, 0.5mm, 35deg, --unit inch. Of models, options of their surface: --set surface_mesh.max_edge=0.2; `sterna surface --help` lists them.");
  command->final_callback([&] {
    mesh.options.insert(mesh.options.end(), set.begin(), set.end());
    request.execute = [&](const CommandContext& context) { return execute(mesh, context); };
    request.trouble = beside(mesh.outputs.front());
  });
}

/// A bare number of an angle is in degrees here; what could be either is left as it is, and refused.
std::string with_degrees(const std::string& name, const std::string& text) {
  constexpr double k_surely_degrees = 1.6;  // largest curvature_angle in radians
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (name != "curvature_angle" || error != std::errc() || end != text.data() + text.size()) return text;
  if (value > k_surely_degrees) return text + "deg";
  throw Error({.code = ErrorCode::bad_argument, .attempted = "option curvature_angle", .problem = text + " may be degrees or radians", .hint = "write " + text + "deg or " + text + "rad"});
}

/// --patch "wing*:max_edge=0.1,curvature_angle=8": of two patterns that match the one with more letters counts.
void add_patch_option(CLI::App& command, std::vector<std::pair<std::string, OptionOverrides>>& patches) {
  command
      .add_option_function<std::vector<std::string>>(
          "--patch",
          [&patches](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const std::size_t equals = text.find('='), colon = text.rfind(':', equals);
              if (equals == std::string::npos || colon == std::string::npos || colon == 0) throw CLI::ValidationError("--patch", "\"" + text + "\" is not NAMES:OPTION=VALUE,OPTION=VALUE");
              auto& [names, options] = patches.emplace_back(text.substr(0, colon), OptionOverrides{});
              std::istringstream list(text.substr(colon + 1));
              for (std::string entry; std::getline(list, entry, ',');) {
                const std::size_t at = entry.find('=');
                if (at == std::string::npos || at == 0) throw CLI::ValidationError("--patch", "\"" + entry + "\" is not OPTION=VALUE");
                options.emplace_back(entry.substr(0, at), entry.substr(at + 1));
              }
            }
          },
          "what faces with such names ask for instead, e.g. --patch \"wing*:max_edge=0.1,curvature_angle=8\": max_edge, min_edge, curvature_angle, chord_error, leading_edge_factor, trailing_edge_factor; may be given several times")
      ->type_name("NAMES:OPTION=VALUE,...")
      ->allow_extra_args(false)
      ->take_all();
}

void add_surface_command(CLI::App& app, SurfaceCommand& surface, OptionOverrides& set, Request& request) {
  CLI::App* command = app.add_subcommand("surface", "mesh the faces of a model (STEP, IGES, BREP, sumo, CPACS): triangles, closed where the model is");
  command->add_option("models", surface.inputs, "model files; several stand side by side. Components of sumo and CPACS files are united first")->required();
  command->add_option("-o,--output", surface.outputs, "surface file: " + io::list_formats_with(io::FormatUse::write_surface) + "; may be given several times")->required()->allow_extra_args(false)->take_all();
  surfmesh::SurfaceMeshOptions options;
  ReadCadOptions reading;
  add_schema_options(*command, model_surface_options(options, reading), surface.options);
  add_set_option(*command, set);
  add_patch_option(*command, surface.patches);
  command->add_option("--source", surface.sources, "shorter edges in a region, e.g. --source \"line 0 0 0 8 0 0 size=0.02 radius=0.5\"; point, line, box, sphere, cylinder, wake; may be given several times")
      ->type_name("SOURCE")->allow_extra_args(false)->take_all();
  command->footer("Numbers take units: 0.2, 5mm, 12deg; --curvature-angle 12 is degrees, too.");
  command->final_callback([&] {
    for (auto& [names, options] : surface.patches)
      for (auto& [name, text] : options) text = with_degrees(name, text);
    for (auto& [name, text] : surface.options) text = with_degrees(name, text);
    surface.options.insert(surface.options.end(), set.begin(), set.end());
    request.execute = [&](const CommandContext& context) { return execute(surface, context); };
    request.trouble = beside(surface.outputs.front());
  });
}

void add_union_command(CLI::App& app, UnionCommand& unite, Request& request) {
  CLI::App* command = app.add_subcommand("union", "unite closed surfaces that stick in each other, or the crossing parts of one file, to one wall; or models to one model");
  command->add_option("parts", unite.inputs, "surface files, or model files (STEP, IGES, BREP, sumo, CPACS). `sterna formats` lists what is read")->required();
  command->add_option("-o,--output", unite.output, "surface file: " + io::list_formats_with(io::FormatUse::write_surface) + "; of models: STEP, IGES, BREP (.step, .iges, .brep)")->required();
  UnionOptions options;
  UniteOptions models;
  add_schema_options(*command, sterna::options_of(options), unite.options);
  add_schema_options(*command, sterna::options_of(models), unite.options);
  command->add_option_function<std::string>("--unit", [&unite](const std::string& text) { unite.options.emplace_back("unit", text); }, "length of one unit of the files: mm, inch, 0.5mm ...");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(unite, context); };
    request.trouble = beside(unite.output);
  });
}

void add_check_command(CLI::App& app, CheckCommand& check, Request& request) {
  CLI::App* command = app.add_subcommand("check", "prove that a volume mesh tiles its domain and measure its quality; exit status 0 only if it is VALID. Of a model (STEP ...): whether it is closed, and where not");
  command->add_option("mesh", check.input, "mesh file, or model file")->required();
  command->add_flag("--json", check.is_json, "print the report as JSON");
  command->add_option("--findings-per-kind", check.options.findings_per_kind, "places listed for each kind of violation")->check(CLI::PositiveNumber);
  command->add_flag("--strict", check.options.strict, "exit status 3 also when a QUALITY gate FAILs");
  command->add_flag("--intersections,!--no-intersections", check.options.intersections, "test boundaries exactly for intersection (default)");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(check, context); };
    request.trouble = beside(std::filesystem::path(check.input).filename());
  });
}

void add_info_command(CLI::App& app, InfoCommand& info, Request& request) {
  CLI::App* command = app.add_subcommand("info", "say what a surface, mesh or model file holds: counts, patches, box, units; of models areas, volumes, mean chords");
  command->add_option("file", info.input, "surface, mesh or model file")->required();
  command->add_option("--unit", info.unit, "length of one unit of the file: mm, inch, 0.5mm ...");
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(info, context); };
    request.trouble = beside(std::filesystem::path(info.input).filename());
  });
}

void add_convert_command(CLI::App& app, ConvertCommand& convert, Request& request) {
  CLI::App* command = app.add_subcommand("convert", "write a surface, a volume mesh or a model in another format");
  command->add_option("input", convert.input, "surface, mesh or model file (STEP, IGES, BREP, sumo .smx, CPACS .xml)")->required();
  command->add_option("output", convert.output, "file to write; `sterna formats` lists the formats")->required();
  command->add_option("--format", convert.settings.format, "format of the output by its name in `sterna formats`, e.g. \"STL text\"; default: by the extension")->type_name("NAME");
  command->add_flag("--surface", convert.settings.as_surface, "of a volume mesh write the boundary");
  ReadCadOptions reading;
  WriteCadOptions writing;
  for (const OptionTable& table : {sterna::options_of(reading), sterna::options_of(writing)}) add_schema_options(*command, table, convert.options);
  command->final_callback([&] {
    request.execute = [&](const CommandContext& context) { return execute(convert, context); };
    request.trouble = beside(convert.output);
  });
}

int execute_request(const Request& request, const CommonSettings& common) {
  const InterruptGuard interrupt;
  Console console(common.console);
  const RunContext context({.threads = common.threads,
                            .seed = common.seed,
                            .stop = interrupt.token(),
                            .dump_directory = common.dump_directory,
                            .log = [&](LogLevel level, std::string_view text) { console.log(level, text); },
                            .progress = [&](const ProgressState& state) { console.progress(state); }});
  try {
    return request.execute({console, context});
  } catch (const Error& error) {
    const std::filesystem::path trouble = common.dump_directory.empty() ? request.trouble : common.dump_directory / request.trouble.filename();
    console.end_progress();
    console.error(error.what() + draw_trouble(error, trouble));
    return exit_status_of(error.code());
  }
}

/// The commands of the program by name, or the long options that a command takes.
std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}
std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* level = &app; level; level = level->get_parent())
    for (const CLI::Option* option : level->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// What is misspelt in a command line that was refused, with a suggestion; empty where every name is known and something else is wrong.
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
    if (std::find(known.begin(), known.end(), name) == known.end()) return with_suggestion(command ? "option of " + command->get_name() : "option", name, known);
    const CLI::Option* option = (command ? *command : app).get_option_no_throw(name);
    if (!option) option = app.get_option_no_throw(name);
    if (!command && option && option->get_items_expected_min() > 0 && word.find('=') == std::string::npos) ++i;  // its value is no command
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
  MeshCommand mesh;
  SurfaceCommand surface;
  UnionCommand unite;
  CheckCommand check;
  InfoCommand info;
  ConvertCommand convert;
  OptionOverrides set;
  Request request;
  add_common_options(app, common);
  add_run_command(app, run, request);
  add_mesh_command(app, mesh, set, request);
  add_surface_command(app, surface, set, request);
  add_union_command(app, unite, request);
  add_check_command(app, check, request);
  add_info_command(app, info, request);
  add_convert_command(app, convert, request);
  app.add_subcommand("formats", "list the file formats")->final_callback([&] { request.execute = list_formats; });
  try {
    app.parse(argc, argv);
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
  // Before the console stands, and for what no Error describes, stderr is all there is.
  try {
    return parse_and_execute(argc, argv);
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return exit_status_of(error.code());
  } catch (const std::bad_alloc&) {
    std::fputs("error: not enough memory\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s (please report this)\n", error.what());
  }
  return k_exit_failed;
}

}  // namespace sterna::scripting
