// This is the driver. Edges that are too long for the geometry lead to faces that cannot be meshed, to edges with more than two triangles, or to crossing
// triangles. Sizes are halved around such locations and the affected faces are re-meshed, a few times.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <set>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "surfmesh/model/crossings.h"
#include "surfmesh/model/doubled_edges.h"
#include "surfmesh/model/estimate.h"
#include "surfmesh/model/join_faces.h"
#include "surfmesh/model/mesh_report.h"
#include "surfmesh/model/sized_model.h"
#include "surfmesh/model/smooth_angle.h"

namespace sterna::surfmesh {
namespace {

constexpr const char* k_attempted = "meshing the model's surface";
/// Largest number of meshing rounds. Each round halves the sizes at faults, so sizes are at 1/32 of their start in the last round.
constexpr int k_max_rounds = 6;
constexpr double k_repair_factor = 0.5;
/// A face that still fails in this round stays a hole if holes are allowed. Shorter edges around a hole seldom help, and they would stay in the mesh.
constexpr int k_rounds_before_holes = 2;
/// If the mesh turns by more than this angle, volume_mesh does not derive its feature angle from the mesh.
constexpr double k_largest_smooth_turn = std::numbers::pi / 3.0;
constexpr int k_digits = 4;  ///< digits of numbers in messages

struct Meshing : SizedModel {
  WingBands bands;
  PeriodicBorders periodic_borders;
  std::vector<AbsorbedPart> absorbed;
  std::vector<SizePoint> repairs;
  Column<EdgeId, EdgeCut> cuts;
  Column<FaceId, MeshedFace> faces;
  std::set<FaceId> to_mesh;
};

// Progress fractions at the ends of the stages, measured on the widebody with 1.5 M triangles.
constexpr double k_prepared = 0.15, k_first_round = 0.75, k_first_judged = 0.9;

/// Reports the progress as a fraction of the expected triangles of the faces.
class FaceProgress {
 public:
  FaceProgress(const Meshing& meshing, std::span<const FaceId> work, const RunContext& context) : context_(context) {
    for (const FaceId f : work) all_ += weight_.emplace_back(1.0 + estimated_triangles(meshing.sizes, f));
  }
  /// Thread-safe.
  void done(std::size_t i) {
    const std::scoped_lock lock(mutex_);
    done_ += weight_[i];
    context_.progress(done_ / all_);
  }

