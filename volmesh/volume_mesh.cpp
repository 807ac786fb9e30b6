#include "volmesh/volume_mesh.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/alongside.h"
#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/sort_unique.h"
#include "geom/mesh/check_moved.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/periodic_growth.h"
#include "volmesh/forecast.h"
#include "volmesh/layer/close_multi_normals.h"
#include "volmesh/layer/lay_out.h"
#include "volmesh/layer/repair_envelope.h"
#include "volmesh/layer/slide_lines.h"
#include "volmesh/layer/split_layer.h"
#include "volmesh/parts/joint_envelope.h"
#include "volmesh/stages.h"
#include "volmesh/tetra/size_supply.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_boundary_repairs = 3;

/// Fractions of the total time at which the steps end.
struct StepEnds {
  double envelope, prisms, tetrahedra, improve;
};

/// The times are a fit a + b / threads to the seconds of the steps for the DLR-F6 with 184 k triangles and 30 layers, with sterna's own engine on one and on
/// two threads. On one thread, the sizes and the verification of the layer do not run in parallel with other steps.
StepEnds step_ends(int threads) {
  constexpr double k_envelope = 6.0, k_lay_out = 1.4, k_sizes = 3.3;
  constexpr double k_engine_alone = 1.0, k_engine = 2.7, k_improve_alone = 1.2, k_improve = 4.3, k_check_alone = 1.1, k_check = 2.4;
  const double n = std::min(threads, 8);  // with more threads the serial part dominates
  const double envelope = k_envelope / n, prisms = envelope + k_lay_out / n,
               tetrahedra = prisms + (n == 1.0 ? k_sizes : 0.5 * k_sizes / n) + k_engine_alone + k_engine / n,
               improve = tetrahedra + k_improve_alone + k_improve / n, all = improve + k_check_alone + k_check / n;
  return {envelope / all, prisms / all, tetrahedra / all, improve / all};
}

/// Adapts the true surface of the user's surface to the triangles of the wall.
TrueSurface true_surface_of(const TrueSurface& of_surface, const Domain& domain) {
  if (!of_surface) return {};
  return [of_surface, &domain](const Point& p, TriangleId t, const std::array<double, 3>& weights) {
    if (domain.wall_weights.empty()) return of_surface(p, domain.wall2surface[t], weights);
    std::array<double, 3> in_given{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j) in_given[j] += weights[k] * domain.wall_weights[t][k][j];
    const bool is_of_one = std::ranges::any_of(in_given, [](double weight) { return weight != 0.0; });
    return is_of_one ? of_surface(p, domain.wall2surface[t], in_given) : p;
  };
}

void report_slivers(const SliverReport& slivers, const SliverOptions& options, const RunContext& context) {
  if (slivers.has_changed()) context.debug(describe(slivers));
  if (slivers.n_left == 0) return;
  std::string hint;
  if (options.needle_budget == 0.0) hint = "; needle_budget = 1 splits the slivers that can be improved";
  if (slivers.is_over_budget) hint = "; a larger needle_budget splits more slivers";
  context.warn(std::to_string(slivers.n_left) + " triangles of the wall have an angle below " +
               number_text(options.split_needles * 180.0 / std::numbers::pi, 3) + " degrees (slivers" + (slivers.has_changed() ? " that are left" : "") +
               "); the first one is at " + format_point(slivers.first_left) + hint);
}

TetraBoundary boundary_for_engines(const FillBoundary& boundary, std::span<const Point> holes, ClearProof clear) {
  return {.points = boundary.points,
          .triangles = boundary.triangles,
          .hole_points = holes,
          .clear = clear,
          .patch_names = boundary.patch_names,
          .triangle_patch = boundary.triangle_patch};
}

