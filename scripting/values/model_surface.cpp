#include "scripting/values/model_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/math/constants.h"
#include "geom/mesh/topology.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/cached_surface.h"
#include "scripting/values/fluid_model.h"
#include "scripting/values/mesh_parts.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/start_from_reference.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"
#include "surfmesh/model/periodic_borders.h"
#include "volmesh/case/size_sources.h"

namespace sterna::scripting {
namespace {

/// Number of open edges and absorbed parts in the log; the report contains all.
constexpr std::size_t k_listed = 10;

/// Open edges that lie in one plane x, y or z = constant, such as the open boundary of a half model.
struct OpenPlane {
  std::size_t axis = 0;
  double at = 0.0;      ///< m
  double length = 0.0;  ///< m
  std::size_t n_edges = 0;
};

/// Returns planes with two open edges or more, the one with the longest open boundary first; removes their edges from the list.
std::vector<OpenPlane> open_planes(std::vector<OpenEdge>& open) {
  constexpr double k_flat = 1e-6;  // relative to the longest side of the box of all open edges
  Box box;
  for (const OpenEdge& edge : open)
    for (const Point* p : {&edge.from, &edge.middle, &edge.to}) box.add(*p);
  const auto is_in = [&](const OpenEdge& edge, const OpenPlane& plane) {
    const auto is_near = [&](const Point& p) { return std::abs(p[plane.axis] - plane.at) <= k_flat * box.longest_side(); };
    return is_near(edge.from) && is_near(edge.middle) && is_near(edge.to);
  };
  std::vector<OpenPlane> planes;
  for (;;) {
    OpenPlane longest;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const OpenEdge& start : open) {
        OpenPlane plane{.axis = axis, .at = start.middle[axis]};
        for (const OpenEdge& edge : open) {
          if (!is_in(edge, plane)) continue;
          plane.length += edge.length;
          ++plane.n_edges;
        }
        if (plane.n_edges > 1 && plane.length > longest.length) longest = plane;
      }
    if (longest.n_edges == 0) return planes;
    std::erase_if(open, [&](const OpenEdge& edge) { return is_in(edge, longest); });
    planes.push_back(longest);
  }
}
// Progress at the ends of the steps of mesh_model_files.
constexpr double k_model_file_end = 0.3;
constexpr double k_unite_end = 0.5;
constexpr double k_first_try_end = 0.6;  ///< progress after a first try, for parts that have to be united
constexpr double k_second_unite_end = 0.8;

bool is_description(const std::filesystem::path& path) { return path.extension() == ".smx" || path.extension() == ".xml"; }

/// sumo's default normal angle; files that do not change it have this value
constexpr double k_sumo_angle = 30.0 * std::numbers::pi / 180.0;
constexpr double k_same_angle = 1e-3;

/// Returns rules with the triangle settings of components in an .smx file, except settings that sumo derived itself. There are rules only for components with
/// faces of their name.
std::vector<Rule> rules_of(const Aircraft& aircraft, const Model& model) {
  std::vector<Rule> rules;
  const auto add = [&](const std::string& name, const std::optional<MeshCriterion>& criterion) {
    if (!criterion || criterion->is_automatic || std::none_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& face) { return face.name == name; }))
      return;
    Rule rule{.names = name, .options = {}};
    if (criterion->max_edge) rule.options["max_edge"] = *criterion->max_edge;
    if (criterion->min_edge) rule.options["min_edge"] = *criterion->min_edge;
    if (criterion->max_normal_angle && std::abs(*criterion->max_normal_angle - k_sumo_angle) > k_same_angle)
      rule.options["curvature_angle"] = *criterion->max_normal_angle;
    if (criterion->is_wing) {
      rule.options["leading_edge_factor"] = std::clamp(criterion->leading_edge_factor, 0.01, 1.0);
      rule.options["trailing_edge_factor"] = std::clamp(criterion->trailing_edge_factor, 0.01, 1.0);
    }
    rules.push_back(std::move(rule));
  };
  for (const Body& body : aircraft.bodies) add(body.name, body.criterion);
  for (const Wing& wing : aircraft.wings) add(wing.name, wing.criterion);
  return rules;
}

