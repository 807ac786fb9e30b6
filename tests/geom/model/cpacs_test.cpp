// Reader of CPACS: all real files, transformations and profiles by hand, errors with their location.
#include "geom/model/cpacs.h"
#include "geom/model/components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "geom/base/error.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using testing::Contains;
using testing::HasSubstr;

AircraftReading read_real(const std::string& name) { return read_cpacs(test::shared_data() / "cpacs" / name, RunContext()); }

AircraftReading read_cpacs_text(const std::string& text) {
  const auto path = test::scratch() / "case.xml";
  std::ofstream(path) << text;
  return read_cpacs(path, RunContext());
}

const WingSection& tip_of(const Wing& wing) { return wing.sections.front(); }
const WingSection& root_of(const Wing& wing) { return wing.sections.back(); }

struct CpacsCounts {
  const char* name;
  std::size_t fuselages, wings, nacelles, controls;
};
class CpacsFiles : public testing::TestWithParam<CpacsCounts> {};

TEST_P(CpacsFiles, AreReadWithEveryComponent) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_real(GetParam().name).aircraft;
  EXPECT_EQ(aircraft.bodies.size(), GetParam().fuselages);
  EXPECT_EQ(aircraft.wings.size(), GetParam().wings);
  EXPECT_EQ(aircraft.nacelles.size(), GetParam().nacelles);
  EXPECT_EQ(aircraft.control_surfaces.size(), GetParam().controls);
  for (const Wing& wing : aircraft.wings)
    for (const WingSection& section : wing.sections) EXPECT_GE(section.loop.size(), 5u);
  for (const ControlSurface& surface : aircraft.control_surfaces)
    for (const HingePoint& point : surface.hinge) {
      EXPECT_TRUE(point.span >= 0.0 && point.span <= 1.0) << surface.name << " " << point.span;
      EXPECT_TRUE(point.chord >= 0.0 && point.chord < 1.0) << surface.name;
    }
}

// Component counts, counted in the files; pylons count as wings.
INSTANTIATE_TEST_SUITE_P(all_twelve, CpacsFiles,
                         testing::Values(CpacsCounts{"CPACS_30_D150.xml", 1, 3, 0, 5}, CpacsCounts{"boxWing.xml", 1, 2, 0, 1},
                                         CpacsCounts{"canards.xml", 1, 1, 0, 1}, CpacsCounts{"d150.xml", 1, 3, 0, 5},
                                         CpacsCounts{"landingGears.xml", 1, 1, 0, 0}, CpacsCounts{"nacelles.xml", 0, 1, 4, 0},
                                         CpacsCounts{"onera_m6.xml", 1, 1, 0, 0}, CpacsCounts{"simpletest-flaps.cpacs.xml", 1, 1, 0, 3},
                                         CpacsCounts{"simpletest-halfmodel.cpacs.xml", 1, 1, 0, 0}, CpacsCounts{"simpletest-nacelle.xml", 1, 1, 0, 0},
                                         CpacsCounts{"simpletest-pylon-nacelle.cpacs.xml", 1, 2, 1, 0}, CpacsCounts{"simpletest.cpacs.xml", 1, 1, 0, 0}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
                           return name;
                         });

TEST(Cpacs, OneraM6IsAtItsPosition) {
  STERNA_NEEDS_SHARED_DATA();
  const Wing wing = read_real("onera_m6.xml").aircraft.wings.at(0);
  EXPECT_TRUE(wing.is_symmetric);
  ASSERT_EQ(wing.sections.size(), 2u);
  EXPECT_NEAR(root_of(wing).chord, 0.8059, 1e-12);
  EXPECT_NEAR(tip_of(wing).chord, 0.4513, 1e-12);
  EXPECT_NEAR(tip_of(wing).leading_edge.y, 1.1963 * std::cos(M_PI / 6), 1e-12);  // length and sweep from the file
  EXPECT_NEAR(tip_of(wing).leading_edge.x, 1.1963 * 0.5, 1e-12);
  // The airfoil runs from the trailing edge over the upper side.
  const auto highest = std::max_element(wing.sections[0].loop.begin(), wing.sections[0].loop.end(), [](const Point& a, const Point& b) { return a.z < b.z; });
  EXPECT_LT(highest - wing.sections[0].loop.begin(), std::ssize(wing.sections[0].loop) / 2);
}

