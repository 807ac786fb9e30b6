#include "scripting/values/layer_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "geom/base/error.h"
#include "scripting/lua/script_function.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/flow_verbs.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/flow/boundary_layer.h"

namespace sterna::scripting {

struct FamilyVerbOptions {
  int levels = 3;
  double factor = 1.5;
  int medium = 2;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::FamilyVerbOptions> {
  using O = scripting::FamilyVerbOptions;
  static constexpr std::string_view stage = "family";
  static constexpr std::array fields = {
      Field<O>{.name = "levels", .member = &O::levels, .min = 1, .max = 12, .help = "number of members of the family, from coarse to fine"},
      Field<O>{
          .name = "factor",
          .member = &O::factor,
          .min = 1.01,
          .max = 4.0,
          .help =
              "ratio of edge lengths between successive members; the ratio of nodes is about its third power: 1.5 for 3.4 times the nodes, 1.442 for 3 times"},
      Field<O>{
          .name = "medium", .member = &O::medium, .min = 1, .max = 12, .help = "number of the member with the edge lengths and heights of the given options"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

std::string member_name(int finer) {
  constexpr std::array<const char*, 5> k_names = {"extra_coarse", "coarse", "medium", "fine", "extra_fine"};
  if (std::abs(finer) <= 2) return k_names[static_cast<std::size_t>(finer + 2)];
  return (finer < 0 ? "coarse_" : "fine_") + std::to_string(std::abs(finer));
}

constexpr std::string_view k_family_usage = "for _, member in ipairs(family{ levels = 3, factor = 1.5 }) do print(member.name, member.refinement) end";

ScriptValue make_family(const ScriptCall& call) {
  FamilyVerbOptions options;
  const ScriptTable table = table_argument(call, 0, k_family_usage);
  TableReader reader(table, call.attempted());
  reader.read_options(sterna::options_of(options));
  reader.finish();
  // A family with one member is the mesh described by the options. It is not a coarse member.
  if (!reader.is_given("family", "medium")) options.medium = std::min(options.medium, options.levels);
  auto members = std::make_shared<ScriptTable>();
  for (int level = 1; level <= options.levels; ++level) {
    auto member = std::make_shared<ScriptTable>();
    member->fields = {{"name", member_name(level - options.medium)}, {"refinement", std::pow(options.factor, level - options.medium)}};
    members->items.emplace_back(TableHandle(member));
  }
  return members;
}

std::string family_help() {
  FamilyVerbOptions options;
  return options_help(sterna::options_of(options));
}

constexpr std::array<ScriptVerb, 1> k_layer_options_verbs = {{
    {"family", k_family_usage, "Returns the members of a mesh family, each with a name and the refinement for surface_mesh and volume_mesh.", make_family,
     family_help, false, "table"},
}};

}  // namespace

namespace {

bool is_among(const OptionOverrides& given, std::string_view stage, std::string_view name) {
  return std::ranges::any_of(given, [&](const auto& entry) { return entry.first == name || entry.first == std::string(stage) + "." + std::string(name); });
}

/// \param flow conditions of the first height; null: none
void complete_layers_of(volmesh::MeshCase& options, const std::function<bool(std::string_view, std::string_view)>& is_given, const volmesh::FlowState* flow,
                        std::string_view attempted) {
  volmesh::EnvelopeOptions& envelope = options.envelope;
  const bool has_thickness = !is_automatic(envelope.boundary_layer) || !is_automatic(envelope.total_height);
  if (flow && !has_thickness && !is_automatic(flow->length) && flow->reynolds >= volmesh::k_least_reynolds && flow->reynolds <= volmesh::k_largest_reynolds)
    envelope.boundary_layer = volmesh::layer_thickness({}, *flow);
  if (is_given("family", "refinement") && options.family.family_wake == volmesh::FamilyOptions{}.family_wake) options.family.family_wake = "on";
  if (!is_automatic(envelope.total_height) && !is_given("envelope", "solve_for"))
    envelope.solve_for = volmesh::solved_for(is_given("envelope", "layers"), is_given("envelope", "max_growth"), true, attempted);
}

/// Returns the conditions of the first height if it is given as a string with a flow; else nothing.
std::optional<volmesh::FlowState> flow_of_first_height(const OptionOverrides& given) {
  for (const auto& [name, text] : given)
    if ((name == "first_height" || name == "envelope.first_height") && is_flow_text(text)) return quantity_of_text(text).flow;
  return std::nullopt;
}

}  // namespace

void complete_layers(volmesh::MeshCase& options, const OptionOverrides& given, std::string_view attempted) {
  const std::optional<volmesh::FlowState> flow = flow_of_first_height(given);
  complete_layers_of(
      options, [&](std::string_view stage, std::string_view name) { return is_among(given, stage, name); }, flow ? &*flow : nullptr, attempted);
}

void complete_layers(volmesh::MeshCase& options, TableReader& reader, const ScriptCall& call) {
  const OptionOverrides& overrides = call.session.overrides;
  const std::optional<volmesh::FlowState> overruling = flow_of_first_height(overrides);
  const QuantityValue* quantity = is_among(overrides, "envelope", "first_height") ? nullptr : reader.quantity_of("envelope", "first_height");
  try {
    complete_layers_of(
        options, [&](std::string_view stage, std::string_view name) { return reader.is_given(stage, name) || is_among(overrides, stage, name); },
        overruling ? &*overruling
        : quantity ? &quantity->flow
                   : nullptr,
        call.verb);
  } catch (const Error& error) {
    reader.add_problem(error.info().problem + " (" + error.info().hint + ")");
  }
}

FunctionHandle read_first_heights(TableReader& reader, const ScriptCall& call) {
  const FunctionHandle* function = reader.option_function("envelope", "first_height");
  const bool is_overruled = is_among(call.session.overrides, "envelope", "first_height");
  return function && !is_overruled ? *function : nullptr;
}

void set_first_heights(const FunctionHandle& function, const SurfaceValue& wall, volmesh::MeshCase& options, const RunContext& context) {
  if (!function) return;
  std::vector<double> heights;
  heights.reserve(wall.mesh.n_vertices());
  for (const Point& p : wall.mesh.points) {
    double height = 0.0;
    function->call(std::array{p.x, p.y, p.z}, std::span(&height, 1));
    heights.push_back(height);
  }
  options.first_heights = std::make_shared<const volmesh::FirstHeights>(wall.mesh, std::move(heights), context);
  options.envelope.first_height = options.first_heights->least();
  context.info(fmt::format("first heights by a function: {:.4g} m to {:.4g} m", options.first_heights->least(), options.first_heights->greatest()));
}

void warn_of_other_member(const SurfaceValue& wall, const volmesh::MeshCase& options, const RunContext& context) {
  const SurfaceRecipe* const recipe = last_of<SurfaceRecipe>(wall.history);
  if (!recipe || recipe->options.sizes.refinement == options.family.refinement) return;
  context.warn(fmt::format("the surface was made with refinement {:.4g}, the volume with {:.4g}: for a mesh family give both the same value",
                           recipe->options.sizes.refinement, options.family.refinement));
}

std::span<const ScriptVerb> family_verbs() { return k_layer_options_verbs; }

}  // namespace sterna::scripting
