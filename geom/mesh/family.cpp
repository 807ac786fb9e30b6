// The rule for a family refined by the factor f: first height h0/f, n f layers, f times as many constant layers, growth r^(1/f), growth of tetrahedra 1 + (g -
// 1)/f, the same farfield and patches (docs/method/quality.md, "Mesh families").
#include "geom/mesh/family.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna {
namespace {

/// Relative difference below which two steps of a line count as equal: far below any requested growth, far above rounding.
constexpr double k_equal_steps = 1e-3;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the distinct edges of wall faces, lower node first.
std::vector<std::array<std::uint32_t, 2>> wall_edges(const HybridMesh& mesh, std::int64_t& n_faces, const RunContext& context) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  const auto add = [&](const auto& nodes) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const std::uint32_t a = nodes[k].value(), b = nodes[(k + 1) % nodes.size()].value();
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
    ++n_faces;
  };
  for (const BoundaryTriangle& face : mesh.boundary_triangles)
    if (mesh.patches[face.patch].kind == PatchKind::wall) add(face.nodes);
  for (const BoundaryQuad& face : mesh.boundary_quads)
    if (mesh.patches[face.patch].kind == PatchKind::wall) add(face.nodes);
  // Equal edges are identical, so their order does not matter.
  parallel_sort(context, edges, [](const auto& a, const auto& b) { return a < b; });
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

void measure_layers(const HybridMesh& mesh, FamilyMember& member) {
  const LayerBlock& layers = mesh.layers;
  if (layers.n_lines() == 0) return;
  member.layers = layers.n_layers;
  std::vector<double> first, growth, constant;
  for (std::uint32_t k = 0; k < layers.n_lines(); ++k) {
    const int n = layers.n_steps(k);
    if (n == 0) continue;
    const auto step = [&](int j) { return distance(mesh.points[layers.node(k, j)], mesh.points[layers.node(k, j + 1)]); };
    first.push_back(step(0));
    int n_constant = 1;
    while (n_constant < n && std::abs(step(n_constant) / step(0) - 1.0) <= k_equal_steps) ++n_constant;
    constant.push_back(n_constant);
    if (n > 1) growth.push_back(std::pow(step(n - 1) / step(0), 1.0 / (n - 1)));
  }
  if (first.empty()) return;
  member.measured_first = median(first);
  member.constant_layers = static_cast<int>(std::lround(median(constant)));
  if (!growth.empty()) member.measured_growth = median(growth);
}

GateState worse(GateState a, GateState b) {
  const auto rank = [](GateState s) { return s == GateState::not_checked ? 0 : s == GateState::pass ? 1 : s == GateState::warn ? 2 : 3; };
  return rank(a) >= rank(b) ? a : b;
}

class StepRules {
 public:
  StepRules(const FamilyMember& coarse, const FamilyMember& fine, const FamilyTolerances& tolerances, FamilyStep& step)
      : coarse_(coarse), fine_(fine), tolerances_(tolerances), step_(step) {}

  /// Adds a rule that compares `value` with `expected`; `deviation` is their difference.
  void add(std::string name, std::string title, double coarse, double fine, double value, double expected, double deviation, double tolerance) {
    const GateState state = deviation <= tolerance ? GateState::pass : deviation <= tolerances_.fail * tolerance ? GateState::warn : GateState::fail;
    step_.rules.push_back({std::move(name), std::move(title), state, {}, coarse, fine, value, expected, deviation, tolerance});
  }
  void skip(std::string name, std::string title, std::string reason) {
    step_.rules.push_back({.name = std::move(name), .title = std::move(title), .reason = std::move(reason)});
  }

  /// Compares a quantity that may be unknown: calls f(coarse, fine) if both members know it, else marks the rule as not checked.
  template <class T, class F>
  void compare(std::optional<T> FamilyMember::*of, const char* name, const char* title, const char* why, const F& f) {
    if (coarse_.*of && fine_.*of) return f(*(coarse_.*of), *(fine_.*of));
    const FamilyMember& without = coarse_.*of ? fine_ : coarse_;
    skip(name, title, without.name + " " + why);
  }
  void ratio(const char* name, const char* title, double coarse, double fine, double tolerance) {
    const double value = coarse / fine;
    add(name, title, coarse, fine, value, step_.factor, std::abs(value / step_.factor - 1.0), tolerance);
  }
  void growth(const char* name, const char* title, double coarse, double fine, double tolerance) {
    const double expected = std::pow(coarse, 1.0 / step_.factor), log_expected = std::log(expected);
    // Without growth (ratio 1) the logarithms are zero.
    add(name, title, coarse, fine, fine, expected, log_expected > 0.0 ? std::abs(std::log(fine) / log_expected - 1.0) : std::abs(std::log(fine)), tolerance);
  }

