#include "tests/io/volume/openfoam_tools.h"

#include <cstdlib>
#include <fstream>
#include <string_view>

#include "tests/support/process.h"

namespace sterna::test {

void make_foam_case(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "system");
  const auto header = [](const std::string& object) { return "FoamFile { version 2.0; format ascii; class dictionary; object " + object + "; }\n"; };
  std::ofstream(folder / "system" / "controlDict")
      << header("controlDict") << "application none;\nstartFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\nwritePrecision 17;\n";
  for (const std::string name : {"fvSchemes", "fvSolution"})
    std::ofstream(folder / "system" / name) << header(name) << "divSchemes{} gradSchemes{} laplacianSchemes{} interpolationSchemes{} snGradSchemes{} ddtSchemes{}\n";
}

std::optional<std::string> run_openfoam(const std::string& tool, const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  const std::filesystem::path program = "/usr/bin/" + tool;
  if (!std::filesystem::exists(program)) {
    const char* const required = std::getenv("STERNA_REQUIRE_DATA");
    if (required && std::string_view(required) == "1") ADD_FAILURE() << "STERNA_REQUIRE_DATA=1, but " << program << " is absent";
    return std::nullopt;
  }
  ::setenv("WM_PROJECT_DIR", "/usr/share/openfoam", 1);  // its tools find their settings by it
  const ProcessResult result = run_process(program, arguments, folder);
  EXPECT_EQ(result.status, 0) << tool << ":\n" << result.output << result.errors;
  return result.output + result.errors;
}

double number_after(const std::string& output, const std::string& label) {
  const std::size_t at = output.find(label);
  return at == std::string::npos ? -1.0 : std::atof(output.c_str() + at + label.size());
}

}  // namespace sterna::test
