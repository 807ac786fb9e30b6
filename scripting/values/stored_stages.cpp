#include "scripting/values/stored_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "geom/base/error.h"
#include "geom/mesh/topology.h"
#include "io/file/input_hash.h"
#include "io/volume/sterna_file.h"
#include "scripting/values/cached_volume.h"
#include "scripting/values/envelope_domain.h"
#include "scripting/values/layer_json.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/manifest.h"
#include "scripting/values/open_domains.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/summary.h"
#include "surfmesh/model/periodic_borders.h"
#include "volmesh/case/body_wake.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/case/thin_layers.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/layer/assemble.h"

namespace sterna::scripting {
namespace {

// ---- Values of volmesh in the form of a file -------------------------------------------------------------------------------------------------

io::StoredEnvelope stored(const volmesh::Envelope& envelope, const TriMesh& surface, const volmesh::FirstHeights* first_heights) {
  io::StoredEnvelope result{
      .direction = envelope.direction, .height = envelope.height, .target = envelope.target, .eq1 = envelope.eq1, .cap = envelope.cap, .limit = {}};
  for (const volmesh::HeightLimit limit : envelope.limit) result.limit.push_back(static_cast<std::uint8_t>(limit));
  if (first_heights)
    for (const Point& p : surface.points) result.first_height.push_back(first_heights->at(p));
  return result;
}

io::StoredTetrahedra stored(const volmesh::FilledStage& filled) {
  return {.n_boundary_points = volmesh::boundary_of(filled.layers).points.size(),
          .new_points = filled.tets.new_points,
          .tetrahedra = filled.tets.tetrahedra,
          .moved_nodes = {},
          .moved_points = {}};
}

[[noreturn]] void refuse(const InputPath& file, std::string problem) {
  throw Error({.code = ErrorCode::file_malformed, .attempted = "reading the steps of a run in " + file.name, .problem = std::move(problem)});
}

volmesh::Envelope envelope_of(io::StoredEnvelope file_envelope, const InputPath& file) {
  volmesh::Envelope envelope;
  envelope.direction = std::move(file_envelope.direction);
  envelope.height = std::move(file_envelope.height);
  envelope.target = std::move(file_envelope.target);
  envelope.eq1 = std::move(file_envelope.eq1);
  envelope.cap = std::move(file_envelope.cap);
  for (const std::uint8_t limit : file_envelope.limit) {
    if (limit >= volmesh::k_height_limits)
      refuse(file, "a height has the limit code " + std::to_string(limit) + "; the number of known codes is " + std::to_string(volmesh::k_height_limits));
    envelope.limit.push_back(static_cast<volmesh::HeightLimit>(limit));
  }
  return envelope;
}

/// Returns the mesh without the nodes after those of its layer. Nodes on the boundary of the tetrahedra are kept, at their position when the tetrahedra were
/// made.
HybridMesh layers_of(HybridMesh mesh, const io::StoredTetrahedra& tetrahedra, const InputPath& file) {
  const std::uint64_t n_boundary_points = tetrahedra.n_boundary_points;
  const std::size_t n_lines = mesh.layers.n_lines();
  std::size_t n_nodes = 0;
  for (std::uint32_t line = 0; line < n_lines; ++line) n_nodes = std::max(n_nodes, mesh.layers.top(line).index() + 1);
  if (n_boundary_points < n_lines || n_boundary_points - n_lines > mesh.points.size() - n_nodes)
    refuse(file, "the file has tetrahedra within " + std::to_string(n_boundary_points) + " points of a boundary, but a mesh of " + std::to_string(n_lines) +
                     " lines and " + std::to_string(mesh.points.size()) + " nodes");
  mesh.points.raw().resize(n_nodes + (n_boundary_points - n_lines));
  mesh.tetrahedra.clear();
  for (std::size_t i = 0; i < tetrahedra.moved_nodes.size(); ++i) {
    const std::uint32_t node = tetrahedra.moved_nodes[i];
    if (node >= n_nodes) refuse(file, "the file has the moved node " + std::to_string(node) + " of layers with " + std::to_string(n_nodes) + " nodes");
    mesh.points[NodeId(node)] = tetrahedra.moved_points[i];
  }
  return mesh;
}

// ---- Other data: JSON ----------------------------------------------------------------------------------------------------------------------

Json stage_json(const volmesh::EnvelopeStage& envelope, std::int64_t n_wall_triangles) {
  Json json = {{"feature_angle", envelope.feature_angle}, {"wall_triangles", n_wall_triangles}};
  if (const volmesh::ClosedMultiNormals& closed = envelope.closed; closed.n_rounds > 0) {
    json["closed_fans"] = {{"rounds", closed.n_rounds}, {"vertices", Json::array()}};
    for (const VertexId v : closed.base_vertices) json["closed_fans"]["vertices"].push_back(v.value());
  }
  return json;
}

/// Calls entry(name, member) for the entries of "stage" that are always there. The same list writes and reads.
template <class AnyFilled, class F>
void stage_entries(AnyFilled& filled, const F& entry) {
  entry("engine", filled.tets.engine);
  entry("is_two_pass", filled.tets.is_two_pass);
  entry("is_reproducible", filled.tets.is_reproducible);
  entry("failures", filled.tetra_failures);
  entry("curving_shares", filled.curving_shares);
  entry("boundary_triangles_added_by_splits", filled.n_split_triangles);
}

Json stage_json(const volmesh::FilledStage& filled, std::int64_t n_wall_triangles) {
  Json json = stage_json(filled.envelope, n_wall_triangles);
  stage_entries(filled, [&](const char* name, const auto& member) { json[name] = member; });
  json["needles"] = slivers_json(filled.slivers);
  if (filled.is_opened) json["is_opened"] = true;
  return json;
}

/// Returns, for placed parts, the default limits of their layer thickness. They are based on the parts' own lengths, which do not change with their attitude or
/// their neighbours.
std::vector<Rule> thickness_rules(const SurfaceValue& wall, const volmesh::MeshCase& options) {
  std::vector<Rule> rules;
  if (!is_automatic(options.envelope.max_thickness)) return rules;
  for (const volmesh::PlacedPart& part : wall.parts) {
    const double thickness = volmesh::k_default_thickness_share * body_length(*part.own);
    for (const Patch& patch : part.own->patches) {
      if (patch.kind != PatchKind::wall) continue;  // only walls carry layers
      const auto known = std::ranges::find_if(rules, [&](const Rule& rule) { return rule.names == patch.name; });
      if (known == rules.end()) rules.push_back({.names = patch.name, .options = {{"max_thickness", thickness}}});
      else known->options["max_thickness"] = std::max(value_or(*known, "max_thickness", thickness), thickness);
    }
  }
  return rules;
}

/// Returns the rules for patches: first defaults of placed parts, then rules of the makers of the wall, then rules of the user. Later rules win.
std::vector<Rule> rules_of(const SurfaceValue& wall, const volmesh::MeshCase& options) {
  std::vector<Rule> rules = thickness_rules(wall, options);
  rules.insert(rules.end(), wall.layers.begin(), wall.layers.end());
  rules.insert(rules.end(), options.patches.begin(), options.patches.end());
  return rules;
}

MeshOrigin origin_of(const SurfaceValue& wall, const volmesh::MeshCase& options) {
  MeshOrigin origin{.surface_options = wall.options, .history = wall.history, .smooth_angle = wall.smooth_angle, .options = options};
  origin.options.patches = rules_of(wall, options);  // a file with the stages gets these rules only from here
  return origin;
}

/// Returns the data of an unfinished run, which has no manifest yet. First heights are in the envelope of the file.
std::string unfinished_json(const SurfaceValue& wall, const volmesh::MeshCase& options, Json stage) {
  MeshOrigin origin = origin_of(wall, options);
  origin.history.clear();
  inherit(origin.history, wall.history, true);
  origin.options.first_heights.reset();
  Json json = {{"schema", "sterna-stage-1"}, {"program", "sterna " STERNA_VERSION}, {"inputs", inputs_json(wall.inputs)}};
  add_request(json, origin);
  json["stage"] = std::move(stage);
  return json.dump(2) + "\n";
}

/// Members of the JSON in a file, each of its required type.
class StageJson {
 public:
  StageJson(const std::string& text, const InputPath& file) : file_(file), json_(Json::parse(text, nullptr, false)) {
    if (json_.is_discarded() || !json_.is_object()) refuse(file_, "the manifest is not JSON");
  }

