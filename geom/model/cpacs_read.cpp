// Reader of CPACS. Steps: read the header; find the positions of the components (translations may depend on those of their parents); read wings and pylons,
// fuselages, and nacelles; report other contents of the model.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <pugixml.hpp>

#include "geom/base/error.h"
#include "geom/model/cpacs.h"
#include "geom/model/cpacs_parts.h"

namespace sterna {
namespace cpacs {

using Node = pugi::xml_node;

struct Document::Uids {
  std::unordered_map<std::string, Node> nodes;
};

namespace {

void collect_uids(const Node& node, std::unordered_map<std::string, Node>& uids) {
  if (const pugi::xml_attribute uid = node.attribute("uID")) uids.emplace(uid.value(), node);
  for (const Node child : node.children()) collect_uids(child, uids);
}

}  // namespace

Document::Document(const std::filesystem::path& path) : file(path), uids_(std::make_unique<Uids>()) { collect_uids(file.root(), uids_->nodes); }
Document::~Document() = default;

Node Document::find(const std::string& uid) const {
  const auto found = uids_->nodes.find(uid);
  return found == uids_->nodes.end() ? Node() : found->second;
}

Node Document::resolve(const Node& from, const std::string& uid) const {
  if (uid.empty()) file.fail(from, "a uID is missing here");
  const Node node = find(uid);
  if (!node) file.fail(from, "the file has no element with the uID '" + uid + "'");
  return node;
}

Transform Transformation::matrix() const {
  const Point origin;
  const Transform scale{{scaling.x, 0.0, 0.0}, {0.0, scaling.y, 0.0}, {0.0, 0.0, scaling.z}, {}};
  return sterna::translation(translation) * sterna::rotation(origin, {1.0, 0.0, 0.0}, rotation.x) * sterna::rotation(origin, {0.0, 1.0, 0.0}, rotation.y) *
         sterna::rotation(origin, {0.0, 0.0, 1.0}, rotation.z) * scale;
}

Vec3 read_vector(const XmlFile& file, const Node& element, const Vec3& fallback) {
  return {file.child_number(element, "x", fallback.x), file.child_number(element, "y", fallback.y), file.child_number(element, "z", fallback.z)};
}

Transformation read_transformation(const Document& document, const Node& element) {
  const Node node = element.child("transformation");
  const XmlFile& file = document.file;
  Transformation t;
  t.scaling = read_vector(file, node.child("scaling"), {1.0, 1.0, 1.0});
  t.rotation = k_degree * read_vector(file, node.child("rotation"), {});
  t.translation = read_vector(file, node.child("translation"), {});
  t.is_absolute = file.text(node.child("translation"), "refType", "absLocal") == "absGlobal";
  return t;
}

namespace {

/// A wing's root farther than this from y = 0, relative to its size, is not in the plane of symmetry.
constexpr double k_in_plane = 1e-6;

/// Elements that are not read and do not describe the outer shape: no message is issued.
constexpr std::string_view k_no_shape =
    "structure structuralElements materials fuels systems system global analyses dynamicAircraftModel dynamicAircraftModels wingFuselageAttachments "
    "wingWingAttachments wingFuelTanks compartments decks cargoCrossBeams longFloorBeams performanceCases performanceRequirements missionDefinitions "
    "configurationDefinitions engineMassBreakdown";

const char* const k_component_tags[] = {"wing", "fuselage", "enginePylon", "engine", "landingGear", "rotor", "genericGeometryComponent"};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : document_(path), file_(document_.file) {}
  AircraftReading read();

 private:
  struct Element {
    Node node;
    Transform location;  ///< maps the profile into component axes
  };
  void header();
  void read_model(const Node& model);
  Transform location_of(const Node& component);
  Vec3 translation_of(const Node& component, std::set<std::string>& visited);
  std::map<std::string, Vec3> positionings(const Node& component);
  std::vector<Element> chain(const Node& component);
  bool is_mirrored(const Node& component);
  void wing(const Node& node, bool is_pylon);
  void fuselage(const Node& node);
  void engine(const Node& node);
  template <class Read>
  void or_leave_out(const char* what, const Read& read);
  void devices(const Node& node, const Wing& wing, const std::vector<Element>& elements, bool is_turned);

  Document document_;
  XmlFile& file_;
  AircraftReading reading_;
};

/// Reads an optional part of an aircraft. A part that cannot be read is reported and omitted, and reading continues.
template <class Read>
void Reader::or_leave_out(const char* what, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::file_malformed) throw;
    file_.messages().push_back(error.info().problem + "; the " + what + " is left out");
  }
}

