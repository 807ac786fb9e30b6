// Reader and writer of .smx: all files of sumo, unexpected conventions of the schema, and refused input with its location.
#include "geom/model/smx.h"
#include "geom/model/components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "geom/base/error.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

AircraftReading read_smx_text(const std::string& text) {
  const auto path = test::scratch() / "case.smx";
  std::ofstream(path) << text;
  return read_smx(path, RunContext());
}

std::string malformed(const std::string& text) {
  try {
    read_smx_text(text);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::file_malformed) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

std::string body_with(const std::string& inside, const std::string& attributes = "") {
  return "<Assembly>\n<BodySkeleton name='B' origin='0 0 0' rotation='0 0 0' " + attributes + ">\n" + inside + "\n</BodySkeleton>\n</Assembly>\n";
}
std::string circle_at(double x) {
  return "<BodyFrame name='F" + std::to_string(x) + "' center='" + std::to_string(x) +
         " 0 0' height='1' width='1'><CircularShapeConstraint npoints='7' radius='2'/></BodyFrame>\n";
}

struct SmxCounts {
  const char* name;
  std::size_t bodies, wings, surfaces, controls, engines;
};

class SmxFiles : public testing::TestWithParam<SmxCounts> {};

TEST_P(SmxFiles, AreReadCompletelyAndReadBackEqual) {
  STERNA_NEEDS_SHARED_DATA();
  const SmxCounts& expected = GetParam();
  const AircraftReading first = read_smx(test::shared_data() / "smx" / expected.name, RunContext());
  EXPECT_EQ(first.aircraft.bodies.size(), expected.bodies);
  EXPECT_EQ(first.aircraft.wings.size(), expected.wings);
  EXPECT_EQ(first.aircraft.control_surfaces.size(), expected.surfaces);
  EXPECT_EQ(first.aircraft.controls.size(), expected.controls);
  EXPECT_EQ(first.aircraft.engines.size(), expected.engines);
  const auto copy = test::scratch() / "copy.smx";
  write_smx(first.aircraft, copy);
  const AircraftReading second = read_smx(copy, RunContext());
  EXPECT_TRUE(first.aircraft == second.aircraft);
  EXPECT_EQ(second.aircraft.bodies.size(), first.aircraft.bodies.size());
}

// Element counts, obtained with grep from each file.
INSTANTIATE_TEST_SUITE_P(all_seven, SmxFiles,
                         testing::Values(SmxCounts{"bjet.smx", 4, 4, 5, 4, 2}, SmxCounts{"delta.smx", 3, 2, 3, 3, 1},
                                         SmxCounts{"sumo_empty.smx", 1, 0, 0, 0, 0}, SmxCounts{"torture.smx", 0, 1, 0, 0, 0},
                                         SmxCounts{"underwingnacelle.smx", 1, 0, 0, 0, 0}, SmxCounts{"utility.smx", 4, 3, 5, 4, 0},
                                         SmxCounts{"widebody.smx", 10, 3, 5, 5, 4}),
                         [](const auto& info) { return std::string(info.param.name).substr(0, std::string(info.param.name).find('.')); });

TEST(Smx, MessagesNameLineAndPathOfOddEntries) {
  STERNA_NEEDS_SHARED_DATA();
  EXPECT_THAT(read_smx(test::shared_data() / "smx/widebody.smx", RunContext()).messages, IsEmpty());
  const AircraftReading odd = read_smx(test::shared_data() / "smx/sumo_empty.smx", RunContext());
  EXPECT_THAT(odd.messages, Contains(HasSubstr("line 3, /Assembly/BodySkeleton[test]: attribute 'akimatg' is 'ture'")));
  EXPECT_THAT(odd.messages, Contains(HasSubstr("are in the same plane x = 0")));
  EXPECT_THAT(odd.messages, Contains(HasSubstr("sumo requires 4 frames; the body has 3")));
}

TEST(Smx, FramePointsAreNormalisedShapeStays) {
  STERNA_NEEDS_SHARED_DATA();
  const BodyFrame frame = read_smx(test::shared_data() / "smx/sumo_empty.smx", RunContext()).aircraft.bodies[0].frames[1];
  EXPECT_EQ(frame.name, "FuselageFrame55");
  EXPECT_NEAR(frame.width, 2 * 0.5279, 1e-12);         // the file's largest y
  EXPECT_NEAR(frame.height, 1.3516 - 0.52531, 1e-12);  // its z from 0.52531 to 1.3516
  EXPECT_NEAR(frame.center.z, 0.5 * (1.3516 + 0.52531), 1e-12);
  EXPECT_NEAR(frame.center.z + 0.5 * frame.height * frame.points[1].v, 0.52531, 1e-12);
  EXPECT_NEAR(0.5 * frame.width * frame.points[1].u, 0.020473, 1e-12);
}

TEST(Smx, ShapesReplacePointsCirclesReplaceSizes) {
  const BodyFrame frame = read_smx_text(body_with(circle_at(0) + circle_at(1))).aircraft.bodies[0].frames[0];
  EXPECT_EQ(frame.shape, FrameShape::circle);
  EXPECT_EQ(frame.width, 2.0);  // "radius" is the diameter
  EXPECT_EQ(frame.height, 2.0);
  EXPECT_THAT(frame.points, IsEmpty());
}

TEST(Smx, FramesAreSortedAndLipMakesNoseFlat) {
  const AircraftReading reading =
      read_smx_text(body_with("<NacelleInletLip axialOffset='0.3'/>" + circle_at(3) + circle_at(1) + "<Cap shape='RingCap' height='1' side='south'/>"));
  const Body& body = reading.aircraft.bodies[0];
  EXPECT_LT(body.frames[0].center.x, body.frames[1].center.x);
  EXPECT_THAT(reading.messages, Contains(HasSubstr("sorted by x")));
  ASSERT_TRUE(body.lip);
  EXPECT_EQ(body.lip->axial_offset, 0.3);
  EXPECT_EQ(body.lip->radial_offset, 0.2);
  EXPECT_EQ(body.nose.height, 0.0);
  EXPECT_THAT(reading.messages, Contains(HasSubstr("its front cap is flat")));
}

TEST(Smx, MissingCapsAreFlatDomesOrRoundStrips) {
  const Body body = read_smx_text(body_with(circle_at(0) + circle_at(1))).aircraft.bodies[0];
  EXPECT_EQ(body.nose, (EndCap{CapShape::dome, 0.0}));
  EXPECT_EQ(read_smx_text(body_with(circle_at(0) + circle_at(1) + "<Caps height_north='0.5' height_south='2'/>")).aircraft.bodies[0].nose,
            (EndCap{CapShape::strip, 2.0}));
  const std::string section = "<WingSection name='S' center='0 1 0.5' chord='1' dihedral='0.1'>1 0  0.5 0.06  0 0  0.5 -0.06  1 0</WingSection>\n";
  const auto wing = [&](const std::string& flags) {
    return read_smx_text("<Assembly><WingSkeleton name='W' " + flags + ">" + section + section + "</WingSkeleton></Assembly>").aircraft.wings[0];
  };
  EXPECT_EQ(wing("").left_tip, (EndCap{CapShape::strip, 0.0}));
  EXPECT_EQ(wing("").right_tip, (EndCap{CapShape::strip, 1.0}));
  const Wing symmetric = wing("flags='autosym, cubic'");
  EXPECT_EQ(symmetric.left_tip, (EndCap{CapShape::strip, 1.0}));
  EXPECT_TRUE(symmetric.is_symmetric && symmetric.is_cubic && !symmetric.has_winglet);
  EXPECT_EQ(symmetric.sections[1].leading_edge.y, 0.0);
  EXPECT_EQ(symmetric.sections[1].dihedral, 0.0);
  EXPECT_EQ(symmetric.sections[0].dihedral, 0.1);
}

TEST(Smx, UnknownEntriesAreReportedAndOmitted) {
  const AircraftReading reading = read_smx_text(body_with(circle_at(0) + circle_at(1) + "<Propeller blades='3'/>", "colour='red'"));
  EXPECT_THAT(reading.messages, Contains(HasSubstr("/Assembly/BodySkeleton[B]/Propeller: this element is not known")));
  EXPECT_THAT(reading.messages, Contains(HasSubstr("attribute 'colour' is not known")));
}

TEST(Smx, DanglingReferencesAreReported) {
  const AircraftReading reading =
      read_smx_text("<Assembly><BodySkeleton name='B'>" + circle_at(0) + circle_at(1) +
                    "</BodySkeleton><ControlSystem><ControlSrf name='Flap' wing='Nowhere' type='TEF'><Hingepoint spanpos='0.1' chordpos='0.7'/><Hingepoint "
                    "spanpos='0.2' chordpos='0.7'/>"
                    "</ControlSrf><Control name='C'><Participation id='FlapSegment7' factor='1'/></Control></ControlSystem></Assembly>");
  EXPECT_THAT(reading.messages, Contains(HasSubstr("there is no wing 'Nowhere'")));
  EXPECT_THAT(reading.messages, Contains(HasSubstr("'FlapSegment7'")));
}

TEST(Smx, ErrorsNameLineAndPath) {
  EXPECT_THAT(malformed("<Assembly>\n<BodySkeleton name='B'>\n</Assembly>"), HasSubstr("line 3, column"));
  EXPECT_THAT(malformed(body_with("<BodyFrame name='F' center='0 0 0' height='-1' width='1'/>")),
              HasSubstr("line 3, /Assembly/BodySkeleton[B]/BodyFrame[F]: attribute 'height' is -1; it must be positive"));
  EXPECT_THAT(malformed(body_with("<BodyFrame name='F' center='0 zero 0' height='1' width='1'/>")), HasSubstr("'zero' is not a finite number"));
  EXPECT_THAT(malformed(body_with("<BodyFrame name='F' center='0 0' height='1' width='1'/>")), HasSubstr("has 2 numbers instead of 3"));
  EXPECT_THAT(malformed(body_with("<BodyFrame name='F' center='0 0 0' height='1' width='1'> 0 -1 1 0 0.5 </BodyFrame>")),
              HasSubstr("5 numbers cannot form pairs"));
  EXPECT_THAT(malformed(body_with("<BodyFrame name='F' center='0 0 0' height='1' width='1'> 0 -1 1 0 1 0 0 1 </BodyFrame>")), HasSubstr("4 points; it has 3"));
  EXPECT_THAT(malformed(body_with("<BodyFrame name='F' center='0 0 0' height='1' width='1'> 0 -1  1 0  0 1  0.5 0.5  0.1 0.9</BodyFrame>")),
              HasSubstr("turns back by 180 degrees"));
  EXPECT_THAT(malformed(body_with(circle_at(0))), HasSubstr("a body needs 2 frames"));
  EXPECT_THAT(malformed("<Mesh/>"), HasSubstr("the root element of a .smx file"));
  EXPECT_THAT(malformed("<Assembly/>"), HasSubstr("the file has no body and no wing"));
}

TEST(Smx, UnsupportedContentIsRefusedByName) {
  Aircraft aircraft;
  aircraft.bodies.push_back({.name = "B"});
  aircraft.bodies[0].frames.resize(2);
  aircraft.bodies[0].frames[1].name = "odd";
  aircraft.bodies[0].frames[1].shape = FrameShape::loop;
  try {
    write_smx(aircraft, test::scratch() / "no.smx");
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::unsupported_format);
    EXPECT_THAT(e.what(), HasSubstr("frame 'odd' is a free loop"));
  }
}

TEST(Smx, SectionMayHaveOnlyNacaDesignation) {
  const auto wing = [](const std::string& naca) {
    const std::string section = " chord='1' naca='" + naca + "'/>";
    return "<Assembly><WingSkeleton name='W'><WingSection name='a' center='0 1 0'" + section + "<WingSection name='b' center='0 0 0'" + section +
           "</WingSkeleton></Assembly>";
  };
  const AircraftReading reading = read_smx_text(wing("23012"));
  EXPECT_TRUE(reading.messages.empty());
  EXPECT_EQ(make_components(reading.aircraft, RunContext()).solids.size(), 1u);
  try {
    read_smx_text(wing("9x"));
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("attribute 'naca'"));
  }
}

}  // namespace
}  // namespace sterna
