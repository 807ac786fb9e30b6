// Debian's OpenFOAM as an independent reader of polyMesh folders and Fluent files.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sterna::test {

/// Creates the few files that every OpenFOAM tool requires.
void make_foam_case(const std::filesystem::path& folder);

/// Returns the output of a tool run in a case ("checkMesh"). nullopt: OpenFOAM is not installed, see STERNA_NEEDS.
std::optional<std::string> run_openfoam(const std::string& tool, const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// Checks that topology, closedness, volumes and orientation pass, and all other checks except quality checks whose line contains a string of `allowed`.
void expect_clean(const std::string& output, const std::vector<std::string>& allowed);

/// Returns the numbers in a list of labels (owner, neighbour, a set) of an OpenFOAM text file; empty if the file does not exist.
std::vector<std::size_t> read_labels(const std::filesystem::path& path);

/// Returns the number after `label` in a tool's output, e.g. number_after(out, "prisms:"); -1 if the label is missing.
double number_after(const std::string& output, const std::string& label);

}  // namespace sterna::test
