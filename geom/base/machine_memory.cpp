#include "geom/base/machine_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace sterna {
namespace {

constexpr double k_no_limit_known = std::numeric_limits<double>::infinity();

/// Returns the number after a key in a file of lines "key number ..."; k_no_limit_known if there is none.
double number_of(const std::filesystem::path& path, const std::string& requested) {
  std::ifstream file(path);
  std::string key, rest;
  double number = 0.0;
  while (file >> key >> number) {
    if (key == requested) return number;
    std::getline(file, rest);
  }
  return k_no_limit_known;
}

/// Returns the only number in a file; k_no_limit_known for "max", or if there is no such file.
double number_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  double number = 0.0;
  return file >> number ? number : k_no_limit_known;
}

double free_of_kernel() {
  constexpr double k_kibibyte = 1024.0;
  return k_kibibyte * number_of("/proc/meminfo", "MemAvailable:");
}

/// Sizes of the process in bytes: its whole address space, and its resident part. Zeros if not reported.
struct ProcessSize {
  double all = 0.0, resident = 0.0;
};
ProcessSize process_size() {
  std::ifstream file("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  if (!(file >> all >> resident)) return {};
  const auto page = static_cast<double>(sysconf(_SC_PAGESIZE));
  return {all * page, resident * page};
}

double free_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return k_no_limit_known;
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - process_size().all);
}

/// Returns the free memory of the process's control group and the groups around it (version 2 of control groups).
double free_of_control_group() {
  std::ifstream file("/proc/self/cgroup");
  double least = k_no_limit_known;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("0::/")) continue;
    const std::filesystem::path top = "/sys/fs/cgroup";
    for (std::filesystem::path group = top / line.substr(4);; group = group.parent_path()) {
      const double limit = number_of(group / "memory.max"), used = number_of(group / "memory.current");
      if (limit != k_no_limit_known && used != k_no_limit_known) {
        const double cache = number_of(group / "memory.stat", "inactive_file");  // released when other processes need memory
        least = std::min(least, std::max(0.0, limit - used + (cache == k_no_limit_known ? 0.0 : cache)));
      }
      if (group == top || !group.has_relative_path()) break;
    }
  }
  return least;
}

}  // namespace

double available_memory() { return std::min({free_of_kernel(), free_of_address_space(), free_of_control_group()}); }

double resident_memory() { return process_size().resident; }

}  // namespace sterna
