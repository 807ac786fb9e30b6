#include "tests/support/data.h"

namespace sterna::test {

std::filesystem::path corpus() { return std::filesystem::path(STERNA_SOURCE_DIR) / "tests" / "data"; }
std::filesystem::path shared_data() { return std::filesystem::path(STERNA_SOURCE_DIR).parent_path() / "shared" / "data"; }
bool has_shared_data() { return std::filesystem::is_directory(shared_data() / "surfaces"); }

std::filesystem::path scratch() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "." + info->name();
  for (char& c : name)
    if (c == '/') c = '_';
  const std::filesystem::path folder = std::filesystem::path(STERNA_BINARY_DIR) / "scratch" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace sterna::test
