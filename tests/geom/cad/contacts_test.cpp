#include "geom/cad/find_contacts.h"

#include <chrono>
#include <numbers>
#include <stop_token>
#include <thread>

#include "cylinder.h"
#include "geom/base/error.h"
#include "geom/cad/unite.h"
#include "geom/cad/write_cad.h"
#include "geom/model/components.h"

namespace sterna {
namespace {

using std::numbers::pi;

/// Returns a body of revolution along x with a blunt front and a domed end.
Model tube(const std::string& name, double radius, const Placement& placement = {}) {
  Body body{.name = name, .placement = placement};
  for (const double x : {0.0, 1.0, 2.5, 4.0}) body.frames.push_back({.name = "f", .center = {x, 0, 0}, .height = 2 * radius, .width = 2 * radius});
  body.tail = {CapShape::dome, 1.0};
  return make_body(body, ComponentKind::body);
}

PartContact only_contact(const std::vector<Model>& parts) {
  const ContactReport report = cad::find_contacts(parts, RunContext());
  EXPECT_EQ(report.contacts.size(), 1u);
  return report.contacts.empty() ? PartContact{} : report.contacts.front();
}

TEST(Contacts, PartsCrossingAtRightAnglesGiveNoWarning) {
  const std::vector<Model> parts = {tube("body", 0.5), tube("post", 0.2, {.origin = {2, 0, 0}, .rotation = {0, -0.5 * pi, 0}})};
  const PartContact contact = only_contact(parts);
  EXPECT_EQ(contact.kind, ContactKind::crossing);
  EXPECT_GT(contact.angle, 1.0);
  EXPECT_LT(contact.share_inside, 0.5);
  EXPECT_EQ(cad::doubt_of(contact, parts), "");
}

TEST(Contacts, NearlyTangentJoinIsReportedWithItsAngle) {
  // Parallel tubes whose axes are 0.998 diameters apart: their surfaces cross at 2 acos(0.998) = 7.25 degrees.
  const std::vector<Model> parts = {tube("low", 0.5), tube("high", 0.5, {.origin = {0.3, 0, 0.998}})};
  const PartContact contact = only_contact(parts);
  EXPECT_EQ(contact.kind, ContactKind::crossing);
  EXPECT_LT(contact.angle, 0.2);
  EXPECT_TRUE(contact.is_crevice);
  EXPECT_NEAR(contact.location.z, 0.499, 0.01);
  EXPECT_LT(std::abs(contact.location.y), 0.06);
  const std::vector<Model> smooth = {tube("low", 0.5), tube("high", 0.5, {.origin = {0.3, 0, 0.02}})};
  const PartContact along = only_contact(smooth);
  EXPECT_FALSE(along.is_crevice);
  EXPECT_NE(cad::doubt_of(along, smooth).find("nearly tangent"), std::string::npos) << cad::doubt_of(along, smooth);
}

TEST(Contacts, GapsTouchesAndPartsInsideOthersAreTold) {
  const std::vector<Model> apart = {tube("low", 0.5), tube("high", 0.5, {.origin = {0, 0, 1.25}})};
  PartContact contact = only_contact(apart);
  EXPECT_EQ(contact.kind, ContactKind::apart);
  EXPECT_NEAR(contact.gap, 0.25, 1e-3);
  EXPECT_NEAR(contact.location.z, 0.625, 1e-3);
  const std::vector<Model> touching = {test::cylinder(1.0, 2.0, {}, "low"), test::cylinder(0.5, 1.0, {0.1, 0, 2.0}, "high")};
  contact = only_contact(touching);
  EXPECT_NE(cad::doubt_of(contact, touching), "");
  EXPECT_NEAR(contact.location.z, 2.0, 1e-9);
  const std::vector<Model> inside = {tube("fuel", 0.2, {.origin = {0, 0, 0.1}}), test::cylinder(9.0, 20.0, {0, 0, -10}, "hangar")};
  contact = only_contact(inside);
  EXPECT_EQ(contact.kind, ContactKind::inside);
  EXPECT_EQ(cad::doubt_of(contact, inside), "\"fuel\" lies inside \"hangar\"");
}

TEST(Contacts, ExposureIsTheOutsideShareOfPart) {
  const std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "thick"), test::cylinder(0.5, 2.0, {0, 0, 1}, "thin")};
  const ContactReport report = cad::find_contacts(parts, RunContext());
  ASSERT_EQ(report.exposures.size(), 2u);
  const double thick = (6.0 * pi - 0.25 * pi) / (6.0 * pi), thin = (pi + 0.25 * pi) / (2.5 * pi);
  EXPECT_NEAR(report.exposures[0].outside, thick, 0.02);
  EXPECT_NEAR(report.exposures[1].outside, thin, 0.02);
}

