#include "geom/cad/check_written.h"

#include <algorithm>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/cad/read_cad.h"
#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {

/// Relative tolerance of area and volume. It is a hundred times the error from translating curves.
constexpr double k_same_written = 1e-6;
/// Area below which a body is ignored, relative to the square of the model's size.
constexpr double k_no_extent = 1e-12;
/// Intervals of an edge for computing its length.
constexpr int k_edge_intervals = 16;

/// A closed solid, or all open shells and loose faces together, because formats store shells and loose faces in different ways.
struct WrittenBody {
  std::string name;
  bool is_closed = false;
  std::size_t n_faces = 0;
  double area = 0.0, volume = 0.0;
  double slack = 0.0;  ///< m2: uncertainty from the tolerances of edges
};

double length_of_edge(const ModelEdge& edge) {
  double length = 0.0;
  for (int i = 1; i <= k_edge_intervals; ++i)
    length += distance(edge.curve->point(edge.range.from + edge.range.length() * (i - 1) / k_edge_intervals),
                       edge.curve->point(edge.range.from + edge.range.length() * i / k_edge_intervals));
  return length;
}

double diagonal_of(const Model& model) {
  Point low, high;
  bool is_first = true;
  for (const ModelCorner& corner : model.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = is_first ? corner.point[k] : std::min(low[k], corner.point[k]);
      high[k] = is_first ? corner.point[k] : std::max(high[k], corner.point[k]);
      if (k == 2) is_first = false;
    }
  return distance(low, high);
}

/// Returns the closed solids in their order, then all other faces as one body.
std::vector<WrittenBody> bodies_of(const Model& model, const RunContext& context) {
  const ModelMeasures measures = model_measures(model, context);
  std::vector<bool> is_open(model.faces.size(), true);
  const auto add = [&](FaceId f, WrittenBody& body) {
    ++body.n_faces;
    body.area += measures.faces[f].area;
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border)
        if (const ModelEdge& edge = model.edges[use.edge]; !edge.is_degenerate()) body.slack += edge.tolerance * length_of_edge(edge);
  };
  std::vector<WrittenBody> bodies;
  for (const SolidId s : model.solids.ids()) {
    const ModelSolid& solid = model.solids[s];
    if (!solid.is_closed) continue;
    WrittenBody body{.name = solid.name, .is_closed = true, .volume = measures.solids[s.index()].volume};
    for (const FaceId f : solid.faces) {
      is_open[f.index()] = false;
      add(f, body);
    }
    bodies.push_back(std::move(body));
  }
  WrittenBody open{.name = "open shells and faces"};
  for (const FaceId f : model.faces.ids())
    if (is_open[f.index()]) add(f, open);
  if (open.n_faces > 0) bodies.push_back(std::move(open));
  const double size = diagonal_of(model);
  std::erase_if(bodies, [&](const WrittenBody& body) { return body.area <= k_no_extent * size * size; });  // faces that are degenerate to lines
  return bodies;
}

std::string figures(const WrittenBody& body) {
  return std::to_string(body.n_faces) + " faces, " + number_text(body.area) + " m^2" + (body.is_closed ? ", " + number_text(body.volume) + " m^3" : ", open");
}

}  // namespace

std::vector<std::string> differences_of_file(const Model& model, const std::string& bytes, CadFormat format, const std::string& name,
                                             const RunContext& context) {
  const RunContext quiet({.threads = context.threads(), .stop = context.stop_token()});
  CadFile file;
  try {
    file = read_cad_bytes(bytes, format, name, {.unit = format == CadFormat::brep ? 1.0 : k_automatic, .heal = false}, quiet);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return {"the file cannot be read again: " + error.info().problem};
  }
  const std::vector<WrittenBody> before = bodies_of(model, context);
  std::vector<WrittenBody> after = bodies_of(file.model, context);
  const double size = diagonal_of(model);
  // Solids around the fluid have normals inwards; STEP and IGES do not store the orientation.
  const auto volume_of = [&](const WrittenBody& body) { return format == CadFormat::brep ? body.volume : std::abs(body.volume); };
  const auto is_same = [&](const WrittenBody& a, const WrittenBody& b) {
    return a.is_closed == b.is_closed && (a.n_faces == b.n_faces || !a.is_closed) && std::abs(a.area - b.area) <= k_same_written * a.area + a.slack &&
           std::abs(volume_of(a) - volume_of(b)) <= k_same_written * std::abs(a.volume) + a.slack * size;
  };
  std::vector<std::string> differences;
  for (const WrittenBody& body : before) {
    const auto same = std::find_if(after.begin(), after.end(), [&](const WrittenBody& other) { return is_same(body, other); });
    if (same == after.end()) differences.push_back("\"" + body.name + "\" (" + figures(body) + ") is not in the file unchanged");
    else after.erase(same);
  }
  for (const WrittenBody& body : after) differences.push_back("the file holds \"" + body.name + "\" (" + figures(body) + ") instead");
  return differences;
}

std::vector<std::string> solids_around_fluid(const Model& model, const RunContext& context) {
  std::vector<std::string> names;
  for (const WrittenBody& body : bodies_of(model, context))
    if (body.is_closed && body.volume < 0.0) names.push_back(body.name);
  return names;
}

}  // namespace sterna::cad
