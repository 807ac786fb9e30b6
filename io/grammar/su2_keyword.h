// "KEY= value" lines of SU2 files, for the surface reader and the volume reader.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/input/line_blocks.h"

namespace sterna::io {

/// Reserved name of markers between partitions, which are not boundaries.
inline constexpr std::string_view k_su2_partition_marker = "SEND_RECEIVE";

/// Key and value without surrounding blanks.
struct Su2Keyword {
  std::string_view key, value;
};

/// Splits a line; the key is empty if the line is not a keyword line. "NPOIN= 7", "NPOIN=7" and "NPOIN = 7" are equivalent.
Su2Keyword split_su2_keyword(std::string_view line);

/// Returns the first number of a keyword's value (old files have a second one).
/// \throws Error(file_malformed) with the cursor's line
std::uint64_t su2_count(const Su2Keyword& keyword, const LineCursor& cursor);

/// Returns a marker's name without blanks, as in SU2 itself.
std::string su2_marker_name(std::string_view value);

struct Su2Marker {
  std::string name;
  LineBlock faces;
};

/// The blocks of one complete mesh in a file; node numbers start at 0 in each zone.
struct Su2Zone {
  std::optional<LineBlock> points, elements;
  std::vector<Su2Marker> markers;
  std::optional<std::uint64_t> n_markers;  ///< number announced in the file
  std::uint64_t n_partition_markers = 0;
};

}  // namespace sterna::io
