// Programs built with a sanitizer need a multiple of the time and memory: time and memory limits do not apply to them.
#pragma once

namespace sterna::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool k_is_sanitized = true;
#else
inline constexpr bool k_is_sanitized = false;
#endif

}  // namespace sterna::test
