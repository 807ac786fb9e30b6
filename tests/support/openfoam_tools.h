// OpenFOAM of Debian as an independent reader of polyMesh folders and Fluent files.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sterna::test {

/// Makes the few files without which no tool of OpenFOAM starts.
void make_foam_case(const std::filesystem::path& folder);

/// Output of a tool run in a case ("checkMesh"); nullopt: OpenFOAM is not installed, see STERNA_NEEDS.
std::optional<std::string> run_openfoam(const std::string& tool, const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// Topology, closedness, volumes and orientation are as they must be, and every other check passes but those of quality in `allowed`, by a part of their line.
void expect_clean(const std::string& output, const std::vector<std::string>& allowed);

/// The numbers in a list of labels (owner, neighbour, a set) of an OpenFOAM text file; empty when there is no such file.
std::vector<std::size_t> read_labels(const std::filesystem::path& path);

/// The number behind `label` in a tool's output, e.g. number_after(out, "prisms:"); -1 when there is none.
double number_after(const std::string& output, const std::string& label);

}  // namespace sterna::test
