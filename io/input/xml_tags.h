// Tags of an XML text in order, as a flat list. Sufficient for VTK's files, whose raw data sections XML parsers reject.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sterna::io {

struct XmlTag {
  std::string name;  ///< "DataArray", or "/DataArray" for a closing tag; a self-closing tag is followed by its closing tag
  std::vector<std::pair<std::string, std::string>> attributes;  ///< entities resolved
  std::string_view text;                                        ///< between this tag and the next
  std::size_t offset = 0;                                       ///< byte of its '<'

  /// Returns the value of an attribute; \p fallback if there is none.
  std::string_view attribute(std::string_view key, std::string_view fallback = {}) const;
};

/// Returns all tags up to the end of the text, or up to and including `last`, whose text is the remainder. Comments and declarations are skipped.
/// \throws Error(file_malformed) with the byte offset.
std::vector<XmlTag> scan_xml_tags(std::string_view text, std::string_view last, std::string_view source);

/// Escapes text for use as an attribute value; control characters become blanks.
std::string xml_escaped(std::string_view text);

}  // namespace sterna::io
