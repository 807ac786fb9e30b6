// Values with a Schema: each member has an effect on the key, on the JSON and on the stored bytes, and all three read back equal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "geom/base/error.h"
#include "scripting/cache/content_key.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/wake_verbs.h"
#include "volmesh/case/size_sources.h"

namespace sterna::scripting {
namespace {

/// Returns a valid value other than the present one.
OptionValue another(const Option& option) {
  const OptionValue value = option.get();
  switch (option.kind) {
    case OptionKind::boolean: return !std::get<bool>(value);
    case OptionKind::integer: return std::get<std::int64_t>(value) + 1;
    case OptionKind::number: return std::isinf(option.max) ? option.min + 0.7 : option.min + 0.7 * (option.max - option.min);
    case OptionKind::string: return option.choices.empty() ? "another" : std::string(option.choices.substr(option.choices.rfind(' ') + 1));
    case OptionKind::vector: return Vec3{0.1, 0.2, 0.3};
    case OptionKind::numbers: return std::vector<double>{0.1, 0.7};
    case OptionKind::vectors: return std::vector<Vec3>{{0.1, 0.2, 0.3}, {1.0, 2.0, 3.0}};
  }
  return value;
}

template <class T>
ContentKey key_of_value(const T& value) {
  return KeyMaker("value").add(std::vector<T>{value}).key();
}

template <class T>
class DescribedValue : public testing::Test {};
using Values = testing::Types<volmesh::ActuatorDisc, volmesh::WakeSheet, volmesh::SizeSource>;
TYPED_TEST_SUITE(DescribedValue, Values);

TYPED_TEST(DescribedValue, EachMemberIsInKeyAndJsonAndReadsBack) {
  TypeParam plain;
  for (const Option& option : options_of(plain))
    if (option.required) set_option(option, another(option));
  std::set<ContentKey> keys = {key_of_value(plain)};
  std::set<std::string> texts = {values_to_json(std::vector{plain})};
  for (std::size_t i = 0; i < Schema<TypeParam>::fields.size(); ++i) {
    TypeParam changed = plain;
    const Option option = options_of(changed)[i];
    set_option(option,
               option.required ? OptionValue(option.kind == OptionKind::vector ? OptionValue(Vec3{4, 5, 6}) : OptionValue(option.min + 1.3)) : another(option));
    EXPECT_TRUE(keys.insert(key_of_value(changed)).second) << option.name << " has no effect on the key";
    const std::string json = values_to_json(std::vector{changed});
    EXPECT_TRUE(texts.insert(json).second) << option.name << " is not in the JSON";
    const std::vector<TypeParam> read = values_of_json<TypeParam>(json);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(key_of_value(read.front()).hex(), key_of_value(changed).hex()) << option.name << " is not read back from " << json;
  }
}

TYPED_TEST(DescribedValue, JsonWithUnknownOrWrongMembersIsRefused) {
  EXPECT_THROW(values_of_json<TypeParam>("{}"), Error);
  EXPECT_THROW(values_of_json<TypeParam>("[3]"), Error);
  EXPECT_THROW(values_of_json<TypeParam>(R"([{"colour": "red"}])"), Error);
  EXPECT_THROW(values_of_json<TypeParam>(R"([{"direction": [1, 2], "axis": [1, 2]}])"), Error);
}

TEST(DescribedValues, StringsOfTheCommandLineHaveVectorsAndUnits) {
  const volmesh::ActuatorDisc disc = disc_of_text("prop center=0,10cm,-1 axis=1,0,0.5 radius=1.2");
  EXPECT_EQ(disc.center, (Vec3{0.0, 0.1, -1.0}));
  EXPECT_EQ(disc.axis, (Vec3{1.0, 0.0, 0.5}));
  const auto problem = [](const auto& read) {
    try {
      read();
    } catch (const Error& error) {
      return error.info().problem;
    }
    return std::string("no error");
  };
  using testing::HasSubstr;
  EXPECT_THAT(problem([] { disc_of_text("prop radius=1.2"); }), HasSubstr("needs center"));
  EXPECT_THAT(problem([] { disc_of_text("prop center=0,0 radius=1.2"); }), HasSubstr("three numbers"));
  EXPECT_THAT(problem([] { disc_of_text("center=0,0,0 radius=1.2"); }), HasSubstr("name of the disc"));
  EXPECT_THAT(problem([] { disc_of_text("prop center=0,0,0 radius=-1"); }), HasSubstr("radius"));
  EXPECT_THAT(problem([] { wake_sheet_of_text("direction=1,0,0 alpha=2"); }), HasSubstr("exclude each other"));
  EXPECT_THAT(problem([] { wake_sheet_of_text("direction=0,0,0"); }), HasSubstr("zero length"));
  EXPECT_THAT(problem([] { wake_sheet_of_text("lenght=2"); }), HasSubstr("lenght"));
}

/// Bytes in memory.
struct RuleBytes final : ByteSink, ByteSource {
  std::string bytes;
  std::size_t at = 0;
  void put(const void* from, std::size_t n) override { bytes.append(static_cast<const char*>(from), n); }
  void take(void* to, std::size_t n) override {
    if (n > n_left()) refuse();
    std::memcpy(to, bytes.data() + at, n);
    at += n;
  }
  std::uint64_t n_left() const override { return bytes.size() - at; }
  [[noreturn]] void refuse() const override { throw Error({.code = ErrorCode::file_malformed, .attempted = "reading rules", .problem = "too short"}); }
};

TEST(DescribedValues, RulesReadBackFromBytesAndJson) {
  const std::vector<Rule> layers = {{.names = "wing*", .options = {{"layers", 12}, {"first_height", 1e-5}, {"open_ridges", "always"}, {"kind", "wall"}}},
                                    {.names = "floor"}};
  const std::vector<Rule> sizes = {{.names = "wing*", .options = {{"max_edge", 0.1}, {"curvature_angle", 0.2}}}};
  RuleBytes stored;
  write_value(stored, layers);
  std::vector<Rule> read;
  read_value(stored, read);
  ASSERT_EQ(read.size(), layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    EXPECT_EQ(read[i].names, layers[i].names);
    EXPECT_EQ(read[i].options, layers[i].options);
  }
  EXPECT_EQ(rules_json(layers).dump(), R"([{"names":"wing*","kind":"wall","layers":12,"first_height":1e-05,"open_ridges":"always"},{"names":"floor"}])");
  EXPECT_EQ(layer_rules_of_json(rules_json(layers))[0].options, layers[0].options);
  EXPECT_EQ(size_rules_of_json(rules_json(sizes))[0].options, sizes[0].options);
  EXPECT_THROW(layer_rules_of_json(rules_json(sizes)), Error);
  EXPECT_THROW(layer_rules_of_json("{}"), Error);
}

}  // namespace
}  // namespace sterna::scripting
