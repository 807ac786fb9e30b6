// Rules: options of patches over the options for all patches.
#include "geom/base/rules.h"

#include <gtest/gtest.h>

#include <array>

#include "geom/base/error.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

struct RuledOptions {
  int cells = k_automatic_count;
  double edge = 1.0;
  std::string shape = "round";
  bool is_smooth = true;
};

}  // namespace

template <>
struct Schema<RuledOptions> {
  using O = RuledOptions;
  static constexpr std::string_view stage = "ruled";
  static constexpr std::array fields = {
      Field<O>{.name = "cells", .member = &O::cells, .min = 1, .max = 9, .help = "number of cells", .automatic = "from the edge", .required = true},
      Field<O>{.name = "edge", .member = &O::edge, .unit = Unit::metre, .min = 0.1, .max = 10.0, .help = "edge length"},
      Field<O>{.name = "shape", .member = &O::shape, .help = "shape of the cells", .choices = "round flat"},
      Field<O>{.name = "is_smooth", .member = &O::is_smooth, .help = "whether cells are smooth"},
  };
};

namespace {

constexpr std::array k_listed = {RuleOption{.name = "shape", .choices = "as_all round flat"}, RuleOption{.name = "cells"},
                                 RuleOption{.name = "edge", .help = "edge length of these patches", .automatic = "value for all patches"},
                                 RuleOption{.name = "is_smooth"}};

OptionTable table_of(Rule& rule) {
  RuledOptions of_all;
  return options_of(rule, k_listed, options_of(of_all));
}

TEST(Rules, LastMatchingRuleThatSetsTheOptionApplies) {
  const std::vector<Rule> rules = {{.names = "*", .options = {{"edge", 2.0}, {"cells", 3}}},
                                   {.names = "wing*", .options = {{"edge", 3.0}, {"is_smooth", false}, {"unknown", 1.0}}},
                                   {.names = "wing_tip", .options = {{"shape", "flat"}}}};
  const RuledOptions body = resolve(RuledOptions{}, rules, "body"), tip = resolve(RuledOptions{}, rules, "wing_tip");
  EXPECT_EQ(body.edge, 2.0);
  EXPECT_EQ(body.cells, 3);
  EXPECT_EQ(body.shape, "round");
  EXPECT_TRUE(body.is_smooth);
  EXPECT_EQ(tip.edge, 3.0);
  EXPECT_EQ(tip.cells, 3);
  EXPECT_EQ(tip.shape, "flat");
  EXPECT_FALSE(tip.is_smooth);
  EXPECT_EQ(rule_for("wing_tip", rules, "edge"), &rules[1]);
  EXPECT_EQ(rule_for("body", rules, "shape"), nullptr);
  EXPECT_EQ(value_or(rules[0], "cells", 0), 3);
  EXPECT_EQ(value_or(rules[1], "cells", 0), 0);
}

TEST(Rules, DefaultsStandForAllPatches) {
  Rule rule;
  const OptionTable table = table_of(rule);
  EXPECT_EQ(table[0].default_text(), "\"as_all\"");
  EXPECT_EQ(table[1].default_text(), "-1");
  EXPECT_EQ(table[1].range_text(), "-1 .. 9");
  EXPECT_EQ(table[2].default_text(), "automatic (value for all patches)");
  EXPECT_EQ(table[2].help, "edge length of these patches");
  EXPECT_EQ(table[0].help, "shape of the cells");
  const std::vector<std::array<const char*, 3>> cases = {{"cells", "4", "-1"}, {"edge", "5", "automatic"}, {"shape", "flat", "as_all"}};
  for (const auto& [name, set, unset] : cases) {
    const Option& option = find_option(table, name, "test");
    set_option_from_text(option, set);
    EXPECT_TRUE(is_set(rule, name)) << name;
    set_option_from_text(option, unset);
    EXPECT_FALSE(is_set(rule, name)) << name;
  }
  EXPECT_EQ(test::error_of([&] { set_option_from_text(find_option(table, "edge", "test"), "50mm"); }).code(), ErrorCode::bad_argument);
  set_option(find_option(table, "is_smooth", "test"), true);
  EXPECT_TRUE(is_set(rule, "is_smooth"));
}

}  // namespace
}  // namespace sterna