/// Puts rules of files before the user's rules, so that the user's rules win.
void put_first(std::vector<Rule> rules, SurfaceRecipe& recipe) { recipe.patches.insert(recipe.patches.begin(), rules.begin(), rules.end()); }

/// Returns the rules that match the name of a face. Others are left out, because a boolean may have removed all their faces.
std::vector<Rule> present(std::vector<Rule> rules, const Model& model) {
  std::erase_if(rules, [&](const Rule& rule) {
    return std::none_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& face) { return matches_glob(face.name, rule.names); });
  });
  return rules;
}

void add_periodic_faces(const std::vector<ModelHandle>& models, std::span<const PeriodicNames> periodic, SurfaceRecipe& recipe) {
  const auto is_face = [&](const std::string& name) {
    if (surfmesh::is_open_plane(name)) return std::ranges::any_of(models, [](const ModelHandle& model) { return !free_edges(model->model).empty(); });
    return std::ranges::any_of(
        models, [&](const ModelHandle& model) { return std::ranges::any_of(model->model.faces, [&](const ModelFace& face) { return face.name == name; }); });
  };
  for (const PeriodicNames& pair : periodic)
    if (is_face(pair.first) && is_face(pair.second)) recipe.options.periodic.push_back(pair);
}

std::string indented(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) text.replace(at, 1, "\n  ");
  return "  " + text;
}

/// Warns about lengths outside the range of aircraft, rotors, cars or wind-tunnel models: most of these are millimetres taken as metres.
void doubt_size(const Model& model, const RunContext& context) {
  constexpr double k_smallest = 1e-3, k_largest = 200.0;  // m
  const double size = box_of(model).longest_side();
  if (size <= 0.0 || (size >= k_smallest && size <= k_largest)) return;
  context.info(
      fmt::format("hint: the model is {:.4g} m long. Lengths are in metres: write 1200*mm in scripts for millimetres, and for CAD files give the unit of the "
                  "file (unit = mm, --unit mm)",
                  size));
}

/// Meshes the models. Closed parts that intersect or touch each other, as in CAD files of one aircraft, are united if their triangles cross. This is reported.
SurfaceValue mesh_or_unite(const std::vector<ModelHandle>& models, const SurfaceRecipe& recipe, const RunContext& context, const Reuse& reuse) {
  std::size_t n_solids = 0;
  bool is_closed = true;
  for (const ModelHandle& model : models) {
    n_solids += model->model.solids.size();
    for (const ModelSolid& solid : model->model.solids) is_closed = is_closed && solid.is_closed;
  }
  try {
    return mesh_models(models, recipe, {}, context.part("parts", 0.0, k_first_try_end), reuse);
  } catch (const Error& crossing) {
    if (crossing.code() != ErrorCode::self_intersection || n_solids < 2 || !is_closed) throw;
    auto united = std::make_shared<ModelValue>();
    try {
      *united = unite_solids(models, {}, context.part("union", k_first_try_end, k_second_unite_end));
    } catch (const Error& failed) {
      if (failed.code() == ErrorCode::cancelled) throw;
      ErrorInfo info = crossing.info();
      info.problem += "; the union of the parts failed: " + failed.info().problem;
      throw Error(std::move(info));
    }
    KeyMaker maker("united");
    const bool are_known = std::ranges::all_of(models, [](const ModelHandle& model) { return model->provenance.key().has_value(); });
    for (const ModelHandle& model : models)
      if (are_known) maker.add(*model->provenance.key());
    if (are_known) united->provenance = maker.key();
    SurfaceValue surface = mesh_models({united}, recipe, {}, context.part("united", k_second_unite_end, 1.0), reuse);
    std::string change = fmt::format("{} closed parts intersect and were united: {} closed now", n_solids, united->model.solids.size());
    context.info("changed: " + change);
    surface.history.push_back({.changes = {std::move(change)}});
    return surface;
  }
}

/// Adds the size rules of models and their descriptions.
void add_rules(const std::vector<ModelHandle>& models, const ModelValue& all, SurfaceRecipe& recipe) {
  put_first(present(all.sizes, all.model), recipe);
  for (const ModelHandle& model : models)
    if (model->description) put_first(rules_of(*model->description, all.model), recipe);
}

