#include "scripting/verbs/model_gates.h"

#include "geom/base/error.h"
#include "scripting/lua/table_reader.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/summary.h"

namespace sterna::scripting {
namespace {

struct SurfaceCheckOptions {
  bool strict = false;
};

}  // namespace
}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::SurfaceCheckOptions> {
  using O = scripting::SurfaceCheckOptions;
  static constexpr std::string_view stage = "check";
  static constexpr std::array fields = {
      Field<O>{.name = "strict", .member = &O::strict, .help = "treat a gate that FAILs as an error"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

void report_left_out(const surfmesh::Deviation& deviation, const RunContext& context) {
  if (!deviation.unknown.empty()) {
    std::string names;
    for (const std::string& name : deviation.unknown) names += (names.empty() ? "\"" : ", \"") + name + "\"";
    context.warn("G17, G18: walls of the mesh whose names the model's surface does not have are not measured: " + names);
  }
  if (deviation.n_beside > 0)
    context.info("G18: at " + count_text(deviation.n_beside) + " facets the model has no normal (poles, tips): a normal nearby was taken");
  if (deviation.n_without > 0) context.warn("G18: " + count_text(deviation.n_without) + " facets were not compared: the model has no normal there or nearby");
}

std::string surface_check_help() {
  SurfaceCheckOptions options;
  return options_help(sterna::options_of(options));
}

ScriptValue check_surface(const ScriptCall& call) {
  const SurfaceHandle& surface = self<SurfaceHandle>(call);
  SurfaceCheckOptions options;
  const ScriptTable table = table_argument(call, 1, "wall:check{ strict = true }");
  TableReader reader(table, call.attempted());
  reader.read_options(sterna::options_of(options));
  reader.finish();
  require_model_wall(*surface, call.attempted());
  const RunContext context = call.session.context.part("check", 0.0, 1.0);
  const surfmesh::Deviation deviation = surfmesh::measure_deviation(surface->mesh, surface->mesh, *surface->true_surface.wall, {}, context);
  report_left_out(deviation, context);
  std::string text =
      count_text(deviation.n_nodes) + " nodes and " + count_text(deviation.n_facets) + " triangles against the model, " + describe(*surface) + "\n";
  for (const GateResult& gate : {deviation.distance, deviation.normal}) text += to_text(gate);
  call.session.print(text);
  if (!options.strict) return surface;
  ErrorInfo info{.code = ErrorCode::mesh_invalid,
                 .attempted = call.attempted(),
                 .problem = "the surface deviates from its model by more than the hard limits of G17 and G18"};
  for (const GateResult& gate : {deviation.distance, deviation.normal}) {
    if (gate.state != GateState::fail) continue;
    info.n_locations += gate.n_beyond_hard;
    for (const GateLocation& location : gate.locations)
      info.locations.push_back({location.position, std::string(info_of(gate.measure).title) + ", " + location.what});
  }
  if (info.n_locations > 0) throw Error(std::move(info));
  return surface;
}

}  // namespace

void require_model_wall(const SurfaceValue& wall, const std::string& attempted) {
  if (wall.true_surface.wall) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = attempted,
               .problem = "the surface has no model to be compared with",
               .hint = "give the surface that surface_mesh{ model } made in this run, before half{ } or joining with other surfaces; for a mesh of another run "
                       "make a surface again, its edges may differ: wall = surface_mesh{ read_cad \"model.step\" }"});
}

void measure_on_model(const HybridMesh& mesh, const SurfaceValue& wall, const GateTable& limits, CheckReport& report, const RunContext& context) {
  surfmesh::Deviation deviation = surfmesh::measure_deviation(mesh, wall.mesh, *wall.true_surface.wall, limits, context);
  report_left_out(deviation, context);
  report.put(std::move(deviation.distance));
  report.put(std::move(deviation.normal));
}

const ScriptVerb k_check_surface = {
    "surface:check",
    "wall:check()",
    "Compares a surface of surface_mesh with its model: distance of nodes (G17) and angle of triangles (G18), with the worst locations.",
    check_surface,
    surface_check_help,
    true,
    "self"};

}  // namespace sterna::scripting