void Reader::header() {
  const Node root = file_.root();
  if (std::string_view(root.name()) != "cpacs") file_.fail(root, "the root element of a CPACS file must be cpacs");
  const Node header = root.child("header");
  std::string version = XmlFile::child_text(header, "cpacsVersion");
  for (const Node info : header.child("versionInfos").children("versionInfo"))
    if (const std::string v = XmlFile::child_text(info, "cpacsVersion"); !v.empty()) version = v;
  if (!version.empty() && version.front() != '2' && version.front() != '3')
    file_.fail(header, "CPACS version " + version + " is not supported; supported are versions 2 and 3");
  file_.warn_unknown(root.child("vehicles"), "xsi:type uID", {"aircraft engines profiles", k_no_shape});
}

bool Reader::is_mirrored(const Node& component) {
  const std::string symmetry = file_.text(component, "symmetry");
  if (symmetry.empty() || symmetry == "none" || symmetry == "inherit") return false;
  if (symmetry != "x-z-plane") file_.fail(component, "only symmetry to the x-z-plane is supported, not '" + symmetry + "'");
  return true;
}

/// Returns the component's translation, added to those of its parents if it is relative to them (translations only, as in TiGL).
Vec3 Reader::translation_of(const Node& component, std::set<std::string>& visited) {
  const Transformation own = read_transformation(document_, component);
  const std::string parent_uid = XmlFile::child_text(component, "parentUID");
  if (own.is_absolute || parent_uid.empty()) return own.translation;
  Node parent = document_.find(parent_uid);
  if (!parent) {
    file_.report(component.child("parentUID"),
                 "the file has no element with the uID '" + parent_uid + "'; the component is placed from the origin of the aircraft instead");
    return own.translation;
  }
  const auto is_component = [](const Node& node) {
    return std::any_of(std::begin(k_component_tags), std::end(k_component_tags), [&](const char* tag) { return std::string_view(node.name()) == tag; });
  };
  while (parent && !is_component(parent)) parent = parent.parent();
  if (!parent) return own.translation;  // the aircraft itself
  if (!visited.insert(parent_uid).second) file_.fail(component, "the component is its own parent through '" + parent_uid + "'");
  return own.translation + translation_of(parent, visited);
}

Transform Reader::location_of(const Node& component) {
  Transformation t = read_transformation(document_, component);
  std::set<std::string> visited;
  t.translation = translation_of(component, visited);
  return t.matrix();
}

/// Returns the positions of the sections. Each position is given relative to another section by length, sweep and dihedral.
std::map<std::string, Vec3> Reader::positionings(const Node& component) {
  struct Step {
    Node node;
    std::string from;
    Vec3 vector;
  };
  std::map<std::string, Step> steps;
  for (const Node node : component.child("positionings").children("positioning")) {
    const double length = file_.required_child_number(node, "length");
    const double sweep = k_degree * file_.child_number(node, "sweepAngle", 0.0), dihedral = k_degree * file_.child_number(node, "dihedralAngle", 0.0);
    const std::string to = XmlFile::child_text(node, "toSectionUID");
    if (to.empty()) file_.fail(node, "the element 'toSectionUID' is missing");
    const Vec3 vector = length * Vec3{std::sin(sweep), std::cos(sweep) * std::cos(dihedral), std::cos(sweep) * std::sin(dihedral)};
    if (!steps.emplace(to, Step{node, XmlFile::child_text(node, "fromSectionUID"), vector}).second)
      file_.fail(node, "section '" + to + "' is positioned twice");
  }
  std::set<std::string> sections;
  for (const Node section : component.child("sections").children("section")) sections.insert(file_.text(section, "uID"));
  std::map<std::string, Vec3> positions;
  for (const auto& [section, step] : steps) {
    if (!sections.contains(section)) file_.report(step.node, "the component has no section '" + section + "'; this positioning has no effect");
    if (!step.from.empty() && !sections.contains(step.from) && !steps.contains(step.from))
      file_.fail(step.node, "section '" + section + "' is positioned from '" + step.from + "', but the component has no such section");
    Vec3 sum;
    std::string at = section;
    for (std::size_t n = 0; steps.contains(at); ++n) {
      if (n > steps.size()) file_.fail(step.node, "the positionings of section '" + section + "' form a cycle");
      sum += steps.at(at).vector;
      at = steps.at(at).from;
    }
    positions.emplace(section, sum);
  }
  return positions;
}

