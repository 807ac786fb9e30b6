// A whole file in memory, the input of every reader. A gzipped file (detected by content, not by name) is unpacked.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"

namespace sterna::io {

struct FileBuffer {
  std::string source;       ///< the path as given by the user, for messages
  std::vector<char> bytes;  ///< unpacked
  std::string_view text() const { return {bytes.data(), bytes.size()}; }
};

/// Loads `path`, and unpacks it if it begins with a gzip header (several members are joined).
/// Memory is proportional to the file size: unpacking stops at k_max_expansion times the packed size.
/// \throws Error file_not_found (missing, a folder, unreadable), file_malformed (empty, damaged or suspiciously expanding gzip data), cancelled.
FileBuffer load_file(const std::filesystem::path& path, const RunContext& context);

/// Returns the first bytes of a regular file, unpacked, at most `n_bytes`; fewer, possibly none, if they cannot be read. load_file() reports the reason.
std::string file_head(const std::filesystem::path& path, std::size_t n_bytes);

/// Returns bytes of a file quoted, escaped and shortened for a message: "\"3.0x\"".
std::string quoted_excerpt(std::string_view bytes);

/// Throws Error(file_malformed) "reading SOURCE: WHERE: PROBLEM", e.g. where = "line 12" or "byte 84".
[[noreturn]] void throw_malformed(std::string_view source, std::string_view where, std::string_view problem, std::string_view hint = {});

/// Throws Error(unsupported_format) "reading SOURCE: PROBLEM".
[[noreturn]] void throw_unsupported(std::string_view source, std::string_view problem, std::string_view hint = {});

}  // namespace sterna::io
