// Series in a separate folder, run by the program as a user would.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns all files of a series by name with their contents, without those that hold times: measure.json, log.txt, series.csv and the entry "measure" of
/// series.json.
inline std::map<std::string, std::string> snapshot(const std::filesystem::path& series) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(series)) {
    const std::string name = entry.path().lexically_relative(series).string(), last = entry.path().filename().string();
    if (!entry.is_regular_file() || last == "measure.json" || last == "log.txt" || last == "series.csv" || last == "series.html" || last == ".lock" ||
        name.starts_with("slurm/"))
      continue;
    std::string text = contents(entry.path());
    if (name == "series.json") text.resize(std::min(text.size(), text.find("\n  \"measure\"")));
    files[name] = text;
  }
  return files;
}

/// Removes the files that hold the script, its key, or the number of a case; meshes, manifests and quality remain.
inline std::map<std::string, std::string> results_only(std::map<std::string, std::string> files) {
  std::erase_if(files, [](const auto& file) {
    return file.first.find("/script/") != std::string::npos || file.first.ends_with("case.json") || file.first.ends_with("status.json") ||
           file.first == "series.json";
  });
  return files;
}

/// Returns the names of files that differ or exist in one of the two sets only; empty if the sets are equal.
inline std::string difference(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  std::string text;
  for (const auto& [name, content] : a)
    if (!b.contains(name)) text += name + " is in the first only\n";
    else if (b.at(name) != content) text += name + " differs:\n" + content.substr(0, 2000) + "\n---\n" + b.at(name).substr(0, 2000) + "\n";
  for (const auto& [name, content] : b)
    if (!a.contains(name)) text += name + " is in the second only\n";
  return text;
}

class SeriesFixture : public testing::Test {
 protected:
  test::ProcessResult run(const std::string& script, std::vector<std::string> words = {}, const std::filesystem::path& folder = {},
                          double interrupt_after = -1.0) {
    const std::filesystem::path where = folder.empty() ? folder_ : folder;
    write(script, where);
    words.insert(words.begin(), {"run", "case.lua"});
    return test::run_process(test::sterna_program(), words, where, interrupt_after);
  }
  void write(const std::string& script, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "case.lua") << script;
  }
  std::string text_of(const std::string& name) const { return contents(folder_ / name); }

  const std::filesystem::path folder_ = test::scratch();
};

}  // namespace sterna::scripting
