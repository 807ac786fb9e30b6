// The driver: the list of the steps, and the order in which they run.
#include "volmesh/volume_mesh.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "geom/base/number_text.h"
#include "geom/base/sort_unique.h"
#include "volmesh/layer/close_multi_normals.h"
#include "volmesh/run_steps.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {
namespace {

/// A step, and its time, from which its share of the progress follows.
struct StepRow {
  void (*run)(MeshRun& run, const RunContext& context);
  std::string_view part;  ///< name in progress reports; empty: the step reports no progress
  double hidden = 0.0;    ///< s: a second thread runs half of this beside other work
  double alone = 0.0;     ///< s: on one thread
  double shared = 0.0;    ///< s: on all threads
};

/// The steps, in the order of RunStep. The times are a fit to those of the DLR-F6 with 184 k triangles and 30 layers, with sterna's own engine on one and on
/// two threads. On one thread, the sizes and the verification of the layer do not run in parallel with other steps.
constexpr std::array<StepRow, 7> k_steps = {{
    {domain_step, {}},
    {envelope_step, "envelope", 0.0, 0.0, 6.0},
    {layer_step, "prisms", 0.0, 0.0, 1.4},
    {tetrahedra_step, "tetrahedra", 3.3, 1.0, 2.7},
    {improvement_step, "improve", 0.0, 1.2, 4.3},
    {joining_step, {}},
    {proof_step, "check", 0.0, 1.1, 2.4},
}};
static_assert(k_steps.size() == static_cast<std::size_t>(RunStep::proof) + 1);

/// Returns the fractions of the total time at which the steps end.
std::array<double, k_steps.size()> step_ends(int threads) {
  const double n = std::min(threads, 8);  // with more threads the serial part dominates
  std::array<double, k_steps.size()> ends{};
  double end = 0.0;
  for (std::size_t i = 0; i < k_steps.size(); ++i) {
    const StepRow& row = k_steps[i];
    end += n == 1.0 ? row.hidden : 0.5 * row.hidden / n;
    end += row.alone;
    end += row.shared / n;
    ends[i] = end;
  }
  for (double& share : ends) share /= end;
  return ends;
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

/// Closes the multi-normal fans that have no valid cells, before the next round.
void close_fans(const MultiNormalError& error, MeshRun& run, const RunContext& context) {
  ClosedMultiNormals& closed = run.closed;
  const std::vector<VertexId> more = with_neighbouring_bases(run.layer_domain->domain.ridges, error.base_vertices(), 1 << closed.n_rounds);
  context.warn("ridges stay closed at " + std::to_string(more.size()) + " vertices of the wall: " + error.info().problem +
               (error.info().locations.empty() ? "" : ", the first at " + format_point(error.info().locations.front().position)));
  closed.base_vertices.insert(closed.base_vertices.end(), more.begin(), more.end());
  if (++closed.n_rounds == k_multi_normal_rounds)
    context.warn("ridges stay closed everywhere: after " + std::to_string(k_multi_normal_rounds) + " rounds some multi-normal fans still had invalid cells");
  run.round = {};
}

/// Runs the steps from `first` to `last`. Multi-normal fans without valid cells are closed, and the domain is built again. If no engine fills the boundary, the
/// envelope is repaired, and the layer is made again.
void run_steps(MeshRun& run, RunStep first, RunStep last, const RunContext& context) {
  for (auto step = static_cast<std::size_t>(first); step <= static_cast<std::size_t>(last);) {
    try {
      k_steps[step].run(run, context);
      ++step;
    } catch (const MultiNormalError& error) {
      close_fans(error, run, context);
      step = static_cast<std::size_t>(RunStep::domain);
    } catch (const FillError& error) {
      if (!repair_for_engines(run, error, context)) throw;
      step = static_cast<std::size_t>(RunStep::layer);
    }
  }
}

}  // namespace

RunContext part_of_run(RunStep step, const RunContext& context) {
  const auto i = static_cast<std::size_t>(step);
  const auto ends = step_ends(context.threads());
  return context.part(k_steps[i].part, i == 0 ? 0.0 : ends[i - 1], ends[i]);
}

VolumeMeshResult volume_mesh(const TriMesh& wall, const MeshCase& options, const RunContext& context) {
  return watched_volume_mesh(wall, options, {}, {}, context);
}

VolumeMeshResult watched_volume_mesh(const TriMesh& wall, const MeshCase& options, const Makers& makers, const StageWatch& watch, const RunContext& context) {
  MeshRun run{.surface = wall, .options = options, .makers = makers, .watch = watch};
  run_steps(run, RunStep::domain, RunStep::proof, context);
  return std::move(run.result);
}

EnvelopeStage make_envelope(const TriMesh& wall, const MeshCase& options, const Makers& makers, const RunContext& context) {
  const StageWatch nobody;
  MeshRun run{.surface = wall, .options = options, .makers = makers, .watch = nobody};
  run_steps(run, RunStep::domain, RunStep::envelope, context);
  return std::move(run.envelope);
}

FilledStage make_tetrahedra(const TriMesh& wall, const EnvelopeStage& envelope, const MeshCase& options, const Makers& makers, const RunContext& context) {
  const StageWatch nobody;
  MeshRun run{.surface = wall, .options = options, .makers = makers, .watch = nobody, .given = envelope, .closed = envelope.closed};
  run_steps(run, RunStep::domain, RunStep::tetrahedra, context);
  return std::move(run.filled);
}

VolumeMeshResult finish_mesh(const TriMesh& wall, FilledStage filled, const MeshCase& options, const RunContext& context) {
  const Makers none;
  const StageWatch nobody;
  MeshRun run{.surface = wall, .options = options, .makers = none, .watch = nobody, .filled = std::move(filled)};
  restore(run, context);
  run_steps(run, RunStep::improvement, RunStep::proof, context);
  return std::move(run.result);
}

MeshCase with_closed_multi_normals(MeshCase options, const ClosedMultiNormals& closed) {
  if (closed.n_rounds < k_multi_normal_rounds) return options;
  options.ridges.open_ridges = "never";
  for (Rule& rule : options.patches) rule.options.erase("open_ridges");
  return options;
}

}  // namespace sterna::volmesh