TEST(Contacts, AreInReportAndLogBeforeUnion) {
  std::vector<std::string> warnings;
  const RunContext context({.log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::warning) warnings.emplace_back(text);
  }});
  const std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "low"), test::cylinder(1.0, 2.0, {0, 0, 2.25}, "high")};
  const UniteResult result = cad::unite(parts, {}, context);
  ASSERT_EQ(result.report.contacts.size(), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings.front().find("\"high\" and \"low\" are apart by 0.25 m"), std::string::npos) << warnings.front();
}

/// Two pods that almost coincide: their surfaces cross at angles of 1e-4 along the whole curve, which takes OpenCASCADE minutes.
std::vector<Model> twins() { return {tube("pod", 0.5), tube("twin", 0.5, {.origin = {}, .rotation = {0.3, 1e-4, 0}})}; }

double seconds_since(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

TEST(Unite, EndsWithinItsTimeLimit) {
  const auto start = std::chrono::steady_clock::now();
  try {
    cad::unite(twins(), {.time_limit = 1.0}, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry_failed);
    const std::string text = error.what();
    EXPECT_NE(text.find("\"pod\", \"twin\""), std::string::npos) << text;
    EXPECT_NE(text.find("took longer than the limit of 1 s"), std::string::npos) << text;
  }
  EXPECT_LT(seconds_since(start), 10.0);  // limit for a busy machine; 2 s on an idle machine
}

TEST(Unite, StopsSoonAfterItIsAskedTo) {
  std::stop_source source;
  const RunContext context({.stop = source.get_token()});
  std::chrono::steady_clock::time_point requested;
  std::jthread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    requested = std::chrono::steady_clock::now();
    source.request_stop();
  });
  try {
    cad::unite(twins(), {}, context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
  EXPECT_LT(seconds_since(requested), 5.0);  // limit for a busy machine; below 1 s on an idle machine
}

TEST(Unite, APairThatDoesNotUniteIsNamed) {
  // With a tolerance above the wire's radius, nothing of the wire remains that could be closed.
  const std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "drum"), test::cylinder(0.5, 2.0, {0, 0, 1}, "pipe"),
                                    test::cylinder(0.02, 2.0, {0.8, 0, 1}, "wire")};
  try {
    cad::unite(parts, {.tolerance = 0.1}, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry_failed);
    const std::string text = error.what();
    EXPECT_NE(text.find("\"drum\" and \"wire\" cannot be united"), std::string::npos) << text;
    EXPECT_FALSE(error.info().locations.empty());
  }
}

TEST(Unite, TheSameBytesForAnyNumberOfThreads) {
  const std::vector<Model> parts = {tube("body", 0.5), tube("post", 0.2, {.origin = {2, 0, 0}, .rotation = {0, -0.5 * pi, 0}}),
                                    test::cylinder(0.3, 2.0, {1, 0, -1.5}, "strut")};
  std::vector<std::string> bytes;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    bytes.push_back(cad::cad_bytes(cad::unite(parts, {}, context).model, cad::CadFormat::step, "x.step", {}, context));
  }
  EXPECT_GT(bytes[0].size(), 10000u);
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_TRUE(bytes[0] == bytes[2]);
}

}  // namespace
}  // namespace sterna
