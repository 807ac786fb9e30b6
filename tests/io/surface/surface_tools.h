// What the tests of surface readers share: files made of text, hand-packed gzip, checks of a soup.
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
/// A small file of tests/data/io.
std::string small_text(const char* name);
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

/// The soup in a file, checked for what holds for every soup; warnings go to `warnings` when it is given.
SurfaceSoup read_surface(const std::filesystem::path& path, std::vector<std::string>* warnings = nullptr);
/// The same for a file of that name and content.
SurfaceSoup read_surface_text(const std::string& name, std::string_view content, std::vector<std::string>* warnings = nullptr);

/// Indices in range, patches named, coordinates finite.
void expect_sound(const SurfaceSoup& soup);
void expect_same_soup(const SurfaceSoup& a, const SurfaceSoup& b);

/// Enclosed volume, positive when the triangles' normals point outward.
double volume_of(const SurfaceSoup& soup);
/// Triangles by name of their patch.
std::map<std::string, int> triangles_by_patch(const SurfaceSoup& soup);

/// A gzip member that holds `content` unpacked (RFC 1952, stored blocks).
/// \pre content is below 65536 bytes
std::string packed(std::string_view content);
std::string with_crlf(std::string_view text);
std::string replaced(std::string text, std::string_view from, std::string_view to);

/// Reading the file of that name and content must fail with that code and a message that has every one of the texts.
void expect_refused(const std::string& name, std::string_view content, ErrorCode code, const std::vector<std::string>& texts);

}  // namespace sterna::test
