#include "scripting/verbs/solver_case.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "scripting/values/mesh_manifest.h"

namespace sterna::scripting {
namespace {

constexpr double k_straight = 1e-9;  ///< rad: smaller angles of the flow are treated as zero

/// Returns the kind of the patches to which this value of a condition applies.
PatchKind kind_with(std::string_view value) {
  return value == "pressure" ? PatchKind::outflow : value.starts_with("total_") ? PatchKind::inflow : PatchKind::interface;
}

Column<PatchId, PatchFacts> facts_of(const HybridMesh& mesh) {
  Column<PatchId, PatchFacts> facts(mesh.patches.size());
  const auto add = [&](PatchId patch, const Vec3& area) {
    ++facts[patch].n_faces;
    facts[patch].area = facts[patch].area + area;
    facts[patch].size += norm(area);
  };
  for (const BoundaryTriangle& f : mesh.boundary_triangles) {
    const Point &a = mesh.points[f.nodes[0]], &b = mesh.points[f.nodes[1]], &c = mesh.points[f.nodes[2]];
    add(f.patch, 0.5 * cross(b - a, c - a));
  }
  for (const BoundaryQuad& f : mesh.boundary_quads) {
    const Point &a = mesh.points[f.nodes[0]], &b = mesh.points[f.nodes[1]], &c = mesh.points[f.nodes[2]], &d = mesh.points[f.nodes[3]];
    add(f.patch, 0.5 * cross(c - a, d - b));
  }
  return facts;
}

/// Returns the patches with a node on an inflow or outflow.
std::set<PatchId> beside_openings(const HybridMesh& mesh) {
  const auto is_opening = [&](PatchId p) { return mesh.patches[p].kind == PatchKind::inflow || mesh.patches[p].kind == PatchKind::outflow; };
  std::vector<std::uint8_t> is_on(mesh.points.size(), 0);
  const auto for_each_face = [&](const auto& f) {
    for (const BoundaryTriangle& face : mesh.boundary_triangles) f(face.patch, std::span<const NodeId>(face.nodes));
    for (const BoundaryQuad& face : mesh.boundary_quads) f(face.patch, std::span<const NodeId>(face.nodes));
  };
  for_each_face([&](PatchId patch, std::span<const NodeId> nodes) {
    if (is_opening(patch))
      for (const NodeId node : nodes) is_on[node.index()] = 1;
  });
  std::set<PatchId> result;
  for_each_face([&](PatchId patch, std::span<const NodeId> nodes) {
    if (!is_opening(patch) && std::ranges::any_of(nodes, [&](NodeId node) { return is_on[node.index()] != 0; })) result.insert(patch);
  });
  return result;
}

std::vector<std::string> names_of_patches(const HybridMesh& mesh) {
  std::vector<std::string> names;
  for (const Patch& patch : mesh.patches) names.push_back(patch.name);
  return names;
}

void find_half(const CaseOptions& options, int n_symmetry, CasePatches& case_patches, CaseProblems& problems) {
  case_patches.is_half = options.half == "yes" || (options.half == "automatic" && n_symmetry > 0);
  if (options.half == "automatic" && n_symmetry > 1 && !case_patches.is_internal)
    problems.add(
        fmt::format("the mesh has {} symmetry planes: is it a half model? give half = \"yes\" or \"no\", and the reference area accordingly", n_symmetry));
  if (case_patches.is_half && std::abs(options.beta) > k_straight) problems.add("a half model has no sideslip (beta)");
  if (case_patches.is_tunnel && (std::abs(options.alpha) > k_straight || std::abs(options.beta) > k_straight))
    problems.add("alpha and beta are not allowed in a tunnel: leave them out and rotate the model instead");
}

void find_monitored(const HybridMesh& mesh, const CaseOptions& options, CasePatches& case_patches, CaseProblems& problems) {
  const std::set<PatchId> of_tunnel = case_patches.is_tunnel ? beside_openings(mesh) : std::set<PatchId>{};
  std::vector<std::string> patterns;
  std::istringstream words(options.monitor);
  for (std::string word; words >> word;) patterns.push_back(word);
  std::set<std::string> used;
  for (const PatchId p : mesh.patches.ids()) {
    if (case_patches.facts[p].n_faces == 0 || is_periodic(mesh, p)) continue;
    if (patterns.empty() && mesh.patches[p].kind == PatchKind::wall) (of_tunnel.contains(p) ? case_patches.unmonitored : case_patches.monitored).push_back(p);
    bool is_named = false;
    for (const std::string& pattern : patterns) {
      if (!matches_glob(mesh.patches[p].name, pattern)) continue;
      is_named = true;
      used.insert(pattern);
    }
    if (is_named) case_patches.monitored.push_back(p);
  }
  for (const std::string& pattern : patterns)
    if (!used.contains(pattern)) problems.add("monitor: no patch has a name like \"" + pattern + "\" (" + names_hint(names_of_patches(mesh), pattern) + ")");
  case_patches.is_internal = case_patches.is_tunnel && case_patches.monitored.empty() && patterns.empty();
  if (case_patches.monitored.empty() && patterns.empty() && !case_patches.is_tunnel) problems.add("no wall is left for the forces: name walls with monitor");
}

/// Reports the verdict for the kind of solver that uses the measure, as a warning if a gate FAILs.
void report_verdict(const CheckReport& report, Measure measure, std::string_view solver, const RunContext& context) {
  for (const Consumer consumer : k_consumers) {
    if (!info_of(measure).consumers.has(consumer)) continue;
    const std::string text = fmt::format("the mesh for {}, {}: {}", solver, to_string(consumer), verdict_of(report, consumer));
    if (report.quality_state(consumer) == GateState::fail) context.warn(text + "; `sterna check` lists the locations");
    else context.info(text);
  }
}

}  // namespace

CaseMeasure measured_worst(const HybridMesh& mesh, Measure measure, const CheckReport* known, std::string_view solver, const RunContext& context) {
  std::optional<CheckReport> own;
  if (!known || !known->quality_measured || known->gate(measure).state == GateState::not_checked) {
    CheckOptions options;
    options.intersections = false;
    own = check(mesh, options, context);
    known = &*own;
  }
  if (own && !own->dual_checked) {
    ErrorInfo info{.code = ErrorCode::bad_argument,
                   .attempted = "making a case of " + std::string(solver),
                   .problem = "the mesh is not conforming, so no solver can read it",
                   .hint = "`sterna check` lists the locations"};
    if (!known->findings.empty()) info.add_location(known->findings.front().position, known->findings.front().what);
    throw Error(std::move(info));
  }
  report_verdict(*known, measure, solver, context);
  const GateResult& gate = known->gate(measure);
  CaseMeasure result{.worst = gate.worst, .location = {}};  // a mesh of one cell has no faces between cells, so the measure is 0
  for (const auto* locations : {&gate.locations, &gate.forced})
    if (!locations->empty() && locations->front().value == gate.worst) result.location = locations->front().position;
  return result;
}

std::string at_location(const CaseMeasure& measure) {
  return measure.location ? fmt::format(" at ({:.6g}, {:.6g}, {:.6g})", measure.location->x, measure.location->y, measure.location->z) : "";
}

void CaseProblems::require_none(const std::string& attempted) const {
  std::string text;
  for (const std::string& problem : all_) text += (text.empty() ? "" : "; ") + problem;
  if (!text.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = text});
}

