// Tests says_where: the locations that the tests of damaged files and the fuzz targets accept.
#include "tests/support/reader_checks.h"

#include <gtest/gtest.h>

namespace sterna::test {
namespace {

Error refusal(const std::string& problem) { return Error({.code = ErrorCode::file_malformed, .attempted = "reading x", .problem = problem}); }

TEST(SaysWhere, TextOrBinaryFilesReportLineByteCell) {
  for (const char* const problem : {"line 3: found \"a\"", "block at line 7: too long", "byte 0: no head", "cell 12: has five faces", "the file is empty"})
    EXPECT_TRUE(says_where(refusal(problem), false)) << problem;
  for (const char* const problem : {"it is damaged", "the line is bad", "byte: none", "/Base/Zone: found no coordinates"})
    EXPECT_FALSE(says_where(refusal(problem), false)) << problem;
}

TEST(SaysWhere, ContainersReportNodeOrWholeFileWithReason) {
  for (const char* const problem :
       {"/Base/Zone: found no GridCoordinates", "/VTKHDF, attribute \"Version\": found text", "variable \"points_xc\": there is none",
        "variable 3: the NetCDF library says: no", "attribute \"marker_1\": the NetCDF library says: no",
        "the head of the file: opening the file: the HDF5 library says: truncated", "byte 0: found \"a\", expected the beginning of an HDF5 file",
        "the file: the HDF5 library crashed while reading the file: signal 11 (Segmentation fault)"})
    EXPECT_TRUE(says_where(refusal(problem), true)) << problem;
  for (const char* const problem : {"the file: is damaged", "the variables: found no \"points_xc\"", "point 3: is not finite", "variable \"\": is bad",
                                    "found no zone", "the head of the file: is bad", ""})
    EXPECT_FALSE(says_where(refusal(problem), true)) << problem;
}

}  // namespace
}  // namespace sterna::test
