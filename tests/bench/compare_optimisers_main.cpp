// Compares all envelope optimisers on real surfaces, from the same start and with the same upper heights (docs/method/optimisation.md). Prints a Markdown table
// for each surface: objective and its gain, smallest scaled Jacobian and skew shares (13) of the macro-elements, area-weighted height, evaluations, time.
// usage: compare_optimisers [options] surface...        with the settings of docs/measurements/surfaces.md: 35 layers, first height 1e-6 body lengths
//   --evaluations=300   limit for NLopt (the descent stops by itself, at 30 sweeps)
//   --solvers=a,b,...   names from solvers() below; default all
//   --slack=      slack of NLopt's constraint (NloptSettings::slack)
//   --threads=2  --layers=35  --history (f by evaluation, one line per solver)
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/mesh/quality.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/nlopt_optimise.h"
#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/paper_problem.h"
#include "volmesh/envelope/validity.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;
using Clock = std::chrono::steady_clock;

struct Settings {
  int evaluations = 300;
  double slack = -1.0;  ///< slack of NLopt's constraint; negative: NLopt's default
  int threads = 2;
  int layers = 35;
  bool has_history = false;
  std::vector<std::string> solvers;  ///< empty: all
  std::vector<std::string> surfaces;
};

/// Input of every solver.
struct Task {
  const LayerBase& base;
  const Envelope& start;
  const Column<VertexId, double>& h_u;
  double h_l;
  int evaluations;
  double slack;
  const RunContext& context;
};

struct Answer {
  Envelope envelope;
  int n_evaluations = 0;
  std::size_t n_taken_back = 0;
  std::string stopped;
  double solver_f = 0.0;        ///< f_1 + f_2 of the solver's own last point, before acceptance
  std::vector<double> history;  ///< f_1 + f_2 after each evaluation
};

std::vector<double> totals(const std::vector<ObjectiveValue>& history) {
  std::vector<double> f;
  for (const ObjectiveValue& value : history) f.push_back(value.f1 + value.f2);
  return f;
}

Answer run_nlopt(NloptMethod method, const Task& task) {
  NloptSettings settings;
  settings.method = method;
  settings.max_evaluations = task.evaluations;
  if (task.slack >= 0.0) settings.slack = task.slack;
  NloptReport report;
  Answer answer;
  answer.envelope = nlopt_optimise(task.base, task.start, task.h_u, task.h_l, settings, report, task.context);
  answer.n_evaluations = report.run.n_evaluations;
  answer.n_taken_back = report.run.n_taken_back;
  answer.stopped = report.run.stopped;
  answer.history = totals(report.run.history);
  answer.solver_f = report.best.f1 + report.best.f2;
  return answer;
}

Answer run_descent(const ObjectiveWeights& weights, const Task& task) {
  OptimiseSettings settings;
  settings.weights = weights;
  OptimiseReport report;
  Answer answer;
  answer.envelope = optimise(task.base, task.start, task.h_u, task.h_l, settings, report, task.context);
  answer.n_evaluations = report.n_evaluations;
  answer.n_taken_back = report.n_taken_back;
  answer.stopped = report.stopped;
  answer.history = totals(report.history);
  answer.solver_f = answer.history.back();
  return answer;
}

struct Solver {
  std::string name;
  std::function<Answer(const Task&)> run;
};

/// The list of solvers; add a line here for a new one. "descent" minimises f_1 + f_2 alone (height 1, top 0), as NLopt does; "descent_default" uses the
/// weights of the pipeline.
std::vector<Solver> solvers() {
  return {
      {"mma", [](const Task& task) { return run_nlopt(NloptMethod::mma, task); }},
      {"ccsaq", [](const Task& task) { return run_nlopt(NloptMethod::ccsaq, task); }},
      {"descent", [](const Task& task) { return run_descent({.height = 1.0, .top = 0.0}, task); }},
      {"descent_default", [](const Task& task) { return run_descent(OptimiseSettings{}.weights, task); }},
  };
}

/// Shares of the macro-elements by skew angle (13) in per cent; those with a collapsed corner count as skewed by more than 60 degrees.
struct SkewShares {
  double below_6 = 0.0, below_18 = 0.0, above_60 = 0.0;
};

SkewShares skew_shares(const LayerBase& base, const Envelope& envelope) {
  constexpr double k_degree = 0.017453292519943295;
  SkewShares shares;
  for (const TriangleId t : base.wall.triangles.ids()) {
    const MacroElement e = macro_element(base, envelope, t);
    if (e.height[0] == 0.0 || e.height[1] == 0.0 || e.height[2] == 0.0) {
      shares.above_60 += 1.0;
      continue;
    }
    std::array<Vec3, 6> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = e.wall[k];
      p[k + 3] = e.wall[k] + e.height[k] * e.direction[k];
    }
    const double skew = skew_angle(p) / k_degree;
    shares.below_6 += skew < 6.0;
    shares.below_18 += skew < 18.0;
    shares.above_60 += skew > 60.0;
  }
  const double per_cent = 100.0 / static_cast<double>(base.wall.n_triangles());
  return {per_cent * shares.below_6, per_cent * shares.below_18, per_cent * shares.above_60};
}