/// Result of one attempt to make the tetrahedra.
struct Filling {
  TetraResult tets;
  std::optional<SplitLayer> split;  ///< set if the engine has split triangles: the layer with the same splits
  std::optional<LayerProof> proof;  ///< verification of the layer that the tetrahedra surround
  std::vector<Point> holes;
  ClearProof clear;  ///< proof for the boundary
};

/// Fills the volume inside the split boundary again, which is now kept, after the layer had to be lowered for the splits.
void refill(const SplitLayer& layer, const MeshCase& options, TetraResult& tets, const RunContext& context) {
  TetraOptions keeping = options.tetrahedra;
  keeping.boundary_splits = "never";
  const std::vector<Point> holes = find_cavity_points(*layer.wall, context);
  const TetraBoundary domain = boundary_for_engines(layer.boundary, holes, layer.clear);
  SizeSupply sizes(domain, options.sources, options.size, context);
  tets = fill(domain, sizes, keeping, context);
}

/// Takes the first candidate of the engines whose splits can be applied to the layer.
void climb(const LayerDomain& layer_domain, const Envelope& envelope, const Makers& makers, TetraLadder& ladder, Filling& filling, const RunContext& context) {
  const TrueSurface true_surface = true_surface_of(makers.true_surface, layer_domain.domain);
  for (;;) {
    filling.tets = ladder.next();
    if (filling.tets.splits.empty()) return;
    try {
      filling.split = split_layer(layer_domain.base, envelope, layer_domain.domain.outer, layer_domain.options, true_surface, filling.tets, context);
      if (!filling.split->is_filled) refill(*filling.split, layer_domain.options, filling.tets, context);
      return;
    } catch (const Error& error) {
      filling.split.reset();
      ladder.reject(error);
    }
  }
}

/// Makes the tetrahedra around a layer, and verifies the layer in parallel. \throws FillError
Filling fill_around(const LayerDomain& layer_domain, const Envelope& envelope, const LaidLayer& layer, const Makers& makers, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra");
  Filling filling;
  // The boundary must stay unchanged if layers end on other patches, if sides are periodic, if ridges are opened, or if wakes have sheets.
  const bool may_split = layer_domain.base.wall.n_triangles() > 0 && !layer_domain.domain.has_borders() && layer_domain.domain.periodic.empty() &&
                         !layer_domain.domain.is_opened();
  const SplitPermission splits = may_split ? SplitPermission::permitted : SplitPermission::never;
  filling.holes = find_cavity_points(layer_domain.domain.bodies, context);
  TetraBoundary domain = boundary_for_engines(layer.boundary, filling.holes, layer.clear);
  domain.has_baffles = !layer_domain.options.discs.empty();
  domain.has_wakes = !layer_domain.domain.sheets.is_empty();
  const CellCounts cells = count_cells(layer.mesh);
  Forecast forecast{.n_triangles = static_cast<double>(layer_domain.base.wall.n_triangles()), .n_prisms = static_cast<double>(cells.total())};
  SizeSupply sizes(domain, layer_domain.options.sources, layer_domain.options.size, context, [&](const SizeField& field, const RunContext& side) {
    forecast.n_tetrahedra = expected_tetrahedra(field);
    require_room(forecast, layer_domain.options.limits, side);
  });
  const StepEnds ends = step_ends(context.threads());
  TetraLadder ladder(domain, &sizes, layer_domain.options.tetrahedra, splits, context.part("tetrahedra", ends.prisms, ends.tetrahedra));
  filling.clear = ladder.proof();
  Alongside<LayerProof> proof(context, ladder.begins_here() ? context.threads() : context.threads() - 1, [&sizes, &layer](const RunContext& side) {
    sizes.wait();  // the verification waits, because the engine needs the sizes sooner
    return prove_layer(layer.mesh, side);
  });
  climb(layer_domain, envelope, makers, ladder, filling, context);
  filling.proof.emplace(std::move(proof).take());
  return filling;
}

