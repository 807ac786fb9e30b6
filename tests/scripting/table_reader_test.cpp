#include "scripting/lua/table_reader.h"

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

ScriptValue table(std::map<std::string, ScriptValue> fields) {
  auto result = std::make_shared<ScriptTable>();
  result->fields = std::move(fields);
  return result;
}

TEST(TableReader, FlatAndNestedNamesReachTheirOption) {
  volmesh::MeshCase options;
  ScriptTable input;
  input.fields = {{"layers", 12.0},
                  {"envelope", table({{"first_height", 1e-5}, {"max_thickness", std::string("automatic")}})},
                  {"farfield", table({{"shape", std::string("sphere")}, {"radius", std::int64_t{100}}, {"farfield_edge", 7.5}})}};
  TableReader reader(input, "test");
  const OptionTable schema = volmesh::options_of(options);
  reader.read_options(schema);
  reader.require(schema);
  reader.finish();
  EXPECT_EQ(options.envelope.layers, 12);
  EXPECT_EQ(options.envelope.first_height, 1e-5);
  EXPECT_TRUE(is_automatic(options.envelope.max_thickness));
  EXPECT_EQ(options.farfield.farfield_radius, 100.0);
  EXPECT_EQ(options.farfield.farfield_edge, 7.5);
}

TEST(TableReader, StageOptionsCanBeGivenFlatAndNested) {
  volmesh::MeshCase options, defaults;
  for (const Option& option : volmesh::options_of(defaults)) {
    const OptionValue value = option.default_value;
    const bool is_automatic_number = std::holds_alternative<double>(value) && is_automatic(std::get<double>(value));
    const bool is_automatic_count = std::holds_alternative<std::int64_t>(value) && std::get<std::int64_t>(value) == k_automatic_count;
    const ScriptValue given =
        is_automatic_count ? ScriptValue(std::string("automatic")) : script_value_of(is_automatic_number ? OptionValue(std::min(1e9, option.max)) : value);
    for (const bool is_nested : {false, true}) {
      ScriptTable input;
      if (is_nested) input.fields[std::string(option.stage)] = table({{std::string(option.name), given}});
      else input.fields[std::string(option.name)] = given;
      TableReader reader(input, "test");
      reader.read_options(volmesh::options_of(options));
      EXPECT_NO_THROW(reader.finish()) << option.name;
    }
  }
}

TEST(TableReader, ReportsAllProblemsOfATableTogether) {
  volmesh::MeshCase options;
  ScriptTable input;
  input.fields = {{"layres", 3.0}, {"max_growth", 9.0}, {"layers", true}, {"feature_angle", table({})}};
  input.items = {std::string("stray")};
  input.other_keys = {"[7]"};
  TableReader reader(input, "case.lua:5: volume_mesh");
  reader.read_options(volmesh::options_of(options));
  try {
    reader.finish();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    const std::string text = error.what();
    for (const char* part : {"case.lua:5: volume_mesh: 6 problems", "\"layres\", did you mean \"layers\"?", "max_growth: 9", "layers: true",
                             "feature_angle: a table", "entry 1", "[7]"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  EXPECT_EQ(options.envelope.layers, volmesh::EnvelopeOptions{}.layers);
}

TEST(TableReader, UnknownKeysAloneAreUnknownOptions) {
  volmesh::MeshCase options;
  ScriptTable input;
  input.fields = {{"entirely_different", 3.0}};
  TableReader reader(input, "test");
  reader.read_options(volmesh::options_of(options));
  try {
    reader.finish();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unknown_option);
    EXPECT_STREQ(error.what(), "test: unknown key \"entirely_different\"");
  }
}

}  // namespace
}  // namespace sterna::scripting
