// Data embedded in a report page.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace sterna::test {

inline nlohmann::json page_json(const std::filesystem::path& page) {
  std::ifstream file(page, std::ios::binary);
  const std::string html{std::istreambuf_iterator<char>(file), {}};
  const std::string head = "<script id=\"sterna-json\" type=\"application/json\">";
  const std::size_t at = html.find(head);
  if (at == std::string::npos) {
    ADD_FAILURE() << page << " holds no JSON";
    return {};
  }
  const std::size_t begin = at + head.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

}  // namespace sterna::test