SurfaceValue mesh_from_scratch(const std::vector<ModelHandle>& models, const SurfaceRecipe& requested, const std::function<double(const Point&)>& size,
                               const RunContext& context, const Reuse& reuse) {
  const ModelValue all = fluid_of(assemble(models, context), context);
  doubt_size(all.model, context);
  SurfaceRecipe recipe = requested;
  add_rules(models, all, recipe);
  PartsMesh made = mesh_parts(all, recipe, space_sizes(recipe, size), cached_part_mesher(reuse), context,
                              reuse.reference ? starting_mesher(reuse, mesh_part) : PartMesher());
  recipe.has_function = static_cast<bool>(size);
  SurfaceValue surface{.inputs = all.inputs, .history = {{.options = recipe}}};
  surface.parts = std::move(made.parts);
  for (const Rule& rule : all.layers)
    if (std::any_of(all.model.faces.begin(), all.model.faces.end(), [&](const ModelFace& face) { return face.name == rule.names; }))
      surface.layers.push_back(rule);
  surface.smooth_angle = made.mesh.report.max_smooth_angle;
  surface.true_surface.wall = std::make_shared<const surfmesh::ModelWall>(all.model, made.mesh);
  surface.mesh = std::move(made.mesh.mesh);
  const Topology topology(surface.mesh, context);
  surface.report.n_triangles_read = static_cast<std::int64_t>(surface.mesh.n_triangles());
  surface.report.n_vertices_read = static_cast<std::int64_t>(surface.mesh.n_vertices());
  surface.report.n_components = static_cast<std::int64_t>(connected_components(surface.mesh, topology).count);
  surface.report.is_closed = topology.n_boundary_halfedges() == 0;
  surface.mesh_report = std::move(made.mesh.report);
  context.info(surface_mesh_text(all.model, surface));
  context.debug(indented(to_text(*surface.mesh_report)));
  return surface;
}

}  // namespace

surfmesh::SpaceSizes space_sizes(const SurfaceRecipe& recipe, const std::function<double(const Point&)>& size) {
  surfmesh::SpaceSizes requested{.regions = {}, .function = size, .samples = {}};
  std::vector<volmesh::SizeSource> regions;
  for (const volmesh::SizeSource& source : recipe.sources) {
    if (const std::string problem = problem_of(source, recipe.options.sizes.growth); !problem.empty())
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "reading the sources of a surface mesh",
                   .problem = std::string(to_string(source.kind)) + ": " + problem});
    if (source.kind != volmesh::SourceKind::samples) regions.push_back(source);
    for (std::size_t i = 0; i < source.points.size(); ++i) requested.samples.push_back({source.points[i], source.sizes[i]});
  }
  if (!regions.empty())
    requested.regions = [regions = std::move(regions)](const Point& p, double slope) {
      double least = std::numeric_limits<double>::infinity();
      for (const volmesh::SizeSource& source : regions) least = std::min(least, size_of(source, p, slope));
      return least;
    };
  return requested;
}

OptionTable with_edge_tables(OptionTable table) {
  for (Option& option : table)
    for (const std::string_view edge : {"leading_edge", "trailing_edge"})
      if (option.name.starts_with(edge)) option.stage = edge;
  return table;
}

std::string surface_mesh_text(const Model& model, const SurfaceValue& surface) {
  const surfmesh::SurfaceMeshReport& report = *surface.mesh_report;
  std::string text = describe(surface) + fmt::format("; angles {:.3g} to {:.4g} deg", report.min_angle / k_degree, report.max_angle / k_degree);
  if (report.n_free_edges > 0) {
    std::vector<OpenEdge> open = open_edges(model);
    for (const OpenPlane& plane : open_planes(open))
      text += fmt::format("\n  open      along {:.4g} m in the plane {} = {:.6g} m, {} edges", plane.length, "xyz"[plane.axis], plane.at, plane.n_edges);
    for (std::size_t i = 0; i < std::min(k_listed, open.size()); ++i)
      text += fmt::format("\n  open      along {:.4g} m of face \"{}\" about {}", open[i].length, open[i].face, format_point(open[i].middle));
    if (open.size() > k_listed) text += fmt::format("\n  open      and {} more edges of the model", open.size() - k_listed);
  }
  for (std::size_t i = 0; i < std::min(k_listed, report.absorbed.size()); ++i)
    text += fmt::format("\n  absorbed  {} at {}, {:.3g} m", report.absorbed[i].what, format_point(report.absorbed[i].location), report.absorbed[i].size);
  if (report.absorbed.size() > k_listed) text += fmt::format("\n  absorbed  and {} more", report.absorbed.size() - k_listed);
  return text;
}

