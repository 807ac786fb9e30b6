#include "scripting/cache/build_identity.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/hash.h"

namespace sterna::scripting {
namespace {

/// Returns the build id among the notes of a loaded file, as hex digits; empty if there is none.
std::string build_id(const dl_phdr_info& object) {
  constexpr char k_digits[] = "0123456789abcdef";
  constexpr std::string_view k_owner{"GNU", 4};  // length with the final NUL
  for (std::size_t i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& header = object.dlpi_phdr[i];
    if (header.p_type != PT_NOTE) continue;
    const std::size_t alignment = header.p_align == 8 ? 8 : 4;
    const auto padded = [&](std::size_t n) { return (n + alignment - 1) / alignment * alignment; };
    const char* at =
        reinterpret_cast<const char*>(object.dlpi_addr + header.p_vaddr);  // NOLINT(performance-no-int-to-ptr): the loader gives the address as an integer
    const char* end = at + header.p_memsz;
    while (at + sizeof(ElfW(Nhdr)) <= end) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const char* name = at + sizeof note;
      const char* content = name + padded(note.n_namesz);
      if (content + note.n_descsz > end) break;
      if (note.n_type == NT_GNU_BUILD_ID && std::string_view(name, note.n_namesz) == k_owner) {
        std::string hex;
        for (std::size_t k = 0; k < note.n_descsz; ++k) {
          const auto byte = static_cast<unsigned char>(content[k]);
          hex += k_digits[byte >> 4];
          hex += k_digits[byte & 15];
        }
        return hex;
      }
      at = content + padded(note.n_descsz);
    }
  }
  return {};
}

/// The object of the kernel itself, which no result depends on, has no file.
bool has_file(const std::string& name) { return name.find('/') != std::string::npos; }

int add_object(dl_phdr_info* object, std::size_t, void* lines) {
  const std::string name = object->dlpi_name;
  const bool is_program = name.empty();
  if (!is_program && !has_file(name)) return 0;
  std::string id = build_id(*object);
  if (id.empty()) id = hash_file(is_program ? std::filesystem::path("/proc/self/exe") : std::filesystem::path(name));
  static_cast<std::vector<std::string>*>(lines)->push_back((is_program ? "program" : std::filesystem::path(name).filename().string()) + " " + id);
  return 0;
}

}  // namespace

std::string build_identity() {
  std::vector<std::string> lines;
  dl_iterate_phdr(add_object, &lines);
  std::sort(lines.begin(), lines.end());
  std::string text = "sterna " STERNA_VERSION "\n";
  for (const std::string& line : lines) text += line + "\n";
#if defined(__x86_64__)
  text += std::string("processor") + (__builtin_cpu_supports("avx") ? " avx" : "") + (__builtin_cpu_supports("avx2") ? " avx2" : "") +
          (__builtin_cpu_supports("fma") ? " fma" : "") + (__builtin_cpu_supports("avx512f") ? " avx512f" : "") + "\n";
#endif
  return text;
}

}  // namespace sterna::scripting