/// Area-weighted mean height over that of the target, in per cent.
double height_share(const LayerBase& base, const Envelope& envelope) {
  double height = 0.0, target = 0.0;
  for (const VertexId v : envelope.height.ids()) {
    height += base.vertex_area[v] * envelope.height[v];
    target += base.vertex_area[v] * envelope.target[v];
  }
  return 100.0 * height / target;
}

void print_row(const std::string& name, const Task& task, const Answer& answer, double f_start, double seconds) {
  const PaperProblem problem(task.base, task.start, task.h_u, task.h_l, NloptSettings{}.g1_min, task.context);
  const PaperObjective f = problem.objective(problem.unknowns(answer.envelope), {}, task.context);
  const SkewShares skew = skew_shares(task.base, answer.envelope);
  const double total = f.total();
  std::printf("| %s | %.6f | %.6f | %.6f | %.6f | %.6f | %.2g | %.1f | %.1f | %.2f | %.2f | %d | %.2f | %zu | %s |\n", name.c_str(), f.f1, f.f2, total,
              f_start - total, f_start - answer.solver_f, smallest_scaled_jacobian(task.base, answer.envelope, task.context), skew.below_6, skew.below_18,
              skew.above_60, height_share(task.base, answer.envelope), answer.n_evaluations, seconds, answer.n_taken_back, answer.stopped.c_str());
  std::fflush(stdout);
}

void compare(const std::string& file, const Settings& settings) {
  const RunContext context({.threads = settings.threads});
  const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(file, context)}, {}, context).mesh;
  const LayerBase base(wall, context);
  EnvelopeOptions options;
  options.layers = settings.layers;
  options.first_height = 1e-6 * base.body_length;
  const Clock::time_point begin = Clock::now();
  const Envelope start = build_envelope(base, options, context);
  const double build_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  const Column<VertexId, double> h_u = upper_heights(base, start);
  const Task task{base, start, h_u, scale_of(base, options).least_height(), settings.evaluations, settings.slack, context};
  const PaperProblem problem(base, start, h_u, task.h_l, NloptSettings{}.g1_min, context);
  const std::vector<double> z = problem.unknowns(start);
  std::vector<double> gradient(z.size());
  const PaperObjective f = problem.objective(z, {}, context);

  // One evaluation in the form that NLopt calls: objective and constraint with gradients.
  constexpr int k_repeats = 5;
  const Clock::time_point before = Clock::now();
  const std::clock_t processor_before = std::clock();
  for (int i = 0; i < k_repeats; ++i) {
    problem.objective(z, gradient, context);
    problem.constraint(z, gradient, context);
  }
  const double evaluation = std::chrono::duration<double>(Clock::now() - before).count() / k_repeats;
  const double processor = static_cast<double>(std::clock() - processor_before) / CLOCKS_PER_SEC / k_repeats;
  std::printf(
      "\n%s: %zu triangles, %zu vertices, %zu unknowns; envelope before in %.2f s; one evaluation with gradients %.1f ms on %d threads, %.1f ms of processor "
      "time\n\n",
      file.c_str(), wall.n_triangles(), wall.n_vertices(), problem.n_unknowns(), build_seconds, 1e3 * evaluation, settings.threads, 1e3 * processor);
  std::printf(
      "| solver | f1 | f2 | f | gain | before acceptance | min sJ | < 6 deg %% | < 18 deg %% | > 60 deg %% | height %% | evaluations | s | taken back | "
      "stopped |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  print_row("start", task, {.envelope = start, .stopped = "", .solver_f = f.total()}, f.total(), 0.0);
  for (const Solver& solver : solvers()) {
    if (!settings.solvers.empty() && std::find(settings.solvers.begin(), settings.solvers.end(), solver.name) == settings.solvers.end()) continue;
    const Clock::time_point from = Clock::now();
    const Answer answer = solver.run(task);
    print_row(solver.name, task, answer, f.total(), std::chrono::duration<double>(Clock::now() - from).count());
    if (!settings.has_history) continue;
    std::printf("history of %s:", solver.name.c_str());
    for (const double value : answer.history) std::printf(" %.6g", value);
    std::printf("\n");
  }
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals), value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (name == "--evaluations") settings.evaluations = std::stoi(value);
    else if (name == "--slack") settings.slack = std::stod(value);
    else if (name == "--threads") settings.threads = std::stoi(value);
    else if (name == "--layers") settings.layers = std::stoi(value);
    else if (name == "--history") settings.has_history = true;
    else if (name == "--solvers") {
      std::stringstream list(value);
      for (std::string item; std::getline(list, item, ',');) settings.solvers.push_back(item);
    } else if (argument.starts_with("--")) throw std::invalid_argument("unknown option " + argument);
    else settings.surfaces.push_back(argument);
  }
  for (const std::string& expected : settings.solvers) {
    const std::vector<Solver> known = solvers();
    if (std::none_of(known.begin(), known.end(), [&](const Solver& s) { return s.name == expected; }))
      throw std::invalid_argument("there is no solver " + expected);
  }
  if (settings.surfaces.empty())
    throw std::invalid_argument("usage: compare_optimisers [--evaluations=N] [--solvers=mma,ccsaq,...] [--threads=N] [--history] surface...");
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Settings settings = parse(argc, argv);
    for (const std::string& surface : settings.surfaces) compare(surface, settings);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_optimisers: %s\n", error.what());
    return 1;
  }
}
