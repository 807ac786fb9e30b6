// "KEY= value" lines of SU2 files, for its surface and its volume reader.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/input/line_blocks.h"

namespace sterna::io {

/// The reserved name of markers between partitions; not a boundary.
inline constexpr std::string_view k_su2_partition_marker = "SEND_RECEIVE";

/// Blanks around the two are removed.
struct Su2Keyword {
  std::string_view key, value;
};

/// No key when the line is something else. "NPOIN= 7", "NPOIN=7" and "NPOIN = 7" are the same.
Su2Keyword split_su2_keyword(std::string_view line);

/// The first number of a keyword's value (old files add a second).
/// \throws Error(file_malformed) with the cursor's line
std::uint64_t su2_count(const Su2Keyword& keyword, const LineCursor& cursor);

/// A marker's name without its blanks, as SU2 itself removes them.
std::string su2_marker_name(std::string_view value);

struct Su2Marker {
  std::string name;
  LineBlock faces;
};

/// The blocks of one complete mesh of a file; node numbers start at 0 in each.
struct Su2Zone {
  std::optional<LineBlock> points, elements;
  std::vector<Su2Marker> markers;
  std::optional<std::uint64_t> n_markers;  ///< announced
  std::uint64_t n_partition_markers = 0;
};

}  // namespace sterna::io