/// Lowers and smooths the envelope after an engine failure. Returns false if nothing can be repaired or the retry limit is reached.
bool repair_for_engines(LayerDomain& layer_domain, Envelope& envelope, const LaidLayer& layer, const FillError& error, const RunContext& context) {
  if (!layer_domain.options.tetrahedra.repair_boundary || !error.is_repeatable()) return false;
  const bool has_baffles = !layer_domain.options.discs.empty();
  const std::size_t n_changed =
      repair_envelope(layer_domain.base, layer.boundary, has_baffles, error.info().locations, layer_domain.collider, envelope, context).size();
  if (n_changed == 0) return false;
  context.warn("trying again with the layer lowered and smoothed at " + std::to_string(n_changed) +
               " vertices around slivers, folds and gaps of the layer top");
  return true;
}

/// Replaces the layer by its split version.
LaidLayer adopted(SplitLayer& split, const LaidLayer& unsplit, const EnvelopeOptions& options, const RunContext& context) {
  context.info("boundary splits: " + std::to_string(split.boundary.points.size() - unsplit.boundary.points.size()) + " new points, " +
               std::to_string(split.boundary.triangles.size() - unsplit.boundary.triangles.size()) + " more triangles");
  LaidLayer layer;
  layer.certificate = split.certificate;
  layer.clear = split.clear;
  layer.report = report_layer(*split.base, options, split.envelope, split.extrusion, split.outer.get(), context);
  layer.curving_shares = split.extrusion.curving_shares;
  layer.mesh = assemble_layers(*split.base, std::move(split.extrusion), unlinked(*split.outer), {});
  layer.mesh.request = layer_request(*split.base, options, split.envelope, layer.mesh.layers);
  layer.boundary = std::move(split.boundary);
  return layer;
}

constexpr int k_slide_rounds = 4;
constexpr double k_slides_begin = 0.75;  ///< fraction of the time

/// Improves tetrahedra within the boundary; \p improved is the improvement that has already started. Then, where the boundary is the cause of bad tetrahedra,
/// ends of growth lines move, and the tetrahedra around them are improved again. \p slid receives these growth lines, ascending.
void slide_and_improve(HybridMesh& layers, FillBoundary& boundary, TetraResult& tets, const ImproveOptions& options, ImproveReport& report,
                       std::vector<std::uint32_t>& slid, const RunContext& context) {
  const auto domain = [&] {
    return TetraBoundary{.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}, .layer_volumes = boundary.layer_volumes};
  };
  if (options.improve_rounds == 0 || options.slide_share == 0.0) return;
  LineSlider slider(layers, boundary, options, context);
  for (int round = 0; round < k_slide_rounds; ++round) {
    const std::vector<std::uint32_t> moved = slider.slide(tets);
    if (moved.empty()) break;
    slid.insert(slid.end(), moved.begin(), moved.end());
    if (round + 1 < k_slide_rounds)
      improve_around(domain(), moved, tets, options, report,
                     context.part("slides", k_slides_begin + (1.0 - k_slides_begin) * round / k_slide_rounds, 1.0));  // slides come last in this step
  }
  if (slider.n_moved() > 0) report_remaining(domain(), tets, options, report, context);
  sort_unique(slid);
  report.n_slid = static_cast<std::int64_t>(slid.size());
}

/// Returns the given ridge base vertices, and those up to n_edges away along their ridges; ascending.
std::vector<VertexId> with_neighbouring_bases(const OpenedRidges& ridges, std::vector<VertexId> base_vertices, int n_edges) {
  sort_unique(base_vertices);
  for (int i = 0; i < n_edges; ++i) {
    std::vector<VertexId> more = base_vertices;
    for (const auto& quad : ridges.quads) {
      const VertexId a = ridges.base_vertex[quad[0]], b = ridges.base_vertex[quad[1]];
      if (std::ranges::binary_search(base_vertices, a)) more.push_back(b);
      if (std::ranges::binary_search(base_vertices, b)) more.push_back(a);
    }
    sort_unique(more);
    base_vertices.swap(more);
  }
  return base_vertices;
}