std::optional<HybridMesh> with_kinds(const HybridMesh& mesh, std::vector<CaseKind> kinds, const std::string& attempted) {
  if (kinds.empty()) return std::nullopt;
  sort_by_pattern(kinds);
  HybridMesh changed = mesh;
  CaseProblems problems;
  for (const CaseKind& rule : kinds) {
    const std::string key = "kinds[\"" + rule.names + "\"]: ";
    if (rule.kind == PatchKind::interface) problems.add(key + "a patch of kind interface has cells on both sides; only volume_mesh makes such patches");
    bool is_used = false;
    for (const PatchId p : mesh.patches.ids()) {
      if (!matches_glob(mesh.patches[p].name, rule.names)) continue;
      is_used = true;
      if (is_periodic(mesh, p) || mesh.patches[p].kind == PatchKind::interface)
        problems.add(key + "patch \"" + mesh.patches[p].name + "\" is " + (is_periodic(mesh, p) ? "a periodic side" : "a side of an actuator disc") +
                     "; its kind cannot be changed");
      changed.patches[p].kind = rule.kind;
    }
    if (!is_used) problems.add(key + "no patch has a matching name (" + names_hint(names_of_patches(mesh), rule.names) + ")");
  }
  problems.require_none(attempted);
  return changed;
}

void require_known_kinds(const std::set<std::string>& unknown, const std::vector<CaseKind>& kinds, const std::string& attempted) {
  std::set<std::string> left = unknown;
  std::erase_if(left,
                [&](const std::string& name) { return std::ranges::any_of(kinds, [&](const CaseKind& rule) { return matches_glob(name, rule.names); }); });
  if (left.empty()) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = attempted,
               .problem = "the kind of " + quoted_list(left) + " is unknown: neither the mesh file nor a manifest beside it has the boundary conditions",
               .hint =
                   "give it with --kind \"inlet=inflow\" --kind \"*=wall\" (in scripts kinds = { inlet = \"inflow\", [\"*\"] = \"wall\" }), read the .sterna "
                   "file instead, or put the mesh's manifest (.json) beside it"});
}

