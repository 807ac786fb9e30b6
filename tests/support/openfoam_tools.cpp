#include "tests/support/openfoam_tools.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <string_view>

#include "tests/support/process.h"

namespace sterna::test {

void make_foam_case(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "system");
  const auto header = [](const std::string& object) { return "FoamFile { version 2.0; format ascii; class dictionary; object " + object + "; }\n"; };
  std::ofstream(folder / "system" / "controlDict") << header("controlDict")
                                                   << "application none;\nstartFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\ndeltaT "
                                                      "1;\nwriteControl timeStep;\nwriteInterval 1;\nwritePrecision 17;\n";
  for (const std::string name : {"fvSchemes", "fvSolution"})
    std::ofstream(folder / "system" / name) << header(name)
                                            << "divSchemes{} gradSchemes{} laplacianSchemes{} interpolationSchemes{} snGradSchemes{} ddtSchemes{}\n";
}

std::optional<std::string> run_openfoam(const std::string& tool, const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  const std::filesystem::path program = "/usr/bin/" + tool;
  if (!std::filesystem::exists(program)) return std::nullopt;
  ::setenv("WM_PROJECT_DIR", "/usr/share/openfoam", 1);  // OpenFOAM's tools find their settings through this variable
  const ProcessResult result = run_process(program, arguments, folder);
  EXPECT_EQ(result.status, 0) << tool << ":\n" << result.output << result.errors;
  return result.output + result.errors;
}

void expect_clean(const std::string& output, const std::vector<std::string>& allowed) {
  for (const char* const line :
       {"Boundary definition OK.", "Cell to face addressing OK.", "Point usage OK.", "Upper triangular ordering OK.", "Face vertices OK.",
        "Topological cell zip-up check OK.", "Face-face connectivity OK.", "Number of regions: 1 (OK).", "Cell volumes OK.", "Face pyramids OK."})
    EXPECT_NE(output.find(line), std::string::npos) << line << "\n" << output;
  EXPECT_TRUE(std::regex_search(output, std::regex("Boundary openness \\(.*\\) OK"))) << output;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("***") == std::string::npos) continue;
    EXPECT_TRUE(std::any_of(allowed.begin(), allowed.end(), [&](const std::string& part) { return line.find(part) != std::string::npos; })) << line << "\n"
                                                                                                                                            << output;
  }
}

std::vector<std::size_t> read_labels(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::size_t> labels;
  std::string line;
  while (std::getline(file, line) && line != "(") {
  }
  while (std::getline(file, line) && line != ")") labels.push_back(std::stoul(line));
  return labels;
}

double number_after(const std::string& output, const std::string& label) {
  const std::size_t at = output.find(label);
  return at == std::string::npos ? -1.0 : std::atof(output.c_str() + at + label.size());
}

}  // namespace sterna::test
