#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "tests/support/error_of.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/volume_mesh.h"

namespace sterna {
namespace {

using volmesh::EnvelopeOptions;

TEST(Schema, TextWithUnitsReachesTheMember) {
  EnvelopeOptions options;
  const OptionTable table = options_of(options);
  set_option_from_text(find_option(table, "feature_angle", "test"), "40*deg");
  set_option_from_text(find_option(table, "envelope.first_height", "test"), "2.5mm");
  set_option_from_text(find_option(table, "layers", "test"), "24");
  EXPECT_DOUBLE_EQ(options.feature_angle, 40.0 * 3.14159265358979323846 / 180.0);
  EXPECT_DOUBLE_EQ(options.first_height, 2.5e-3);
  EXPECT_EQ(options.layers, 24);
}

TEST(Schema, WholeNumbersMayBeAutomatic) {
  EnvelopeOptions options;
  const OptionTable table = options_of(options);
  const Option& layers = find_option(table, "layers", "test");
  set_option_from_text(layers, "automatic");
  EXPECT_TRUE(is_automatic(options.layers));
  EXPECT_NE(options_to_json(table).find("\"layers\": \"automatic\""), std::string::npos);
  // Users cannot enter the number that represents "automatic", and other integer options cannot be automatic.
  EXPECT_EQ(test::error_of([&] { set_option(layers, std::int64_t{k_automatic_count}); }).code(), ErrorCode::bad_argument);
  EXPECT_EQ(test::error_of([&] { set_option_from_text(find_option(table, "height_sweeps", "test"), "automatic"); }).code(), ErrorCode::bad_argument);
}

TEST(Schema, MisspeltNameGetsASuggestion) {
  EnvelopeOptions options;
  const OptionTable table = options_of(options);
  try {
    find_option(table, "layer", "volume_mesh");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unknown_option);
    EXPECT_NE(std::string(error.what()).find("did you mean \"layers\"?"), std::string::npos) << error.what();
  }
}

TEST(Schema, ValueOutsideItsRangeNamesValueAndLimit) {
  EnvelopeOptions options;
  const OptionTable table = options_of(options);
  for (const char* text : {"-1", "-3", "1001", "2.5", "many"}) {
    try {
      set_option_from_text(find_option(table, "layers", "test"), text);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_NE(std::string(error.what()).find("layers"), std::string::npos);
    }
  }
  EXPECT_EQ(options.layers, EnvelopeOptions{}.layers);
}

TEST(Schema, MemoryHasUnits) {
  volmesh::MeshCase options;
  const OptionTable table = volmesh::options_of(options);
  set_option_from_text(find_option(table, "max_memory", "test"), "16GB");
  EXPECT_DOUBLE_EQ(options.limits.max_memory, 16e9);
  EXPECT_THROW(set_option_from_text(find_option(table, "max_memory", "test"), "16mm"), Error);
}

TEST(Schema, AngleLimitsAreAcceptedAsPrinted) {
  volmesh::MeshCase options;
  int n_limits = 0;
  for (const Option& option : volmesh::options_of(options)) {
    if (option.unit != Unit::radian) continue;
    for (const double limit : {option.min, option.max}) {
      if (!std::isfinite(limit) || std::abs(limit) > 10.0) continue;
      char text[40];
      std::snprintf(text, sizeof text, "%.6gdeg", limit * 180.0 / 3.14159265358979323846);
      EXPECT_NO_THROW(set_option_from_text(option, text)) << option.name << " = " << text;
      std::snprintf(text, sizeof text, "%.6gdeg", limit * 180.0 / 3.14159265358979323846 + (limit == option.max ? 0.01 : -0.01));
      EXPECT_THROW(set_option_from_text(option, text), Error) << option.name << " = " << text;
      ++n_limits;
    }
  }
  EXPECT_GT(n_limits, 4);
}

TEST(Schema, AUnitOfAnotherDimensionIsAnError) {
  EnvelopeOptions options;
  const OptionTable table = options_of(options);
  const auto message = [&](const char* name, const char* text) {
    try {
      set_option_from_text(find_option(table, name, "test"), text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(message("first_height", "12deg").find("envelope.first_height: \"12deg\" is an angle, expected a length (m, mm, um, cm, inch, in, ft)"),
            std::string::npos)
      << message("first_height", "12deg");
  EXPECT_NE(message("feature_angle", "3mm").find("is a length, expected an angle (deg, rad)"), std::string::npos);
  EXPECT_NE(message("max_growth", "1.2m").find("expected a number without a unit"), std::string::npos);
  EXPECT_NE(message("first_height", "12furlongs").find("is not a length"), std::string::npos);
  EXPECT_EQ(message("feature_angle", "0.5 rad"), "none");
  EXPECT_EQ(message("first_height", "0.1 inch"), "none");
  EXPECT_DOUBLE_EQ(options.first_height, 0.00254);
}

TEST(Schema, RequiredOptionsAreNamedWhenMissing) {
  EnvelopeOptions options;
  test::expect_error(ErrorCode::bad_argument, "volume_mesh: needs first_height", [&] { (void)require_options(options_of(options), "volume_mesh"); });
  options.first_height = 1e-6;
  EXPECT_NO_THROW(require_options(options_of(options), "volume_mesh"));
}

TEST(Schema, ManifestHoldsEveryOption) {
  EnvelopeOptions options;
  const std::string json = options_to_json(options_of(options));
  for (const Option& option : options_of(options)) EXPECT_NE(json.find("\"" + std::string(option.name) + "\""), std::string::npos);
}

}  // namespace
}  // namespace sterna