CasePatches find_case_patches(const HybridMesh& mesh, const CaseOptions& options, CaseProblems& problems) {
  CasePatches case_patches;
  case_patches.facts = facts_of(mesh);
  case_patches.has_layers = mesh.layers.n_columns() > 0 || !mesh.prisms.empty();
  bool has_farfield = false, has_opening = false;
  int n_symmetry = 0;
  for (const PatchId p : mesh.patches.ids()) {
    if (case_patches.facts[p].n_faces == 0) continue;
    const PatchKind kind = mesh.patches[p].kind;
    has_farfield = has_farfield || kind == PatchKind::farfield;
    has_opening = has_opening || kind == PatchKind::inflow || kind == PatchKind::outflow;
    n_symmetry += kind == PatchKind::symmetry && !is_periodic(mesh, p) ? 1 : 0;
    if (kind == PatchKind::inflow) case_patches.inflows.push_back(p);
    if (kind == PatchKind::outflow) case_patches.outflows.push_back(p);
  }
  case_patches.is_tunnel = has_opening && !has_farfield;
  find_monitored(mesh, options, case_patches, problems);
  find_half(options, n_symmetry, case_patches, problems);
  return case_patches;
}

bool is_periodic(const HybridMesh& mesh, PatchId patch) {
  return std::ranges::any_of(mesh.periodic, [&](const PeriodicSides& sides) { return sides.first == patch || sides.second == patch; });
}

std::optional<PatchId> back_of_disc(const HybridMesh& mesh, const CasePatches& case_patches, PatchId patch) {
  for (const PatchId back : mesh.patches.ids())
    if (case_patches.facts[back].n_faces > 0 && mesh.patches[back].name == mesh.patches[patch].name + ".back") return back;
  return std::nullopt;
}

std::optional<PatchId> front_of_disc(const HybridMesh& mesh, const CasePatches& case_patches, PatchId patch) {
  for (const PatchId front : mesh.patches.ids())
    if (mesh.patches[front].kind == PatchKind::interface && case_patches.facts[front].n_faces > 0 &&
        mesh.patches[patch].name == mesh.patches[front].name + ".back")
      return front;
  return std::nullopt;
}

CaseBoundary UsedBoundaries::of(const Patch& patch) {
  const auto found = boundaries_.find(patch.name);
  if (found == boundaries_.end()) return {};
  used_[found->first] = patch.kind;
  return found->second;
}

std::optional<double> UsedBoundaries::pressure_jump(const Patch& disc, double area, CaseProblems& problems) {
  const CaseBoundary given = of(disc);
  if (!is_automatic(given.pressure_jump)) return given.pressure_jump;
  if (!is_automatic(given.thrust)) return given.thrust / area;
  problems.add("the pressure jump of the actuator disc \"" + disc.name + "\" is unknown: give boundaries = { [\"" + disc.name +
               "\"] = { thrust = ... } } (N), or pressure_jump (Pa)");
  return std::nullopt;
}

void UsedBoundaries::require_used(CaseProblems& problems) const {
  for (const auto& [name, boundary] : boundaries_) {
    const auto used = used_.find(name);
    if (used == used_.end()) {
      problems.add("boundaries: no inflow, outflow or actuator disc of the mesh is called \"" + name + "\"");
      continue;
    }
    CaseBoundary given = boundary;
    for (const Option& option : sterna::options_of(given)) {
      const bool is_given = !is_automatic(std::get<double>(option.get())) && option.get() != option.default_value;
      if (is_given && kind_with(option.name) != used->second)
        problems.add(fmt::format("boundaries: {} of \"{}\" has no effect: it applies to patches of kind {}, and this patch is of kind {}", option.name, name,
                                 to_string(kind_with(option.name)), to_string(used->second)));
    }
  }
}

double reference_area(const CaseReference& reference, const CasePatches& case_patches) { return case_patches.is_half ? 0.5 * reference.area : reference.area; }

double reference_length(const CaseReference& reference, const volmesh::FlowState& flow) {
  return is_automatic(reference.length) ? flow.length : reference.length;
}

Point moment_origin(const CaseReference& reference, const volmesh::FlowState& flow) {
  const Point& o = reference.moment_origin;
  const double length = reference_length(reference, flow);
  return {clean_component(o.x, length), clean_component(o.y, length), clean_component(o.z, length)};
}

double clean_component(double x, double length) {
  constexpr double k_rounding = 1e-14;
  return std::abs(x) <= k_rounding * length ? 0.0 : x;
}

Vec3 inward_normal(const PatchFacts& facts) {
  const Vec3 inward = -1.0 * normalized(facts.area);
  return {clean_component(inward.x, 1.0), clean_component(inward.y, 1.0), clean_component(inward.z, 1.0)};
}

std::string case_number(double x) { return fmt::format("{:.10g}", std::abs(x) < 1e-300 ? 0.0 : x); }

}  // namespace sterna::scripting