  template <class T>
  T get(const std::string& pointer) const {
    try {
      return json_.at(Json::json_pointer(pointer)).get<T>();
    } catch (const Json::exception& error) {
      refuse(file_, "the manifest has no valid " + pointer + ": " + error.what());
    }
  }

  std::vector<InputFile> inputs() const {
    std::vector<InputFile> result;
    for (std::size_t i = 0; i < get<Json::array_t>("/inputs").size(); ++i)
      result.push_back({get<std::string>("/inputs/" + std::to_string(i) + "/file"), get<std::string>("/inputs/" + std::to_string(i) + "/xxh3_128")});
    return result;
  }

  void read_options(const OptionTable& options) const {
    for (const Option& option : options) {
      const std::string pointer = "/options/" + std::string(option.stage) + "/" + std::string(option.name);
      if (!json_.contains(Json::json_pointer(pointer))) continue;  // the file is from a version without this member, which keeps its default
      const Json& value = json_.at(Json::json_pointer(pointer));
      set_option_from_text(option, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }

  std::vector<Rule> patch_rules() const { return layer_rules_of_json(list("patch_rules")); }

  volmesh::EnvelopeStep step() const {
    return json_.contains(Json::json_pointer("/stage/step")) ? volmesh::envelope_step_of(get<std::string>("/stage/step")) : volmesh::EnvelopeStep::finished;
  }

  /// Returns the history of the wall: its recipe, if surface_mesh made the wall, and the changes and figures of all steps.
  SurfaceHistory history() const {
    SurfaceHistory history;
    if (json_.contains(Json::json_pointer("/options/surface_mesh"))) {
      SurfaceRecipe recipe;
      read_options(sterna::options_of(recipe.options));
      try {
        read_recipe(json_, recipe);
      } catch (const Error& error) {
        refuse(file_, "the manifest has no valid request of surface_mesh: " + error.info().problem);
      }
      history.push_back({.options = std::move(recipe)});
    }
    try {
      inherit(history, read_changes(json_));
    } catch (const Json::exception& error) {
      refuse(file_, std::string("the manifest has no valid /changes: ") + error.what());
    }
    return history;
  }

  /// Returns the smooth angle, radians, of a wall made by surface_mesh in this run or an earlier one.
  std::optional<double> smooth_angle() const {
    if (!json_.contains(Json::json_pointer("/wall/max_smooth_angle"))) return std::nullopt;
    return get<double>("/wall/max_smooth_angle");
  }

  /// Returns the values of a list that manifests have only if it is not empty.
  template <class T>
  std::vector<T> values(const char* name) const {
    return values_of<T>(list(name));
  }

  std::vector<PeriodicNames> periodic() const { return periodic_of_json(list("periodic")); }

  /// Returns the report on slivers.
  volmesh::SliverReport slivers() const {
    volmesh::SliverReport report;
    sliver_entries(report, [&](const char* name, auto& member) {
      using Member = std::remove_reference_t<decltype(member)>;
      const std::string pointer = std::string("/stage/needles/") + name;
      if constexpr (std::is_same_v<Member, Point>) {
        const auto p = get<std::array<double, 3>>(pointer);
        member = {p[0], p[1], p[2]};
      } else {
        member = get<Member>(pointer);
      }
    });
    return report;
  }

  /// Returns the closed fans, which are present only in files of runs that had to close some.
  volmesh::ClosedMultiNormals closed_multi_normals() const {
    volmesh::ClosedMultiNormals closed;
    if (!json_.contains(Json::json_pointer("/stage/closed_fans"))) return closed;
    closed.n_rounds = get<int>("/stage/closed_fans/rounds");
    if (closed.n_rounds < 0) refuse(file_, "multi-normal fans were closed in " + std::to_string(closed.n_rounds) + " rounds");
    for (const auto v : get<std::vector<std::uint32_t>>("/stage/closed_fans/vertices")) closed.base_vertices.emplace_back(v);
    return closed;
  }

  bool is_opened() const { return json_.contains(Json::json_pointer("/stage/is_opened")) && get<bool>("/stage/is_opened"); }

 private:
  Json list(const char* name) const { return json_.value(name, Json::array()); }

  const InputPath& file_;
  Json json_;
};

volmesh::FilledStage filled_of(const StageJson& json, volmesh::EnvelopeStage envelope, io::SternaContent& content, const InputPath& file) {
  volmesh::FilledStage filled;
  filled.envelope = std::move(envelope);
  filled.is_opened = json.is_opened();
  filled.layers = layers_of(content.opened ? std::move(*content.opened) : *content.mesh, *content.tetrahedra, file);
  filled.tets.new_points = std::move(content.tetrahedra->new_points);
  filled.tets.tetrahedra = std::move(content.tetrahedra->tetrahedra);
  stage_entries(filled, [&](const char* name, auto& member) { member = json.get<std::remove_reference_t<decltype(member)>>(std::string("/stage/") + name); });
  filled.slivers = json.slivers();
  return filled;
}

SurfaceHandle surface_of(TriMesh mesh, std::vector<InputFile> inputs, const RunContext& context) {
  auto surface = std::make_shared<SurfaceValue>();
  surface->report.n_triangles_read = static_cast<std::int64_t>(mesh.n_triangles());
  surface->report.n_vertices_read = static_cast<std::int64_t>(mesh.n_vertices());
  surface->report.is_closed = Topology(mesh, context).n_boundary_halfedges() == 0;
  surface->mesh = std::move(mesh);
  surface->inputs = std::move(inputs);
  return surface;
}

MeshValue mesh_value(const SurfaceValue& wall, std::int64_t n_wall_triangles, const volmesh::MeshCase& options, volmesh::VolumeMeshResult result) {
  MeshValue value{.mesh = std::move(result.mesh), .inputs = wall.inputs, .origin = origin_of(wall, options), .check = std::move(result.check)};
  value.origin->n_wall_triangles = n_wall_triangles;
  value.origin->report = static_cast<volmesh::VolumeMeshReport&&>(result);
  return value;
}

std::int64_t n_triangles(const SurfaceValue& surface) { return static_cast<std::int64_t>(surface.mesh.n_triangles()); }

// ---- Writing -------------------------------------------------------------------------------------------------------------------------------

void write_envelope(const SurfaceValue& wall, const volmesh::MeshCase& options, const volmesh::EnvelopeStage& stage, const std::filesystem::path& path,
                    const RunContext& context, volmesh::EnvelopeStep step = volmesh::EnvelopeStep::finished) {
  const StageTimer timer(context, "write");
  const io::StoredEnvelope envelope = stored(stage.envelope, wall.mesh, options.first_heights.get());
  Json json = stage_json(stage, n_triangles(wall));
  if (step != volmesh::EnvelopeStep::finished) json["step"] = volmesh::to_string(step);
  io::write_sterna(
      {.surface = &wall.mesh, .farfield = options.farfield_surface.get(), .envelope = &envelope, .manifest = unfinished_json(wall, options, std::move(json))},
      path, context);
}

void write_filled(const SurfaceValue& wall, std::int64_t n_wall_triangles, const volmesh::MeshCase& options, const volmesh::FilledStage& stage,
                  const std::filesystem::path& path, const RunContext& context) {
  const StageTimer timer(context, "write");
  const TriMesh& surface = stage.split_wall ? *stage.split_wall : wall.mesh;
  const io::StoredEnvelope envelope = stored(stage.envelope.envelope, surface, options.first_heights.get());
  const io::StoredTetrahedra tetrahedra = stored(stage);
  io::write_sterna({.surface = &surface,
                    .farfield = options.farfield_surface.get(),
                    .envelope = &envelope,
                    .tetrahedra = &tetrahedra,
                    .mesh = &stage.layers,
                    .manifest = unfinished_json(wall, options, stage_json(stage, n_wall_triangles))},
                   path, context);
}

/// Data of a stage that remain after its layer has become the mesh.
struct FinishedParts {
  std::optional<TriMesh> split_wall;
  io::StoredEnvelope envelope;
  io::StoredTetrahedra tetrahedra;
  std::vector<Point> layer_points;   ///< m, points of the stage's layer, if that is the mesh's layer
  std::optional<HybridMesh> opened;  ///< the stage's layer, if that is not the mesh's layer
  Json json;
};

/// Returns the tetrahedra, and the nodes of their stage that were moved in the mesh.
io::StoredTetrahedra with_moved_nodes(const FinishedParts& parts, const HybridMesh& mesh) {
  io::StoredTetrahedra tetrahedra = parts.tetrahedra;
  for (std::size_t i = 0; i < parts.layer_points.size(); ++i) {
    if (parts.layer_points[i] == mesh.points.raw()[i]) continue;
    tetrahedra.moved_nodes.push_back(static_cast<std::uint32_t>(i));
    tetrahedra.moved_points.push_back(parts.layer_points[i]);
  }
  return tetrahedra;
}

void write_finished(const SurfaceValue& wall, const FinishedParts& parts, const MeshValue& mesh, const std::filesystem::path& path, const RunContext& context) {
  const StageTimer timer(context, "write");
  Json manifest = manifest_of(mesh, path, context.seed());
  manifest["stage"] = parts.json;
  const io::StoredTetrahedra tetrahedra = with_moved_nodes(parts, mesh.mesh);
  io::write_sterna({.surface = parts.split_wall ? &*parts.split_wall : &wall.mesh,
                    .farfield = mesh.origin->options.farfield_surface.get(),
                    .envelope = &parts.envelope,
                    .tetrahedra = &tetrahedra,
                    .mesh = &mesh.mesh,
                    .opened = parts.opened ? &*parts.opened : nullptr,
                    .manifest = manifest.dump(2) + "\n",
                    .certificate = certificate_json(mesh.origin->report.certificate).dump(),
                    .quality = to_json(*mesh.check)},
                   path, context);
}

}  // namespace

OptionTable envelope_options(volmesh::MeshCase& options) { return volmesh::options_of(options, volmesh::k_envelope_step); }
OptionTable tetrahedra_options(volmesh::MeshCase& options) { return volmesh::options_of(options, volmesh::k_tetrahedra_step); }
OptionTable finish_options(volmesh::MeshCase& options) { return volmesh::options_of(options, volmesh::k_finish_step); }

namespace {

/// Returns the periodic sides that the mesher of the wall meshed identically, if the wall still has its triangles.
std::vector<PeriodicNames> periodic_of_wall(const SurfaceValue& wall) {
  const SurfaceRecipe* const recipe = last_of<SurfaceRecipe>(wall.history);
  if (!recipe || last_of<surfmesh::RemeshOptions>(wall.history) || last_of<surfmesh::RepairOptions>(wall.history) ||
      last_of<surfmesh::WrapOptions>(wall.history) || last_of<UnionOptions>(wall.history))
    return {};
  std::vector<PeriodicNames> pairs = recipe->options.periodic;
  const auto has = [&](const std::string& name) {
    return surfmesh::is_open_plane(name) || std::ranges::any_of(wall.mesh.patches, [&](const Patch& patch) { return patch.name == name; });
  };
  std::erase_if(pairs, [&](const PeriodicNames& pair) { return !has(pair.first) || !has(pair.second); });
  return pairs;
}

}  // namespace

volmesh::MeshCase with_wall_facts(const SurfaceValue& wall, volmesh::MeshCase options) {
  if (wall.smooth_angle) options.smooth_angle = *wall.smooth_angle;
  if (!options.first_heights) options.parts = wall.parts;  // with variable first heights, the layers of parts depend on their location
  options.patches = rules_of(wall, options);
  if (options.periodic.empty()) options.periodic = periodic_of_wall(wall);
  return options;
}

EnvelopeValue make_envelope(const SurfaceHandle& wall, const volmesh::MeshCase& options, const RunContext& context, const Reuse& reuse) {
  warn_of_other_member(*wall, options, context);
  return {.wall = wall, .options = options, .stage = cached_envelope(*wall, with_wall_facts(*wall, options), reuse, context)};
}

TetrahedraValue make_tetrahedra(const EnvelopeValue& envelope, const volmesh::MeshCase& options, const RunContext& context, const Reuse& reuse) {
  require_ready(envelope, options, context);
  const SurfaceValue& wall = *envelope.wall;
  return {.wall = envelope.wall,
          .n_wall_triangles = n_triangles(wall),
          .options = options,
          .stage = cached_tetrahedra(wall, envelope.stage, with_wall_facts(wall, options), reuse, context)};
}

MeshValue finish_mesh(const TetrahedraValue& tetrahedra, const volmesh::MeshCase& options, const RunContext& context, const Reuse& reuse) {
  return mesh_value(*tetrahedra.wall, tetrahedra.n_wall_triangles, options,
                    cached_finish(*tetrahedra.wall, tetrahedra.stage, with_wall_facts(*tetrahedra.wall, options), reuse, context));
}

namespace {

/// Gives a hint if no source refines the wake. It is then resolved only by the growth of tetrahedra.
void hint_at_wake(const SurfaceValue& wall, const volmesh::MeshCase& options, const RunContext& context) {
  if (volmesh::has_bare_wake(wall.mesh, options))
    context.info(
        "hint: no source refines the wake: add --wake length=2, or in scripts sources = { wake{ wall, length = 2 } }; members of a family get this source "
        "automatically");
}

/// Gives a hint before the work if there are too few layers to reach the size of tetrahedra, which leaves a jump on top of the layers. The hint contains a
/// sufficient number.
void hint_at_layers(const SurfaceValue& wall, const volmesh::MeshCase& options, const RunContext& context) {
  if (const auto thin = volmesh::thin_layers(wall.mesh, options))
    context.info(
        fmt::format("hint: on {:.0f} % of the walls' area the last of {} layers is thinner than a third of the adjacent tetrahedra: layers = {} are sufficient "
                    "(sterna inspect lists the locations)",
                    100.0 * thin->share, options.envelope.layers, thin->enough));
}

}  // namespace

MeshValue make_volume_mesh(const SurfaceValue& given, const volmesh::MeshCase& options, const std::filesystem::path& stages, const RunContext& context,
                           const Reuse& reuse) {
  const std::string& floor = options.farfield.farfield_floor;
  const SurfaceValue wall = floor.empty() ? as_body(given, volmesh::is_farfield_given(options.farfield), context) : with_floor_upwards(given, floor, context);
  warn_of_other_member(wall, options, context);
  hint_at_wake(wall, options, context);
  hint_at_layers(wall, options, context);
  if (stages.empty()) return mesh_value(wall, n_triangles(wall), options, cached_volume_mesh(wall, with_wall_facts(wall, options), {}, reuse, context));
  require_stage_output(stages);
  FinishedParts parts;
  const volmesh::StageWatch watch{
      .envelope = {},
      .enveloped = [&](const volmesh::EnvelopeStage& stage) { write_envelope(wall, options, stage, stages, context.part("stages", 0.0, 0.0)); },
      .filled =
          [&](const volmesh::FilledStage& stage) {
            write_filled(wall, n_triangles(wall), options, stage, stages, context.part("stages", 0.0, 0.0));
            parts = {.split_wall = stage.split_wall,
                     .envelope = stored(stage.envelope.envelope, stage.split_wall ? *stage.split_wall : wall.mesh, options.first_heights.get()),
                     .tetrahedra = stored(stage),
                     .layer_points = stage.is_opened ? std::vector<Point>() : stage.layers.points.raw(),
                     .opened = stage.is_opened ? std::optional(stage.layers) : std::nullopt,
                     .json = stage_json(stage, n_triangles(wall))};
          }};
  MeshValue mesh = mesh_value(wall, n_triangles(wall), options, cached_volume_mesh(wall, with_wall_facts(wall, options), watch, reuse, context));
  write_finished(wall, parts, mesh, stages, context.part("stages", 1.0, 1.0));
  return mesh;
}

StageContent read_stages(const InputPath& file, const RunContext& context) {
  const StageTimer timer(context, "read");
  io::SternaContent content = io::read_sterna(file.path, context);
  StageContent result;
  if (content.surface && !content.envelope) result.surface = surface_of(std::move(*content.surface), {{file.name, io::hash_input(file.path)}}, context);
  if (content.envelope) {
    if (content.manifest.empty()) refuse(file, "the file has an envelope, but not its options");
    const StageJson json(content.manifest, file);
    auto wall = std::make_shared<SurfaceValue>(*surface_of(std::move(*content.surface), json.inputs(), context));
    volmesh::MeshCase options;
    json.read_options(all_options(wall->options, options));
    options.sources = json.values<volmesh::SizeSource>("sources");
    options.discs = json.values<volmesh::ActuatorDisc>("actuator_discs");
    options.wakes = json.values<volmesh::WakeSheet>("wake_sheets");
    options.periodic = json.periodic();
    options.patches = json.patch_rules();
    if (content.farfield) options.farfield_surface = std::make_shared<const TriMesh>(std::move(*content.farfield));
    if (!content.envelope->first_height.empty())
      options.first_heights = std::make_shared<const volmesh::FirstHeights>(wall->mesh, std::move(content.envelope->first_height), context);
    wall->history = json.history();
    wall->smooth_angle = json.smooth_angle();
    result.surface = wall;
    volmesh::EnvelopeStage envelope{.envelope = envelope_of(std::move(*content.envelope), file),
                                    .feature_angle = json.get<double>("/stage/feature_angle"),
                                    .closed = json.closed_multi_normals()};
    result.envelope = std::make_shared<const EnvelopeValue>(EnvelopeValue{.wall = wall, .options = options, .stage = envelope, .step = json.step()});
    if (content.tetrahedra && content.mesh)
      result.tetrahedra = std::make_shared<const TetrahedraValue>(TetrahedraValue{.wall = wall,
                                                                                  .n_wall_triangles = json.get<std::int64_t>("/stage/wall_triangles"),
                                                                                  .options = options,
                                                                                  .stage = filled_of(json, std::move(envelope), content, file)});
  }
  if (content.mesh && count_cells(*content.mesh).total() > 0 && !(result.tetrahedra && content.mesh->tetrahedra.empty())) {
    MeshValue mesh;
    mesh.mesh = std::move(*content.mesh);
    mesh.inputs.push_back({file.name, io::hash_input(file.path)});
    result.mesh = std::make_shared<const MeshValue>(std::move(mesh));
  }
  return result;
}

void write_stage(const EnvelopeValue& envelope, const std::filesystem::path& path, const RunContext& context) {
  require_stage_output(path);
  if (envelope.step == volmesh::EnvelopeStep::classified)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "writing " + path.string(),
                 .problem = "a classification alone cannot be stored",
                 .hint = "write the result of envelope.initial"});
  write_envelope(*envelope.wall, envelope.options, envelope.stage, path, context, envelope.step);
}

void write_stage(const TetrahedraValue& tetrahedra, const std::filesystem::path& path, const RunContext& context) {
  require_stage_output(path);
  write_filled(*tetrahedra.wall, tetrahedra.n_wall_triangles, tetrahedra.options, tetrahedra.stage, path, context);
}

void require_stage_output(const std::filesystem::path& path) {
  if (path.extension() != ".sterna")
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "writing " + path.string(),
                 .problem = "steps of a run can be written to .sterna files only, not to \"" + path.extension().string() + "\""});
  require_mesh_output(path);
}

