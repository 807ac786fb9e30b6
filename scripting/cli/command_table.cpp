#include "scripting/cli/command_table.h"

#include <algorithm>

#include "geom/cad/write_cad.h"
#include "io/file/format_table.h"
#include "scripting/cli/commands.h"
#include "scripting/cli/determinism.h"
#include "scripting/cli/shell_help.h"
#include "scripting/cli/verb_command.h"
#include "scripting/cli/volume_request.h"
#include "scripting/report/report_command.h"
#include "scripting/values/check_options.h"
#include "scripting/verbs/family_gate.h"
#include "scripting/view/view_command.h"

namespace sterna::scripting {
namespace {

constexpr int k_max_tasks = 1000000, k_last_port = 65535;

std::vector<CommandArgument> joined(std::vector<CommandArgument> a, const std::vector<CommandArgument>& b, const std::vector<CommandArgument>& c) {
  for (const std::vector<CommandArgument>* more : {&b, &c}) a.insert(a.end(), more->begin(), more->end());
  return a;
}

std::string surface_formats() { return "surface file: " + io::list_formats_with(io::FormatUse::write_surface); }
constexpr const char* k_several = "; may be given several times";
std::string known_formats(const std::string& files) { return files + ". `sterna formats` lists the formats"; }

CommandArgument source_argument() {
  return argument::texts(
      "--source",
      "shorter edges in a region, e.g. --source \"line 0 0 0 8 0 0 size=0.02 radius=0.5\"; point, line, box, sphere, cylinder, wake; may be given "
      "several times",
      "SOURCE");
}

/// Options of reading that also apply to models.
bool is_for_models(const Option& option) { return option.name == "fluid" || option.name == "unit"; }

/// Options of `sterna mesh` for triangulations only.
HeldOptions mesh_options_of_triangulations() {
  HeldOptions held = options_of_verb("read_surface");
  std::erase_if(held.table, is_for_models);
  return held;
}

/// Options of `sterna mesh` for triangulations and models.
HeldOptions mesh_options_of_both() {
  static const std::string unit_help = [] {
    const HeldOptions of_models = options_of_verb("read_cad");
    return "length of 1 unit of the file in metres (for models: " + std::ranges::find(of_models.table, "unit", &Option::name)->range_text() +
           ", instead of the unit in the file's header)";
  }();
  HeldOptions held = options_of_verb("read_surface");
  std::erase_if(held.table, [](const Option& option) { return !is_for_models(option); });
  for (Option& option : held.table)
    if (option.name == "unit") option.help = unit_help;
  return joined_options(std::move(held), options_of_verb("volume_mesh"));
}

/// `sterna foam-case` and `sterna su2-config`.
CommandRow case_row(bool is_foam) {
  using namespace argument;
  return {
      .name = is_foam ? "foam-case" : "su2-config",
      .summary = is_foam ? "write a complete OpenFOAM case for a mesh: fields by the kinds of patches, schemes, forces, Allrun"
                         : "write an SU2 configuration for a mesh: markers, flow, reference values and initial settings",
      .verbs = {"read_mesh", is_foam ? "mesh:foam_case" : "mesh:su2_config"},
      .arguments = {file("input", known_formats("volume mesh file; .sterna files keep the growth lines of layers")),
                    output(is_foam ? "folder of the case" : "case.cfg"), options(case_arguments(is_foam)), other(add_flow_words),
                    text("--reference", "model file (sumo, CPACS) with the wing for reference area, length and moment origin", "FILE"),
                    text("--moment-origin", "origin of moments, e.g. 15,0,0", "X,Y,Z"),
                    patches("conditions at an inflow, outflow or actuator disc, e.g. --boundary prop:thrust=800, --boundary "
                            "nozzle:total_pressure=1.5e5,total_temperature=600; may be given several times",
                            "--boundary"),
                    other(add_patch_kinds)},
      .footer =
          is_foam
              ? "sterna foam-case wing.sterna -o case --mach 0.2 --altitude 0 --length 4.2 --alpha 2deg --reference-area 30; then: case/Allrun. docs/flow.md"
              : "sterna su2-config wing.su2 -o wing.cfg --mach 0.78 --altitude 11000 --length 4.2 --alpha 2deg --reference-area 120. docs/flow.md",
      .run = is_foam ? foam_case_command : su2_config_command,
      .alias = is_foam ? "foam_case" : "su2_config"};
}

}  // namespace

const std::vector<CommandRow>& command_rows() {
  using namespace argument;
  static const std::vector<CommandRow> rows = {
      {.name = "run",
       .summary = "run a Lua case",
       .arguments = {file("script", "case.lua; input files are searched in the current folder, then beside the script; outputs go to the current folder"),
                     other(add_script_arguments), set(),
                     whole("--tasks", "number of cases of a series that run at the same time, instead of the value in the script", k_max_tasks),
                     flag("--retry", "series: repeat all cases that failed in an earlier run, whatever the script sets"),
                     hidden("--series-case"),  // set by series{} for its workers
                     hidden("--look-in"),      // set by `sterna determinism` for its runs
                     cache()},
       .run = run_command,
       .picture = "script"},
      {.name = "check-script",
       .summary = "find mistakes in a Lua case without meshing or writing files: unknown verbs and keys, wrong types, units and ranges, missing files",
       .arguments = {file("script", "case.lua"), other(add_script_arguments), set()},
       .run = check_script_command},
      {.name = "prompt",
       .summary =
           "run Lua statements interactively, with all verbs; the default of `sterna` without a command on a terminal. Statements can also come from a pipe"},
      {.name = "manual", .add = add_manual_command},
      {.name = "mesh",
       .summary = "mesh the space around a surface or a model: prism layers and tetrahedra",
       .verbs = {"read_surface", "volume_mesh"},
       .arguments = joined(
           {files(
                "surfaces",
                "surface files; several are joined to one wall. Or model files (STEP, IGES, BREP, sumo, CPACS), whose faces are meshed first. `sterna formats` "
                "lists the formats"),
            outputs("mesh file: " + io::list_formats_with(io::FormatUse::write_volume) + k_several),
            text("--stats", "write sizes, times and memory of this run as JSON", "FILE"),
            text(
                "--stages",
                "write surface, envelope, tetrahedra and mesh to this .sterna file; `sterna mesh case.sterna -o ...` continues after the last step in the file",
                "FILE")},
           volume_arguments("mesh"),
           {flag(
                "--auto",
                "take the files unchanged if they can be meshed, otherwise repair them, otherwise wrap them; remesh triangulations with many sliver triangles; "
                "unite crossing parts of models, or mesh their faces with triangles first. Summary and manifest begin with the changes"),
            flag("--repair", "repair the files first, see `sterna repair --help`; options of repair with --set repair.gap=1e-3 --set repair.hole=0.5"),
            flag("--wrap", "wrap the files first, see `sterna wrap --help`; options of wrap with --set wrap.edge=5mm --set wrap.gap=20mm"),
            flag("--remesh",
                 "remesh the surface first, as `sterna remesh`; options of remesh with --set remesh.max_edge=0.1 --set remesh.curvature_angle=10*deg"),
            text("--fill-crevices",
                 "make crevices and gaps between facing walls solid up to this width, for example 20mm; other options with --set fill_crevices.angle=45*deg"),
            options(mesh_options_of_triangulations(), "for triangulations only"), options(mesh_options_of_both()), options(options_of_verb("mesh:write")),
            set(), cache()}),
       .footer =
           "--time-limit applies to the tetrahedra engines and to reading of models (read_cad.time_limit). Numbers can have units: 0.5mm, 35deg, --unit inch; "
           "without units they are metres, degrees, kelvin. Heights can be computed from the flow: --first-height \"y_plus 1 mach=0.78 altitude=11000 "
           "length=4.2\", --total-height \"boundary_layer factor=1.3 reynolds=6e6 length=1\"; for details run help(y_plus) in `sterna prompt`. For models, "
           "options of the surface mesh are set with --set surface_mesh.max_edge=0.2; `sterna surface --help` lists them.",
       .run = mesh_command,
       .picture = "output"},
      {.name = "surface",
       .summary = "mesh the faces of a model (STEP, IGES, BREP, sumo, CPACS) with triangles, closed where the model is closed",
       .verbs = {"read_cad", "surface_mesh"},
       .arguments =
           {files("models", "model files; several models stay separate. Components of sumo and CPACS files are united first"),
            outputs(surface_formats() + k_several),
            flag("--auto", "unite, repair or wrap if faces cross or the surface is open; triangulations are also repaired or wrapped if required"),
            options(options_of_verb("surface_mesh")), options(options_of_verb("read_cad")), set(), cache(),
            patches("options of faces with matching names, e.g. --patch \"wing*:max_edge=0.1,curvature_angle=8\": max_edge, min_edge, curvature_angle, "
                    "chord_error, leading_edge_factor, trailing_edge_factor; also the options of `sterna mesh --patch` (kind, layers, first_height ...), which "
                    "are stored for the volume mesh; may be given several times"),
            source_argument()},
       .footer = "Numbers can have units: 5mm, 12deg; without units they are metres and degrees.",
       .run = surface_command,
       .picture = "output"},
      {.name = "half",
       .summary = "cut a surface at a plane and write one half; its open boundary is one closed line in the plane",
       .verbs = {"read_surface", "half"},
       .arguments = {file("surface", known_formats("surface file")), output(surface_formats()), options(options_of_verb("half")),
                     unit("length of one unit of the file: mm, inch, 0.5mm ...")},
       .run = half_command,
       .picture = "output"},
      {.name = "remesh",
       .summary = "remesh a surface by curvature and sizes: removes sliver triangles, keeps sharp edges and patches",
       .verbs = {"read_surface", "remesh"},
       .arguments = {file("surface", known_formats("surface file")), outputs(surface_formats() + k_several), options(options_of_verb("remesh")), set(), cache(),
                     patches("options of patches with matching names, e.g. --patch \"wing*:max_edge=0.1,curvature_angle=8\": max_edge, min_edge, "
                             "curvature_angle, chord_error, leading_edge_chordwise, trailing_edge_chordwise ...; may be given several times"),
                     source_argument(), unit("length of one unit of the file: mm, inch, 0.5mm ...")},
       .footer = "Numbers can have units: 5mm, 12deg; without units they are metres and degrees.",
       .run = remesh_command,
       .picture = "output"},
      {.name = "cache",
       .summary = "list the content of a cache, or empty it",
       .arguments = {{.name = "--folder", .help = "folder of the cache, as given to --cache", .type = "FOLDER", .is_required = true},
                     flag("--list", "list every entry"),
                     flag("--clear", "remove all entries")},
       .run = cache_command},
      {.name = "union",
       .summary = "unite closed surfaces that intersect, or the crossing parts of one file, to one wall; or unite models to one model",
       .verbs = {"union"},
       .arguments = {files("parts", known_formats("surface files, or model files (STEP, IGES, BREP, sumo, CPACS)")),
                     output(surface_formats() + "; for models: STEP, IGES, BREP (.step, .iges, .brep)"), options(options_of_verb("union")),
                     unit("length of one unit of the files: mm, inch, 0.5mm ...")},
       .run = union_command,
       .picture = "output"},
      {.name = "repair",
       .summary =
           "close seams and holes of surfaces, cut crossing facets, remove sheets and inner walls; changes as little as possible and reports each change",
       .verbs = {"repair"},
       .arguments = {files("parts", known_formats("surface files")), output(surface_formats()),
                     text("--changes", "write a VTU file with the changed and removed facets", "FILE"),
                     text("--report", "write a JSON file with every change (kind, location, size, facets) and the distances", "FILE"),
                     options(options_of_verb("repair")), set(), cache()},
       .footer = "docs/dirty_surfaces.md describes the steps, their order and limits.",
       .run = repair_command,
       .picture = "output"},
      {.name = "wrap",
       .summary = "wrap damaged surfaces in one closed surface close to them, with their sharp edges and patches",
       .verbs = {"wrap"},
       .arguments = {files("parts", known_formats("surface files")), output(surface_formats()),
                     text("--changes", "write a VTU file with the triangles that close openings, and those at leaks", "FILE"),
                     text("--report", "write a JSON file with every closure and leak (kind, location, size) and the distances", "FILE"),
                     options(options_of_verb("wrap")), set(), cache()},
       .footer = "Numbers can have units: --edge 5mm, --gap 20mm, --features 35deg, --unit inch; without units they are metres and degrees. docs/wrap.md "
                 "describes the steps and limits.",
       .run = wrap_command,
       .picture = "output"},
      {.name = "check",
       .summary =
           "prove that a volume mesh tiles its domain and measure its quality; exit status 0 only if it is VALID. For a model (STEP ...): report whether it "
           "is closed, and list open edges",
       .verbs = {"read_mesh", "mesh:check"},
       .arguments =
           {file("mesh", "mesh file, or model file"), flag("--json", "print the report as JSON"),
            texts("--model",
                  "compare the walls of the mesh with the model from which it was made (gates G17, G18): STEP, IGES, BREP, sumo, CPACS; may be given several "
                  "times",
                  "FILE"),
            whole("--findings-per-kind", "number of locations listed for each kind of violation"),
            flag("--strict", "exit status 3 also if a QUALITY gate FAILs for the solvers of --for"),
            text("--for", "solvers of the verdict, e.g. --for su2,openfoam: " + known_solvers() + "; default: the solvers that read the format of the file",
                 "SOLVER,..."),
            flag("--cell-centred,!--no-cell-centred", "also compute the measures of cell-centred solvers: OpenFOAM's non-orthogonality, skewness ... (default)",
                 CheckSettings{}.cell_centred),
            text("--cells", "write the mesh with the quality of each cell (scaled Jacobian, volume, dihedral angles as VTK defines them) to this .vtu file",
                 "FILE"),
            texts("--gate",
                  "limits of a QUALITY gate, instead of the defaults, e.g. --gate orthogonality:hard=3deg,target=15deg --gate face_weight:none; help "
                  "\"mesh:check\" lists them; may be given several times",
                  "MEASURE:LIMITS"),
            flag("--intersections,!--no-intersections", "test boundaries exactly for intersection (default)", CheckSettings{}.intersections)},
       .run = check_command,
       .picture = "mesh"},
      {.name = "determinism",
       .summary =
           "gate G22: run a Lua case once for each number of threads, in separate folders, and compare all written files byte by byte; exit status 0 only "
           "if they are equal",
       .arguments = {file("script",
                          "case.lua; input files are searched in the current folder, then beside the script; files written under absolute names are not "
                          "compared"),
                     other(add_script_arguments), other(add_thread_numbers), set(), flag("--json", "print the report as JSON")},
       .footer = "Pages (.html), logs and measures of cases contain times; they are not compared, and the report lists them. The files of the runs are removed "
                 "if all are equal, otherwise kept below TMPDIR.",
       .run = determinism_command},
      {.name = "check-family",
       .summary = "check that meshes are members of one family: the same factor between successive meshes in nodes, walls, first heights, layers and growth; "
                  "exit status 3 if a rule FAILs",
       .verbs = {"check_family"},
       .arguments = {files("meshes", "mesh files from coarse to fine; .sterna files contain most data, manifests <file>.json beside the files are read"),
                     options(options_of_verb("check_family")), flag("--json", "print the report as JSON")},
       .run = check_family_command},
      {.name = "info",
       .summary = "describe a surface, mesh or model file: counts, patches, bounding box, units; for models also areas, volumes, mean chords",
       .arguments = {file("file", "surface, mesh or model file"), text("--unit", "length of one unit of the file: mm, inch, 0.5mm ..."),
                     flag("--json", "print JSON (schema sterna-info-1)")},
       .run = info_command,
       .picture = "file",
       .prints_findings = true},
      {.name = "inspect",
       .summary = "predict within seconds how volume_mesh will treat a surface: reasons to refuse it, low layers, bad cells, each with a line of advice. Exit "
                  "status 0 if there is no error, else 1",
       .verbs = {"inspect"},
       .arguments = joined(
           {files("surfaces", known_formats("surface files; several are joined to one wall. Or model files, whose faces are meshed first")),
            text("-o,--output",
                 "picture of the findings: .vtu, the surface with the predicted fraction of the layer's height, visibility angles, gaps and findings; or .png",
                 "FILE"),
            flag("--json", "print the report as JSON"), flag("--strict", "exit status 1 also if there are warnings"),
            text("--flow", "flow conditions, for the y+ of the first height, e.g. --flow \"mach=0.78 altitude=11000 length=4.2\"", "CONDITIONS")},
           volume_arguments("inspect"), {options(inspect_arguments()), set()}),
       .footer = "Without --first-height the surface is inspected, but layer heights are not predicted. Options of later stages (tetrahedra ...) are accepted "
                 "without effect. For models, options of the surface mesh are set with --set surface_mesh.max_edge=0.2.",
       .run = inspect_command,
       .picture = "surfaces"},
      {.name = "convert",
       .summary = "write a surface, a volume mesh or a model in another format",
       .verbs = {"read_mesh", "mesh:write"},
       .arguments = {file("input", "surface, mesh or model file (STEP, IGES, BREP, sumo .smx, CPACS .xml)"),
                     file("output", "file to write; `sterna formats` lists the formats"),
                     text("--format", "format of the output by its name in `sterna formats`, e.g. \"STL text\"; default: by the extension", "NAME"),
                     flag("--surface", "write the boundary of a volume mesh"), options(options_of_verb("read_cad")), options(held_options<WriteCadOptions>()),
                     options(options_of_verb("mesh:write"))},
       .run = convert_command,
       .picture = "output"},
      {.name = "draw",
       .summary = "draw a surface or volume mesh as a PNG picture: walls, cells along a plane, colours by quality; needs no display",
       .verbs = {"draw"},
       .arguments = {file("mesh", known_formats("surface or mesh file")), output("picture.png"), options(options_of_verb("draw")), other(add_picture_size)},
       .footer =
           "sterna draw mesh.su2 -o wing.png --view iso --color quality; --cut \"leading edge\"; --cut x=1.2 --focus \"1.2,3,0 radius=0.1\" --color volume",
       .run = draw_command,
       .picture = "output"},
      {.name = "report",
       .summary = "write a page (one HTML file) that shows a mesh: view, cuts, worst locations, histograms, gates, coverage, options",
       .verbs = {"report"},
       .arguments = {file("mesh", known_formats("volume mesh or surface file")), output("page.html"),
                     texts("--cut",
                           "cut at a location by name (\"leading edge\", \"tip\" ...), \"x=1.2\", or \"point=0,0,0 normal=0,1,0\", shown before the automatic "
                           "cuts; may be given several times",
                           "CUT"),
                     texts("--gate", "limits of a QUALITY gate, instead of the defaults, as for `sterna check`; may be given several times", "MEASURE:LIMITS"),
                     options(options_of_verb("report"))},
       .footer = "sterna report mesh.cgns -o mesh.html --cut \"leading edge\" --cut x=1.2. Exit status 3 if the mesh is INVALID; the page is written in any "
                 "case.",
       .run = report_command,
       .picture = "output"},
      case_row(true),
      case_row(false),
      {.name = "view",
       .summary = "open the workbench: a page in the browser that shows the results of a script and follows its changes",
       .arguments = {file("file", "case.lua; or a file of a model, surface or volume mesh; or the folder of a series that was run"),
                     other(add_script_arguments),
                     whole("--port", "port on 127.0.0.1; default: any free port", k_last_port, "N"),
                     flag("--no-browser", "only print the address"),
                     set(),
                     cache("store results of stages in this folder; default: until the workbench ends"),
                     {.takes = CommandArgument::Takes::flag, .name = "--worker", .is_hidden = true}},  // see view_worker.h
       .footer = "sterna view case.lua span=11 --port 8123. Ctrl-C ends it. From another machine: ssh -L 8123:127.0.0.1:8123 HOST. See docs/view.md.",
       .run = view_command},
      {.name = "pentagrow",
       .summary = "mesh the space around a surface by a configuration of pentagrow, with pentagrow's file names; also available as the program pentagrow "
                  "beside sterna",
       .arguments = {file("surface", "surface file"), text("config", "configuration file with lines Key = value; default: the defaults of pentagrow")},
       .run = pentagrow_command},
      {.name = "doctor",
       .summary = "test this installation: versions, processor, memory, engines, page, browser, and a small mesh by each engine",
       .run = doctor_command},
      {.name = "completion", .add = add_shell_commands},
      {.name = "formats", .summary = "list the file formats", .run = formats_command}};
  return rows;
}

}  // namespace sterna::scripting
