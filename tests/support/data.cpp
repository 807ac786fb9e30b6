#include "tests/support/data.h"

#include <cstdlib>
#include <string_view>

namespace sterna::test {

std::filesystem::path source_folder() { return STERNA_SOURCE_DIR; }
std::filesystem::path build_folder() { return STERNA_BINARY_DIR; }
std::filesystem::path corpus() { return source_folder() / "tests" / "data"; }
std::filesystem::path shared_data() { return build_folder() / "test_data"; }
bool has_shared_data() { return std::filesystem::is_directory(shared_data() / "surfaces"); }

bool is_all_required() {
  const char* const required = std::getenv("STERNA_REQUIRE_DATA");
  return required && std::string_view(required) == "1";
}

std::filesystem::path scratch() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "." + info->name();
  for (char& c : name)
    if (c == '/') c = '_';
  const std::filesystem::path folder = build_folder() / "scratch" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace sterna::test