TEST(Cpacs, FinIsTurnedFirstAboutItsAxes) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_real("d150.xml").aircraft;
  const Wing& fin = aircraft.wings.at(2);
  EXPECT_EQ(fin.name, "Wing3V");
  EXPECT_FALSE(fin.is_symmetric || fin.has_mirror_image);
  for (const WingSection& section : fin.sections) EXPECT_NEAR(section.leading_edge.y, 0.0, 0.01);  // the file itself is 2 mm off
  EXPECT_GT(fin.sections.back().leading_edge.z, fin.sections.front().leading_edge.z + 4.0);
  EXPECT_EQ(aircraft.reference_area, 122.4);
}

TEST(Cpacs, ChildrenMoveWithParentsUnlessAbsolute) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_real("simpletest-pylon-nacelle.cpacs.xml").aircraft;
  const Wing& pylon = aircraft.wings.at(1);
  EXPECT_TRUE(pylon.is_pylon);
  EXPECT_NEAR(aircraft.nacelles.at(0).placement.shift.y, 1.0, 1e-12);  // the pylon's shift
  EXPECT_NEAR(aircraft.nacelles[0].placement.shift.z, -0.12 - 0.41, 1e-12);
  EXPECT_EQ(aircraft.nacelles[0].cowls.at(0).sections.size(), 3u);
  EXPECT_EQ(aircraft.nacelles[0].center_body.size(), 4u);
}

TEST(Cpacs, OmittedElementsAreNamed) {
  STERNA_NEEDS_SHARED_DATA();
  EXPECT_THAT(read_real("simpletest-nacelle.xml").messages, Contains(HasSubstr("/genericGeometryComponents: this element is not known and was left out")));
  EXPECT_THAT(read_real("landingGears.xml").messages, testing::IsEmpty());
  EXPECT_THAT(read_real("landingGears.xml").notes, testing::ElementsAre(HasSubstr("landing gear is assumed to be retracted")));
  EXPECT_THAT(read_real("nacelles.xml").messages, Contains(HasSubstr("guide curves are not supported")));
  EXPECT_THAT(read_real("boxWing.xml").messages, Contains(HasSubstr("the engine has no cowls")));
}

TEST(Cpacs, ControlSurfacesBecomePatchesOnBothHalves) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_real("simpletest-flaps.cpacs.xml").aircraft;
  const Model model = make_components(aircraft, RunContext());
  // In the file: InnerLED from eta 0.1 to 0.41 (at its hinge) of the half span, 2 m; hinge at 0.08 .. 0.1 of the chord.
  for (const auto& [name, side] : {std::pair{"InnerLED", 1.0}, std::pair{"InnerLEDLeft", -1.0}}) {
    double low = 10.0, high = 0.0;
    for (const ModelFace& face : model.faces) {
      if (face.name != name) continue;
      EXPECT_EQ(face.role, FaceRole::control);
      for (const EdgeUse& use : face.borders.at(0))
        for (const CornerId c : {model.edges[use.edge].start, model.edges[use.edge].end}) {
          low = std::min(low, side * model.corners[c].point.y);
          high = std::max(high, side * model.corners[c].point.y);
        }
    }
    EXPECT_NEAR(low, 0.2, 1e-9) << name;
    EXPECT_NEAR(high, 0.82, 1e-9) << name;
  }
  for (const char* flap : {"FlapInner", "FlapInnerLeft", "FlapOuter", "FlapOuterLeft"})
    EXPECT_TRUE(std::any_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& f) { return f.name == flap; })) << flap;
}

