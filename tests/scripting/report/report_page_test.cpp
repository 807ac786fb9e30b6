#include "scripting/report/report_page.h"

#include <gtest/gtest.h>

#include <string_view>

#include "tests/support/data.h"

namespace sterna::scripting {
namespace {

int count_of(std::string_view text, std::string_view part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

TEST(ReportPage, HoldsEachMarkerOnceAndAsksForNothing) {
  const std::string_view page = report_page();
  STERNA_NEEDS(!page.empty(), "the report page (npm or its registry, when this was built)");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_EQ(count_of(page, "<!--STERNA_JSON-->"), 1);
  EXPECT_EQ(count_of(page, "<!--STERNA_BLOB-->"), 1);
  EXPECT_EQ(count_of(page, "default-src 'none'"), 1);  // the browser loads nothing, whatever the scripts of the page contain
  EXPECT_LT(page.size(), 2'500'000u);                  // every report contains this page
  EXPECT_GE(count_of(page, "MIT"), 2);                 // licences of three.js and Chart.js
}

}  // namespace
}  // namespace sterna::scripting