 private:
  const RunContext& context_;
  std::vector<double> weight_;
  double all_ = 0.0, done_ = 0.0;
  std::mutex mutex_;
};

/// Cuts edges again. Meshes the faces whose edges changed and the faces that are marked for re-meshing.
SurfaceMesh mesh_round(Meshing& meshing, const SurfaceSizes& field, const RunContext& context) {
  const Model& model = meshing.model;
  Column<EdgeId, EdgeCut> cuts = cut_edges(model, meshing.edges, meshing.topology, meshing.bands, meshing.periodic_borders, field, context);
  std::vector<FaceId> work;
  for (const FaceId f : model.faces.ids()) {
    bool is_concerned = meshing.cuts.empty() || meshing.to_mesh.contains(f);
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border) is_concerned = is_concerned || !(meshing.cuts[use.edge] == cuts[use.edge]);
    if (is_concerned) work.push_back(f);
  }
  meshing.cuts = std::move(cuts);
  const BorderVertices numbers = number_border(model, meshing.topology, meshing.cuts);
  if (meshing.faces.empty()) meshing.faces.resize(model.faces.size());
  FaceProgress progress(meshing, work, context);
  parallel_for(
      context, work.size(),
      [&](std::size_t i) {
        meshing.faces[work[i]] = mesh_one_face(model, work[i], meshing.topology, meshing.cuts, numbers, meshing.sizes, meshing.bands, field,
                                               meshing.options.sizes.max_triangles, context);
        progress.done(i);
      },
      1);
  // The faces that are not re-meshed get new numbers for their border vertices.
  for (const FaceId f : model.faces.ids())
    if (!std::binary_search(work.begin(), work.end(), f))
      meshing.faces[f].border_ids = border_ids(model, f, meshing.topology, meshing.cuts, numbers, meshing.sizes.outlines[f]);
  meshing.to_mesh.clear();
  return join_faces(model, meshing.topology, meshing.cuts, numbers, meshing.faces);
}

/// Returns the sizes of a round. They are equal on periodic borders: a requirement on one border also applies to its images.
SurfaceSizes sizes_of_round(const Meshing& meshing, const RunContext& context) {
  SurfaceSizes field(meshing.model, meshing.edges, meshing.topology, meshing.sizes, meshing.repairs, context);
  if (meshing.periodic_borders.empty()) return field;
  std::vector<SizePoint> in_space = sizes_of_partners(meshing.periodic_borders, meshing.model, meshing.edges, field);
  if (in_space.empty()) return field;
  in_space.insert(in_space.end(), meshing.repairs.begin(), meshing.repairs.end());
  return SurfaceSizes(meshing.model, meshing.edges, meshing.topology, meshing.sizes, std::move(in_space), context);
}

void refine_at(Meshing& meshing, FaceId f, const Point& location, double size, double factor = k_repair_factor) {
  meshing.repairs.push_back({location, factor * size});
  meshing.to_mesh.insert(f);
}

[[noreturn]] void throw_failures(const Meshing& meshing) {
  ErrorInfo info{.code = ErrorCode::geometry_failed, .attempted = k_attempted};
  for (const FaceId f : meshing.model.faces.ids()) {
    const MeshedFace& face = meshing.faces[f];
    if (!face.failure) continue;
    if (face.failure->code == ErrorCode::overflow || face.failure->code == ErrorCode::bad_argument) info.code = face.failure->code;
    ++info.n_locations;
    if (info.locations.size() >= k_max_locations) continue;
    Point location;
    if (!face.failure->locations.empty()) location = face.failure->locations.front().position;
    else if (const EdgeSamples& samples = meshing.edges[meshing.model.faces[f].borders.front().front().edge]; !samples.samples.empty())
      location = samples.samples.front().point;
    info.locations.push_back({location, face.failure->attempted + ": " + face.failure->problem});
    if (info.hint.empty()) info.hint = face.failure->hint;
  }
  info.problem = std::to_string(info.n_locations) + " of " + std::to_string(meshing.model.faces.size()) + " faces cannot be meshed";
  info.hint += std::string(info.hint.empty() ? "" : "; ") + "failed_faces = \"hole\" leaves these faces out; --auto also fills the holes";
  throw Error(std::move(info));
}

/// Halves the sizes where faces failed. \return true if any face failed
bool refine_failures(Meshing& meshing, const SurfaceSizes& field) {
  bool is_any = false;
  for (const FaceId f : meshing.model.faces.ids()) {
    const MeshedFace& face = meshing.faces[f];
    if (!face.failure) continue;
    is_any = true;
    if (face.failure->code == ErrorCode::overflow) throw_failures(meshing);  // finer edges would increase the number of triangles further
    const double cap = meshing.sizes.faces[f].max_edge;
    const auto size_at = [&](const Point& p) { return std::min(cap, field.least_near(p)); };
    for (const ErrorLocation& location : face.failure->locations) refine_at(meshing, f, location.position, size_at(location.position));
    if (!face.failure->locations.empty()) continue;
    for (const Border& border : meshing.model.faces[f].borders)
      for (const EdgeUse& use : border)
        for (const EdgeSample& s : meshing.edges[use.edge].samples) refine_at(meshing, f, s.point, size_at(s.point));
  }
  return is_any;
}

void refine_triangle(Meshing& meshing, const SurfaceMesh& mesh, TriangleId t, double factor) {
  const auto p = corners(mesh.mesh, t);
  const double size = std::min({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
  const double longest = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
  refine_at(meshing, mesh.triangle_face[t], (p[0] + p[1] + p[2]) / 3.0, std::max(size, 0.5 * longest), factor);
}

[[noreturn]] void throw_faults(const Meshing& meshing, const SurfaceMesh& mesh, const JoinFaults& faults) {
  ErrorInfo info{.code = ErrorCode::non_manifold_surface,
                 .attempted = k_attempted,
                 .problem = "triangles of adjacent faces do not match: edges have one or more than two triangles, or two triangles of opposite orientation"};
  info.n_locations = static_cast<std::int64_t>(faults.triangles.size());
  for (std::size_t i = 0; i < std::min(k_max_locations, faults.triangles.size()); ++i) {
    const auto p = corners(mesh.mesh, faults.triangles[i]);
    info.locations.push_back({(p[0] + p[1] + p[2]) / 3.0, "face \"" + meshing.model.faces[mesh.triangle_face[faults.triangles[i]]].name + "\""});
  }
  info.hint = "check the model in CAD: faces may overlap, or an edge may have more than two faces";
  throw Error(std::move(info));
}

BandSummary summarise_bands(const Meshing& meshing) {
  BandSummary summary;
  summary.notes = meshing.bands.notes;
  for (const auto& band : meshing.bands.edges) summary.n_edges += band ? 1 : 0;
  for (const FaceId f : meshing.model.faces.ids()) {
    const MeshedFace& face = meshing.faces[f];
    summary.notes.insert(summary.notes.end(), face.notes.begin(), face.notes.end());
    if (face.bands.n_triangles == 0) continue;
    summary.n_triangles += face.bands.n_triangles;
    if (meshing.bands.strips[f]) ++summary.n_strips;
    double& stretch = meshing.bands.strips[f] ? summary.max_strip_stretch : summary.max_stretch;
    stretch = std::max(stretch, face.bands.max_stretch);
    summary.max_growth = std::max(summary.max_growth, face.bands.max_growth);
  }
  return summary;
}

/// Returns one sentence for each face without a mesh.
std::vector<std::string> holes_of(const Meshing& meshing) {
  std::vector<std::string> notes;
  for (const FaceId f : meshing.model.faces.ids()) {
    const MeshedFace& face = meshing.faces[f];
    if (!face.failure) continue;
    const CornerId corner = meshing.model.edges[meshing.model.faces[f].borders.front().front().edge].start;
    const Point location = !face.failure->locations.empty() ? face.failure->locations.front().position : meshing.model.corners[corner].point;
    notes.push_back("face " + std::to_string(f.value()) + ", \"" + meshing.model.faces[f].name + "\", near " + format_point(location) +
                    " cannot be meshed and is left as a hole: " + face.failure->problem);
  }
  return notes;
}

void summarise(const Meshing& meshing, SurfaceMesh& mesh) {
  mesh.report.absorbed = meshing.absorbed;
  mesh.report.bands = summarise_bands(meshing);
  const std::vector<std::string> holes = holes_of(meshing);
  mesh.report.bands.notes.insert(mesh.report.bands.notes.end(), holes.begin(), holes.end());
  summarise_faces(meshing.faces, mesh.report);
  measure_triangles(mesh);
}

void check_options(const SurfaceMeshOptions& options) {
  SurfaceMeshOptions copy = options;
  require_separable(options.periodic);
  for (const Option& option : options_of(copy))
    if (option.kind != OptionKind::number || option.automatic.empty() || !is_automatic(std::get<double>(option.get()))) set_option(option, option.get());
  if (options.sizes.min_edge > options.sizes.max_edge)  // the comparison is false if either value is automatic
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_attempted,
                 .problem = "min_edge = " + number_text(options.sizes.min_edge, k_digits) +
                            " m is above max_edge = " + number_text(options.sizes.max_edge, k_digits) + " m",
                 .hint = "curvature and narrow regions do not require edges below min_edge; automatic sets min_edge to 2 % of max_edge"});
}

}  // namespace

