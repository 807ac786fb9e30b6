#include "scripting/cache/content_key.h"

#include <algorithm>
#include <cstdio>

namespace sterna::scripting {
namespace {

std::string number_text(double number) {
  if (is_automatic(number)) return "automatic";
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

std::string value_text(const OptionValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  if (const auto* v = std::get_if<Vec3>(&value)) return number_text(v->x) + " " + number_text(v->y) + " " + number_text(v->z);
  std::string text;
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    for (const double number : *numbers) text += number_text(number) + " ";
    return text;
  }
  if (const auto* vectors = std::get_if<std::vector<Vec3>>(&value)) {
    for (const Vec3& v : *vectors) text += value_text(v) + " ";
    return text;
  }
  if (std::holds_alternative<std::monostate>(value)) return "automatic";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return std::get<std::string>(value);
}

}  // namespace

std::string ContentKey::hex() const {
  constexpr char k_digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += k_digits[byte >> 4];
    text += k_digits[byte & 15];
  }
  return text;
}

KeyMaker::KeyMaker(std::string_view what) { add(what); }

void KeyMaker::put(const void* bytes, std::size_t n) { hash_.append({static_cast<const std::byte*>(bytes), n}); }

KeyMaker& KeyMaker::add(std::string_view text) {
  detail::write_count(*this, text.size());
  put(text.data(), text.size());
  return *this;
}

KeyMaker& KeyMaker::add(const OptionTable& options) {
  for (const Option& option : options) add(option.stage).add(option.name).add(value_text(option.get()));
  return *this;
}

KeyMaker& KeyMaker::add(const OptionTable& options, std::initializer_list<std::string_view> stages) {
  for (const Option& option : options)
    if (std::find(stages.begin(), stages.end(), option.stage) != stages.end()) add(option.stage).add(option.name).add(value_text(option.get()));
  return *this;
}

ContentKey KeyMaker::key() const { return {hash_.digest()}; }

ContentKey key_of(const OptionTable& options) { return KeyMaker("options").add(options).key(); }

}  // namespace sterna::scripting
