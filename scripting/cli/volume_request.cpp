#include "scripting/cli/volume_request.h"

#include "geom/base/error.h"
#include "geom/mesh/half.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/wake_verbs.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/half_verbs.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {

std::vector<CommandArgument> volume_arguments(const std::string& what) {
  return {
      argument::texts(
          "--disc",
          "an actuator disc in the fluid, e.g. --disc \"prop center=-0.4,0,0 axis=1,0,0 radius=1.2 inner_radius=0.25 edge=5cm\"; may be given several times",
          "DISC"),
      argument::texts("--wake-sheet",
                      "experimental: continue layers behind trailing edges: --wake-sheet auto, or options of wake_sheet such as --wake-sheet \"wing=main* "
                      "length=2\" (length in chords; also growth, "
                      "direction); may be given several times",
                      "SHEET"),
      argument::texts("--periodic",
                      "two flat sides, each the translated image of the other, e.g. --periodic left,right: the meshes of both sides match node by node; may be "
                      "given several times",
                      "FIRST,SECOND"),
      argument::texts(
          "--source",
          "shorter edges in a region, e.g. --source \"cylinder from=1,0,0 to=8,0,0 radius=0.5 size=5cm\"; point, line, box, sphere, cylinder, wake; may be "
          "given several times",
          "SOURCE"),
      argument::texts(
          "--wake",
          "shorter edges behind the whole body, e.g. --wake length=2 (body lengths), or --wake \"length=3 size=5cm direction=1,0,0.05\"; size_end, spread",
          "WAKE"),
      argument::text(
          "--farfield",
          "farfield around the bodies: \"sphere radius=100 edge=20\", \"box -10 -5 -5 20 5 5 edge=2 x_min=inflow x_max=outflow,edge:0.5\", \"cylinder -10 0 0 "
          "20 0 0 radius=5 edge=1\", \"none\", or the file of a closed surface",
          "SHAPE"),
      argument::flag(
          "--half",
          what + " half of the surface, cut at a plane, by default the half y > 0; other planes with --set half.axis=z --set half.at=0.5 --set half.keep=-"),
      argument::patches(
          "options of patches with matching names, e.g. --patch \"tunnel*:layers=20,first_height=2e-5\": kind (slip, symmetry, inflow, outflow, "
          "farfield, interface, wall), layers, first_height, max_growth, total_height, max_thickness, blend, open_ridges, truncate; for models also "
          "the options of `sterna surface --patch`: max_edge ...; may be given several times"),
  };
}

OptionOverrides options_with_farfield(const CommandLine& line) {
  OptionOverrides options = line.all("farfield").empty() ? OptionOverrides() : farfield_of_text(line.word("farfield"));
  options.insert(options.end(), line.options.begin(), line.options.end());
  return options;
}

std::vector<OptionsElsewhere> options_of_other_files(bool is_model, const std::string& file, AutoSurface& unused) {
  std::vector<OptionsElsewhere> result;
  if (is_model) result.push_back({sterna::options_of(unused.stitching), "applies to triangulations (STL ...), and " + file + " is a model"});
  else
    result.push_back(
        {model_surface_options(unused.recipe.options, unused.reading), "applies to the faces of models (STEP ...), and " + file + " is a triangulation"});
  return result;
}

void read_features(const CommandLine& line, volmesh::MeshCase& options) {
  for (const std::string& text : line.all("disc")) options.discs.push_back(disc_of_text(text));
  for (const std::string& text : line.all("wake-sheet")) options.wakes.push_back(wake_sheet_of_text(text));
  for (const std::string& text : line.all("periodic")) options.periodic.push_back(periodic_of_text(text));
}

std::vector<volmesh::SizeSource> sources_of(const std::vector<std::string>& texts) {
  std::vector<volmesh::SizeSource> sources;
  for (const std::string& text : texts) sources.push_back(source_of_text(text));
  return sources;
}

void add_sources(const CommandLine& line, const TriMesh& wall, volmesh::MeshCase& options) {
  for (volmesh::SizeSource& source : sources_of(line.all("source"))) options.sources.push_back(std::move(source));
  for (const std::string& text : line.all("wake")) options.sources.push_back(wake_of_text(text, wall));
}

HalfOptions half_options(const CommandLine& line, const OptionOverrides& half, const CommandContext& context) {
  const bool is_half = line.flag("half");
  if (!is_half && !half.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + half.front().first, .problem = "is given without --half"});
  HalfOptions options;
  if (is_half) set_options(sterna::options_of(options), half, context);
  return options;
}

SurfaceValue halved(const CommandLine& line, const OptionOverrides& half, const SurfaceValue& wall, const CommandContext& context) {
  const HalfOptions options = half_options(line, half, context);
  return line.flag("half") ? half_surface(wall, options, context.run) : wall;
}

void read_farfield_of(volmesh::MeshCase& options, SurfaceValue& wall, const RunContext& context) {
  const SurfaceHandle surface = read_farfield(
      options.farfield,
      [](const std::string& name) {
        return InputPath{name, name};
      },
      context);
  if (!surface) return;
  options.farfield_surface = std::shared_ptr<const TriMesh>(surface, &surface->mesh);
  wall.inputs.insert(wall.inputs.end(), surface->inputs.begin(), surface->inputs.end());
}

}  // namespace sterna::scripting
