// Each verb builds the layer domain (wall, outer boundary, and their hierarchy) again, because a value contains only the data of a file.
#include "scripting/verbs/envelope_steps.h"

#include <algorithm>
#include <array>
#include <memory>

#include "geom/base/error.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/envelope_domain.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/wake_verbs.h"
#include "scripting/verbs/farfield_verbs.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/parts/joint_envelope.h"

namespace sterna::scripting {
namespace {

using volmesh::EnvelopeStep;
using volmesh::LayerDomain;
using volmesh::MeshCase;

/// Returns the options of the envelope with these names, separated by blanks, and those of the farfield if the list contains it.
OptionTable some_options(MeshCase& options, std::string_view names) {
  const std::string padded = " " + std::string(names) + " ";
  OptionTable table = envelope_options(options);
  std::erase_if(table, [&](const Option& option) {
    return padded.find(" " + std::string(option.stage == "farfield" ? option.stage : option.name) + " ") == std::string::npos;
  });
  return table;
}

/// Rejects walls with placed parts, and periodic sides. The steps treat the wall as one surface, but make_envelope performs further steps in these cases, so
/// the steps would not give its envelope.
void require_one_part(const ScriptCall& call, const LayerDomain& layer_domain, const RunContext& context) {
  if (!layer_domain.options.periodic.empty())
    reject(call, "the single envelope steps do not keep periodic sides identical", "make_envelope{ wall, periodic = ... } performs all steps");
  const std::vector<volmesh::WholePart> parts = volmesh::whole_parts(layer_domain.domain, layer_domain.options.parts, context);
  if (parts.empty()) return;
  const volmesh::PlacedPart& first = layer_domain.options.parts[parts.front().part];
  if (parts.size() == 1 && first.placement == Transform{} && first.own->n_triangles() == layer_domain.base.wall.n_triangles()) return;
  reject(call,
         "the wall has " + std::to_string(parts.size()) + (parts.size() == 1 ? " part" : " parts") +
             " with envelopes made in their own frames, then moved and separated from each other: the single envelope steps take a wall as a whole",
         "make_envelope{ wall, ... } performs all steps; surface_mesh{ ..., gap_cells = ... } meshes all parts together in position, and a surface of "
         "read_surface has no parts");
}

SurfaceHandle with_inputs(const SurfaceHandle& wall, const std::vector<InputFile>& inputs) {
  if (inputs.empty()) return wall;
  auto given = std::make_shared<SurfaceValue>(*wall);
  given->inputs.insert(given->inputs.end(), inputs.begin(), inputs.end());
  return given;
}

// ---- classify, initial ---------------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_classify_names = "feature_angle farfield";
constexpr std::string_view k_classify_usage = "envelope.classify{ wall, feature_angle = 40*deg }";
constexpr std::string_view k_initial_names =
    "layers first_height max_growth total_height solve_for max_thickness max_relative_height height_gradient refinement family_wake farfield";
constexpr std::string_view k_initial_usage = "envelope.initial{ wall, class, layers = 5, first_height = 0.01, max_growth = 1.35 }";

/// Reads the wall as entry 1 and, for the verb initial, the classes as entry 2.
SurfaceHandle wall_of(TableReader& reader, std::string_view usage) {
  const std::vector<ScriptValue>& items = reader.items();
  if (const auto* wall = items.empty() ? nullptr : std::get_if<SurfaceHandle>(&items.front())) return *wall;
  reader.add_problem("entry 1: expected a surface (from surface_mesh or read_surface), not " +
                     std::string(items.empty() ? "nothing" : type_text(items.front())) + ": " + std::string(usage));
  return nullptr;
}

ScriptValue classify(const ScriptCall& call) {
  MeshCase options;
  std::vector<InputFile> inputs;
  const ScriptTable table = with_farfield(call, table_argument(call, 0, k_classify_usage), options.farfield_surface, inputs);
  const OptionTable schema = some_options(options, k_classify_names);
  TableReader reader(table, call.attempted());
  const SurfaceHandle wall = wall_of(reader, k_classify_usage);
  if (reader.items().size() > 1) reader.add_problem("entry 2: unexpected, only one entry without a name is allowed");
  reader.read_options(schema);
  options.discs = read_interfaces(reader, call);
  options.wakes = read_wakes(reader, call);
  options.patches = read_layer_rules(reader);
  apply_overrides(call, schema);
  reader.finish();
  const RunContext context = call.session.context.part("classify", 0.0, 1.0);
  EnvelopeValue value{.wall = with_inputs(wall, inputs), .options = options, .stage = {}, .step = EnvelopeStep::classified};
  value.stage.feature_angle = options.envelope.feature_angle;
  const auto layer_domain = envelope_domain(value, context);
  require_one_part(call, *layer_domain, context);
  value.classes = std::make_shared<const volmesh::Classification>(volmesh::classify_vertices(layer_domain->base, layer_domain->options.envelope, context));
  value.stage.feature_angle = layer_domain->options.envelope.feature_angle;
  return std::make_shared<const EnvelopeValue>(std::move(value));
}

ScriptValue make_initial(const ScriptCall& call) {
  const ScriptTable given = table_argument(call, 0, k_initial_usage);
  const auto* classes = given.items.size() < 2 ? nullptr : std::get_if<EnvelopeHandle>(&given.items[1]);
  const bool is_classified = classes && ((*classes)->step == EnvelopeStep::classified || call.session.check);
  MeshCase options = is_classified ? (*classes)->options : MeshCase();
  std::vector<InputFile> inputs;
  const ScriptTable table = with_farfield(call, given, options.farfield_surface, inputs);
  const OptionTable schema = some_options(options, k_initial_names);
  TableReader reader(table, call.attempted());
  SurfaceHandle wall = wall_of(reader, k_initial_usage);
  if (given.items.size() != 2 || !is_classified) reader.add_problem("entry 2: expected the result of envelope.classify: " + std::string(k_initial_usage));
  else if (wall && (*classes)->wall->mesh.n_vertices() != wall->mesh.n_vertices()) reader.add_problem("entry 2: belongs to another wall");
  const FunctionHandle first_heights = read_first_heights(reader, call);
  reader.read_options(schema);
  if (table.fields.contains("interfaces")) options.discs = read_interfaces(reader, call);
  if (table.fields.contains("wakes")) options.wakes = read_wakes(reader, call);
  if (table.fields.contains("patches")) options.patches = read_layer_rules(reader);
  apply_overrides(call, schema);
  complete_layers(options, reader, call);
  MeshCase known = options;
  if (wall) known.patches.insert(known.patches.end(), wall->layers.begin(), wall->layers.end());  // the rules of the surface may give the first height
  reader.require(volmesh::required_options_of(known));
  reader.finish();
  set_first_heights(first_heights, *wall, options, call.session.context);
  const RunContext context = call.session.context.part("initial", 0.0, 1.0);
  EnvelopeValue value{.wall = with_inputs((*classes)->wall, inputs), .options = options, .stage = {}, .step = EnvelopeStep::initial};
  value.stage.feature_angle = (*classes)->stage.feature_angle;
  const auto layer_domain = envelope_domain(value, context);
  require_one_part(call, *layer_domain, context);
  value.stage.envelope = volmesh::initial_envelope(layer_domain->base, layer_domain->options.envelope, context);
  return std::make_shared<const EnvelopeValue>(std::move(value));
}

// ---- The steps that change an envelope --------------------------------------------------------------------------------------------------------

struct Step {
  std::string_view verb;
  EnvelopeStep needs, makes;
  std::string_view options;
  std::string_view usage;
  void (*run)(LayerDomain&, volmesh::Envelope&, const RunContext&);
};

void run_smooth(LayerDomain& layer_domain, volmesh::Envelope& envelope, const RunContext& context) {
  volmesh::smooth_step(layer_domain.base, volmesh::classify_vertices(layer_domain.base, layer_domain.options.envelope, context), layer_domain.options.envelope,
                       envelope, context);
}
void run_untangle(LayerDomain& layer_domain, volmesh::Envelope& envelope, const RunContext& context) {
  volmesh::untangle_step(layer_domain.base, layer_domain.options.envelope, envelope, context);
}
void run_unwarp(LayerDomain& layer_domain, volmesh::Envelope& envelope, const RunContext& context) {
  volmesh::unwarp_step(layer_domain.base, volmesh::classify_vertices(layer_domain.base, layer_domain.options.envelope, context), layer_domain.options.envelope,
                       envelope, context);
}
void run_retract(LayerDomain& layer_domain, volmesh::Envelope& envelope, const RunContext& context) {
  volmesh::retract_step(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, envelope, context);
}
void run_optimise(LayerDomain& layer_domain, volmesh::Envelope& envelope, const RunContext& context) {
  volmesh::optimise_step(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, envelope, context);
}

constexpr std::array<Step, 5> k_steps = {{
    {"envelope.smooth", EnvelopeStep::initial, EnvelopeStep::smoothed, "height_sweeps direction_sweeps height_floor",
     "envelope.smooth{ env, height_sweeps = 5, direction_sweeps = 50 }", run_smooth},
    {"envelope.untangle", EnvelopeStep::initial, EnvelopeStep::untangled, "untangle_share", "envelope.untangle{ env }", run_untangle},
    {"envelope.unwarp", EnvelopeStep::initial, EnvelopeStep::unwarped, "envelope_sweeps", "envelope.unwarp{ env }", run_unwarp},
    {"envelope.retract", EnvelopeStep::unwarped, EnvelopeStep::retracted, "max_retract_sweeps", "envelope.retract{ env }", run_retract},
    {"envelope.optimise", EnvelopeStep::retracted, EnvelopeStep::finished,
     "optimiser optimiser_evaluations height_weight top_weight membrane_weight barrier_weight", "envelope.optimise{ env, optimiser_evaluations = 30 }",
     run_optimise},
}};

const Step& step_of(std::string_view verb) {
  return *std::find_if(k_steps.begin(), k_steps.end(), [&](const Step& step) { return step.verb == verb; });
}

ScriptValue run_step(const ScriptCall& call) {
  const Step& step = step_of(call.verb);
  const ScriptTable table = table_argument(call, 0, step.usage);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const auto* given = items.empty() ? nullptr : std::get_if<EnvelopeHandle>(&items.front());
  EnvelopeValue value = given ? **given : EnvelopeValue();
  if (!given)
    reader.add_problem("entry 1: expected an envelope, not " + std::string(items.empty() ? "nothing" : type_text(items.front())) + ": " +
                       std::string(step.usage));
  else if (value.step < step.needs && !call.session.check)
    reader.add_problem("entry 1: expected an envelope that is " + std::string(to_string(step.needs)) + " at least; this envelope is " +
                       std::string(to_string(value.step)) + " only");
  if (items.size() > 1) reader.add_problem("entry 2: unexpected, only one entry without a name is allowed");
  const OptionTable schema = some_options(value.options, step.options);
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  const RunContext context = call.session.context.part(call.verb.substr(call.verb.find('.') + 1), 0.0, 1.0);
  const auto layer_domain = envelope_domain(value, context);
  require_one_part(call, *layer_domain, context);
  step.run(*layer_domain, value.stage.envelope, context);
  value.step = step.makes;
  return std::make_shared<const EnvelopeValue>(std::move(value));
}

template <const std::string_view& Names>
std::string help_of_names() {
  MeshCase options;
  return options_help(some_options(options, Names)) + layer_rules_help();
}
template <std::size_t I>
std::string help_of_step() {
  MeshCase options;
  return options_help(some_options(options, k_steps[I].options));
}

constexpr std::array<ScriptVerb, 7> k_envelope_steps_verbs = {{
    {"envelope.classify", k_classify_usage, "Finds ridges, corners, convex and concave regions of a wall: the first step of make_envelope.", classify,
     help_of_names<k_classify_names>, true, "envelope"},
    {"envelope.initial", k_initial_usage, "Computes growth directions and target heights: the second step of make_envelope.", make_initial,
     help_of_names<k_initial_names>, true, "envelope"},
    {k_steps[0].verb, k_steps[0].usage, "Smooths heights and growth directions.", run_step, help_of_step<0>, true, "envelope"},
    {k_steps[1].verb, k_steps[1].usage, "Lowers heights where growth lines would intersect.", run_step, help_of_step<1>, true, "envelope"},
    {k_steps[2].verb, k_steps[2].usage,
     "Lowers heights until every macro-element is valid, smooths the envelope, then raises heights again as far as all elements stay valid.", run_step,
     help_of_step<2>, true, "envelope"},
    {k_steps[3].verb, k_steps[3].usage,
     "Divides gaps between layers and lowers heights until the layer intersects nothing. Tetrahedra can be made around the result.", run_step, help_of_step<3>,
     true, "envelope"},
    {k_steps[4].verb, k_steps[4].usage,
     "Optimises the whole envelope: the last step of make_envelope. All steps together give the same bytes as make_envelope.", run_step, help_of_step<4>, true,
     "envelope"},
}};

}  // namespace

std::span<const ScriptVerb> envelope_step_verbs() { return k_envelope_steps_verbs; }

}  // namespace sterna::scripting
