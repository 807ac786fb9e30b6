// Shared functions of the surface reader tests: files made from text, hand-packed gzip, checks of a soup.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/surface_soup.h"
#include "io/file/surface_file.h"

namespace sterna::test {

std::string bytes_of(const std::filesystem::path& path);
/// Returns the content of a small file of tests/data/io.
std::string small_text(const char* name);
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

/// Reads a soup from a file and checks the properties required of every soup. Warnings are appended to `warnings` if given.
SurfaceSoup read_surface(const std::filesystem::path& path, std::vector<std::string>* warnings = nullptr);
/// Writes a file of this name and content, then reads it as above.
SurfaceSoup read_surface_text(const std::string& name, std::string_view content, std::vector<std::string>* warnings = nullptr);

/// Checks that indices are in range, patches have names, and coordinates are finite.
void expect_sound(const SurfaceSoup& soup);
void expect_same_soup(const SurfaceSoup& a, const SurfaceSoup& b);

/// Returns the enclosed volume, positive if the triangles' normals point outward.
double volume_of(const SurfaceSoup& soup);
/// Returns the number of triangles by patch name.
std::map<std::string, int> triangles_by_patch(const SurfaceSoup& soup);

/// Returns a gzip member that stores `content` uncompressed (RFC 1952, stored blocks).
/// \pre content is below 65536 bytes
std::string packed(std::string_view content);
std::string with_crlf(std::string_view text);
std::string replaced(std::string text, std::string_view from, std::string_view to);

/// Checks that reading a file of this name and content fails with this code and a message that contains each of the strings.
void expect_refused(const std::string& name, std::string_view content, ErrorCode code, const std::vector<std::string>& texts);

}  // namespace sterna::test