/// Returns the elements from the first to the last one along the segments.
std::vector<Reader::Element> Reader::chain(const Node& component) {
  struct Link {
    Node node;
    std::string to;
  };
  std::map<std::string, Link> next;
  std::set<std::string> targets;
  std::vector<std::string> order;
  for (const Node node : component.child("segments").children("segment")) {
    file_.warn_unknown(node, "uID xsi:type", {"name description fromElementUID toElementUID guideCurves", k_no_shape});
    if (node.child("guideCurves")) file_.report(node.child("guideCurves"), "guide curves are not supported; the segment is made from its sections alone");
    const std::string from = XmlFile::child_text(node, "fromElementUID"), to = XmlFile::child_text(node, "toElementUID");
    if (!next.emplace(from, Link{node, to}).second) file_.fail(node, "two segments begin at element '" + from + "'; branched components are not supported");
    if (!targets.insert(to).second) file_.fail(node, "two segments end at element '" + to + "'; branched components are not supported");
    order.push_back(from);
  }
  const auto first = std::find_if(order.begin(), order.end(), [&](const std::string& uid) { return !targets.contains(uid); });
  if (first == order.end()) file_.fail(component, order.empty() ? "the component has no segments" : "the segments form a cycle");
  std::vector<std::string> uids{*first};
  while (next.contains(uids.back())) uids.push_back(next.at(uids.back()).to);
  if (uids.size() != next.size() + 1)
    file_.fail(component,
               "the segments are not one chain: " + std::to_string(uids.size() - 1) + " of " + std::to_string(next.size()) + " follow from '" + *first + "'");
  const std::map<std::string, Vec3> positions = positionings(component);
  std::vector<Element> elements;
  for (const std::string& uid : uids) {
    const Node element = document_.resolve(component, uid);
    const Node section = element.parent().parent();
    if (std::string_view(element.name()) != "element" || std::string_view(section.name()) != "section")
      file_.fail(element, "segments must join elements of sections; this element is '" + std::string(element.name()) + "'");
    const auto position = positions.find(file_.text(section, "uID"));
    elements.push_back({element, translation(position == positions.end() ? Vec3{} : position->second) * read_transformation(document_, section).matrix() *
                                     read_transformation(document_, element).matrix()});
  }
  return elements;
}

void Reader::wing(const Node& node, bool is_pylon) {
  file_.warn_unknown(node, "uID symmetry xsi:type", {"name description parentUID transformation sections positionings segments componentSegments", k_no_shape});
  Wing wing;
  wing.name = file_.required_text(node, "uID");
  wing.is_pylon = is_pylon;
  wing.right_tip = wing.left_tip = {CapShape::strip, 0.0};
  const Transform location = location_of(node);
  const std::vector<Element> elements = chain(node);
  double size = 0.0;
  for (const Element& element : elements) {
    WingSection section;
    section.name = file_.text(element.node, "uID");
    section.airfoil = XmlFile::child_text(element.node, "airfoilUID");
    section.points = read_airfoil(document_, element.node, section.airfoil);
    const Transform map = location * element.location;
    for (const Uv p : section.points) section.loop.push_back(map.point({p.u, 0.0, p.v}));
    section.leading_edge = map.point({});
    section.chord = norm(map.vector({1.0, 0.0, 0.0}));
    if (!(section.chord > 0.0)) file_.fail(element.node, "the section has no chord");
    section.points.clear();
    for (const Point& p : section.loop) size = std::max(size, norm(p - section.loop.front()));
    wing.sections.push_back(std::move(section));
  }
  const auto distance_from_plane = [](const WingSection& section) {
    double distance = 0.0;
    for (const Point& p : section.loop) distance = std::max(distance, std::abs(p.y));
    return distance;
  };
  bool is_turned = false;
  if (is_mirrored(node)) {
    const bool is_first_in_plane = distance_from_plane(wing.sections.front()) <= k_in_plane * size;
    wing.is_symmetric = is_first_in_plane || distance_from_plane(wing.sections.back()) <= k_in_plane * size;
    wing.has_mirror_image = !wing.is_symmetric;
    if (is_first_in_plane) {  // our symmetric wings end there
      std::reverse(wing.sections.begin(), wing.sections.end());
      is_turned = true;
    }
    if (wing.is_symmetric)
      for (Point& p : wing.sections.back().loop) p.y = 0.0;
  }
  devices(node, wing, elements, is_turned);
  reading_.aircraft.wings.push_back(std::move(wing));
}

