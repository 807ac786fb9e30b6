// The reader translates the file, applies its unit, repairs the shape, makes the model and writes the report.
#include "geom/cad/read_cad.h"

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Message_ProgressScope.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Edge.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "geom/cad/find_contacts.h"
#include "geom/cad/heal.h"
#include "geom/cad/occt_call.h"
#include "geom/cad/open_shells.h"
#include "geom/cad/translate.h"
#include "geom/model/model_measures.h"
#include "geom/model/select_faces.h"

namespace sterna {
namespace cad {
namespace {

/// Expected size range of an aircraft, a rotor or a wind-tunnel model, metres; outside it a warning about the unit is issued, but the unit is never changed.
constexpr double k_smallest_size = 0.3;
constexpr double k_largest_size = 400.0;
/// A warning is also issued for a model smaller than this, metres, if its numbers, read as metres, would give the size of an aircraft.
constexpr double k_small_size = 2.0;
constexpr Interval k_aircraft = {5.0, 120.0};

/// Fractions of the reading time for translation and repair, from the files of docs/cad_files.md.
constexpr double k_translate_share = 50.0;
constexpr double k_heal_share = 50.0;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Warns of an implausible unit: files whose header says mm although the numbers are metres occur in practice.
void doubt_unit(double size, bool is_given, CadReport& report) {
  const bool looks_like_metres = size < k_small_size && k_aircraft.contains(size / report.unit);
  if (is_given || size <= 0.0 || (size >= k_smallest_size && size <= k_largest_size && !looks_like_metres)) return;
  const std::string as = report.format == CadFormat::brep ? "a BREP file has no unit; reading it in metres" : "the file's unit (" + report.file_unit + ")";
  report.warnings.push_back(as + " makes the model " + number(size) + " m long; its numbers span " + number(size / report.unit) +
                            ": if the unit is wrong, give `unit` (1 for m, 0.001 for mm)");
}

/// Names loose faces and shells after the file if they have no other name.
void name_after_file(LabelledShape& labelled, const std::string& source) {
  std::string stem = source.substr(source.find_last_of('/') + 1);
  if (stem.ends_with(".gz")) stem.resize(stem.size() - 3);
  stem = stem.substr(0, stem.find_last_of('.'));
  std::size_t n_nameless = 0;
  for (const ShapePart& part : labelled.parts)
    if (part.shape.ShapeType() == TopAbs_SOLID && part.component.empty() && part.name.empty()) ++n_nameless;
  std::size_t number = 0;
  for (ShapePart& part : labelled.parts) {
    if (!part.component.empty()) continue;
    if (!part.name.empty()) part.component = part.name;
    else if (part.shape.ShapeType() == TopAbs_SOLID && n_nameless > 1) part.component = stem + "_" + std::to_string(++number);
    else part.component = stem;
  }
}

/// Copies the labels of parts to their faces, so that these can be joined with faces of other parts.
void label_faces(LabelledShape& labelled) {
  for (const ShapePart& part : labelled.parts)
    for (TopExp_Explorer f(part.shape, TopAbs_FACE); f.More(); f.Next()) {
      FaceLabel label = labelled.labels.IsBound(f.Current()) ? labelled.labels.Find(f.Current()) : FaceLabel{};
      if (label.component.empty()) label.component = part.component;
      if (!label.colour) label.colour = part.label.colour;
      if (label.layer.empty()) label.layer = part.label.layer;
      labelled.labels.Bind(f.Current(), label);
    }
}

double length_of(const TopoDS_Edge& edge) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(edge, properties);
  return properties.Mass();
}

/// Largest distance of a flat opening from its plane, relative to its length.
constexpr double k_flat = 1e-4;

/// Groups free edges by common corners.
std::vector<CadOpening> openings_of(const Model& model, const std::vector<CadFreeEdge>& free) {
  std::map<CornerId, std::vector<std::size_t>> at_corner;
  for (std::size_t i = 0; i < free.size(); ++i)
    for (const CornerId c : {model.edges[free[i].edge].start, model.edges[free[i].edge].end}) at_corner[c].push_back(i);
  std::vector<bool> is_done(free.size(), false);
  std::vector<CadOpening> openings;
  for (std::size_t first = 0; first < free.size(); ++first) {
    if (is_done[first]) continue;
    CadOpening opening{.is_loop = true};
    std::vector<std::size_t> queue{first};
    is_done[first] = true;
    std::vector<Point> samples;
    while (!queue.empty()) {
      const std::size_t i = queue.back();
      queue.pop_back();
      const ModelEdge& edge = model.edges[free[i].edge];
      opening.edges.push_back(free[i].edge);
      opening.length += free[i].length;
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) samples.push_back(edge.curve->point(edge.range.from + share * edge.range.length()));
      for (const CornerId c : {edge.start, edge.end}) {
        if (at_corner[c].size() != 2) opening.is_loop = false;
        for (const std::size_t next : at_corner[c])
          if (!is_done[next]) {
            is_done[next] = true;
            queue.push_back(next);
          }
      }
    }
    std::sort(opening.edges.begin(), opening.edges.end());
    for (const Point& p : samples) opening.location += p / static_cast<double>(samples.size());
    // The plane through the centre and the two samples with the largest span.
    const Point far = *std::max_element(samples.begin(), samples.end(),
                                        [&](const Point& a, const Point& b) { return distance(a, opening.location) < distance(b, opening.location); });
    for (const Point& p : samples)
      if (const Vec3 n = cross(far - opening.location, p - opening.location); norm(n) > norm(opening.normal)) opening.normal = n;
    if (norm(opening.normal) > 0.0) opening.normal = opening.normal / norm(opening.normal);
    opening.is_flat = std::all_of(samples.begin(), samples.end(),
                                  [&](const Point& p) { return std::abs(dot(p - opening.location, opening.normal)) <= k_flat * opening.length; });
    openings.push_back(std::move(opening));
  }
  return openings;
}

void describe_result(const Model& model, CadReport& report) {
  report.n_faces = model.faces.size();
  std::vector<bool> is_loose(model.faces.size(), true);
  for (const ModelSolid& solid : model.solids) {
    solid.is_closed ? ++report.n_closed : ++report.n_open;
    for (const FaceId f : solid.faces) is_loose[f.index()] = false;
  }
  report.n_open += static_cast<std::size_t>(std::count(is_loose.begin(), is_loose.end(), true));
  const auto uses = uses_of_edges(model);
  for (const EdgeId e : free_edges(model)) {
    const ModelEdge& edge = model.edges[e];
    report.free_edges.push_back(
        {e, uses[e].front().face, edge.curve->point(0.5 * (edge.range.from + edge.range.to)), length_of(model.shape->content().edges[e.index()])});
  }
  report.openings = openings_of(model, report.free_edges);
  report.faults = faults_of(*model.shape);
}

void count_names(const LabelledShape& labelled, CadReport& report) {
  for (const ShapePart& part : labelled.parts) report.n_named_parts += !part.name.empty() || !part.component.empty();
  for (FaceLabels::Iterator it(labelled.labels); it.More(); it.Next()) report.n_named_faces += !it.Value().name.empty();
}

/// Orients the normals of closed solids that are not inside another one inwards: the fluid is inside them.
void turn_inwards(Model& model, const std::string& attempted, CadReport& report, const RunContext& context) {
  std::vector<SolidId> closed;
  std::vector<Model> parts;
  for (const SolidId s : model.solids.ids()) {
    if (!model.solids[s].is_closed) continue;
    closed.push_back(s);
    const std::vector<FaceId>& faces = model.solids[s].faces;
    parts.push_back(select_faces(model, [&](FaceId f) { return std::find(faces.begin(), faces.end(), f) != faces.end(); }));
  }
  if (closed.empty()) {
    report.warnings.push_back("fluid = \"inside\" has no effect: the model has no closed solid; cap = true closes flat openings");
    return;
  }
  std::vector<bool> is_body(closed.size(), false);
  if (closed.size() > 1) {
    const RunContext quiet({.threads = context.threads(), .stop = context.stop_token()});
    for (const PartContact& contact : find_contacts(parts, quiet).contacts)
      if (contact.kind == ContactKind::inside) is_body[contact.first] = true;
  }
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (is_body[i]) continue;
    if (solid_measures(model, closed[i]).volume <= 0.0) continue;
    for (const FaceId f : model.solids[closed[i]].faces) model.faces[f].is_reversed = !model.faces[f].is_reversed;
  }
  model.shape.reset();
  if (const auto n = static_cast<std::size_t>(std::count(is_body.begin(), is_body.end(), true)); n > 0)
    context.info(attempted + ": the fluid is inside; " + std::to_string(n) + (n == 1 ? " solid within another is a body" : " solids within others are bodies"));
}

}  // namespace

