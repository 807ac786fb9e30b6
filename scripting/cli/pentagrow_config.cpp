// The keys, units and defaults are those of pentagrow 1.6.2 (and of CFS Engineering's fork: Symmetry, YPlaneCut).
#include "scripting/cli/pentagrow_config.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::scripting {
namespace {

constexpr double k_degree = std::numbers::pi / 180.0;
const double k_icosahedron_edge = 2.0 / std::sqrt(1.0 + std::pow(0.5 * (1.0 + std::sqrt(5.0)), 2.0));  ///< divided by the radius of its sphere
constexpr double k_sharp_degrees = 120.0;                                                              ///< angle of sharp edges in sterna, pentagrow's default

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string() : std::string(text.substr(first, last - first + 1));
}

/// The entries of one configuration by key, and the problems of the entries by line.
class Entries {
 public:
  Entries(const std::string& text, std::string file) : file_(std::move(file)) {
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      const std::string content = trimmed(line.substr(0, line.find('#')));
      if (content.empty()) continue;
      const std::size_t equals = content.find('=');
      if (equals == std::string::npos) {
        add_problem(number, "\"" + content + "\" is not Key = value");
        continue;
      }
      const std::string key = trimmed(content.substr(0, equals));
      if (const auto [before, is_new] = entries_.insert_or_assign(key, Entry{number, trimmed(content.substr(equals + 1))}); !is_new)
        notes.push_back(location(number) + key + " is given twice; the last counts");
    }
  }

  std::string location(int line) const { return file_ + ":" + std::to_string(line) + ": "; }
  int line_of(const std::string& key) const { return entries_.at(key).line; }
  bool has(const std::string& key) {
    known_.push_back(key);
    return entries_.contains(key);
  }

  /// Returns the value if the key is present and valid; else `otherwise`.
  double number(const std::string& key, double otherwise, double min = -k_unbounded, double max = k_unbounded) {
    const std::vector<double> values = numbers(key);
    if (values.empty()) return otherwise;
    if (values.size() != 1 || values[0] < min || values[0] > max) {
      add_problem(line_of(key), fmt::format("{} = {}: expected one number{}", key, entries_.at(key).value,
                                            std::isinf(min)   ? std::string()
                                            : std::isinf(max) ? fmt::format(" of at least {:g}", min)
                                                              : fmt::format(" in {:g} .. {:g}", min, max)));
      return otherwise;
    }
    return values[0];
  }
  int whole(const std::string& key, int otherwise, int min, int max) {
    const double value = number(key, otherwise, min, max);
    if (value == std::floor(value)) return static_cast<int>(value);
    add_problem(line_of(key), key + " = " + entries_.at(key).value + ": expected a whole number");
    return otherwise;
  }
  /// Returns a multiple of `n` numbers; empty if the key is missing or invalid.
  std::vector<double> vectors(const std::string& key, std::size_t n, bool is_one = false) {
    const std::vector<double> values = numbers(key);
    if (values.size() % n == 0 && (!is_one || values.size() <= n)) return values;
    add_problem(line_of(key), fmt::format("{}: found {} numbers, expected {}{}", key, values.size(), is_one ? "" : "a multiple of ", n));
    return {};
  }
  bool boolean(const std::string& key, bool otherwise) {
    if (!has(key)) return otherwise;
    std::string value = entries_.at(key).value;
    std::ranges::transform(value, value.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (value == "y" || value == "yes" || value == "true") return true;
    if (value == "n" || value == "no" || value == "false") return false;
    add_problem(line_of(key), key + " = " + entries_.at(key).value + ": expected y, yes, true, n, no or false");
    return otherwise;
  }
  std::string text(const std::string& key, const std::string& otherwise) { return has(key) ? entries_.at(key).value : otherwise; }

  /// Notes that a key has another effect here than in pentagrow. \pre has(key)
  void note(const std::string& key, const std::string& what) { notes.push_back(location(line_of(key)) + key + ": " + what); }
  void refuse(const std::string& key, const std::string& what) { add_problem(line_of(key), key + " = " + entries_.at(key).value + ": " + what); }

  void finish() {
    for (const auto& [key, entry] : entries_) {
      if (std::ranges::find(known_, key) != known_.end()) continue;
      const std::string nearest = nearest_name(key, known_);
      add_problem(entry.line, "unknown key \"" + key + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"));
    }
    if (problems_.empty()) return;
    std::ranges::stable_sort(problems_, {}, &Problem::line);
    std::string text;
    for (const Problem& problem : problems_) text += (problems_.size() == 1 ? "" : "\n  - ") + location(problem.line) + problem.text;
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "reading the configuration of pentagrow",
                 .problem = (problems_.size() == 1 ? "" : std::to_string(problems_.size()) + " problems") + text});
  }

  std::vector<std::string> notes;

 private:
  struct Entry {
    int line = 0;
    std::string value;
  };
  struct Problem {
    int line = 0;
    std::string text;
  };

  void add_problem(int line, std::string text) { problems_.push_back({line, std::move(text)}); }

  std::vector<double> numbers(const std::string& key) {
    std::vector<double> values;
    if (!has(key)) return values;
    std::istringstream words(entries_.at(key).value);
    for (std::string word; words >> word;) {
      double value = 0.0;
      const auto [end, error] = std::from_chars(word.data() + (word.starts_with('+') ? 1 : 0), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
        add_problem(line_of(key), key + ": \"" + word + "\" is not a number");
        return {};
      }
      values.push_back(value);
    }
    if (values.empty()) add_problem(line_of(key), key + ": the value is missing");
    return values;
  }

  std::string file_;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> known_;
  std::vector<Problem> problems_;
};

