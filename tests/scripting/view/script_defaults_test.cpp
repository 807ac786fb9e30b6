#include "scripting/view/script_defaults.h"

#include <gtest/gtest.h>

#include "tests/support/error_of.h"

namespace sterna::scripting {
namespace {

constexpr const char* k_script = R"lua(-- args{ span = 1 } in a comment
local text = "args{ span = 2 }"
local p = args{
  span = number{ 10, min = 6, max = 20, unit = m },  -- span = 3
  alpha = 4*deg, half = false, name = "polar", lengths = 2 * 3 }
local span = 5
)lua";

TEST(ScriptDefaults, ChangesTheDefaultsAndNothingElse) {
  EXPECT_EQ(with_defaults(k_script, {{"span", "11.5"}, {"alpha", "6deg"}, {"half", "true"}, {"name", "a b"}}), R"lua(-- args{ span = 1 } in a comment
local text = "args{ span = 2 }"
local p = args{
  span = number{ 11.5, min = 6, max = 20, unit = m },  -- span = 3
  alpha = 6*deg, half = true, name = "a b", lengths = 2 * 3 }
local span = 5
)lua");
  EXPECT_EQ(with_defaults(k_script, {}), k_script);
  EXPECT_EQ(with_defaults("args{ a = 1 } args{ b = 2 }", {{"b", "3"}}), "args{ a = 1 } args{ b = 3 }");
  EXPECT_EQ(with_defaults("local p = args { a=1 }", {{"a", "-2e-3"}}), "local p = args { a=-2e-3 }");
}

TEST(ScriptDefaults, SaysWhatItCannotChange) {
  const auto refuse = [](const std::string& script, const std::pair<std::string, std::string>& value, const char* what) {
    test::expect_error(ErrorCode::bad_argument, what, [&] { with_defaults(script, {value}); });
  };
  refuse(k_script, {"wings", "1"}, "no default for wings");
  refuse(k_script, {"lengths", "1"}, "which is computed");
  refuse(k_script, {"span", "os.exit()"}, "is not a value for span");
  refuse(k_script, {"name", "a\" .. evil .. \""}, "has quotes");
  refuse("local p = 1", {"span", "1"}, "has no args{");
  refuse("args{ a = 1 } args{ a = 2 }", {"a", "1"}, "declares a twice");
  refuse("args{ a = 1 ", {"a", "1"}, "not closed");
}

}  // namespace
}  // namespace sterna::scripting