CadFile read_cad_bytes(std::string_view bytes, CadFormat format, const std::string& source, const ReadCadOptions& options, const RunContext& context) {
  CadFile file;
  CadReport& report = file.report;
  report.format = format;
  const std::string attempted = "reading " + source;
  run_occt({.attempted = attempted, .time_limit = options.time_limit}, context, [&](const Message_ProgressRange& progress) {
    Message_ProgressScope steps(progress, "reading", k_translate_share + k_heal_share);
    Translated translated = translate(bytes, format, source, steps.Next(k_translate_share));
    context.check_stop();
    if (translated.labelled.parts.empty())
      throw Error({.code = ErrorCode::file_malformed,
                   .attempted = attempted,
                   .problem = "the file holds no face",
                   .hint = "export solids, shells or faces; wires and meshes are not read"});
    report.file_unit = translated.file_unit;
    for (const std::string& loss : translated.losses) report.warnings.push_back(loss + "; compare area and volume with the program that wrote the file");
    for (const std::string& face : translated.seams.failed)
      report.warnings.push_back("the face " + face +
                                " covers a closed surface, and its holes leave no room for a seam: OpenCASCADE may read it wrongly. "
                                "Compare area and volume with the program that wrote the file, or give the model as BREP");
    report.unit = is_automatic(options.unit) ? translated.unit : options.unit;
    if (report.unit != translated.unit) scale(translated.labelled, report.unit / translated.unit);
    doubt_unit(longest_side(compound_of(translated.labelled.parts)), !is_automatic(options.unit), report);
    count_names(translated.labelled, report);
    name_after_file(translated.labelled, source);
    label_faces(translated.labelled);
    if (options.heal) heal(translated.labelled, options, report, steps.Next(k_heal_share), context);
    drop_sheets(translated.labelled, options, report);
    file.model = model_of(translated.labelled, attempted, context);
    file.model.source_unit = report.file_unit;
    describe_result(file.model, report);
  });
  if (options.fluid == "inside") turn_inwards(file.model, attempted, report, context);
  for (const std::string& warning : report.warnings) context.warn(source + ": " + warning);
  return file;
}

}  // namespace cad