/// Returns a file of a wing with two sections; `section` is inserted into the first one, `profiles` after the wing.
std::string wing_file(const std::string& element, const std::string& airfoil, const std::string& positionings = "", const std::string& wing = "uID='W'") {
  const auto section = [&](const std::string& n, const std::string& inside) {
    return "<section uID='S" + n + "'><elements><element uID='E" + n + "'><airfoilUID>A</airfoilUID>" + inside + "</element></elements></section>\n";
  };
  return "<cpacs><header><cpacsVersion>3.2</cpacsVersion></header><vehicles><aircraft><model uID='M'><wings><wing " + wing + ">\n<sections>" +
         section("1", element) + section("2", "") + "</sections><positionings>" + positionings +
         "<positioning><length>2</length><toSectionUID>S2</toSectionUID></positioning></positionings>"
         "<segments><segment uID='G'><fromElementUID>E1</fromElementUID><toElementUID>E2</toElementUID></segment></segments></wing></wings></model></aircraft>"
         "<profiles><wingAirfoils><wingAirfoil uID='A'>" +
         airfoil + "</wingAirfoil></wingAirfoils></profiles></vehicles></cpacs>";
}
const char* const k_diamond = "<pointList><x>1;0.5;0;0.5;1</x><y>0;0;0;0;0</y><z>0;-0.1;0;0.1;0</z></pointList>";

TEST(Cpacs, ElementsAreScaledThenTurnedThenMoved) {
  const Wing wing =
      read_cpacs_text(
          wing_file(
              "<transformation><scaling><x>2</x><z>3</z></scaling><rotation><x>90</x><z>90</z></rotation><translation><y>5</y></translation></transformation>",
              k_diamond))
          .aircraft.wings[0];
  // x' y' z'': rotation about z first, then about x. (1, 0, 0) -> (2, 0, 0) -> (0, 2, 0) -> (0, 0, 2); (0, 0, 1) -> (0, 0, 3) -> (0, -3, 0).
  const std::vector<Point>& loop = wing.sections[0].loop;
  EXPECT_NEAR(distance(loop[0], {0.0, 5.0, 2.0}), 0.0, 1e-12);
  EXPECT_NEAR(distance(loop[1], {0.0, 5.0 - 0.3, 1.0}), 0.0, 1e-12);  // the upper side comes first, although the file lists the lower side first
  EXPECT_NEAR(wing.sections[0].chord, 2.0, 1e-12);
  EXPECT_NEAR(wing.sections[1].leading_edge.y, 2.0, 1e-12);
}

TEST(Cpacs, WingsAtSymmetryPlaneJoinOthersAreMirrored) {
  const Wing whole = read_cpacs_text(wing_file("", k_diamond, "", "uID='W' symmetry='x-z-plane'")).aircraft.wings[0];
  EXPECT_TRUE(whole.is_symmetric);
  EXPECT_NEAR(whole.sections[0].leading_edge.y, 2.0, 1e-12);  // the tip comes first
  const Wing apart =
      read_cpacs_text(wing_file("<transformation><translation><y>0.5</y></translation></transformation>", k_diamond, "", "uID='W' symmetry='x-z-plane'"))
          .aircraft.wings[0];
  EXPECT_TRUE(apart.has_mirror_image);
  EXPECT_FALSE(apart.is_symmetric);
}

TEST(Cpacs, ClassShapeAirfoilsHaveTheirThickness) {
  // N1 = 0.5, N2 = 1, B = {a, a}: z = a sqrt(x) (1 - x), largest at x = 1/3.
  const Wing wing =
      read_cpacs_text(
          wing_file(
              "",
              "<cst2D><upperN1>0.5</upperN1><upperN2>1</upperN2><upperB>0.2;0.2</upperB><lowerN1>0.5</lowerN1><lowerN2>1</lowerN2><lowerB>-0.1;-0.1</lowerB>"
              "<trailingEdgeThickness>0.01</trailingEdgeThickness></cst2D>"))
          .aircraft.wings[0];
  const std::vector<Point>& loop = wing.sections[0].loop;
  EXPECT_NEAR(loop.front().z, 0.005, 1e-12);
  EXPECT_NEAR(loop.back().z, -0.005, 1e-12);
  for (const Point& p : loop) {
    const double shape = std::sqrt(p.x) * (1.0 - p.x);
    EXPECT_TRUE(std::abs(p.z - (0.2 * shape + 0.005 * p.x)) < 1e-12 || std::abs(p.z - (-0.1 * shape - 0.005 * p.x)) < 1e-12) << p.x << " " << p.z;
  }
}