SurfaceValue mesh_models(const std::vector<ModelHandle>& models, const SurfaceRecipe& requested, const std::function<double(const Point&)>& size,
                         const RunContext& context, const Reuse& reuse) {
  const StageTimer timer(context, "surface_mesh");
  const auto make = [&](const std::function<double(const Point&)>& requested_size) {
    return mesh_from_scratch(models, requested, requested_size, context, reuse);
  };
  // This runs in the thread that first needs the model, and therefore uses no additional threads.
  const auto all = [models, stop = context.stop_token(), seed = context.seed()] {
    const RunContext quiet({.threads = 1, .seed = seed, .stop = stop});
    return fluid_of(assemble(models, quiet), quiet).model;
  };
  return cached_surface(models, requested, size, make, all, reuse, context);
}

ModelsOfFiles read_model_files(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, const RunContext& context,
                               std::span<const PeriodicNames> periodic) {
  for (const InputPath& file : files)
    if (!is_model_file(file.path))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "meshing the surface of " + file.name,
                   .problem = "the file is not a model (STEP, IGES, BREP, sumo .smx, CPACS .xml)",
                   .hint = "remesh a triangulation: sterna remesh " + file.name + " -o wall.stl; or make a volume mesh on it: sterna mesh " + file.name});
  ModelsOfFiles result{.models = {}, .recipe = recipe};
  std::vector<ModelHandle>& models = result.models;
  const double n = static_cast<double>(files.size());
  for (const InputPath& file : files) {
    const double i = static_cast<double>(models.size());
    auto model = std::make_shared<ModelValue>(read_model(file, reading, context.part("read", k_model_file_end * i / n, k_model_file_end * (i + 1) / n)));
    if (is_description(file.path) && model->model.solids.size() > 1) {
      const std::optional<Aircraft> description = model->description;  // a union has none
      const std::optional<ContentKey> of_file = model->provenance.key();
      *model = unite_solids({std::make_shared<const ModelValue>(std::move(*model))}, {}, context.part("union", k_model_file_end, k_unite_end));
      model->provenance = KeyMaker("united").add(*of_file).key();
      if (description) put_first(rules_of(*description, model->model), result.recipe);
    }
    models.push_back(std::move(model));
  }
  add_periodic_faces(models, periodic, result.recipe);
  return result;
}

SurfaceValue mesh_model_files(const ModelsOfFiles& files, const RunContext& context, const Reuse& reuse) {
  return mesh_or_unite(files.models, files.recipe, context.part("surface_mesh", k_unite_end, 1.0), reuse);
}

SurfaceValue mesh_model_files(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, const RunContext& context,
                              const Reuse& reuse, std::span<const PeriodicNames> periodic) {
  return mesh_model_files(read_model_files(files, reading, recipe, context, periodic), context, reuse);
}

surfmesh::SurfaceForecast forecast_models(const std::vector<ModelHandle>& models, const SurfaceRecipe& requested, const RunContext& context) {
  const ModelValue all = fluid_of(assemble(models, context), context);
  SurfaceRecipe recipe = requested;
  add_rules(models, all, recipe);
  return surfmesh::forecast_surface(all.model, recipe.options, recipe.patches, space_sizes(recipe, {}), context);
}

OptionTable model_surface_options(surfmesh::SurfaceMeshOptions& surface, ReadCadOptions& reading) {
  OptionTable table = sterna::options_of(surface);
  for (Option& option : sterna::options_of(reading)) table.push_back(std::move(option));
  return table;
}

}  // namespace sterna::scripting
