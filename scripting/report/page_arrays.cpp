#include "scripting/report/page_arrays.h"

#include <bit>
#include <cmath>

#include "geom/base/error.h"
#include "io/input/gzip.h"
#include "scripting/report/report_page.h"

namespace sterna::scripting {
namespace {

constexpr std::size_t k_alignment = 4;
constexpr std::string_view k_json_placeholder = "<!--STERNA_JSON-->", k_blob_placeholder = "<!--STERNA_BLOB-->";

/// Escapes JSON inside <script>: a "<" could close the tag.
std::string escaped(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

}  // namespace

template <class T>
ArrayLocation PageArrays::add_values(std::string_view type, std::span<const T> values) {
  static_assert(std::endian::native == std::endian::little);
  const std::size_t at = bytes_.size();
  bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  bytes_.resize((bytes_.size() + k_alignment - 1) / k_alignment * k_alignment, '\0');
  return {type, at, values.size()};
}

ArrayLocation PageArrays::add(std::span<const float> values) { return add_values("f32", values); }
ArrayLocation PageArrays::add(std::span<const std::uint32_t> values) { return add_values("u32", values); }
ArrayLocation PageArrays::add(std::span<const std::uint16_t> values) { return add_values("u16", values); }
ArrayLocation PageArrays::add(std::span<const std::uint8_t> values) { return add_values("u8", values); }

float shortened(double value) {
  constexpr std::uint32_t k_dropped = 13;  // number of bits dropped from the 23 mantissa bits of a float
  const auto narrow = static_cast<float>(value);
  if (!std::isfinite(narrow)) return std::isnan(narrow) ? std::nanf("") : narrow;
  const auto bits = std::bit_cast<std::uint32_t>(narrow);
  return std::bit_cast<float>((bits + (1u << (k_dropped - 1))) & ~((1u << k_dropped) - 1u));
}

std::string page_text(const std::string& json, const PageArrays& arrays) {
  std::string text(report_page());
  if (text.empty())
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "making a report page",
                 .problem = "this sterna was built without the page: npm was not found, or the npm registry could not be reached",
                 .hint = "install npm, then run tools/build again; `sterna check --json` contains the other data of a report"});
  const auto fill = [&](std::string_view location, const std::string& content) {
    const std::size_t at = text.find(location);
    if (at == std::string::npos)
      throw Error({.code = ErrorCode::internal, .attempted = "making a report page", .problem = "the template has no " + std::string(location)});
    text.replace(at, location.size(), content);
  };
  fill(k_json_placeholder, escaped(json));
  fill(k_blob_placeholder, io::base64(io::gzip(arrays.bytes())));
  return text;
}

}  // namespace sterna::scripting