/// Returns the diamond wing of wing_file with one trailing-edge device.
std::string file_with_device(const std::string& inner, const std::string& outer, const std::string& from = "E1") {
  std::string text = wing_file("", k_diamond);
  text.insert(text.find("</wing>"),
              "<componentSegments><componentSegment uID='C'><fromElementUID>" + from +
                  "</fromElementUID><toElementUID>E2</toElementUID><structure/><controlSurfaces><trailingEdgeDevices>"
                  "<trailingEdgeDevice uID='Flap'><outerShape><innerBorder>" +
                  inner + "</innerBorder><outerBorder>" + outer +
                  "</outerBorder></outerShape></trailingEdgeDevice></trailingEdgeDevices></controlSurfaces></componentSegment></componentSegments>");
  return text;
}

TEST(Cpacs, BordersMayOmitTheirOtherEnd) {
  const AircraftReading both =
      read_cpacs_text(file_with_device("<etaLE>0.2</etaLE><etaTE>0.2</etaTE><xsiLE>0.7</xsiLE>", "<etaLE>0.6</etaLE><etaTE>0.6</etaTE><xsiLE>0.7</xsiLE>"));
  ASSERT_EQ(both.aircraft.control_surfaces.size(), 1u);
  EXPECT_THAT(both.messages, testing::IsEmpty());  // structural elements are not geometry
  for (const char* tag : {"etaLE", "etaTE"}) {
    const auto border = [&](const std::string& eta) { return "<" + std::string(tag) + ">" + eta + "</" + tag + "><xsiLE>0.7</xsiLE>"; };
    const AircraftReading one = read_cpacs_text(file_with_device(border("0.2"), border("0.6")));
    ASSERT_EQ(one.aircraft.control_surfaces.size(), 1u) << tag;
    for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(one.aircraft.control_surfaces[0].hinge[k].span, both.aircraft.control_surfaces[0].hinge[k].span) << tag;
    EXPECT_THAT(one.messages, testing::IsEmpty());
  }
}

TEST(Cpacs, UnreadableDevicesAndPylonsAreOmittedWithWarning) {
  const std::string border = "<etaLE>0.2</etaLE><xsiLE>0.7</xsiLE>";
  for (const auto& [text, problem] :
       {std::pair{file_with_device("<xsiLE>0.7</xsiLE>", border), "the element 'etaLE' is missing; the control surface is left out"},
        std::pair{file_with_device(border, border, "E9"), "element 'E9' is not in the wing; the control surface is left out"}}) {
    const AircraftReading reading = read_cpacs_text(text);
    EXPECT_EQ(reading.aircraft.wings.size(), 1u);
    EXPECT_EQ(reading.aircraft.control_surfaces.size(), 0u);
    EXPECT_THAT(reading.messages, testing::ElementsAre(HasSubstr(problem)));
  }
  std::string text = wing_file("", k_diamond);
  text.insert(text.find("</wings>") + 8, "<enginePylons><enginePylon uID='P'><name>no segments</name></enginePylon></enginePylons>");
  const AircraftReading reading = read_cpacs_text(text);
  EXPECT_EQ(reading.aircraft.wings.size(), 1u);
  EXPECT_THAT(reading.messages, testing::ElementsAre(HasSubstr("enginePylon[P]: the component has no segments; the pylon is left out")));
}