SurfaceMesh mesh_model(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, const RunContext& context) {
  return mesh_model(model, options, patches, SpaceSizes{}, context);
}

SurfaceMesh mesh_model(const Model& model, const SurfaceMeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                       const RunContext& context) {
  check_options(options);
  Meshing meshing{sized_model(model, options, patches, requested, context), {}, {}, {}, {}, {}, {}, {}};
  check_estimate(model, meshing.sizes, meshing.edges, options);
  meshing.topology = absorb_small_parts(model, meshing.edges, meshing.sizes, meshing.absorbed);
  if (!options.periodic.empty()) meshing.periodic_borders = find_periodic_borders(model, meshing.edges, options.periodic, meshing.topology);
  meshing.bands = find_wing_bands(model, meshing.edges, meshing.sizes, meshing.topology);
  check_band_estimate(model, meshing.bands, meshing.edges, options);
  meshing.sizes.is_covered = [&](FaceId f, const Point& p) { return meshing.bands.covers(meshing.edges, f, p); };
  add_narrow_locations(meshing, &meshing.bands, context);
  context.progress(k_prepared);
  SurfaceMesh mesh;
  MeshCrossings crossings;
  std::size_t n_crossing_before = static_cast<std::size_t>(-1);
  for (int round = 1;; ++round) {
    const SurfaceSizes field = sizes_of_round(meshing, context);
    // Later rounds mesh few faces, and fewer in each round.
    const double begin = round == 1 ? k_prepared : 1.0 - (1.0 - k_first_judged) * std::pow(0.5, round - 2);
    mesh = mesh_round(meshing, field, context.part("faces", begin, round == 1 ? k_first_round : 0.5 * (begin + 1.0)));
    mesh.report.n_rounds = round;
    check_count(mesh, options);
    const bool is_last = round == k_max_rounds;
    const bool may_leave_holes = options.failed_faces == "hole" && round >= k_rounds_before_holes;
    if (!may_leave_holes && refine_failures(meshing, field)) {
      if (is_last) throw_failures(meshing);
      continue;
    }
    JoinFaults faults = check_joins(model, meshing.topology, meshing.faces, mesh, context);
    if (!faults.triangles.empty() && split_doubled_edges(model, mesh, faults.triangles, meshing.faces) > 0) {
      mesh = join_faces(model, meshing.topology, meshing.cuts, number_border(model, meshing.topology, meshing.cuts), meshing.faces);
      mesh.report.n_rounds = round;
      faults = check_joins(model, meshing.topology, meshing.faces, mesh, context);
    }
    mesh.report.n_free_edges = faults.n_free_edges;
    if (!faults.triangles.empty()) {
      if (is_last) throw_faults(meshing, mesh, faults);
      for (const TriangleId t : faults.triangles) refine_triangle(meshing, mesh, t, k_repair_factor);
      continue;
    }
    if (options.crossings == "ignore") break;
    crossings = find_mesh_crossings(model, mesh, context);
    const std::size_t n_crossing = crossings.refinable.size();
    if (is_last || n_crossing == 0 || n_crossing >= n_crossing_before) break;
    n_crossing_before = n_crossing;
    for (const RefinableTriangle& r : crossings.refinable) refine_triangle(meshing, mesh, r.triangle, r.factor);
  }
  summarise(meshing, mesh);
  report_crossings(model, options, crossings, mesh, context);
  for (const std::string& note : mesh.report.bands.notes) context.warn(note);
  const SmoothAngle smooth = measure_smooth_angle(model, meshing.faces, context);
  mesh.report.max_smooth_angle = smooth.angle;
  mesh.report.smooth_angle_location = smooth.location;
  if (smooth.angle_outside_spots > k_largest_smooth_turn)
    context.warn("the mesh turns by " + number_text(std::round(smooth.angle_outside_spots * 180.0 / std::numbers::pi), k_digits) + " degrees at " +
                 format_point(smooth.place_outside_spots) +
                 ", where the model is smooth: layers will treat this location as a sharp edge (use shorter edges there: max_edge, min_edge, curvature_angle; "
                 "or the model folds)");
  return mesh;
}