 private:
  const FamilyMember& coarse_;
  const FamilyMember& fine_;
  const FamilyTolerances& tolerances_;
  FamilyStep& step_;
};

void find_factor(const FamilyMember& coarse, const FamilyMember& fine, const FamilyTolerances& tolerances, FamilyStep& step) {
  step.factor_by_nodes = std::cbrt(static_cast<double>(fine.nodes) / static_cast<double>(coarse.nodes));
  if (coarse.wall_edge > 0.0 && fine.wall_edge > 0.0) step.factor_by_edges = coarse.wall_edge / fine.wall_edge;
  const auto choose = [&](double factor, const char* from) {
    step.factor = factor;
    step.factor_from = from;
  };
  if (!is_automatic(tolerances.factor)) choose(tolerances.factor, "the option factor");
  else if (coarse.refinement && fine.refinement && *fine.refinement > *coarse.refinement)
    choose(*fine.refinement / *coarse.refinement, "the requested refinements");
  else if (step.factor_by_edges > 0.0) choose(step.factor_by_edges, "the mean wall edges");
  else choose(step.factor_by_nodes, "the nodes");
  if (step.factor > 1.0 && fine.nodes > coarse.nodes) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "checking a family of meshes",
               .problem = fine.name + " is not finer than " + coarse.name + ": " + std::to_string(fine.nodes) + " nodes after " + std::to_string(coarse.nodes),
               .hint = "give the members from coarse to fine"});
}

void compare_patches(const FamilyMember& coarse, const FamilyMember& fine, FamilyStep& step) {
  FamilyRule rule{.name = "patches", .title = "the same patches", .state = GateState::pass, .reason = {}};
  rule.coarse = static_cast<double>(coarse.patches.size());
  rule.fine = rule.value = static_cast<double>(fine.patches.size());
  rule.expected = rule.coarse;
  const auto list_missing = [&](const FamilyMember& of, const FamilyMember& in) {
    for (const auto& patch : of.patches)
      if (!std::binary_search(in.patches.begin(), in.patches.end(), patch))
        rule.reason += (rule.reason.empty() ? "" : "; ") + std::string("only ") + of.name + " has \"" + patch.first + "\", " + patch.second;
  };
  list_missing(coarse, fine);
  list_missing(fine, coarse);
  if (!rule.reason.empty()) rule.state = GateState::fail;
  step.rules.push_back(std::move(rule));
}

double box_difference(const Box& a, const Box& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k) most = std::max({most, std::abs(a.min[k] - b.min[k]), std::abs(a.max[k] - b.max[k])});
  return most;
}