// ---- Groups of keys, as in sumo's documentation ---------------------------------------------------------------------------------------------

void read_formats(Entries& in, PentagrowCase& out) {
  if (const std::string format = in.text("InputFormat", ""); !format.empty()) {
    const std::map<std::string, std::string> known = {{"stl", ".stl"}, {"msh", ".msh"}, {"cgns", ".cgns"}, {"zml", ".zml"}};
    if (const auto found = known.find(format); found != known.end()) out.input_extension = found->second;
    else in.refuse("InputFormat", "expected msh, stl, cgns or zml; without it the format follows from the file's name");
  }
  const bool is_given = in.has("OutputFormat");
  const std::string formats = in.text("OutputFormat", "bmsh");
  const auto names = [&](std::initializer_list<std::string_view> any) {
    return std::ranges::any_of(any, [&](std::string_view name) { return formats.find(name) != std::string::npos; });
  };
  if (names({"bmsh", "edge"})) out.outputs.emplace_back("hybrid.bmsh");
  if (names({"cgns"})) out.outputs.emplace_back("hybrid.cgns");
  if (names({"tau"})) out.outputs.emplace_back("hybrid.taumesh");
  if (names({"su2"})) out.outputs.emplace_back("hybrid.su2");
  const bool has_zml = names({"zml", "native"});
  if (out.outputs.empty())
    in.refuse("OutputFormat", has_zml ? "hybrid.zml is not written; use cgns, su2, bmsh or tau" : "expected some of bmsh, cgns, tau, su2");
  else if (has_zml && is_given) in.note("OutputFormat", "hybrid.zml is not written; cgns, su2, bmsh and tau are");
}

void read_layers(Entries& in, volmesh::EnvelopeOptions& layer) {
  layer.layers = in.whole("NLayers", 21, 1, 1000);
  layer.growth = "local";  // the file means eq. (1)
  layer.first_height = in.number("InitialHeight", 1e-5, 1e-12);
  layer.max_thickness = in.number("MaxLayerThickness", 1.0, 1e-12);
  layer.max_relative_height = in.number("MaxRelativeHeight", 5.0, 0.01, 1e6);
  layer.max_growth = in.number("MaxGrowthRatio", 1.5, 1.0, 3.0);
  layer.feature_angle = k_degree * in.number("FeatureAngle", 44.0, 1.0, 177.0);
  if (in.number("SharpEdgeAngle", k_sharp_degrees, 0.0, 180.0) != k_sharp_degrees)
    in.note("SharpEdgeAngle", "edges above 120 degrees are sharp in sterna; this limit cannot be set");
  layer.height_sweeps = in.whole("HeightIterations", 5, 0, 1000);
  layer.direction_sweeps = in.whole("NormalIterations", 50, 0, 1000);
  layer.envelope_sweeps = in.whole("LaplaceIterations", 5, 0, 1000);
  layer.max_retract_sweeps = in.whole("MaxCritIterations", 99, 1, 1000);
  if (!in.boolean("UntangleGrid", true)) in.note("UntangleGrid", "sterna always untangles layers");
  if (in.number("MaxOptimizationTime", 30.0, 0.0) == 0.0) layer.optimiser = "none";
  else if (in.has("MaxOptimizationTime"))
    in.note("MaxOptimizationTime", "the optimiser of sterna stops after its number of sweeps, so that results are reproducible; 0 switches it off");
  in.boolean("VerboseOptimization", false);
}