/// Reads control surfaces. Their borders are given in fractions of the span of their component segment, or of another element.
void Reader::devices(const Node& node, const Wing& wing, const std::vector<Element>& elements, bool is_turned) {
  std::vector<double> span{0.0};    // along the mid chord, as WingSpan measures the span
  std::vector<double> across{0.0};  // the same length seen along x, as CPACS measures eta
  const auto middle = [&](std::size_t i) {
    const WingSection& s = wing.sections[is_turned ? elements.size() - 1 - i : i];
    return 0.5 * (s.loop.front() + s.leading_edge);
  };
  for (std::size_t i = 1; i < elements.size(); ++i) {
    const Vec3 step = middle(i) - middle(i - 1);
    span.push_back(span.back() + norm(step));
    across.push_back(across.back() + std::hypot(step.y, step.z));
  }
  const auto span_at = [&](std::size_t from, std::size_t to, double eta) {
    const double target = across[from] + eta * (across[to] - across[from]);
    std::size_t i = 1;
    while (i + 1 < across.size() && target > across[i]) ++i;
    const double length = across[i] - across[i - 1];
    return (span[i - 1] + (length > 0.0 ? (target - across[i - 1]) / length : 0.0) * (span[i] - span[i - 1])) / span.back();
  };
  const auto index_of = [&](const Node& from, const std::string& uid) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (file_.text(elements[i].node, "uID") == uid) return i;
    file_.fail(from, "element '" + uid + "' is not in the wing");
  };
  for (const Node segment : node.child("componentSegments").children("componentSegment")) {
    file_.warn_unknown(segment, "uID xsi:type", {"name description fromElementUID toElementUID controlSurfaces", k_no_shape});
    const Node surfaces = segment.child("controlSurfaces");
    file_.warn_unknown(surfaces, "xsi:type", "trailingEdgeDevices leadingEdgeDevices spoilers");  // closed spoilers are part of the wing's skin
    for (const char* list : {"trailingEdgeDevices", "leadingEdgeDevices"}) {
      const bool is_trailing = list[0] == 't';
      for (const Node device : surfaces.child(list).children(is_trailing ? "trailingEdgeDevice" : "leadingEdgeDevice")) {
        or_leave_out("control surface", [&] {
          ControlSurface surface;
          surface.name = file_.required_text(device, "uID");
          surface.wing = wing.name;
          surface.kind = is_trailing ? ControlKind::trailing_edge : ControlKind::leading_edge;
          const Node shape = device.child("outerShape");
          for (const char* side : {"innerBorder", "outerBorder"}) {
            const Node border = shape.child(side);
            if (!border) file_.fail(device, std::string("the outer shape has no ") + side);
            const auto value = [&](const char* tag, const char* inner) {
              const Node at = border.child(tag);
              if (!at) file_.fail(border, std::string("the element '") + tag + "' is missing");
              return at.child(inner) ? file_.child_number(at, inner, 0.0) : file_.child_number(border, tag, 0.0);
            };
            // The border may be omitted at one of the two ends. The control surface then ends parallel to the flow.
            const char* const other = is_trailing ? "etaTE" : "etaLE";
            const char* hinge_eta = is_trailing ? "etaLE" : "etaTE";
            if (!border.child(hinge_eta) && border.child(other)) hinge_eta = other;
            const double eta = value(hinge_eta, "eta"), xsi = value(is_trailing ? "xsiLE" : "xsiTE", "xsi");
            const double other_eta = border.child(other) ? value(other, "eta") : eta;
            if (other_eta != eta)
              file_.report(border,
                           "the border is placed along the flow direction at " + std::string(hinge_eta) + "; its other end is at " + exact_text(other_eta));
            const std::string reference_uid = XmlFile::child_text(border.child(hinge_eta), "referenceUID");
            Node reference = document_.find(reference_uid);
            if (!reference && !reference_uid.empty())
              file_.report(border, "the file has no element with the uID '" + reference_uid + "'; the border is taken along this component segment instead");
            if (!reference || !reference.child("fromElementUID")) reference = segment;
            const std::size_t from = index_of(reference, XmlFile::child_text(reference, "fromElementUID")),
                              to = index_of(reference, XmlFile::child_text(reference, "toElementUID"));
            const double at = span_at(from, to, eta);
            const double along = is_turned ? 1.0 - at : at;
            surface.hinge.push_back({wing.is_symmetric ? 0.5 * along : along, xsi});
          }
          if (is_trailing && surface.hinge[0].chord == 0.0 && surface.hinge[1].chord == 0.0) surface.kind = ControlKind::all_moving;
          surface.has_image = wing.is_symmetric || wing.has_mirror_image;
          std::sort(surface.hinge.begin(), surface.hinge.end(), [](const HingePoint& a, const HingePoint& b) { return a.span < b.span; });
          reading_.aircraft.control_surfaces.push_back(std::move(surface));
        });
      }
    }
  }
}