std::string to_text(const CadReport& report) {
  constexpr std::size_t k_shown = 10;
  std::string text = std::string(to_string(report.format)) + ", unit " + report.file_unit + " = " + cad::number(report.unit) +
                     " m: " + std::to_string(report.n_faces) + " faces, " + std::to_string(report.n_closed) + " closed solids" +
                     (report.n_open > 0 ? ", " + std::to_string(report.n_open) + " open shells or loose faces" : "") +
                     "; names: " + std::to_string(report.n_named_parts) + " parts, " + std::to_string(report.n_named_faces) + " faces";
  for (const std::string& warning : report.warnings) text += "\n  warning: " + warning;
  std::map<std::string, std::vector<const CadRepair*>> by_kind;
  for (const CadRepair& repair : report.repaired) by_kind[repair.what].push_back(&repair);
  for (const auto& [what, repairs] : by_kind) {
    text += "\n  repaired: " + what + ", " + std::to_string(repairs.size()) + " x";
    for (std::size_t i = 0; i < std::min<std::size_t>(repairs.size(), 3); ++i)
      text += (i == 0 ? ": " : ", ") + format_point(repairs[i]->location) + (repairs[i]->value > 0.0 ? " " + cad::number(repairs[i]->value) + " m" : "");
    if (repairs.size() > 3) text += " ...";
  }
  for (std::size_t i = 0; i < std::min(report.openings.size(), k_shown); ++i) {
    const CadOpening& opening = report.openings[i];
    text += "\n  opening: " + std::to_string(opening.edges.size()) + " edges, " + cad::number(opening.length) + " m, near " + format_point(opening.location);
    if (!opening.is_loop) text += ", not a single loop";
    if (opening.is_flat) text += ", flat with normal " + format_point(opening.normal) + (opening.is_loop ? ": `cap = true` closes it" : "");
  }
  for (std::size_t i = 0; i < std::min(report.free_edges.size(), k_shown); ++i) {
    const CadFreeEdge& edge = report.free_edges[i];
    text += "\n  open: edge " + std::to_string(edge.edge.index()) + " of face " + std::to_string(edge.face.index()) + " at " + format_point(edge.location) +
            ", " + cad::number(edge.length) + " m long";
  }
  if (report.free_edges.size() > k_shown) text += "\n  open: and " + std::to_string(report.free_edges.size() - k_shown) + " more edges";
  for (std::size_t i = 0; i < std::min(report.faults.size(), k_shown); ++i)
    text += "\n  fault: " + report.faults[i].what + " at " + format_point(report.faults[i].position);
  if (report.faults.size() > k_shown) text += "\n  fault: and " + std::to_string(report.faults.size() - k_shown) + " more";
  return text;
}

}  // namespace sterna