TEST(Cpacs, ErrorsNameLineAndPath) {
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      read_cpacs_text(text);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::file_malformed);
      return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  };
  EXPECT_THAT(error_of(wing_file("", "<pointList><x>1;0</x><z>0;0;0</z></pointList>")), HasSubstr("the lists 'x' and 'z' have 2 and 3 numbers"));
  EXPECT_THAT(error_of(wing_file("<transformation><scaling><x>wide</x></scaling></transformation>", k_diamond)),
              HasSubstr("section[S1]/elements/element[E1]/transformation/scaling/x: 'wide' is not a finite number"));
  EXPECT_THAT(
      error_of(wing_file("", k_diamond, "<positioning><length>1</length><fromSectionUID>S1</fromSectionUID><toSectionUID>S1</toSectionUID></positioning>")),
      HasSubstr("form a cycle"));
  EXPECT_THAT(error_of("<cpacs><header><cpacsVersion>1.5</cpacsVersion></header></cpacs>"), HasSubstr("version 1.5 is not supported"));
  EXPECT_THAT(error_of("<cpacs/>"), HasSubstr("no aircraft model"));
  std::string broken = wing_file("", k_diamond);
  broken.replace(broken.find("<airfoilUID>A<"), 14, "<airfoilUID>B<");
  EXPECT_THAT(
      error_of(broken),
      HasSubstr("line 2, /cpacs/vehicles/aircraft/model[M]/wings/wing[W]/sections/section[S1]/elements/element[E1]: the file has no element with the uID 'B'"));
}

/// Returns the file of wing_file with an engine of the given references, and the engine's definition if given.
std::string file_with_engine(const std::string& uid, const std::string& definition) {
  std::string text = wing_file("", k_diamond);
  text.insert(text.find("</model>"), "<engines><engine uID='inst'><engineUID>" + uid + "</engineUID></engine></engines>");
  text.insert(text.find("<profiles>"), "<engines>" + definition + "</engines>");
  return text;
}

TEST(CpacsReferences, MissingEngineIsOmitted) {
  for (const std::string uid : {"nothing", ""}) {
    const AircraftReading reading = read_cpacs_text(file_with_engine(uid, ""));
    EXPECT_EQ(reading.aircraft.wings.size(), 1u);
    EXPECT_TRUE(reading.aircraft.nacelles.empty());
    EXPECT_THAT(reading.messages, Contains(testing::AllOf(HasSubstr("engine[inst]"), HasSubstr("the engine is left out"))));
  }
  // The profile of the cowl is missing.
  const AircraftReading reading = read_cpacs_text(file_with_engine(
      "e",
      "<engine uID='e'><nacelle><fanCowl uID='c'><sections><section uID='s'><profileUID>none</profileUID></section></sections></fanCowl></nacelle></engine>"));
  EXPECT_TRUE(reading.aircraft.nacelles.empty());
  EXPECT_THAT(reading.messages, Contains(testing::AllOf(HasSubstr("'none'"), HasSubstr("the engine is left out"))));
}

TEST(CpacsReferences, AParentThatIsNotThereIsTold) {
  std::string text = wing_file("", k_diamond);
  text.insert(text.find("<sections>"), "<parentUID>gone</parentUID>");
  const AircraftReading reading = read_cpacs_text(text);
  EXPECT_EQ(reading.aircraft.wings.size(), 1u);
  EXPECT_THAT(reading.messages, Contains(testing::AllOf(HasSubstr("'gone'"), HasSubstr("from the origin of the aircraft"))));
}

TEST(CpacsReferences, PositioningsOfSectionsThatAreNotThere) {
  const AircraftReading reading = read_cpacs_text(wing_file("", k_diamond, "<positioning><length>1</length><toSectionUID>S9</toSectionUID></positioning>"));
  EXPECT_THAT(reading.messages, Contains(testing::AllOf(HasSubstr("'S9'"), HasSubstr("no effect"))));
  try {
    read_cpacs_text(
        wing_file("", k_diamond, "<positioning><length>1</length><fromSectionUID>S9</fromSectionUID><toSectionUID>S1</toSectionUID></positioning>"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_malformed);
    EXPECT_THAT(error.info().problem, testing::AllOf(HasSubstr("'S9'"), HasSubstr("no such section")));
  }
}

}  // namespace
}  // namespace sterna