/// Merges patches of the same name and kind. They are parts of a patch that was split at its corners (split_at_corners).
void merge_equal_patches(HybridMesh& mesh) {
  Column<PatchId, Patch> patches;
  Column<PatchId, PatchId> merged;
  for (const Patch& patch : mesh.patches) {
    const auto same = std::find(patches.begin(), patches.end(), patch);
    merged.push_back(same == patches.end() ? patches.push_back(patch) : PatchId(static_cast<std::uint64_t>(same - patches.begin())));
  }
  if (patches.size() == mesh.patches.size()) return;
  mesh.patches = std::move(patches);
  for (sterna::BoundaryTriangle& face : mesh.boundary_triangles) face.patch = merged[face.patch];
  for (sterna::BoundaryQuad& face : mesh.boundary_quads) face.patch = merged[face.patch];
  for (PeriodicSides& sides : mesh.periodic) {
    sides.first = merged[sides.first];
    sides.second = merged[sides.second];
  }
}

void require_valid(const CheckReport& report) {
  if (report.is_valid()) return;
  const bool is_rounding_alone = std::ranges::all_of(report.counts, [](const auto& of_kind) {
    return of_kind.first == Violation::cell_within_rounding || of_kind.first == Violation::sub_volume_within_rounding;
  });
  ErrorInfo info{.code = ErrorCode::mesh_invalid,
                 .attempted = "checking the finished mesh",
                 .hint = is_rounding_alone ? "these cells are too flat for solvers in double precision: remesh the wall there without sliver triangles, or "
                                             "move the model towards the origin if it is far from it"
                                           : "report this surface"};
  for (const auto& [violation, count] : report.counts) {
    info.problem += (info.problem.empty() ? "" : ", ") + std::to_string(count) + " x " + std::string(to_string(violation));
    info.n_locations += count;
  }
  for (const CheckFinding& finding : report.findings) info.locations.push_back({finding.position, finding.what});
  throw Error(std::move(info));
}

}  // namespace

VolumeMeshResult volume_mesh(const TriMesh& wall, const MeshCase& options, const RunContext& context) { return volume_mesh(wall, options, {}, {}, context); }

VolumeMeshResult volume_mesh(const TriMesh& wall, const MeshCase& options, const Makers& makers, const StageWatch& watch, const RunContext& context) {
  LayerKnowledge knowledge;
  FilledStage filled = make_filled(wall, options, makers, watch, {}, knowledge, context);
  if (watch.filled) watch.filled(filled);
  return finish_mesh(std::move(filled), std::move(knowledge), options.improve, context);
}

MeshCase with_closed_multi_normals(MeshCase options, const ClosedMultiNormals& closed) {
  if (closed.n_rounds < k_multi_normal_rounds) return options;
  options.ridges.open_ridges = "never";
  for (Rule& rule : options.patches) rule.options.erase("open_ridges");
  return options;
}

FilledStage make_filled(const TriMesh& wall, const MeshCase& options, const Makers& makers, const StageWatch& watch, std::optional<EnvelopeStage> made,
                        LayerKnowledge& knowledge, const RunContext& context) {
  ClosedMultiNormals closed = made ? made->closed : ClosedMultiNormals{};
  for (;;) {
    MeshCase now = with_closed_multi_normals(options, closed);
    if (made) now.envelope.feature_angle = made->feature_angle;
    LayerDomain layer_domain(wall, now, context, closed.base_vertices);
    try {
      const auto make = [&] { return make_envelope(layer_domain, makers, context); };
      EnvelopeStage envelope = made ? std::move(*made) : watch.envelope && closed.n_rounds == 0 ? watch.envelope(make) : make();
      made.reset();  // the given envelope belongs to the wall of this round only
      envelope.closed = closed;
      if (watch.enveloped) watch.enveloped(envelope);
      return make_tetrahedra(layer_domain, std::move(envelope), makers, knowledge, context);
    } catch (const MultiNormalError& error) {
      const std::vector<VertexId> more = with_neighbouring_bases(layer_domain.domain.ridges, error.base_vertices(), 1 << closed.n_rounds);
      context.warn("ridges stay closed at " + std::to_string(more.size()) + " vertices of the wall: " + error.info().problem +
                   (error.info().locations.empty() ? "" : ", the first at " + format_point(error.info().locations.front().position)));
      closed.base_vertices.insert(closed.base_vertices.end(), more.begin(), more.end());
      if (++closed.n_rounds == k_multi_normal_rounds)
        context.warn("ridges stay closed everywhere: after " + std::to_string(k_multi_normal_rounds) +
                     " rounds some multi-normal fans still had invalid cells");
    }
  }
}

