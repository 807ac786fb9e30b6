#include "scripting/series/series_cases.h"

#include <limits>

#include "geom/base/error.h"
#include "scripting/values/value_json.h"
#include "tests/support/error_of.h"

namespace sterna::scripting {
namespace {

ScriptTable table_of(const std::string& json) { return *std::get<std::shared_ptr<const ScriptTable>>(value_of_json(json)); }

std::string names_of(const std::string& over) {
  std::string text;
  for (const SeriesCase& c : cases_of(table_of(over))) text += c.name + " ";
  return text;
}
std::string error_of(const std::string& over) {
  try {
    cases_of(table_of(over));
  } catch (const Error& error) {
    return error.info().problem;
  }
  return "no error";
}

TEST(SeriesCases, AreProductInAlphabeticalOrderLastFastest) {
  EXPECT_EQ(names_of(R"({"beta": [0, 5], "alpha": [-4, 2.5]})"), "alpha=-4_beta=0 alpha=-4_beta=5 alpha=2.5_beta=0 alpha=2.5_beta=5 ");
  EXPECT_EQ(names_of(R"({"alpha": 3, "flap": [true, false]})"), "alpha=3_flap=true alpha=3_flap=false ");
}

TEST(SeriesCases, AreAListOfTables) {
  EXPECT_EQ(names_of(R"([{"alpha": 1}, {"alpha": 0, "b": 2}])"), "alpha=1 alpha=0_b=2 ");
  EXPECT_EQ(names_of(R"([{"alpha": 1, "name": "cruise"}, {"alpha": 2}])"), "cruise alpha=2 ");
}

TEST(SeriesCases, OfZippedListsAndTheirProduct) {
  const ScriptValue zip = zipped(table_of(R"({"alpha": [0, 4], "bend": [0.5, 1]})"));
  EXPECT_EQ(to_json(zip), R"([{"alpha":0,"bend":0.5},{"alpha":4,"bend":1}])");
  ScriptTable over = table_of(R"({"beta": [0, 5]})");
  over.items.push_back(zip);
  std::string names;
  for (const SeriesCase& c : cases_of(over)) names += c.name + " ";
  EXPECT_EQ(names, "alpha=0_bend=0.5_beta=0 alpha=0_bend=0.5_beta=5 alpha=4_bend=1_beta=0 alpha=4_bend=1_beta=5 ");
  test::expect_error(ErrorCode::bad_argument, "bend has 1 values, alpha 2", [&] { (void)zipped(table_of(R"({"alpha": [0, 4], "bend": [1]})")); });
}

TEST(SeriesCases, HaveNamesThatAreSafeAndUnique) {
  const std::vector<SeriesCase> cases = cases_of(table_of(R"({"file": ["a/b.stl", "a b.stl", "../x"], "v": [[1, 2]]})"));
  std::set<std::string> names;
  for (const SeriesCase& c : cases) {
    EXPECT_EQ(c.name.find('/'), std::string::npos);
    EXPECT_EQ(c.name.find(' '), std::string::npos);
    names.insert(c.name);
  }
  EXPECT_EQ(names.size(), 3u);
  const std::string long_text(300, 'x');
  EXPECT_LT(names_of(R"({"file": ")" + long_text + R"("})").size(), 120u);
  EXPECT_EQ(names_of(R"({"x": -0.0})"), "x=0 ");
}

TEST(SeriesCases, RefuseWhatIsNone) {
  EXPECT_EQ(error_of(R"({})"), "there are no cases");
  EXPECT_EQ(error_of(R"({"alpha": []})"), "alpha: the list is empty");
  EXPECT_EQ(error_of(R"([{"alpha": 1}, {"alpha": 1}])"), "cases 1 and 2 have the same name \"alpha=1\"");
  EXPECT_EQ(error_of(R"([{"alpha": 1}, 7])"), "expected tables of parameters, not a number");
  EXPECT_EQ(error_of(R"({"index": [1]})"), "index: this name is reserved, p.index is the number of the case");
  EXPECT_EQ(error_of(R"([{"name": "a/b"}])"), "name: names of cases have letters, digits and . + - _ = only (at most 100)");
}

TEST(SeriesCases, RangesMeetTheirEnd) {
  const auto range = [](ScriptValue a, ScriptValue b, ScriptValue c) { return to_json(range_of(a, b, c)); };
  EXPECT_EQ(range(std::int64_t{-4}, std::int64_t{12}, std::int64_t{8}), "[-4,4,12]");
  EXPECT_EQ(range(std::int64_t{1}, std::int64_t{3}, {}), "[1,2,3]");
  EXPECT_EQ(range(std::int64_t{4}, std::int64_t{0}, std::int64_t{-2}), "[4,2,0]");
  EXPECT_EQ(std::get<std::shared_ptr<const ScriptTable>>(range_of(0.0, 1.0, 0.1))->items.size(), 11u);
  test::expect_error(ErrorCode::bad_argument, "from 0 to 1 in steps of -0.1 there are no values", [&] { (void)range_of(0.0, 1.0, -0.1); });
  test::expect_error(ErrorCode::bad_argument, "in steps of 0 there are no values", [&] { (void)range_of(0.0, 1.0, 0.0); });
  test::expect_error(ErrorCode::bad_argument, "last value: expected a finite number, not inf",
                     [&] { (void)range_of(0.0, std::numeric_limits<double>::infinity(), 1.0); });
}

TEST(ValueJson, KeepsKindsAndDigits) {
  for (const char* text : {"0.1", "5", "5.0", "true", "\"a\\\"b\"", "[1,2.5,\"x\"]", "{\"a\":{\"b\":[1]}}", "1e-06"})
    EXPECT_EQ(to_json(value_of_json(text)), text);
  EXPECT_TRUE(std::holds_alternative<double>(value_of_json("5.0")));
  EXPECT_EQ(to_json(std::numeric_limits<double>::quiet_NaN()), "null");
  test::expect_error(ErrorCode::file_malformed, "it is not JSON: {", [&] { (void)value_of_json("{"); });
}

}  // namespace
}  // namespace sterna::scripting