void read_curves(Entries& in, volmesh::PrismOptions& prisms) {
  const bool is_curved = in.boolean("SplineNormals", false);
  const double transition = in.number("WallNormalTransition", 0.05, 0.0, 1.0);
  prisms.wall_perpendicularity = is_curved ? transition : 0.0;
}

void read_farfield(Entries& in, PentagrowCase& out) {
  volmesh::FarfieldOptions& farfield = out.options.farfield;
  farfield.farfield_shape = "sphere";
  farfield.farfield_radius = in.number("FarfieldRadius", 100.0, 1e-9);
  farfield.farfield_edge = k_icosahedron_edge * farfield.farfield_radius / std::exp2(in.whole("FarfieldSubdivision", 3, 0, 9));
  std::vector<double> center = in.vectors("FarfieldCenter", 3, true);
  const std::vector<double> holes = in.vectors("HolePosition", 3);  // cavities are found automatically
  if (center.empty() && !holes.empty()) center.assign(holes.begin(), holes.begin() + 3);
  out.is_half = in.boolean("Symmetry", false);
  out.cut = in.number("YPlaneCut", 0.0);
  if (center.empty()) return;
  farfield.farfield_center_x = center[0];
  farfield.farfield_center_y = out.is_half ? k_automatic : center[1];
  farfield.farfield_center_z = center[2];
}

