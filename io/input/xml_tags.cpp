#include "io/input/xml_tags.h"

#include <array>

#include "io/input/file_buffer.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_blanks = " \t\r\n";

std::string resolved(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> k_entities = {{{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  while (!text.empty()) {
    std::size_t n = 1;
    char c = text[0];
    for (const auto& [entity, meaning] : k_entities) {
      if (!text.starts_with(entity)) continue;
      n = entity.size();
      c = meaning;
    }
    out += c;
    text.remove_prefix(n);
  }
  return out;
}

class TagScanner {
 public:
  TagScanner(std::string_view text, std::string_view source) : text_(text), source_(source) {}

  std::vector<XmlTag> scan(std::string_view last) {
    std::vector<XmlTag> tags;
    for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) {
      if (!tags.empty()) tags.back().text = text_.substr(text_begin_, at_ - text_begin_);
      if (skip("<!--", "-->") || skip("<?", "?>") || skip("<!", ">")) continue;
      const bool is_closed = take_tag(tags);
      text_begin_ = at_;
      if (is_closed) tags.push_back({.name = "/" + tags.back().name, .offset = at_});
      if (tags.back().name == last) {
        tags.back().text = text_.substr(at_);
        break;
      }
    }
    return tags;
  }

 private:
  bool skip(std::string_view begin, std::string_view end) {
    if (!text_.substr(at_).starts_with(begin)) return false;
    const std::size_t found = text_.find(end, at_ + begin.size());
    if (found == std::string_view::npos) fail("found no end of \"" + std::string(begin) + "\"");
    at_ = text_begin_ = found + end.size();
    return true;
  }

  /// Reads a tag. \returns true if the tag is self-closing
  bool take_tag(std::vector<XmlTag>& tags) {
    XmlTag tag{.offset = at_++};
    tag.name = take_until(std::string(k_blanks) + (peek() == '/' ? ">" : "/>"), peek() == '/' ? 1 : 0);
    for (;;) {
      skip_blanks();
      if (peek() == '>' || peek() == '/') break;
      std::string key(take_until(std::string(k_blanks) + "=", 0));
      skip_blanks();
      expect('=');
      skip_blanks();
      const char quote = peek();
      if (quote != '"' && quote != '\'') fail("expected a quoted value of \"" + key + "\"");
      ++at_;
      tag.attributes.emplace_back(std::move(key), resolved(take_until(std::string(1, quote), 0)));
      ++at_;
    }
    const bool is_closed = peek() == '/';
    if (is_closed) ++at_;
    expect('>');
    tags.push_back(std::move(tag));
    return is_closed;
  }

  /// Reads up to one of `ends`; the first `n_free` characters are not compared.
  std::string_view take_until(const std::string& ends, std::size_t n_free) {
    const std::size_t end = text_.find_first_of(ends, at_ + n_free);
    if (end == std::string_view::npos) fail("the file ends within a tag");
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end;
    return found;
  }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(k_blanks, at_), text_.size()); }
  char peek() const {
    if (at_ >= text_.size()) fail("the file ends within a tag");
    return text_[at_];
  }
  void expect(char c) {
    if (peek() != c) fail("found " + quoted_excerpt(text_.substr(at_, 1)) + ", expected \"" + std::string(1, c) + "\"");
    ++at_;
  }
  [[noreturn]] void fail(const std::string& problem) const { throw_malformed(source_, "byte " + std::to_string(std::min(at_, text_.size())), problem); }

  std::string_view text_;
  std::string_view source_;
  std::size_t at_ = 0;
  std::size_t text_begin_ = 0;
};

}  // namespace

std::string_view XmlTag::attribute(std::string_view key, std::string_view fallback) const {
  for (const auto& [name_of_attribute, value] : attributes)
    if (name_of_attribute == key) return value;
  return fallback;
}

std::vector<XmlTag> scan_xml_tags(std::string_view text, std::string_view last, std::string_view source) { return TagScanner(text, source).scan(last); }

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;  // control characters are not valid XML
    }
  }
  return out;
}

}  // namespace sterna::io