std::string to_text(const SurfaceMeshReport& report) {
  const auto number = [](double value) { return number_text(value, k_digits); };
  std::int64_t n = 0;
  for (const FaceMeshSummary& face : report.faces) n += face.n_triangles;
  std::string text = std::to_string(n) + " triangles on " + std::to_string(report.faces.size()) + " faces; angles " + number(report.min_angle / k_degree) +
                     " .. " + number(report.max_angle / k_degree) + " degrees, " + number(100.0 * report.share_20_130) +
                     " % of the triangles within [20, 130]; mean radius ratio " + number(report.mean_radius_ratio) + "\n";
  text += "least angles";
  for (std::size_t i = 0; i < report.least_angles.size(); ++i)
    if (report.least_angles[i] > 0)
      text += " " + std::to_string(10 * i) + "-" + std::to_string(10 * (i + 1)) + ": " + std::to_string(report.least_angles[i]) + ",";
  text += " 1 % below " + number(report.angle_quantile_1 / k_degree) + " degrees\n";
  if (report.worst_face.is_valid()) {
    const FaceMeshSummary& worst = report.faces[report.worst_face.index()];
    text += "worst angle on \"" + worst.name + "\" at " + format_point(worst.worst_location) + "\n";
  }
  if (report.worst_normal_face.is_valid()) {
    const FaceMeshSummary& worst = report.faces[report.worst_normal_face.index()];
    text += "normals within the curvature angle on " + number(100.0 * report.share_normals) + " % of the area; largest deviation on \"" + worst.name +
            "\" at " + format_point(worst.normal_location) + ", " + number(worst.max_normal_angle / k_degree) + " degrees for " +
            number(worst.curvature_angle / k_degree) + "\n";
  }
  if (const BandSummary& bands = report.bands; bands.n_triangles > 0) {
    text += "bands: " + std::to_string(bands.n_triangles) + " triangles beside " + std::to_string(bands.n_edges) + " edges and on " +
            std::to_string(bands.n_strips) + " bases of trailing edges, not counted in the angles above; stretched up to " + number(bands.max_stretch) +
            " (bases " + number(bands.max_strip_stretch) + "), growing by up to " + number(bands.max_growth) + "\n";
  }
  for (const std::string& note : report.bands.notes) text += note + "\n";
  text += report.n_free_edges == 0 ? "closed" : "open: " + std::to_string(report.n_free_edges) + " free edges of triangles";
  text += "; edges within " + number(report.max_edge_distance) + " m of their surfaces";
  if (!report.loose_edges.empty()) {
    const LooseEdge& loose = report.loose_edges.front();
    text += "; " + std::to_string(report.loose_edges.size()) + " edges exceed their tolerance, first: " + number(loose.distance) + " m instead of " +
            number(loose.tolerance) + " m beside \"" + report.faces[loose.face.index()].name + "\" at " + format_point(loose.location);
  }
  constexpr double k_flat = 1e-6;  // rad: smaller angles are negligible
  if (report.max_smooth_angle > k_flat)
    text +=
        "; smooth regions turn by up to " + number(report.max_smooth_angle / k_degree) + " degrees per edge, at " + format_point(report.smooth_angle_location);
  if (!report.absorbed.empty())
    text += "; " + std::to_string(report.absorbed.size()) + " small parts removed, first: " + report.absorbed.front().what + " at " +
            format_point(report.absorbed.front().location);
  if (report.n_crossings > 0) text += "; " + std::to_string(report.n_crossings) + " pairs of triangles cross";
  return text + "\n";
}

}  // namespace sterna::surfmesh