/// Parses "-pq1.2a0.1VY": letters, some followed by numbers.
void read_tetgen_switches(Entries& in, const std::string& text, volmesh::MeshCase& options) {
  for (std::size_t i = text.find_first_not_of("- ") == std::string::npos ? text.size() : 0; i < text.size();) {
    const char letter = text[i++];
    const std::size_t start = i;
    while (i < text.size() &&
           (std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.' || text[i] == '/' || ((text[i] == 'e' || text[i] == '-') && i > start)))
      ++i;
    const std::string numbers = text.substr(start, i - start);
    const double value = numbers.empty() || numbers.front() == '/' ? 0.0 : std::strtod(numbers.c_str(), nullptr);
    if (letter == 'q' && value > 0.0) options.tetrahedra.radius_edge = value;
    else if (letter == 'Y') options.tetrahedra.boundary_splits = "never";
    else if (letter == 'S' && value > 0.0) options.tetrahedra.max_new_points = value;
    else if (letter == 'a' && value > 0.0) options.size.size_max = std::cbrt(6.0 * std::sqrt(2.0) * value);  // edge of the regular tetrahedron of that volume
    else if (std::string_view("-pq aVQCDOAT").find(letter) == std::string_view::npos)
      in.note("TetgenOptions", std::string("the switch ") + letter + " has no equivalent in sterna");
  }
}

void read_tetrahedra(Entries& in, volmesh::MeshCase& options) {
  options.tetrahedra.radius_edge = 1.2;
  if (in.has("TetgenPath")) in.note("TetgenPath", "sterna uses sterna-tet-tetgen beside this program; for another folder use sterna mesh --helper-folder");
  if (in.has("TetgenOptions")) read_tetgen_switches(in, in.text("TetgenOptions", ""), options);
  if (const double n = in.number("MaxSteinerPoints", 0.0, 0.0); n > 0.0) {
    options.tetrahedra.max_new_points = n;
    in.note("MaxSteinerPoints", "in sterna more points are an error and do not give a coarser mesh");
  }
  if (const double edge = in.number("MaxGlobalEdgeLength", 0.0, 0.0); edge > 0.0) options.size.size_max = edge;
  if (const double growth = in.number("TetGrowthFactor", 0.0, 0.0, 2.0); growth > 1.0) {
    options.size.size_growth = std::max(growth, 1.02);
    if (growth < 1.21 || growth > 1.6) in.note("TetGrowthFactor", "is outside the range 1.21 .. 1.6");
  }
  for (const char* key : {"TetEdgeSmoothing", "TetEdgeDistrib"}) {
    in.number(key, 0.0, 0.0);
    if (in.has(key)) in.note(key, "sterna grades sizes by TetGrowthFactor only");
  }
  if (const std::string pass = in.text("Pass", "both"); pass != "both")
    in.refuse("Pass",
              "is not available in sterna; `sterna mesh wall.stl --stages case.sterna -o ...` keeps the steps of a run, and `sterna mesh case.sterna -o ...` "
              "continues");
}

void read_boxes(Entries& in, PentagrowCase& out) {
  const int n = in.whole("RefineBoxCount", 0, 0, 100000);
  std::vector<std::vector<double>> limits;
  for (const char* key : {"RefineBoxXLimits", "RefineBoxYLimits", "RefineBoxZLimits"}) limits.push_back(in.vectors(key, 2));
  const std::vector<double> edges = in.vectors("RefineBoxEdgeLength", 1);
  if (n == 0) return;
  const auto count = static_cast<std::size_t>(n);
  if (std::ranges::any_of(limits, [&](const auto& l) { return l.size() != 2 * count; }) || edges.size() != count ||
      std::ranges::any_of(edges, [](double e) { return e <= 0.0; })) {
    in.refuse("RefineBoxCount", "RefineBoxXLimits, ...YLimits, ...ZLimits need two numbers for each box, RefineBoxEdgeLength one above zero");
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
    out.options.sources.push_back({.kind = volmesh::SourceKind::box,
                                   .from = {limits[0][2 * i], limits[1][2 * i], limits[2][2 * i]},
                                   .to = {limits[0][2 * i + 1], limits[1][2 * i + 1], limits[2][2 * i + 1]},
                                   .size = edges[i]});
}

void read_nearfield(Entries& in, PentagrowCase& out) {
  out.nearfield_edge = in.number("NearfieldEdgeLength", 0.0);
  out.nearfield_size = in.number("NearfieldSize", 3.5, 1.0);
  out.nearfield_center = in.vectors("NearfieldCenter", 3, true);
  out.nearfield_axes = in.vectors("NearfieldSemiAxes", 3, true);
  if (std::ranges::any_of(out.nearfield_axes, [](double a) { return a <= 0.0; })) in.refuse("NearfieldSemiAxes", "expected numbers above zero");
  if (out.nearfield_edge != 0.0) in.note("NearfieldEdgeLength", "sterna refines the box around the ellipsoid");
}

}  // namespace

PentagrowCase read_pentagrow_config(const std::string& text, const std::string& file_name) {
  Entries in(text, file_name);
  PentagrowCase out;
  read_formats(in, out);
  read_layers(in, out.options.envelope);
  read_curves(in, out.options.prisms);
  read_farfield(in, out);
  read_tetrahedra(in, out.options);
  read_boxes(in, out);
  read_nearfield(in, out);
  in.finish();
  out.notes = std::move(in.notes);
  return out;
}

std::vector<volmesh::SizeSource> nearfield_sources(const PentagrowCase& given, const TriMesh& wall) {
  if (given.nearfield_edge == 0.0) return {};
  Box box;
  double longest = 0.0, sum = 0.0;
  for (const Point& p : wall.points) box.add(p);
  for (const TriangleVertices& t : wall.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge = distance(wall.points[t[k]], wall.points[t[(k + 1) % 3]]);
      longest = std::max(longest, edge);
      sum += edge;
    }
  const double mean = sum / (3.0 * static_cast<double>(std::max<std::size_t>(wall.n_triangles(), 1)));
  const Vec3 center = given.nearfield_center.empty() ? box.center() : Vec3{given.nearfield_center[0], given.nearfield_center[1], given.nearfield_center[2]};
  const Vec3 axes = given.nearfield_axes.empty() ? 0.5 * given.nearfield_size * (box.max - box.min)
                                                 : Vec3{given.nearfield_axes[0], given.nearfield_axes[1], given.nearfield_axes[2]};
  const double edge = given.nearfield_edge > 0.0 ? given.nearfield_edge : std::max(2.0 * longest, 8.0 * mean);
  return {{.kind = volmesh::SourceKind::box, .from = center - axes, .to = center + axes, .size = edge}};
}

}  // namespace sterna::scripting