EnvelopeStage make_envelope(LayerDomain& layer_domain, const Makers& makers, const RunContext& context) {
  const StageTimer timer(context, "envelope");
  const RunContext part = context.part("envelope", 0.0, step_ends(context.threads()).envelope);
  require_room(forecast_of(layer_domain), layer_domain.options.limits, context);
  report_slivers(layer_domain.domain.slivers, layer_domain.options.needles, context);
  const std::vector<WholePart> parts = layer_domain.domain.wall_discs.empty() && !layer_domain.domain.is_opened()
                                           ? whole_parts(layer_domain.domain, layer_domain.options.parts, context)
                                           : std::vector<WholePart>{};  // walls that are cut or opened no longer belong to placed parts
  const auto of_wall = [&] {
    const WallEnvelopeMaker& make = makers.wall_envelope;
    return make ? make(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, part)
                : build_envelope(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, part);
  };
  EnvelopeStage stage{parts.empty() ? of_wall() : joint_envelope(layer_domain, parts, makers.part_envelope, part), layer_domain.options.envelope.feature_angle};
  equalise_partners(layer_domain.base, layer_domain.options.envelope, &layer_domain.collider, stage.envelope, context);
  return stage;
}

FilledStage make_tetrahedra(LayerDomain& layer_domain, EnvelopeStage stage, const Makers& makers, LayerKnowledge& knowledge, const RunContext& context) {
  require_envelope_of(layer_domain.base, stage);
  const StepEnds ends = step_ends(context.threads());
  LaidLayer layer = lay_out(layer_domain, stage.envelope, context.part("prisms", ends.envelope, ends.prisms));
  std::vector<std::string> reported;
  const auto report_warnings = [&] {
    for (const std::string& warning : layer.report.warnings)
      if (std::ranges::find(reported, warning) == reported.end()) context.warn(reported.emplace_back(warning));
  };
  report_warnings();

  FilledStage filled;
  filled.slivers = layer_domain.domain.slivers;
  Filling filling;
  for (int n_repairs = 0;; ++n_repairs) {
    try {
      filling = fill_around(layer_domain, stage.envelope, layer, makers, context);
      break;
    } catch (const FillError& error) {
      filled.tetra_failures.insert(filled.tetra_failures.end(), error.failures().begin(), error.failures().end());
      if (n_repairs == k_max_boundary_repairs || !repair_for_engines(layer_domain, stage.envelope, layer, error, context)) throw;
      layer = lay_out(layer_domain, stage.envelope, context);
    }
  }
  if (filling.split) {
    filled.n_split_triangles = static_cast<std::int64_t>(filling.split->boundary.triangles.size() - layer.boundary.triangles.size());
    layer = adopted(*filling.split, layer, layer_domain.options.envelope, context);
    filling.proof.emplace(prove_layer(layer.mesh, context));
    filled.split_wall = *filling.split->wall;
    stage.envelope = std::move(filling.split->envelope);
  }
  report_warnings();  // these are the warnings of a layer that is no longer the first one
  require_proved_cells(filling.proof->cells, layer.certificate);

  knowledge = {std::move(layer.report), std::move(layer.certificate), std::move(filling.proof->check), {}, {}};
  if (!filling.split) knowledge.second = second_engine(layer_domain.options, std::move(filling.holes), filling.clear, !layer_domain.domain.sheets.is_empty());
  filled.envelope = std::move(stage);
  filled.is_opened = layer.opened.has_value();
  if (filled.is_opened) {
    knowledge.closed = std::move(layer.mesh);
    knowledge.boundary = std::move(layer.boundary);
  }
  filled.layers = filled.is_opened ? std::move(*layer.opened) : std::move(layer.mesh);
  filled.curving_shares = layer.curving_shares;
  filled.tets = std::move(filling.tets);
  filled.tetra_failures.insert(filled.tetra_failures.end(), filled.tets.failures.begin(), filled.tets.failures.end());
  return filled;
}