FamilyStep check_step(const FamilyMember& coarse, const FamilyMember& fine, const FamilyTolerances& tolerances) {
  constexpr const char* k_no_columns = "has no layer columns: the mesh was read from a file other than .sterna";
  constexpr const char* k_no_request = "does not store the requested layer: the mesh was read from a file other than .sterna";
  constexpr const char* k_no_manifest = "has no manifest <file>.json, which holds this value";
  FamilyStep step{.coarse = coarse.name, .fine = fine.name, .factor_from = {}, .rules = {}};
  find_factor(coarse, fine, tolerances, step);
  const double f = step.factor;
  StepRules rules(coarse, fine, tolerances, step);
  rules.add("nodes", "factor by nodes, cube root of their ratio", static_cast<double>(coarse.nodes), static_cast<double>(fine.nodes), step.factor_by_nodes, f,
            std::abs(step.factor_by_nodes / f - 1.0), tolerances.nodes);
  if (step.factor_by_edges > 0.0) rules.ratio("wall_edge", "factor by mean wall edges, m", coarse.wall_edge, fine.wall_edge, tolerances.wall_edge);
  else rules.skip("wall_edge", "factor by mean wall edges", (coarse.wall_edge > 0.0 ? fine.name : coarse.name) + " has no patch of kind wall");
  rules.compare(&FamilyMember::first_height, "first_height", "requested first height, m", k_no_request,
                [&](double a, double b) { rules.ratio("first_height", "requested first height, m", a, b, tolerances.first_height); });
  rules.compare(&FamilyMember::measured_first, "measured_first", "median first height, m", k_no_columns,
                [&](double a, double b) { rules.ratio("measured_first", "median first height, m", a, b, tolerances.measured_first); });
  rules.compare(&FamilyMember::layers, "layers", "number of layers", k_no_columns,
                [&](int a, int b) { rules.add("layers", "number of layers", a, b, b, f * a, std::abs(b - f * a), tolerances.layers * 0.5 * (1.0 + f)); });
  rules.compare(&FamilyMember::constant_layers, "constant_layers", "layers of constant height", k_no_columns, [&](int a, int b) {
    if (a == 1 && b == 1) rules.skip("constant_layers", "layers of constant height", "in both meshes the heights grow from the first layer on");
    else rules.add("constant_layers", "layers of constant height", a, b, b, f * a, std::abs(b - f * a), tolerances.layers * 0.5 * (1.0 + f));
  });
  rules.compare(&FamilyMember::growth, "growth", "requested growth", k_no_request,
                [&](double a, double b) { rules.growth("growth", "requested growth", a, b, tolerances.growth); });
  rules.compare(&FamilyMember::measured_growth, "measured_growth", "median growth", k_no_columns,
                [&](double a, double b) { rules.growth("measured_growth", "median growth", a, b, tolerances.measured_growth); });
  rules.compare(&FamilyMember::tet_growth, "tet_growth", "growth of tetrahedra", k_no_manifest, [&](double a, double b) {
    const double expected = 1.0 + (a - 1.0) / f;
    rules.add("tet_growth", "growth of tetrahedra", a, b, b, expected, expected > 1.0 ? std::abs((b - 1.0) / (expected - 1.0) - 1.0) : std::abs(b - expected),
              tolerances.tet_growth);
  });
  const double side = coarse.box.longest_side();
  rules.add("box", "box of the farfield, longest side, m", side, fine.box.longest_side(), fine.box.longest_side(), side,
            box_difference(coarse.box, fine.box) / side, tolerances.box);
  compare_patches(coarse, fine, step);
  return step;
}

}  // namespace

FamilyMember family_member(const HybridMesh& mesh, std::string name, const RunContext& context) {
  FamilyMember member{.name = std::move(name)};
  member.nodes = static_cast<std::int64_t>(mesh.points.size());
  for (const Point& p : mesh.points) member.box.add(p);
  CompensatedSum length;
  const std::vector<std::array<std::uint32_t, 2>> edges = wall_edges(mesh, member.wall_faces, context);
  for (const auto& [a, b] : edges) length.add(distance(mesh.points.raw()[a], mesh.points.raw()[b]));
  if (!edges.empty()) member.wall_edge = length.value() / static_cast<double>(edges.size());
  std::set<std::pair<std::string, std::string>> patches;
  for (const Patch& patch : mesh.patches) patches.emplace(patch.name, to_string(patch.kind));
  member.patches.assign(patches.begin(), patches.end());
  measure_layers(mesh, member);
  if (mesh.request.is_known()) {
    member.first_height = mesh.request.first_height;
    member.growth = mesh.request.max_growth;
  }
  return member;
}

GateState FamilyReport::state() const {
  GateState state = GateState::not_checked;
  for (const FamilyStep& step : steps)
    for (const FamilyRule& rule : step.rules) state = worse(state, rule.state);
  return state;
}

FamilyReport check_family(std::vector<FamilyMember> members, const FamilyTolerances& tolerances) {
  if (members.size() < 2)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "checking a family of meshes",
                 .problem = "the family has " + std::to_string(members.size()) + " member" + (members.size() == 1 ? "" : "s") + ", at least two are needed",
                 .hint = "give the meshes from coarse to fine"});
  FamilyReport report{.members = std::move(members), .steps = {}};
  for (std::size_t i = 0; i + 1 < report.members.size(); ++i) report.steps.push_back(check_step(report.members[i], report.members[i + 1], tolerances));
  return report;
}

}  // namespace sterna
