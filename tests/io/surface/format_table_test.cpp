#include "io/file/format_table.h"

#include <gmock/gmock.h>

#include <map>
#include <set>
#include <sstream>

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::io {
namespace {

using test::scratch;
using test::write_bytes;

TEST(FormatTable, RowsAreComplete) {
  std::set<std::string_view> names;
  for (const Format& format : formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_FALSE(format.extensions.empty()) << format.name;
    EXPECT_TRUE(format.is_read() || format.write_surface || format.write_volume) << format.name;
  }
}

// If readers share an extension, all but the first must inspect the file's contents.
TEST(FormatTable, SharedExtensionsAreToldByContents) {
  std::map<std::string, int> n_readers;
  for (const Format& format : formats()) {
    if (!format.is_read()) continue;
    std::istringstream extensions{std::string(format.extensions)};
    for (std::string extension; extensions >> extension;) EXPECT_TRUE(n_readers[extension]++ == 0 || format.is_content) << format.name << " " << extension;
  }
}

TEST(FormatTable, MissingFileGetsFirstFormatOfExtension) { EXPECT_EQ(format_of(scratch() / "nowhere.msh").name, "Gmsh MSH"); }

TEST(FormatTable, WritingTakesTheFirstWriterOrTheNamed) {
  EXPECT_EQ(format_to_write("a.SU2", FormatUse::write_volume).name, "SU2");
  EXPECT_EQ(format_to_write("a.b8.ugrid", FormatUse::write_surface).name, "UGRID");
  EXPECT_EQ(format_to_write("a.dat", FormatUse::write_surface, "vtu").name, "VTU");
}

TEST(FormatTable, ErrorsListWhatThereIs) {
  const auto message = [](const char* path, FormatUse use, std::string_view name = {}) -> std::string {
    try {
      format_to_write(path, use, name);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::unsupported_format);
      return error.what();
    }
    return "no error";
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(message("a.xyzzy", FormatUse::write_surface), AllOf(HasSubstr("extension is unknown"), HasSubstr(".su2")));
  EXPECT_THAT(message("a.off", FormatUse::write_volume), AllOf(HasSubstr("OFF is not written as a volume mesh"), HasSubstr("SU2 (.su2)")));
  EXPECT_THAT(message("a.su2", FormatUse::write_surface, "nothing"), HasSubstr("unknown format \"nothing\""));
  EXPECT_THAT(message("a.su2.gz", FormatUse::write_surface), HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace sterna::io