SecondEngine second_engine(const MeshCase& options, std::vector<Point> holes, ClearProof clear, bool has_wakes) {
  return {.tetrahedra = options.tetrahedra,
          .sources = options.sources,
          .sizes = options.size,
          .holes = std::move(holes),
          .clear = clear,
          .has_baffles = !options.discs.empty(),
          .has_wakes = has_wakes};
}

VolumeMeshResult finish_mesh(FilledStage filled, LayerKnowledge knowledge, const ImproveOptions& options, const RunContext& context) {
  const StepEnds ends = step_ends(context.threads());
  VolumeMeshResult result;
  TetraResult& tets = filled.tets;
  result.mesh = std::move(knowledge.closed ? *knowledge.closed : filled.layers);
  result.layer = std::move(knowledge.report);
  result.certificate = knowledge.certificate;
  result.tetra_failures = std::move(filled.tetra_failures);
  result.n_split_triangles = filled.n_split_triangles;
  result.slivers = filled.slivers;
  FillBoundary boundary = knowledge.closed ? std::move(knowledge.boundary) : boundary_of(result.mesh);
  std::vector<std::uint32_t> slid;
  {
    const StageTimer timer(context, "improve");
    const RunContext part = context.part("improve", ends.tetrahedra, ends.improve);
    const TetraBoundary domain{.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}, .layer_volumes = boundary.layer_volumes};
    result.improvement = improve_tetrahedra(domain, tets, options, part.part("tetrahedra", 0.0, k_slides_begin));
    if (knowledge.second && options.improve_rounds > 0)
      result.tetra_choice = choose_engine(boundary, *knowledge.second, options, result.tetra_failures, tets, result.improvement, part);
    slide_and_improve(result.mesh, boundary, tets, options, result.improvement, slid, part);
  }
  result.tetra_engine = tets.engine + (tets.is_two_pass ? " in two passes" : "");
  result.is_reproducible = tets.is_reproducible;
  result.tetra_engine_seconds = tets.engine_seconds;
  result.tetra_engine_peak_bytes = tets.engine_peak_bytes;
  if (!slid.empty()) {
    const StageTimer timer(context, "check");
    knowledge.check = check_moved_lines(*knowledge.check, result.mesh, slid, {}, context);
  }
  {
    const StageTimer timer(context, "assemble");
    add_tetrahedra(boundary, tets, result.mesh, context);
  }
  {
    const StageTimer timer(context, "check");
    result.check = check(result.mesh, {}, context.part("check", ends.improve, 1.0), &*knowledge.check);
  }
  require_valid(result.check);
  merge_equal_patches(result.mesh);
  for (const PeriodicMatchReport& sides : result.check.periodic)
    context.info("periodic sides " + sides.first + " and " + sides.second + ": " + std::to_string(sides.n_nodes) + " nodes and " +
                 std::to_string(sides.n_faces) + " faces match within " + number_text(sides.worst, 3) + " m");
  return result;
}

}  // namespace sterna::volmesh