void Reader::fuselage(const Node& node) {
  file_.warn_unknown(node, "uID symmetry xsi:type", {"name description parentUID transformation sections positionings segments", k_no_shape});
  Body body;
  body.name = file_.required_text(node, "uID");
  body.has_mirror_image = is_mirrored(node);
  const Transform location = location_of(node);
  for (const Element& element : chain(node)) {
    BodyFrame frame;
    frame.name = file_.text(element.node, "uID");
    frame.shape = FrameShape::loop;
    const Transform map = location * element.location;
    for (const Uv p : read_fuselage_profile(document_, element.node, XmlFile::child_text(element.node, "profileUID")))
      frame.loop.push_back(map.point({0.0, p.u, p.v}));
    Point low = frame.loop.front(), high = low;
    for (const Point& p : frame.loop)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    frame.center = 0.5 * (low + high);
    frame.width = high.y - low.y;
    frame.height = high.z - low.z;
    body.frames.push_back(std::move(frame));
  }
  reading_.aircraft.bodies.push_back(std::move(body));
}

void Reader::engine(const Node& node) {
  file_.warn_unknown(node, "uID symmetry xsi:type", {"name description engineUID parentUID transformation", k_no_shape});
  const Node engine = document_.resolve(node, XmlFile::child_text(node, "engineUID"));
  const Node nacelle = engine.child("nacelle");
  if (!nacelle.child("fanCowl") && !nacelle.child("coreCowl") && !nacelle.child("centerCowl")) {
    file_.report(engine, "the engine has no cowls and is left out");
    return;
  }
  CowlNacelle read = read_nacelle(document_, node, location_of(node));
  read.has_mirror_image = is_mirrored(node);
  reading_.aircraft.nacelles.push_back(std::move(read));
}

void Reader::read_model(const Node& model) {
  Aircraft& aircraft = reading_.aircraft;
  file_.warn_unknown(model, "uID xsi:type", {"name description reference wings fuselages enginePylons engines landingGear landingGears", k_no_shape});
  if (model.child("landingGear") || model.child("landingGears"))
    reading_.notes.emplace_back("the landing gear is assumed to be retracted and is not part of the shape");
  aircraft.name = file_.text(model, "uID");
  if (const Node reference = model.child("reference")) {
    if (reference.child("area")) aircraft.reference_area = file_.child_number(reference, "area", 0.0);
    if (reference.child("length")) aircraft.reference_length = file_.child_number(reference, "length", 0.0);
    if (reference.child("point")) aircraft.reference_point = read_vector(file_, reference.child("point"), {});
  }
  for (const Node node : model.child("fuselages").children("fuselage")) fuselage(node);
  for (const Node node : model.child("wings").children("wing")) wing(node, false);
  for (const Node node : model.child("enginePylons").children("enginePylon")) or_leave_out("pylon", [&] { wing(node, true); });
  for (const Node node : model.child("engines").children("engine")) or_leave_out("engine", [&] { engine(node); });
}

AircraftReading Reader::read() {
  header();
  const Node aircraft = file_.root().child("vehicles").child("aircraft");
  const Node model = aircraft.child("model");
  if (!model) file_.fail(file_.root(), "the file has no aircraft model");
  for (Node other = model.next_sibling("model"); other; other = other.next_sibling("model"))
    file_.report(other, "only the first model is read; this model was left out");
  read_model(model);
  if (reading_.aircraft.wings.empty() && reading_.aircraft.bodies.empty() && reading_.aircraft.nacelles.empty())
    file_.fail(model, "the model has no wing, fuselage or nacelle");
  reading_.messages = std::move(file_.messages());
  return std::move(reading_);
}

}  // namespace
}  // namespace cpacs

AircraftReading read_cpacs(const std::filesystem::path& path, const RunContext& context) {
  context.check_stop();
  AircraftReading reading = cpacs::Reader(path).read();
  for (const std::string& message : reading.messages) context.warn(path.filename().string() + ": " + message);
  for (const std::string& note : reading.notes) context.info(path.filename().string() + ": " + note);
  return reading;
}

}  // namespace sterna
