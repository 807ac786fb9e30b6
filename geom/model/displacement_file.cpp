#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "geom/base/error.h"
#include "geom/model/radial_map.h"

namespace sterna {

ScatteredDisplacements read_displacements(const std::filesystem::path& path) {
  const std::string attempted = "reading displacements " + path.string();
  std::ifstream file(path);
  if (!file) throw Error({.code = ErrorCode::file_not_found, .attempted = attempted, .problem = "the file does not exist or cannot be read"});
  ScatteredDisplacements data;
  std::string line;
  int n_lines = 0;
  while (std::getline(file, line)) {
    const int number = ++n_lines;
    const auto fail = [&](const std::string& problem) {
      throw Error({.code = ErrorCode::file_malformed,
                   .attempted = attempted,
                   .problem = "line " + std::to_string(number) + ": " + problem,
                   .hint = "each line is: x y z dx dy dz, metres"});
    };
    line.resize(std::min(line.find('#'), line.size()));
    double values[6];
    int n = 0;
    const char *at = line.data(), *end = line.data() + line.size();
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; };
    while (true) {
      while (at < end && is_blank(*at)) ++at;
      if (at == end) break;
      if (n == 6) fail("more than 6 numbers");
      const char* begin = *at == '+' ? at + 1 : at;
      const auto [next, error] = std::from_chars(begin, end, values[n]);
      if (error != std::errc{} || (next < end && !is_blank(*next)) || !std::isfinite(values[n]))
        fail("\"" + std::string(at, std::find_if(at, end, is_blank)) + "\" is not a finite number");
      at = next;
      ++n;
    }
    if (n == 0) continue;
    if (n < 6) fail(std::to_string(n) + " numbers, expected 6");
    data.at.push_back({values[0], values[1], values[2]});
    data.shift.push_back({values[3], values[4], values[5]});
  }
  if (data.at.empty())
    throw Error({.code = ErrorCode::file_malformed,
                 .attempted = attempted,
                 .problem = n_lines == 0 ? "the file is empty" : "line " + std::to_string(n_lines) + ": the file ends here and holds no points",
                 .hint = "each line is: x y z dx dy dz, metres"});
  return data;
}

}  // namespace sterna