namespace {

std::string describe_classes(const volmesh::Classification& classes) {
  const auto count = [&](bool volmesh::VertexClass::*flag) {
    return count_text(std::count_if(classes.vertex.begin(), classes.vertex.end(), [&](const volmesh::VertexClass& v) { return v.*flag; }));
  };
  return fmt::format("Classification: {} vertices, {} on ridges, {} corners, {} convex, {} concave, feature angle {:.4g} deg",
                     count_text(static_cast<std::int64_t>(classes.vertex.size())), count(&volmesh::VertexClass::is_ridge),
                     count(&volmesh::VertexClass::is_corner), count(&volmesh::VertexClass::is_convex), count(&volmesh::VertexClass::is_concave),
                     classes.feature_angle * 180.0 / std::numbers::pi);
}

/// Returns "30 layers" for make_envelope{}.
std::string layers_text(const volmesh::MeshCase& options) {
  if (!options.patches.empty()) return "layers by patch";
  const int layers = volmesh::effective_options(options, RunContext()).envelope.layers;
  return is_automatic(layers) ? "layers by the edges of the walls" : fmt::format("{} layers", layers);
}

}  // namespace

std::string describe(const EnvelopeValue& envelope) {
  if (envelope.classes) return describe_classes(*envelope.classes);
  const auto& heights = envelope.stage.envelope.height;
  const auto n_collapsed = std::count(heights.begin(), heights.end(), 0.0);
  return fmt::format("Envelope{}: {} vertices, {} collapsed, {}, up to {:.6g} m tall",
                     envelope.step == volmesh::EnvelopeStep::finished ? "" : ", " + std::string(to_string(envelope.step)),
                     count_text(static_cast<std::int64_t>(heights.size())), count_text(n_collapsed), layers_text(envelope.options),
                     heights.size() == 0 ? 0.0 : *std::max_element(heights.begin(), heights.end()));
}

std::string describe(const TetrahedraValue& tetrahedra) {
  const volmesh::TetraResult& tets = tetrahedra.stage.tets;
  return fmt::format("Tetrahedra: {} tetrahedra, {} new points, by {}, around a layer of {} columns",
                     count_text(static_cast<std::int64_t>(tets.tetrahedra.size())), count_text(static_cast<std::int64_t>(tets.new_points.size())), tets.engine,
                     count_text(static_cast<std::int64_t>(tetrahedra.stage.layers.layers.n_columns())));
}

}  // namespace sterna::scripting
