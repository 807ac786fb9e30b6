// Reads nacelles of CPACS engines: rings of sections about the x axis, and a center body. Translations of sections are given in the cylindrical coordinates
// angle, x and radius.
#include <algorithm>
#include <cmath>

#include <pugixml.hpp>

#include "geom/model/cpacs_parts.h"

namespace sterna::cpacs {
namespace {

using Node = pugi::xml_node;

CowlSection read_section(Document& document, const Node& node) {
  XmlFile& file = document.file;
  file.warn_unknown(node, "uID xsi:type", "name description transformation profileUID");
  CowlSection section;
  section.name = file.text(node, "uID");
  const Transformation t = read_transformation(document, node);
  section.angle = t.translation.x * k_degree;
  if (norm(t.rotation) > 0.0) file.report(node, "rotations of nacelle sections are not supported; this rotation was ignored");
  for (const Uv p : read_curve_profile(document, node, XmlFile::child_text(node, "profileUID")))
    section.profile.push_back({t.scaling.x * p.u + t.translation.y, t.scaling.y * p.v + t.translation.z});
  orient(section.profile, -1.0);  // the inner side comes first
  for (const Uv p : section.profile)
    if (p.v < 0.0) file.fail(node, "the section extends beyond the axis: radius " + exact_text(p.v) + " m at x = " + exact_text(p.u) + " m");
  return section;
}

Cowl read_cowl(Document& document, const Node& node) {
  XmlFile& file = document.file;
  file.warn_unknown(node, "uID xsi:type", "name description sections guideCurves rotationCurve");
  Cowl cowl;
  cowl.name = file.text(node, "uID");
  for (const Node section : node.child("sections").children("section")) cowl.sections.push_back(read_section(document, section));
  if (cowl.sections.empty()) file.fail(node, "the cowl has no section");
  std::stable_sort(cowl.sections.begin(), cowl.sections.end(), [](const CowlSection& a, const CowlSection& b) { return a.angle < b.angle; });
  if (node.child("guideCurves")) file.report(node.child("guideCurves"), "guide curves are not supported; the cowl is a smooth ring through its sections");
  if (node.child("rotationCurve")) file.report(node.child("rotationCurve"), "rotation curves are not supported; the inner side follows the sections");
  return cowl;
}

}  // namespace

CowlNacelle read_nacelle(Document& document, const Node& installed, const Transform& placement) {
  XmlFile& file = document.file;
  const Node engine = document.resolve(installed, XmlFile::child_text(installed, "engineUID"));
  CowlNacelle nacelle;
  nacelle.name = file.required_text(installed, "uID");
  nacelle.placement = placement;
  const Node node = engine.child("nacelle");
  file.warn_unknown(node, "uID xsi:type", "name description fanCowl coreCowl centerCowl");
  for (const char* tag : {"fanCowl", "coreCowl"})
    if (const Node cowl = node.child(tag)) nacelle.cowls.push_back(read_cowl(document, cowl));
  if (const Node center = node.child("centerCowl")) {
    file.warn_unknown(center, "uID xsi:type", "name description xOffset curveUID");
    const double offset = file.child_number(center, "xOffset", 0.0);
    for (const Uv p : read_curve_profile(document, center, XmlFile::child_text(center, "curveUID"))) nacelle.center_body.push_back({p.u + offset, p.v});
    if (nacelle.center_body.front().u > nacelle.center_body.back().u) std::reverse(nacelle.center_body.begin(), nacelle.center_body.end());
  }
  return nacelle;
}

}  // namespace sterna::cpacs
